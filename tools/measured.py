#!/usr/bin/python3
"""Writes docs/measured.md, and what other pages repeat of it, from what the tools themselves measured.

  measured.py SECTION ... | all      measures these sections and writes their tables
  measured.py --from SECTION=FILE    takes a tool's output that is already there
  measured.py                        writes the texts round the tables anew
  measured.py --check                writes nothing; says where the page is not as this script writes it

Figures of the tables that other pages repeat (FIGURES: README.md, docs/embed.md, docs/my-ground.md) are written there.

Sections: walk kept changes people clips terrain bench window frames pads latency sticks worn claims fuzz soak. A section that is not
measured in this run keeps the table of the page and its date. `--build` names the build folder (default
build), `--data` the folder of captured motions and recordings (default ../shared/data); sections
that need them say so on the page.
"""
import argparse
import csv
import datetime
import glob
import itertools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap

import paper_table

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tools" / "rig")]
from more_kinds import MORE  # noqa: E402
PAGE = ROOT / "docs" / "measured.md"
MOTIONS = ("cmu_m21_walk", "bvhtoolbox_walk01", "cmu_006_01_iclone")
PYTHON = "/usr/bin/python3"


class Missing(Exception):
    """An input of a section is not on this machine."""


# ---- rows ------------------------------------------------------------------------------------
def number(value):
    """The number as text: at most four significant digits, without an exponent if readers do not need one."""
    if value is None:
        return "unknown"
    if value == 0:
        return "0"
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def row(name, worst, allowed="", unit="", runs=None, failed=0, where=""):
    return {"name": name, "worst": worst, "allowed": allowed, "unit": unit, "runs": runs,
            "failed": failed, "where": where}


def distance(value, bound):
    """Distance of the value from its bound; it grows with the value relative to the bound."""
    low_high = re.match(r"(-?[\d.e-]+)\.\.(-?[\d.e-]+)$", bound)
    if low_high:
        return abs(value - 0.5 * (float(low_high[1]) + float(low_high[2])))
    return -value if bound.startswith(">=") else value


# rows that are shown although they have no bound
FOR_COMPARISON = {"raw playback slides, root as in the file", "raw playback slides, root scaled"}


def worst_rows(results):
    """Rows from {label: [check]}, acceptance.py --json: one per bound, the worst of all runs."""
    groups = {}
    for label, checks in results.items():
        for check in checks:
            is_shown = check["bound"] or check["name"] in FOR_COMPARISON
            if check["value"] is not None and is_shown:
                key = (check["name"], check["bound"], check["unit"])
                bad = distance(check["value"], check["bound"])
                entry = (check["ok"] is False, bad, check["value"], label)
                groups.setdefault(key, []).append(entry)
    rows = []
    for (name, bound, unit), found in groups.items():
        _, _, value, label = max(found)
        where = label if len({f[2] for f in found}) > 1 else ""  # the name of the run, if other runs are better
        rows.append(row(name, value, bound, unit, len(found), sum(f[0] for f in found), where))
    return rows


def read_rows(text):
    """A list of {"name", "worst", "allowed"} as it is; a dict of runs becomes one."""
    data = json.loads(text)
    if isinstance(data, dict) and "rows" in data:
        return [row(**entry) for entry in data["rows"]]
    return [row(**entry) for entry in data] if isinstance(data, list) else worst_rows(data)


