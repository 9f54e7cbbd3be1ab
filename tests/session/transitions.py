#!/usr/bin/python3
"""Measures what is not steady in a walk: starts, stops, reversals and turns, from what `gaitpad replay` exports.

  transitions.py PROGRAM [MOTION_OR_FOLDER ...] [--lines] [--stick Y ...] [--turns] [--thumb SECONDS] [--json]

Thumbs move in 60 ms or what --thumb says (minimum jerk). One row a motion and stick, the built-in motion first. Each stop is
repeated at twelve moments of a cycle. With --lines one row a motion: the worst of its sticks and turns beside what is asked
of them (lines_of()).

- First response: the hips have moved by 5 mm, or chest or head have turned by 1 degree. First foot off: its toe is 1 cm
  above its rest. 90 % of speed: of the steady walk's mean.
- Accelerations of the hips along the heading at 60 Hz: over four ticks to either side.
- Below, back, faster: the hips below the steady walk's lowest place, how far they go back, and their greatest speed over
  the steady walk's greatest.
- Stopped: the hips are within 1 cm of where they end. The way counts from the moment at which the thumb begins; its
  standard deviation over the moments is by how much a player misses a mark who has learnt the mean way. What the thumb's
  own timing adds, 15 mm a centisecond at 1.5 m/s, is not in it.
- Shins: the least distance of both shanks' axes from knee to ankle while the walk turns; feet: of the lines from heel to
  toe.
- Closing foot: how far the heel of a last flight goes out of the straight line between its footprints.
- Second difference of all joints, degrees a tick^2 at 240 Hz, of the ticks of the change; legs: of the legs' joints alone;
  upper: of all others. Chest and head: their angular acceleration at 60 Hz over the steady walk's greatest.
"""
import argparse
import dataclasses
import functools
import json
import multiprocessing
import pathlib
import sys
import tempfile

import numpy as np

if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from fidelity import clips_of
from support import program as programs
from support.traces import EXACT_CALIBRATION, write_trace
from support.walk import Walk

RATE = 240
THUMB_S = 0.06
COARSE = 4  # ticks in a step of 60 Hz
MOMENTS = 12
ROUNDING = 1e-9  # a mean of whole ticks that is the bound meets it


# ---- a hand ----------------------------------------------------------------------------------
def thumb(*moves, takes_s=THUMB_S):
    """Reports of a stick that moves to (x, y) within `takes_s` of each time: moves are (time_s, x, y)."""
    place, timeline = (0.0, 0.0), [(0.0, 0.0, 0.0)]
    for time_s, x, y in moves:
        for i in range(1, 16):
            u = i / 15
            s = u ** 3 * (10 - 15 * u + 6 * u * u)
            timeline.append((time_s + u * takes_s, place[0] + s * (x - place[0]), place[1] + s * (y - place[1])))
        place = (x, y)
    return timeline


class Player:
    """Replays moves of a thumb, each in a folder of its own."""

    def __init__(self, program, folder, motion=None, options=(), thumb_s=THUMB_S):
        self.program, self.folder, self.count = program, pathlib.Path(folder), 0
        self.thumb_s = thumb_s
        self.options = [*options, *(["--motion", motion] if motion else [])]
        self.calibration = self.folder / "exact.toml"
        self.calibration.write_text(EXACT_CALIBRATION)

    def walk(self, *moves, end_s):
        self.count += 1
        out = self.folder / f"walk{self.count}"
        trace = write_trace(self.folder / "moves.hid", thumb(*moves, takes_s=self.thumb_s), (), end_s)
        programs.run(self.program, "replay", trace, "--out", out, "--calibration", self.calibration, *self.options)
        return Walk(out)


# ---- one walk --------------------------------------------------------------------------------
def at_60_hz(x):
    """The first and second derivative of (ticks, ...), of the same length, 0 at the ends."""
    rate, bend = np.zeros_like(x), np.zeros_like(x)
    h = COARSE / RATE
    rate[COARSE:-COARSE] = (x[2 * COARSE:] - x[:-2 * COARSE]) / (2 * h)
    bend[COARSE:-COARSE] = (x[2 * COARSE:] - 2 * x[COARSE:-COARSE] + x[:-2 * COARSE]) / h ** 2
    return rate, bend


def along(walk):
    """Distance of the hips along the walk's heading at the start of the change."""
    return walk.root[:, 2]


def turned(rotation, since):
    """Degrees by which a segment has turned since a tick."""
    relative = np.einsum("ji,njk->nik", rotation[since], rotation)
    return np.degrees(np.arccos(np.clip((np.trace(relative, axis1=1, axis2=2) - 1) / 2, -1, 1)))


def angular_acceleration(rotation):
    """The angular acceleration in degrees/s2 at 60 Hz, from the rotation vectors between neighbours four ticks apart.
    """
    def vector(r):
        axis = np.stack([r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]], -1) / 2
        size = np.linalg.norm(axis, axis=-1, keepdims=True)
        angle = np.arctan2(size[:, 0], (np.trace(r, axis1=1, axis2=2) - 1) / 2)[:, None]
        return np.where(size > 1e-9, axis / np.maximum(size, 1e-12) * angle, axis)
    step = np.einsum("nij,nkj->nik", rotation[COARSE:], rotation[:-COARSE])
    rate = vector(step) * RATE / COARSE
    result = np.zeros(len(rotation))
    bend = np.linalg.norm(rate[COARSE:] - rate[:-COARSE], axis=-1) * RATE / COARSE
    result[COARSE:COARSE + len(bend)] = np.degrees(bend)
    return result


def chest_and_head(walk):
    b = walk.bvh
    lowered = [name.lower() for name in b.names]
    def named(*words):
        return [j for word in words for j, name in enumerate(lowered) if word in name and not b.end_site[j]]
    # A skeleton without a head of that name carries it on the last joint of its neck.
    necks, heads = named("neck"), named("head")
    if necks or heads:
        return b.parents[(necks or heads)[0]], heads[0] if heads else necks[-1]
    chest = named("chest", "spine")[0]
    return chest, chest


def distance_of_lines(a0, a1, b0, b1):
    """The least distance of two segments in each tick, by points along both."""
    shares = np.linspace(0, 1, 9)[:, None, None]
    a, b = a0 + (a1 - a0) * shares, b0 + (b1 - b0) * shares
    least = np.full(len(a0), np.inf)
    for p in a:
        for q in b:
            least = np.minimum(least, np.linalg.norm(p - q, axis=-1))
    return least


def apart(walk):
    """The least distances of shins and of feet, millimetres."""
    shins = distance_of_lines(*(walk.position[:, j] for i in (0, 1) for j in (walk.knee[i], walk.ankle[i])))
    flat = [p * [1, 0, 1] for i in (0, 1) for p in (walk.heel_fk[i], walk.toe_fk[i])]
    feet = distance_of_lines(*flat)
    return shins * 1000, feet * 1000


@dataclasses.dataclass
class Steady:
    """The figures of a change for the steady walk at this stick."""
    speed: float
    cycle_s: float
    fastest: float
    lowest: float
    acceleration: float
    chest: float
    head: float
    upper: float


def upper_joints(walk):
    return sorted(set(range(len(walk.bvh.names))) - set(walk.leg_joints[0] + walk.leg_joints[1]))


def steady_of(walk, from_s):
    at = slice(int(from_s * RATE), walk.ticks - COARSE)
    z, marks = along(walk), walk.landings[0]
    marks = marks[marks >= at.start]
    rate, bend = at_60_hz(z)
    chest, head = (angular_acceleration(walk.rotation[:, j]) for j in chest_and_head(walk))
    return Steady(speed=(z[marks[-1]] - z[marks[0]]) / (marks[-1] - marks[0]) * RATE,
                  cycle_s=(marks[-1] - marks[0]) / (len(marks) - 1) / RATE,
                  fastest=rate[at].max(), lowest=walk.root[at, 1].min(), acceleration=np.abs(bend[at]).max(),
                  chest=chest[at].max(), head=head[at].max(), upper=walk.second_differences[at][:, upper_joints(walk)].max())


def first_after(condition, since):
    ticks = np.nonzero(condition[since:])[0]
    return ticks[0] / RATE if len(ticks) else np.nan