def output_of(*command, may_fail=False):
    print("$", *command, file=sys.stderr)
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, cwd=ROOT)
    if done.returncode != 0 and not may_fail:
        raise Missing(f"{command[0]} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    return done.stdout


def needed(path):
    if not pathlib.Path(path).exists():
        raise Missing(f"{path} is not there")
    return path


# ---- what measures ---------------------------------------------------------------------------
def measure_walk(options, text=None):
    if text is None:
        needed(options.data / "mocap")
        program = needed(options.build / "gaitpad")
        text = output_of(PYTHON, "tests/session/acceptance.py", program, "--data",
                         options.data / "mocap", "--json", may_fail=True)
    return {"rows": read_rows(text)}


def measure_kept(options, text=None):
    if text is None:
        clips = needed(options.data / "mocap")
        program = needed(options.build / "gaitpad")
        text = output_of(PYTHON, "tests/session/fidelity.py", program, clips, "--built-in",
                         "--json", may_fail=True)
    found = json.loads(text)
    kept = []
    for clip in found["clips"]:
        value = {c["name"]: c["value"] for c in clip["checks"]}
        kept.append({
            "clip": clip["clip"], "rms_deg": clip["rms_deg"], "slide_mm": clip["slide_mm"],
            "knee_maxima": clip["knee_maxima"], "least_knee_deg": clip["least_knee_deg"],
            "fall_m_s2": [max(-low, high) for low, high in clip["fall_m_s2"]],
            "d2_deg": clip["d2_deg"],
            "change_d2_deg": value.get("at changes: second difference"),
            "moves_mm": max(v for n, v in value.items() if n.endswith("moves")),
            "broken": [c["name"] for c in clip["checks"] if c["ok"] is False]})
    broken = sum(bool(k["broken"]) for k in kept)
    return {"kept": kept, "medians": found["medians"],
            "note": f"{len(kept)} walked, {broken} of them beyond a bound; planted heels and toes move "
                    f"by {number(max(k['moves_mm'] for k in kept))} mm at most; "
                    f"{len(found['refused'])} files hold no walk and are refused with the reason."}


# Columns of "changes": lines of transitions.py, whose others are told only where they are not met.
CHANGES = ("first foot off", "90 % of speed", "push", "dip", "faster", "stop", "its way", "deviation", "reversal", "shins",
           "feet", "legs", "legs, turns", "upper body", "chest, head")


def measure_changes(options, text=None):
    if text is None:
        clips = needed(options.data / "mocap")
        text = output_of(PYTHON, "tests/session/transitions.py", needed(options.build / "gaitpad"), clips, "--lines", "--json",
                         may_fail=True)
    changes = json.loads(text)
    broken = sum(any(not line["ok"] for line in motion["lines"]) for motion in changes)
    return {"changes": changes, "note": f"{len(changes)} walked, {broken} of them beyond a bound."}


TERRAIN = {  # column of terrain_sweep: (name, unit, allowed value)
    "high_mm": ("a planted heel or toe off the ground", "mm", "<= 5"),
    "slid_mm": ("a planted heel or toe moves", "mm", "<= 1"),
    "sunk_mm": ("any part of a sole below the ground or inside a riser, any tick", "mm",
                "<= 5"),
    "edge_mm": ("a standing sole over an edge", "mm", "== 0"),
    "bad": ("IK failures", "", "== 0"),
}
CURVED = (  # second difference of a leg angle in these walks, degrees a tick squared
    ("second difference of a leg angle, built-in walk", "<= 1", lambda w: w["motion"] == "procedural"),
    ("the same in captured walks at sticks below 1", "<= 1", lambda w: w["motion"] != "procedural" and float(w["y"]) < 1),
    ("the same in captured walks at full stick", "<= 5", lambda w: w["motion"] != "procedural" and float(w["y"]) >= 1),
)


def measure_terrain(options, text=None):
    if text is None:
        motions = [needed(options.data / "mocap" / f"{name}.bvh") for name in MOTIONS]
        sweep = needed(options.build / "tests" / "terrain_sweep")
        text = output_of(sweep, "procedural", *motions, may_fail=True)
    if text.lstrip().startswith(("[", "{")):
        return {"rows": read_rows(text)}
    lines = text.splitlines()
    names = lines[0].split()
    walks = [dict(zip(names, line.split("MISSED")[0].split())) for line in lines[1:]
             if line.count(" ") > 10]
    rows = []
    for column, (name, unit, allowed) in TERRAIN.items():
        worst = max(walks, key=lambda w: float(w[column]))
        rows.append(row(name, float(worst[column]), allowed, unit, len(walks), 0, place(worst)))
    for name, allowed, chosen in CURVED:
        found = [w for w in walks if chosen(w)]
        if found:
            worst = max(found, key=lambda w: float(w["d2_deg"]))
            rows.append(row(name, float(worst["d2_deg"]), allowed, "deg/tick2", len(found), 0,
                            place(worst)))
    missed = sum("MISSED" in line for line in lines)
    return {"rows": rows, "note": f"{missed} of {len(walks)} walks missed a bound."}


def place(walk):
    return f"{walk['motion']}, leg {walk['leg']}, stick {walk['y']}, {walk['style']}"


def measure_bench(options, text=None):
    text = text or output_of(needed(options.build / "gaitpad"), "bench", "--json")
    found = json.loads(text)
    rows = []

    def add(name, label, key="ns", characters=None, **others):
        """Adds the row of that name, in its own unit; `others` are keys that it has to have."""
        for b in found:
            if b["name"] != name or characters not in (None, b["characters"]):
                continue
            if any(b.get(k) != v for k, v in others.items()):
                continue
            bound = b.get({"ns": "bound_ns", "ratio": "bound_ratio", "growth": "bound_growth"}.get(key, ""))
            if b["name"].startswith(("load", "replay")):
                rows.append(row(label, b["ns"] / 1e6, f"<= {bound / 1e6:g}" if bound else "", "ms"))
            else:
                rows.append(row(label, b[key], f"<= {bound:g}" if bound else "",
                                "ns" if key == "ns" else "x"))

    widest = found[0]["lanes"]
    add("leg_paper", "one leg, paper mode, the solve alone")
    add("leg_robust_even", "one leg, robust, even weights")
    add("leg_robust_weighted", "one leg, robust, stiff hip or knee")
    add("playback", "bare playback of the skeleton, scalar: local rotations")
    add("playback_world", "the same and the world frames of all joints")
    add("character_even", "one character, even")
    add("character_even", "the same over bare playback", "ratio")
    add("characters_styled", "four characters with styles, each")
    add("characters_styled", "the same over four even ones", "ratio")
    add("character_even_60_hz", "one character, even, at 60 Hz")
    add("character_asked", "one character, even, on waves that are asked for")
    add("ground_query", "one question to a height field")
    add("step", "four characters with the session around them, each", characters=4)
    add("crowd_alone", "a member of the crowd, mixed builds and styles, at 60 Hz, alone")
    for width in (16, 8, 4, 1):
        add("crowd", f"crowd of 1,000 in {width} lanes, each", characters=1000, width=width)
        add("crowd", "the same over bare playback", "ratio", characters=1000, width=width)
        add("crowd", "the same over its members alone", "ratio_alone", characters=1000, width=width)
    for size in (10000, 100000):
        add("crowd", f"crowd of {size:,}, each", characters=size, width=widest)
        if any(b["characters"] == size and "growth" in b for b in found):
            add("crowd", "the same over the crowd of 1,000", "growth", characters=size, width=widest)
    add("crowd_memory", "limit by memory: state and pose of one of 100,000 moved, nothing computed", characters=100000)
    add("crowd_all_cores", "crowd of 10,000 on all cores, each", characters=10000)
    add("load_built_in", "loading the built-in motion the first time")
    add("load_clip", "loading a clip the first time")
    add("load_cached", "loading it again")
    add("replay", "a replay of 20 s in a running program, without files")
    add("replay_files", "the same with files")
    return {"rows": rows, "note": f"{found[0]['processor']}, {widest} lanes."}


def measure_window(options, text=None):
    """The results of tools/realtime.sh."""
    folder = options.build / "realtime"
    summary = json.loads(text or needed(folder / "summary.json").read_text())
    s = summary[0] if isinstance(summary, list) else summary
    rows = [
        row("ticks begun more than one period late", 1000.0 * s["overruns"] / max(s["ticks"], 1),
            "< 1 where the host takes no time away", "per 1000"),
        row("time skipped", s["skipped_s"], "== 0", "s"),
        row("lateness of a tick, median", s["late_us_median"], "", "us"),
        row("a tick, median", s["tick_us_median"], "", "us"),
    ]
    if s.get("frame_us_p99"):
        frame_us = 1e6 / s["frames_per_second"]
        rows += [row("stick to frame, median", s["frame_us_p50"] / 1000.0,
                     f"<= {frame_us / 1000.0 + 5:.1f}: a frame and 5 ms", "ms"),
                 row("stick to frame, 99th percentile", s["frame_us_p99"] / 1000.0, "", "ms")]
    if "frames_per_second" in s:
        rows.append(row("frames drawn", s["frames_per_second"], ">= 20", "per second"))
    if (folder / "control.json").exists():
        control = json.loads((folder / "control.json").read_text() or "{}")
        rows.append(row("late wake-ups of a thread beside it that only sleeps", control.get("late"),
                        "", f"against {s['overruns']} of the loop"))
    return {"rows": rows, "runs": s["ticks"], "time_policy": s["time_policy"]}


RATES_HZ = (240, 250, 500, 1000)
FRAMES_S = 20


def measure_frames(options, text=None):
    """Measures four characters in the window at each rate; `text`: the summaries of such runs, a list."""
    if text is None:
        program, runs = needed(options.build / "gaitpad"), []
        display = () if os.environ.get("DISPLAY") else ("env", "SDL_VIDEODRIVER=offscreen")
        with tempfile.TemporaryDirectory() as folder:
            trace = pathlib.Path(folder) / "long.hid"
            output_of(PYTHON, "tools/long_trace.py", "config/traces/round.hid", trace, FRAMES_S + 10)
            for rate_hz in RATES_HZ:
                runs.append(json.loads(output_of(*display, program, "play", trace, "--rate", rate_hz,
                                                 "--seconds", FRAMES_S, "--json")))
        text = json.dumps(runs)
    keys = ("rate_hz", "frames_per_second", "wait_us_median", "frame_us_p50", "frame_us_p99")
    return {"rates": [{key: (run[0] if isinstance(run, list) else run)[key] for key in keys}
                      for run in json.loads(text)]}


DRIVERS = ("hidraw", "evdev", "usb", "sdl")
KINDS = {"generic": "generic HID pad, by its descriptor alone", "ds4": "DualShock 4",
         "dualsense": "DualSense", "switch": "Switch Pro Controller", "xbox360": "Xbox 360, wired",
         "xboxone": "Xbox One S, wired"} | {name: kind.name for name, kind in MORE.items()}
BLUETOOTH = {"ds4_bt": "DualShock 4, Bluetooth", "dualsense_bt": "DualSense, Bluetooth",
             "xbox_bt": "Xbox Wireless Controller, Bluetooth", "switch": "Switch Pro Controller, Bluetooth",
             "joycons": "a pair of Joy-Cons as one pad, Bluetooth"}


def measure_pads(options, text=None):
    text = text or needed(options.rig / "remarks").read_text()
    served = set(re.findall(r"^([a-z0-9]+)-([a-z]+): \d+ reports, pose hash", text, re.M))
    felt = set(re.findall(r"^rumble, ([a-z0-9]+)-([a-z]+):", text, re.M))
    linked = set(re.findall(r"^bluetooth, ([a-z0-9_]+)-([a-z]+): \d+ reports", text, re.M))
    found_again = set(re.findall(r"^bluetooth, ([a-z0-9_]+)-([a-z]+): a lost link", text, re.M))
    cells = {}
    for kind in KINDS:
        for driver in DRIVERS:
            cell = "yes" if (kind, driver) in served else "not measured"
            if kind in MORE and driver not in MORE[kind].drivers:
                cell = "-"
            if kind in ("xbox360", "xboxone") and driver == "hidraw":
                cell = "-"
            cells[f"{kind}-{driver}"] = cell + (", R" if (kind, driver) in felt else "")
    for kind in BLUETOOTH:
        for driver in DRIVERS:
            cell = "yes" if (kind, driver) in linked else "-" if driver == "usb" else "not measured"
            cells[f"bluetooth-{kind}-{driver}"] = cell + (", L" if (kind, driver) in found_again else "")
    return {"cells": cells}


def measure_latency(options, text=None):
    text = text or needed(options.rig / "latency.csv").read_text()
    return {"ways": list(csv.DictReader(text.splitlines()))}


STICK = (("centre_x", "centre, x", ""), ("centre_y", "centre, y", ""), ("sigma_x", "noise, x", ""),
         ("sigma_y", "noise, y", ""), ("hysteresis", "hysteresis", ""),
         ("drift_per_s", "drift", "per s"),
         ("min_x", "range, least x", ""), ("max_x", "range, greatest x", ""),
         ("min_y", "range, least y", ""),
         ("max_y", "range, greatest y", ""), ("circularity_error", "circularity error", "%"),
         ("rate_hz", "rate", "Hz"), ("jitter_ms", "jitter", "ms"), ("inner_zone", "inner zone", ""),
         ("outer_zone", "outer zone", ""), ("rests", "rests", ""),
         ("rest_samples", "reports at rest", ""),
         ("samples", "reports", ""), ("verdict", "verdict", ""))


def measure_sticks(options, text=None):
    if text is None:
        files = sorted(glob.glob(str(needed(options.data / "hid") / "dualsense_usb_*.hid")))
        files = [f for f in files if not f.endswith((".rdesc.hid", ".raw.hid"))]
        with tempfile.TemporaryDirectory() as folder:
            traces = [argument for f in files for argument in ("--trace", f)]
            text = output_of(needed(options.build / "gaitpad"), "calibrate", *traces, "--json",
                             "--out", f"{folder}/pad.toml", may_fail=True)
    sticks = json.loads(text)["sticks"]
    rows = [{"name": name, "left": sticks["left"].get(key), "right": sticks["right"].get(key),
             "unit": unit}
            for key, name, unit in STICK]
    for name, key in (("noise, x", "sigma_x"), ("noise, y", "sigma_y")):
        for side in ("left", "right"):
            if sticks[side].get("sigma_hidden_by_steps"):
                next(r for r in rows if r["name"] == name)[side] = "below a step"
    return {"sticks": rows}


def measure_by(script):
    """Measures by a script of tests/ that prints rows with --json."""
    def measure(options, text=None):
        return {"rows": read_rows(text or output_of(PYTHON, script, needed(options.build / "gaitpad"), "--json", may_fail=True))}
    return measure


AIM_OF_EXECUTIONS = 10 ** 9


def measure_fuzz(options, text=None):
    text = text or needed(ROOT / "build-fuzz" / "executed.tsv").read_text()
    runs = [line.split("\t") for line in text.splitlines()]
    targets = sorted({target for target, *_ in runs})
    rows = []
    for target in targets:
        own = [list(map(int, run[1:])) for run in runs if run[0] == target and run[3]]
        rows.append((target, sum(n for _, n, _ in own), sum(s for s, _, _ in own) / 60, max(e for _, _, e in own)))
    broken = [path.name for kind in ("crash", "leak", "oom", "timeout") for path in (ROOT / "build-fuzz").glob(f"fuzz_*-{kind}-*")]
    return {"targets": rows, "note": f"{sum(n for _, n, _, _ in rows):,} executions in all, of {AIM_OF_EXECUTIONS:,} aimed at; "
                                     f"inputs that break a target: {', '.join(broken) or 'none'}."}


def fuzz_rows(section):
    return [[f"`{target}`", f"{runs:,}", f"{minutes:.0f}", f"{edges:,}"] for target, runs, minutes, edges in section["targets"]]


def measure_soak(options, text=None):
    text = text or needed(options.build / "soak.txt").read_text()
    return {"rows": read_rows(next(line for line in reversed(text.splitlines()) if line.startswith("[{")))}


def measure_worn(options, text=None):
    text = text or output_of(needed(options.build / "tests" / "test_session"),
                             "--gtest_filter=WornStick.*")
    walk = re.search(r"worst of (\d+) sticks: ([\d.]+) mm sideways in one stride, "
                     r"([\d.]+) mm on average, stride ([\d.]+)", text)
    full = re.search(r"full deflection of (\d+) sticks: at least ([\d.]+), "
                     r"after the sideways zone ([\d.]+)", text)
    if not walk or not full:
        raise Missing("test_session did not print the lines of WornStick")
    sticks = int(walk[1])
    rests = re.search(r"\[ +OK \] WornStick.RestNeverMovesIt", text)
    at_rest = f"0 of {sticks * 20000}" if rests else "not measured"  # 20000 positions of each stick
    return {"rows": [
        row("sideways drift of a walk straight ahead, one stride", float(walk[2]), "<= 1", "mm",
            sticks),
        row("the same on average", float(walk[3]), "<= 1", "mm", sticks),
        row("full deflection, any of 360 directions, before the sideways zone", float(full[2]),
            ">= 0.99", "", sticks),
        row("the same after it", float(full[3]), ">= 0.96", "", sticks),
        row("stride at full deflection forward, over the full one", walk[4], ">= 0.999", "",
            sticks),
        row("reports at rest that move the character", at_rest, "== 0", "", sticks),
    ]}


def measure_claims(options, text=None):
    if text is None:
        with tempfile.TemporaryDirectory() as folder:
            output_of(needed(options.build / "gaitpad"), "figures", "--out", folder, may_fail=True)
            text = (pathlib.Path(folder) / "claims.json").read_text()
    claims = json.loads(text)["claims"]
    paper_table.write(claims, ROOT / "docs" / "paper.md")
    rows = []
    for mode in MODES:
        mine = [c for c in claims if c["mode"] == mode]
        rows.append({"name": mode, "held": sum(c["pass"] is True for c in mine),
                     "failed": sum(c["pass"] is False for c in mine),
                     "untestable": sum(c["pass"] is None for c in mine)})
    return {"claims": rows}


# ---- rows of tables --------------------------------------------------------------------------
def value_text(entry):
    if isinstance(entry["worst"], str):
        return entry["worst"]
    return f"{number(entry['worst'])} {entry['unit']}".strip()


def bounds_rows(section):
    return [[r["name"], value_text(r), r["allowed"] or "-"] for r in section["rows"]]


def runs_rows(section):
    def runs_text(r):
        return f"{r['failed']} of {r['runs']} failed" if r["failed"] else str(r["runs"] or "-")

    return [[*cells, runs_text(r), r["where"] or "-"] for cells, r in zip(bounds_rows(section), section["rows"])]


def kept_rows(section):
    def pairs(values):
        return ", ".join(f"{round(a)} > {round(b)}" for a, b in values)

    rows = [[k["clip"].rsplit(".", 1)[0], *(f"{v:.1f}" for v in k["rms_deg"]),
             pairs(k["knee_maxima"]), pairs(k["least_knee_deg"]), pairs([k["fall_m_s2"]]),
             f"{k['d2_deg']:.2f}", f"{k['change_d2_deg']:.2f}", f"{k['slide_mm']:.0f}",
             ", ".join(k["broken"]) or "-"] for k in section["kept"]]
    medians = [f"{m['value']:.2f} ({m['bound']})" for m in section["medians"]] or ["-"] * 3
    rows.append(["median of the clips", *medians, *["-"] * 7])
    return rows


def changes_rows(section):
    def cells(motion):
        values = {line["name"]: number(line["value"]) for line in motion["lines"]}
        broken = [f"{line['name']} {number(line['value'])} ({line['sign']} {number(line['bound'])})"
                  for line in motion["lines"] if not line["ok"]]
        return [motion["motion"], *(values[name] for name in CHANGES), ", ".join(broken) or "-"]

    return [cells(motion) for motion in section["changes"]]


ALL_PADS = KINDS | {f"bluetooth-{kind}": label for kind, label in BLUETOOTH.items()}


def pads_rows(section):
    return [[label, *(section["cells"][f"{kind}-{d}"] for d in DRIVERS)] for kind, label in ALL_PADS.items()]


def frames_rows(section):
    def ms(us):
        return f"{us / 1000:.1f} ms"

    return [[f"{r['rate_hz']} Hz", ms(1e6 / r["frames_per_second"]), ms(r["wait_us_median"]),
             ms(r["frame_us_p50"]), ms(r["frame_us_p99"]),
             ms(1e6 / r["frames_per_second"] + 5000)] for r in section["rates"]]


WAYS = {"bare_hidraw": "bare `poll` + `read` of the hidraw node",
        "bare_evdev": "the same of the event node",
        "plain_sdl": "a plain SDL2 program (`SDL_WaitEventTimeout`)"}


def latency_rows(section):
    def ms(text, unit=" ms"):
        return f"{float(text) / 1000:.1f}{unit}" if text not in ("", None) else "-"

    def spread(way, start):
        median = way.get(f"{start}median_us")
        if median in ("", None):
            return "-"
        low, high = (ms(way[f"{start}{q}_us"], "") for q in ("q1", "q3"))
        return f"{ms(median)} ({low} to {high})"

    return [[WAYS.get(w["way"], f"`{w['way']}` driver"), spread(w, ""), ms(w["p99_us"]),
             ms(w["over_bare_us"]), spread(w, "to_tick_"), ms(w["to_tick_p99_us"])]
            for w in section["ways"]]


def sticks_rows(section):
    def cell(value, unit):
        if isinstance(value, str):
            return value
        return f"{number(round(value, 3) if value is not None else None)} {unit}".strip()

    return [[r["name"], cell(r["left"], r["unit"]), cell(r["right"], r["unit"])]
            for r in section["sticks"]]


MODES = ("paper", "robust")


def claims_rows(section):
    return [[r["name"], str(r["held"]), str(r["failed"]), str(r["untestable"])]
            for r in section["claims"]]


# section: (measure, rows, title, made data alone, text before, text after)
SECTIONS = {
    "walk": (measure_walk, runs_rows, "Walks on level ground", False, """\
`tests/session/acceptance.py build/gaitpad` replays the built-in motion and three captured walks
(CMU's m21 walk and 006_01, bvh-toolbox's walk01) with all styles that change the legs, legs of
0.6, 1 and 1.6 times the length, straight, backwards, turning, starting, stopping and with random
sticks, and judges the exported files alone. `d2` is the second difference of a joint's rotation,
in degrees per tick squared; `(fast)` are captured walks beyond 1.3 m/s. If a name occurs twice,
the tighter bound is that of the built-in walk. The step length error is a share of what is
allowed: 0.5 %, in turns 1 %, or 1 mm. `limp` compares `limp_left` with `even`. `weights` compare
a hip weight of 0.2 (hip RMS at least 1.5 degrees) and a knee weight of 0.8 (0.2 to 1.5 degrees)
with even weights. `raw playback` plays the same angles on the same character without adaptation;
it has no bound.""", """\
The three captured walks are plain walks. The next section has the other clips."""),
    "kept": (measure_kept, kept_rows, "What a walk keeps of its capture", False, """\
`tests/session/fidelity.py build/gaitpad FOLDER --built-in` walks each clip of a folder straight on
level ground at its own pace, style `even`, and compares the exported poses with the file's own
frames, after the one phase shift that is best. Hip, knee and ankle are flexions, degrees RMS of
the worse leg; allowed are 3, 3 and 3.5, and up to 4 where the capture's own feet slide (mm) by more
than 40. Capture > walk: the maxima of the left and of the right knee in a stride (none added),
their least angles in degrees (within 3; below 1 counts as 1), and the greatest vertical
acceleration of the hips in m/s² (12, or 1.5 times the capture's). `d2` is the second difference of
a leg joint, degrees a tick²: in the steady walk (0.7; built-in 0.5), and where the walk starts,
stops and changes its stride (1.3).""", """\
A walk keeps neither a knee that a file bends backwards nor the gap of a stride that does not end
as it began."""),
    "changes": (measure_changes, changes_rows, "Starts, stops and turns", False, """\
`tests/session/transitions.py build/gaitpad FOLDER --lines` moves the stick as a thumb does, in 60 ms: starts, stops at twelve
moments of the stride (sticks of 0.3, 0.8 and 1), reversals, and four kinds of turns; the worst of all is told, of times and of
the way at full stick the median. Asked are: first foot off 0.35 s, 90 % of the speed 1 s, push of the hips 6 m/s² or the steady
walk's own, dip 1 cm, 1.05 times the steady walk's fastest, stop 0.9 s and 0.9 m with a standard deviation of 0.1 m, reversal
1.2 s, shins 70 mm apart, feet 60 mm or as in standing, second difference of a leg's joint 0.8 degrees a tick²
(captures: 1.2), of another joint as much or twice the steady walk's, angular acceleration of chest and head twice the steady walk's. The tool's head says how each is measured.""", ""),
    "people": (measure_by("tests/session/people.py"), runs_rows, "Beside people", True, """\
`tests/session/people.py build/gaitpad` walks the built-in motion and sets it beside what others measured of people. The
curves are the mean of healthy people at free speed (Schwartz, Rozumalski & Trost 2008) at every 4 % of a cycle, after the
mean of each curve is laid on theirs; allowed is about their standard deviation. Toe clearance: Winter 1991, Moosabhoy & Gard
2006. Cadence, the first landing interval (from the first landing to the second), and the U-turn (`--stick points`, from ahead
to back, until the heading is within ten degrees) are those of 19 healthy people.""", """\
A bound that is missed is a fact about this walk, not a failed test: at small sticks it takes slow steps on purpose."""),
    "clips": (measure_by("tests/tools/clips.py"), runs_rows, "Exported clips", True, """\
`tests/tools/clips.py build/gaitpad` exports thirty walks as `pose.glb` at 60 frames a second and judges each as the import of
a game would; when a point is planted `frames.csv` says (`tests/support/clip_lint.py`). A loop is one to four strides, as many as end
nearest to a whole frame. Khronos' validator and Blender read exported files in `tests/tools/gltf_test.py`.""", ""),
    "terrain": (measure_terrain, runs_rows, "Walks over terrain", False, """\
`build/tests/terrain_sweep MOTION ...` (`cmake --build build --target terrain_sweep`) walks the
course from its beginning to a stop after its end and judges every tick by a grid of points over
each sole: the built-in motion and those three, all styles, legs of 0.6, 1 and 1.6, sticks of 0.4,
0.7 and 1.""", """\
[walk.md](walk.md) says which walks miss a bound, and why."""),
    "bench": (measure_bench, bounds_rows, "Time of a tick, of loading and of a replay", True, """\
`build/gaitpad bench`, processor time on one core of the machine that wrote this page (elapsed time
where threads work together: loading, all cores); yours prints its own. A tick comes every 4167 us. [crowd.md](crowd.md) says what each row holds. A motion that was loaded before
has its strides in the cache.""",
              ""),
    "window": (measure_window, bounds_rows, "The window", True, """\
`bash tools/realtime.sh` lets four characters walk for five minutes in the window, drawn by
software (llvmpipe, one drawing thread) on two cores, with the loop under `SCHED_FIFO`. The
machine was a virtual one that others used at the same time. The bound on late ticks is not judged
where the host takes processor time away (`steal`).""", ""),
    "frames": (measure_frames, frames_rows, "From the stick to the frame", True, """\
`build/gaitpad play TRACE --rate HZ` with four characters in the window, drawn by software: from
each report's stamp to the hand-over of the first frame that shows it.""", """\
It is half a frame, the time of drawing, and the wait for the tick. With a graphics card drawing
takes a few milliseconds, and the frame begins so late that it is ready just before the refresh."""),
    "pads": (measure_pads, pads_rows, "Pads and drivers", True, """\
`GAITPAD_ALL=1 bash tools/rig.sh` boots a current Debian kernel in QEMU, plugs virtual USB pads into it and runs
the program there ([rig.md](rig.md)). For each cell it lists the pad, decodes every stick, trigger
and button as sent, records the session, and replays the recording to the session's `pose_hash`.
**R**: the pad also received the rumble of the heel strikes, weak at slow and strong at fast
walking, and each stop. The last rows are pads behind the kernel's own Bluetooth stack, between
virtual controllers without a radio; **L**: the link was also lost, noticed and found again. A dash:
there is no such way to that pad.""", """\
The kernel is real, the pads are not: no physical pad has been through these tests."""),
    "latency": (measure_latency, latency_rows, "Latency", True, """\
From the pad's write to `gaitpad play`, on its own threads, and to the begin of the tick that uses
the report, in that virtual machine: the median, and from the first to the third quartile. It
compares the ways with each other and is no figure of your PC.""", """\
A generic pad, 250 reports a second. The blocks of 200 reports of each driver alternate with those
of the bare read, and `over` is the median of the differences block by block. A tick comes every
4.17 ms, so a report waits half of that on average."""),
    "sticks": (measure_sticks, sticks_rows, "A real DualSense", False, """\
`build/gaitpad calibrate --trace ...` on recordings of a DualSense over USB, 3 to 7 seconds each,
that others made. Each stick is turned round in one of them and rests in the others.""", """\
The pad reports 8 bits, so one step is 0.0078: the sticks rest up to 2.5 counts of 256 off the
middle and come back to within 4 counts, and a step hides their noise. The range is full on all
sides. A circularity error of 7 to 10 % is normal: Sony's sticks reach further than a circle
between the axes. The further 0.03 of a stick that is pressed hard do not count. The jitter is that of the
recorder's stamps. The inner zone is the least one; without a calibration it is 0.12. With the
zones found in the two recordings that turn a stick, the calibrated stick is exactly 0 in every
other recording, except in the two in which the left hand moves it (`build/tests/test_stick
--gtest_filter='RecordedSticks.*'`)."""),
    "worn": (measure_worn, runs_rows, "A worn stick", True, """\
`build/tests/test_stick` checks the analysis on made sticks whose truth is known: 8 to 16 bits,
noisy, off centre, square, drifting, with spikes and lost reports, 500 of them without a false
alarm. The worst of these (8 bits, 0.15 off centre, noise 0.02, hysteresis 0.1, reach 0.8 and 0.7)
is calibrated and walked with by `build/tests/test_session --gtest_filter='WornStick.*'`.""", ""),
    "claims": (measure_claims, claims_rows, "The paper's claims", True, """\
`build/gaitpad figures --out out/figures`, the built-in motion: how many assertions hold.
[paper.md](paper.md) lists each one, and why some fail.""", ""),
    "fuzz": (measure_fuzz, fuzz_rows, "Bad input", True, """\
`bash tools/fuzz.sh --hours N` runs the targets of `tools/fuzz` in turn under AddressSanitizer and
UndefinedBehaviorSanitizer, beginning with the inputs of `tools/fuzz/corpus`; `tools/measured.py fuzz` counts what ran in
`build-fuzz` so far. Edges: of the control flow, as libFuzzer counts them.""", ""),
    "soak": (measure_soak, bounds_rows, "A long run", True, """\
`bash tools/soak.sh --hours N` lets four characters walk in the window, drawn by software, while a pad is plugged in and out,
styles, panels and themes change; the session is recorded and replayed at the end. The caches fill in the first ten minutes;
after them the first quarter of the rest is compared with the last.""", ""),
}

ONE_RUN, MANY_RUNS = ["", "measured", "allowed"], ["", "worst", "allowed", "runs", "worst run"]
# section: the columns of its table, and the names of its rows where they do not come from what was measured
SHAPES = {
    "walk": (MANY_RUNS, None), "worn": (MANY_RUNS, None), "bench": (ONE_RUN, None), "window": (ONE_RUN, None),
    "kept": (["walk", "hip", "knee", "ankle", "knee maxima", "least knee", "acceleration", "d2", "d2, changing",
              "own slide", "beyond its bound"], None),
    "changes": (["walk", *CHANGES, "beyond its bound"], None),
    "terrain": (MANY_RUNS, [name for name, _, _ in (*TERRAIN.values(), *CURVED)]),
    "frames": (["ticks", "a frame", "report to tick, median", "stick to frame, median", "99th percentile",
                "a frame and 5 ms"], [f"{rate_hz} Hz" for rate_hz in RATES_HZ]),
    "pads": (["", *(f"`{d}`" for d in DRIVERS)], list(ALL_PADS.values())),
    "latency": (["way", "to the program", "99th percentile", "over the bare read", "to the tick's begin",
                 "99th percentile"], None),
    "sticks": (["", "left", "right"], [name for _, name, _ in STICK]),
    "people": (MANY_RUNS, None), "clips": (MANY_RUNS, None), "soak": (ONE_RUN, None),
    "fuzz": (["target", "executions", "minutes", "edges"], None),
    "claims": (["mode", "hold", "fail", "cannot be tested with this motion"], list(MODES)),
}

# ---- the page --------------------------------------------------------------------------------
HEAD = """\
# What was measured

`tools/measured.py` writes this page from the output of the tools that it names. Do not edit it by hand. A section that
was not measured in the latest run keeps its table and its date.

```
/usr/bin/python3 tools/measured.py bench claims    # measures these two and writes the page
/usr/bin/python3 tools/measured.py all             # all that can be measured here
```
Sections marked *needs real data* use captured motions or recordings of real pads that are not in
this repository ([data.md](data.md)). All others run from a clone alone.
"""


def wrapped(text):
    return textwrap.wrap(" ".join(text.split()), 120, break_long_words=False,
                         break_on_hyphens=False)


def table(name, rows):
    heads, names = SHAPES[name]
    if names is not None:
        found = {row[0]: row for row in rows}
        rows = [found.get(one, [one, *["not measured"] * (len(heads) - 1)]) for one in names]
    lines = ["| " + " | ".join(cells) + " |" for cells in (heads, *rows)]
    return [lines[0], "|" + "---|" * len(heads), *lines[1:]]


def page_of(results):
    """The page. results: section -> (rows, text about its measurement)."""
    lines = HEAD.splitlines()
    for name, (_, _, title, _, before, after) in SECTIONS.items():
        lines += ["", f"## {title}", "", *wrapped(before), ""]
        if name not in results:
            lines.append("Not measured.")
            continue
        rows, said = results[name]
        lines += table(name, rows)
        if after:
            lines += ["", *wrapped(after)]
        lines += ["", *wrapped(said)]
    return "\n".join(lines) + "\n"


def results_of(page):
    """Reads a page of page_of() back. Skips rows whose number of cells differs from the number of columns."""
    results = {}
    for name, (_, _, title, *_) in SECTIONS.items():
        text = re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", page, re.S | re.M)
        said = re.search(r"^Measured on .*", text[1], re.S | re.M) if text else None
        if said:
            rows = [line[2:-2].split(" | ") for line in text[1].splitlines() if line.startswith("| ")][1:]
            results[name] = [row for row in rows if len(row) == len(SHAPES[name][0])], said[0]
    return results


def new_result(name, options, text):
    measure, rows, _, is_made, _, _ = SECTIONS[name]
    found = measure(options, text)
    mark = "" if is_made else " *Needs real data.*"
    note = f" {found['note']}" if found.get("note") else ""
    return rows(found), f"Measured on {datetime.date.today().isoformat()}.{mark}{note}"


def difference(page):
    """An error about the first line that differs from this script's page, numbers aside; None if none does."""
    for ours, theirs in itertools.zip_longest(page_of(results_of(page)).splitlines(), page.splitlines()):
        if ours != theirs:
            return f"docs/measured.md: {theirs!r} stands where this script writes {ours!r}"
    for page_name in FIGURES:
        text = (ROOT / page_name).read_text()
        if with_figures(page_name, text, results_of(page)) != text:
            return f"{page_name}: a figure is not that of docs/measured.md; run tools/measured.py"
    return None


# ---- figures on other pages --------------------------------------------------------------------
def figure(results, section, row, column=1):
    """A number of the first row of a section's table that begins so, without its unit; LookupError if there is none."""
    cells = next((r for r in results[section][0] if r[0].startswith(row)), None)
    if cells is None:
        raise LookupError(row)
    return float(re.match(r"[\d.e+-]+", cells[column])[0])


def rounded(value):
    return f"{float(f'{value:.2g}'):g}"


def kept_text(results, row):
    return "{:.1f}, {:.1f} and {:.1f}".format(*(figure(results, "kept", row, column) for column in (1, 2, 3)))


def us(results, row, times=1):
    return rounded(times * figure(results, "bench", row) / 1000)


def over(results, row, under):
    return f"{figure(results, 'bench', row) / figure(results, 'bench', under):.1f}"


# page: (the words around a figure, where (.+?) stands for it; the figure by the tables)
FIGURES = {
    "README.md": (
        (r"hips, knees and ankles stay within (.+?) degrees", lambda r: kept_text(r, "built-in")),
        (r"captured walks are (.+?)\.\n", lambda r: kept_text(r, "median of the clips")),
        (r"with styles takes about (\S+?) µs", lambda r: us(r, "four characters with styles", 4)),
        (r"takes\s+about (\S+?) µs a character", lambda r: us(r, "crowd of 1,000 in")),
    ),
    "docs/embed.md": ((r"takes about (\S+?) µs", lambda r: us(r, "one character, even")),),
    "docs/my-ground.md": (
        (r"tick takes about (\S+?) times", lambda r: over(r, "one character, even, on waves", "one character, even")),
        (r"answers in about (\S+?) ns", lambda r: rounded(figure(r, "bench", "one question"))),
    ),
}


def with_figures(page, text, results):
    """The text of that page with the tables' figures; a figure that no table has stays."""
    for words, of in FIGURES[page]:
        found = re.search(words, text)
        if not found:
            raise SystemExit(f"measured.py: {page} has no text {words!r}")
        try:
            text = text[:found.start(1)] + of(results) + text[found.end(1):]
        except LookupError:
            continue
    return text


# ---- the command -----------------------------------------------------------------------------
def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("section", nargs="*", choices=[*SECTIONS, "all", []])
    parser.add_argument("--from", dest="files", action="append", default=[], metavar="SECTION=FILE")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared" / "data")
    parser.add_argument("--kernel", default="6.1", help="whose results of the rig are taken")
    parser.add_argument("--check", action="store_true", help="exit status 1 if the page is not as this script writes it")
    options = parser.parse_args()
    options.build, options.data = options.build.resolve(), options.data.resolve()
    options.rig = options.build / "rig" / f"results-{options.kernel}"
    return options


def main():
    options = arguments()
    page = PAGE.read_text()
    if options.check:
        found = difference(page)
        if found:
            print(found, file=sys.stderr)
        return 1 if found else 0
    results = results_of(page)
    wanted = {name: None for name in (SECTIONS if "all" in options.section else options.section)}
    for entry in options.files:
        name, _, path = entry.partition("=")
        if name not in SECTIONS or not path:
            print(f"measured.py: --from {entry}: not SECTION=FILE", file=sys.stderr)
            return 2
        wanted[name] = pathlib.Path(path).read_text()
    for name, text in wanted.items():
        try:
            results[name] = new_result(name, options, text)
        except Missing as problem:
            kept = "keeps its table" if name in results else "is not measured"
            print(f"{name} {kept}: {problem}", file=sys.stderr)
    PAGE.write_text(page_of(results))
    for name in FIGURES:
        other = ROOT / name
        other.write_text(with_figures(name, other.read_text(), results_of(PAGE.read_text())))
    return 0


if __name__ == "__main__":
    os.chdir(ROOT)
    sys.exit(main())