def legs_of(walk, at):
    return walk.second_differences[at][:, walk.leg_joints[0] + walk.leg_joints[1]].max()


def change(walk, since, until, steady):
    """The figures of both starts and stops."""
    at = slice(since, until)
    z = along(walk)
    rate, bend = at_60_hz(z)
    chest, head = (angular_acceleration(walk.rotation[:, j]) for j in chest_and_head(walk))
    back = np.max(np.maximum.accumulate(z[at]) - z[at])
    return {"acc": np.abs(bend[at]).max(), "brake": -bend[at].min(), "below": 100 * (steady.lowest - walk.root[at, 1].min()),
            "back": 100 * back, "faster": rate[at].max() / steady.fastest,
            "d2": walk.second_differences[at].max(), "legs": legs_of(walk, at),
            "upper": walk.second_differences[at][:, upper_joints(walk)].max(),
            "chest": chest[at].max() / steady.chest, "head": head[at].max() / steady.head}


def start_of(walk, since_s, steady):
    since = int(since_s * RATE)
    root, rest = walk.root, walk.root[since]
    chest, head = chest_and_head(walk)
    moved = np.linalg.norm((root - rest)[:, [0, 2]], axis=-1) > 0.005
    response = moved | (turned(walk.rotation[:, chest], since) > 1) | (turned(walk.rotation[:, head], since) > 1)
    off = np.zeros(walk.ticks, bool)
    for i in (0, 1):
        off |= walk.toe_fk[i][:, 1] - walk.toe_rest[i] > 0.01
    rate, _ = at_60_hz(along(walk))
    return {"response": first_after(response, since), "off": first_after(off, since),
            "speed90": first_after(rate >= 0.9 * steady.speed, since),
            **change(walk, since, since + int(1.5 * RATE), steady)}


def stop_of(walk, since_s, steady):
    since = int(since_s * RATE)
    root = walk.root[:, [0, 2]]
    away = np.linalg.norm(root - root[-1], axis=-1)
    time = (np.nonzero(away > 0.01)[0].max() + 1 - since) / RATE
    return {"time": time, "way": np.linalg.norm(root[-1] - root[since]), "stands": walk.col["stage"][-1] == "idle",
            **change(walk, since, min(walk.ticks - COARSE, since + int(3.0 * RATE)), steady)}


# ---- a motion --------------------------------------------------------------------------------
def measure(player, stick):
    began = 0.5
    started = player.walk((began, 0, stick), end_s=13.0)
    steady = steady_of(started, 5.0)
    row = {"steady": dataclasses.asdict(steady), "start": start_of(started, began, steady)}
    row["stops"] = [stop_of(player.walk((began, 0, stick), (4.0 + steady.cycle_s * k / MOMENTS, 0, 0), end_s=9.0),
                            4.0 + steady.cycle_s * k / MOMENTS, steady) for k in range(MOMENTS)]
    return row


def reversal(player, stick=1.0):
    """Time from the thumb's return until the hips move back at 90 % of their later speed."""
    times = []
    for k in range(4):
        walk = player.walk((0.5, 0, stick), (4.0 + 0.27 * k, 0, -stick), end_s=10.0)
        rate, _ = at_60_hz(along(walk))
        since = int((4.0 + 0.27 * k) * RATE)
        steady = np.median(rate[-3 * RATE:-RATE])
        times.append(first_after(rate < 0.9 * steady, since))
    return float(np.median(times)), float(np.max(times))


TURNS = {"circle": [(0.5, 0.7, 0.7)], "sharp": [(0.5, 0, 0.9), (3.0, 0.95, 0.3)], "in place": [(0.5, 1, 0)],
         "zigzag": [(0.5, 0.6, 0.8), (2.0, -0.6, 0.8), (3.1, 0.6, 0.8), (4.3, -0.9, 0.4), (5.2, 0.9, 0.4)]}


TURNING = 0.2  # rad/s: slower is straight on, where the capture says how near the feet are


def turn_of(player, moves):
    walk = player.walk(*moves, end_s=8.0)
    shins, feet = apart(walk)
    heading = np.abs(np.degrees(walk.col["heading_rad"]))
    turns = np.abs(np.gradient(np.unwrap(walk.col["heading_rad"])) * RATE) > TURNING
    return {"shins": shins[turns].min(), "feet": feet[turns].min(), "stand": feet[:60].min(), "d2": walk.second_differences.max(),
            "legs": legs_of(walk, slice(None)), "turn_s": 360 / max(1e-6, (heading[-1] - heading[4 * RATE]) / (walk.ticks - 4 * RATE) * RATE)}


def last_flight(walk):
    """The heel's places in the last flight, seen from above, and the side of the foot."""
    flight = walk.col["stage"] == "flight"
    last = np.nonzero(flight)[0][-1]
    first = np.nonzero(~flight[:last])[0][-1] + 1
    left = walk.col["swing"][last] == "left"
    heel = walk.heel_fk[0 if left else 1][first:last + 1][:, [0, 2]]
    return heel, left


def closing_foot(walk):
    """How far the heel of the last flight goes outwards, millimetres from the line between its footprints."""
    heel, left = last_flight(walk)
    way = heel[-1] - heel[0]
    aside = ((heel - heel[0]) @ [way[1], -way[0]]) / np.linalg.norm(way)
    return 1000 * (aside if left else -aside).max()


def closing_foot_behind(walk):
    """How far the heel of the last flight goes back behind its lift-off, millimetres."""
    heel, _ = last_flight(walk)
    way = heel[-1] - heel[0]
    return -1000 * ((heel - heel[0]) @ way).min() / np.linalg.norm(way)


def summary(row):
    """The medians and worst values of a motion's row."""
    s, stops = row["start"], row["stops"]
    of = lambda key: np.array([stop[key] for stop in stops], float)
    most = lambda key: max(s[key], of(key).max())
    return {"response": s["response"], "off": s["off"], "90 %": s["speed90"], "start acc": s["acc"],
            "steady acc": row["steady"]["acceleration"], "brake med": np.median(of("brake")), "brake": of("brake").max(),
            "below cm": most("below"), "back cm": most("back"), "faster": most("faster"),
            "stop s": np.median(of("time")), "worst s": of("time").max(), "way m": np.median(of("way")),
            "way worst": of("way").max(), "way sd": of("way").std(), "d2": most("d2"), "chest x": most("chest"), "head x": most("head"),
            "stands": min(of("stands"))}


# ---- what is asked ---------------------------------------------------------------------------
def lines_of(rows, turns, reversal_s, is_built_in):
    """What is asked of starts, stops and turns: (name, unit, value, sign, bound). `rows`: by stick, the fullest last."""
    starts = [row["start"] for row in rows]
    legs = 0.8 if is_built_in else 1.2
    changes = [(change, row["steady"]["acceleration"]) for row in rows for change in (row["start"], *row["stops"])]
    full = rows[-1]["stops"]
    median = lambda key, among: float(np.median([change[key] for change in among]))
    most = lambda key: max(change[key] for change, _ in changes)
    # Where the steady walk itself swings by more, its own peak counts.
    push, push_bound = max(((change["acc"], max(6.0, own)) for change, own in changes), key=lambda of: of[0] - of[1])
    # No jump beyond twice the steady walk's, and none where it would not count in a leg.
    upper, upper_bound = max(((change["upper"], max(legs, 2 * row["steady"]["upper"]))
                              for row in rows for change in (row["start"], *row["stops"])), key=lambda of: of[0] - of[1])
    own = float(np.median([own for _, own in changes]))
    feet = min(turns.values(), key=lambda turn: turn["feet"] - min(60, turn["stand"]))
    return [("first response", "s", median("response", starts), "<=", 0.1),
            ("first foot off", "s", median("off", starts), "<=", 0.35),
            ("90 % of speed", "s", median("speed90", starts), "<=", 1.0),
            ("push, median", "m/s²", median("acc", [change for change, _ in changes]), "<=", max(4.0, own)),
            ("push", "m/s²", push, "<=", push_bound),
            ("dip", "cm", most("below"), "<=", 1.0), ("back", "cm", most("back"), "<=", 1.0),
            ("faster", "x", most("faster"), "<=", 1.05),
            ("stop", "s", median("time", full), "<=", 0.9), ("its way", "m", median("way", full), "<=", 0.9),
            ("deviation", "m", max(float(np.std([stop["way"] for stop in row["stops"]])) for row in rows), "<=", 0.1),
            ("reversal", "s", reversal_s, "<=", 1.2),
            ("shins", "mm", min(turn["shins"] for turn in turns.values()), ">=", 70.0),
            ("feet", "mm", feet["feet"], ">=", min(60.0, feet["stand"])),
            ("turn", "s", turns["in place"]["turn_s"], "<=", 4.0),
            ("legs", "deg", most("legs"), "<=", legs),
            ("legs, turns", "deg", max(turn["legs"] for turn in turns.values()), "<=", legs),
            ("upper body", "deg", upper, "<=", upper_bound),
            ("chest, head", "x", max(most("chest"), most("head")), "<=", 2.0)]


def judged(program, thumb_s, motion):
    """The lines of a motion (None: the built-in one)."""
    with tempfile.TemporaryDirectory() as folder:
        player = Player(program, folder, motion, thumb_s=thumb_s)
        rows = [measure(player, stick) for stick in (0.3, 0.8, 1.0)]
        turns = {turn: turn_of(player, moves) for turn, moves in TURNS.items()}
        lines = lines_of(rows, turns, reversal(player)[0], motion is None)
    return [{"name": name, "unit": unit, "value": float(value), "sign": sign, "bound": float(bound),
             "ok": bool(value <= bound + ROUNDING if sign == "<=" else value >= bound - ROUNDING)}
            for name, unit, value, sign, bound in lines]


def print_lines(motions, names, as_json):
    """Returns 1 if a bound is broken."""
    if as_json:
        print(json.dumps([{"motion": name, "lines": lines} for name, lines in zip(names, motions)], indent=1))
    for name, lines in zip(names, motions) if not as_json else ():
        broken = [f"{line['name']} {line['value']:.3g} {line['unit']} ({line['sign']} {line['bound']:.3g})"
                  for line in lines if not line["ok"]]
        print(f"{name:22} {', '.join(broken) or 'all met'}")
    return int(any(not line["ok"] for lines in motions for line in lines))


def is_walk(program, motion):
    """False for a file that the program refuses."""
    if motion is None:
        return True
    with tempfile.TemporaryDirectory() as folder:
        trace = write_trace(pathlib.Path(folder) / "rest.hid", [(0.0, 0.0, 0.0)], (), 0.1)
        return programs.run(program, "replay", trace, "--motion", motion, status=None).returncode == 0


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("motions", nargs="*", metavar="MOTION_OR_FOLDER")
    parser.add_argument("--lines", action="store_true", help="one row a motion: the lines that it breaks; status 1 if there is one")
    parser.add_argument("--stick", type=float, nargs="*", default=[0.3, 0.8, 1.0])
    parser.add_argument("--thumb", type=float, default=THUMB_S)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--turns", action="store_true")
    return parser.parse_args()


def main():
    options = arguments()
    program = options.program.resolve()
    motions = [None, *(motion for motion in clips_of(options.motions) if is_walk(program, motion))]
    names = [motion.stem if motion else "built-in" for motion in motions]
    if options.lines:
        with multiprocessing.Pool() as pool:
            return print_lines(pool.map(functools.partial(judged, program, options.thumb), motions, chunksize=1), names, options.json)
    rows = {}
    for name, motion in zip(names, motions):
        with tempfile.TemporaryDirectory() as folder:
            player = Player(program, folder, motion, thumb_s=options.thumb)
            for stick in options.stick:
                rows[f"{name} {stick}"] = summary(measure(player, stick))
            if options.turns:
                for turn, moves in TURNS.items():
                    rows[f"{name} {turn}"] = turn_of(player, moves)
                rows[f"{name} reversal"] = dict(zip(("median", "worst"), reversal(player)))
    if options.json:
        print(json.dumps({name: {k: float(v) for k, v in row.items()} for name, row in rows.items()}, indent=1))
        return 0
    last = None
    for name, row in rows.items():
        if list(row) != last:
            print(f"{'':22}" + " ".join(f"{k:>10}" for k in row))
            last = list(row)
        print(f"{name:22}" + " ".join(f"{v:10.2f}" for v in row.values()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
