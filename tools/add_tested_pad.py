#!/usr/bin/python3
"""Takes a folder of `gaitpad selftest` into the project: add_tested_pad.py FOLDER

Writes a row of docs/tested-pads.md and a test recording, tests/data/tested/VENDOR_PRODUCT-N/. If a control was decoded
as another one, it writes a draft for config/pads beside the report, for a person to finish. A folder that still
identifies its pad (a serial number, a Bluetooth address, a port) is refused. """
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
KEYS = ("format", "program", "date", "pad", "system", "drivers", "controls", "failures")
KEPT = ("report.json", "controls.hid")
BUSES = {3: "USB", 5: "Bluetooth"}


class Refused(Exception):
    """The folder is refused; the message is one sentence: which file, and why."""


def read_report(folder):
    path = folder / "report.json"
    try:
        report = json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise Refused(f"{path}: {error}") from error
    missing = [key for key in KEYS if key not in report]
    if missing or report["format"] != 1:
        raise Refused(f"{path}: no report of gaitpad selftest ({', '.join(missing) or 'another format'})")
    if not report["pad"]:
        raise Refused(f"{path}: no driver opened the pad")
    return report


def refuse_identity(folder):
    """U: is the serial number or address of a device, P: its port."""
    for path in sorted(folder.glob("*.hid")):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if re.match(r"[UP]:\s*\S", line):
                raise Refused(f"{path}:{number}: identifies the pad; record it with gaitpad selftest")
    text = (folder / "report.json").read_text()
    if re.search(r"\b([0-9a-f]{2}:){5}[0-9a-f]{2}\b", text, re.I):
        raise Refused(f"{folder / 'report.json'}: holds a Bluetooth address")


def ids(report):
    return f"{report['pad']['vendor']:04x}:{report['pad']['product']:04x}"


# ---- the row -----------------------------------------------------------------------------------
def plain(text):
    """Text from outside, made safe for a cell of the table."""
    return re.sub(r"[^\x20-\x7e]|[|<>`\\]", "?", text)


def driver_text(report):
    words = []
    for driver in report["drivers"]:
        if driver["opened"] and "rate" in driver:
            words.append(f"{driver['driver']} {driver['rate']['rate_hz']:.0f} Hz")
        else:
            words.append(f"{driver['driver']}: no")
    return ", ".join(words)


def control_text(report):
    by_result = {result: [c["control"] for c in report["controls"] if c["result"] == result]
                 for result in ("seen", "absent", "wrong")}
    text = f"{len(by_result['seen'])} seen"
    for result in ("absent", "wrong"):
        if by_result[result]:
            text += f"; {result}: {', '.join(by_result[result])}"
    return text


def replug_text(report):
    replugged = report.get("unplugging") or {"left_out": True}
    return "left out" if replugged["left_out"] else "came back" if replugged["is_back"] else "did not come back"


def rumble_text(report):
    felt = report.get("rumble") or {}
    return ", ".join(f"{motor} {felt[motor]}" for motor in ("strong", "weak") if motor in felt) or "-"


def stick_text(report):
    sticks = report.get("calibration") or {}
    return ", ".join(f"{side} {stick['verdict']}" for side, stick in sticks.items()) or "-"


def walk_text(report):
    walk = report.get("walk")
    return f"{walk['steps']} steps, {100 * abs(walk['aside_m']):.0f} cm aside" if walk else "-"


def row(report):
    cells = [report["pad"]["name"], f"{ids(report)}, {BUSES.get(report['pad']['bus'], report['pad']['bus'])}",
             f"{report['system']['kernel']}, {report['date']}", driver_text(report), control_text(report),
             replug_text(report), rumble_text(report), stick_text(report), walk_text(report)]
    return "| " + " | ".join(plain(cell) for cell in cells) + " |"


def add_row(page, line):
    lines = page.read_text().splitlines()
    tables = [i for i, text in enumerate(lines) if text.startswith("|---")]
    if not tables:
        raise Refused(f"{page}: has no table")
    end = tables[-1] + 1
    while end < len(lines) and lines[end].startswith("|"):
        end += 1
    if line in lines:
        raise Refused(f"{page}: has this row already")
    page.write_text("\n".join(lines[:end] + [line] + lines[end:]) + "\n")


# ---- the draft ---------------------------------------------------------------------------------
def changed_usages(rows, control):
    """For each usage, the number of reports during this control that differ from its earlier value, greatest first."""
    during = [r for r in rows if control["from_s"] <= r["time_s"] <= control["to_s"]]
    before = {}
    for r in rows:
        if r["time_s"] < control["from_s"]:
            before |= r["values"]
    counts = {}
    for r in during:
        for usage, value in r["values"].items():
            if usage in before and value != before[usage]:
                counts.setdefault(usage, []).append(value)
    return sorted(counts.items(), key=lambda item: -len(item[1]))


def source(control, rows):
    """The usage in the form of config/pads; None if nothing changed."""
    for usage, values in changed_usages(rows, control):
        page, number = (int(part, 16) for part in usage.split(":"))
        is_axis = control["control"].startswith(("left_", "right_"))
        if page == 9 and not is_axis:
            return f"button {number}"
        if (page, number) == (1, 0x39) and not is_axis:
            names = {0: "up", 2: "right", 4: "down", 6: "left"}
            if values[0] in names:
                return f"hat {names[values[0]]}"
        if is_axis and page in (1, 2) and number != 0x39:
            return usage
    return None


def draft(report, rows):
    """Text of a pad file for controls that were decoded as others; empty if there are none."""
    axes, buttons = {}, {}
    for control in report["controls"]:
        found = source(control, rows) if control["result"] == "wrong" else None
        if found is None:
            continue
        name = control["control"].rstrip("+-")
        (axes if name.startswith(("left_", "right_")) else buttons).setdefault(name, found)
    if not axes and not buttons:
        return ""
    pad = report["pad"]
    lines = ["# A draft by tools/add_tested_pad.py: check each line with `gaitpad selftest --map` this file.", "[[pad]]",
             f"name = {json.dumps(plain(pad['name']))}", f"vendor = 0x{pad['vendor']:04x}",
             f"products = [0x{pad['product']:04x}]"]
    for table, sources in (("axes", axes), ("buttons", buttons)):
        if sources:
            lines += [f"[pad.{table}]"] + [f'{name} = "{text}"' for name, text in sources.items()]
    return "\n".join(lines) + "\n"


def decoded(program, recording):
    done = subprocess.run([program, "decode", recording, "--json"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Refused(done.stderr.strip())
    return [r for r in map(json.loads, done.stdout.splitlines()) if "values" in r]


# ---- the command -------------------------------------------------------------------------------
def test_folder(root, report):
    for number in range(1, 100):
        path = root / "tests/data/tested" / f"{ids(report).replace(':', '_')}-{number}"
        if not path.exists():
            return path
    raise Refused(f"there are 99 recordings of {ids(report)}")


def add(folder, root, program):
    report = read_report(folder)
    refuse_identity(folder)
    rows = decoded(program, folder / "controls.hid")
    target = test_folder(root, report)
    add_row(root / "docs/tested-pads.md", row(report))
    target.mkdir(parents=True)
    for name in KEPT:
        shutil.copyfile(folder / name, target / name)
    yield f"{target}: the test recording"
    yield f"{root / 'docs/tested-pads.md'}: a row"
    text = draft(report, rows)
    if text:
        path = folder / f"{ids(report).replace(':', '_')}.toml"
        path.write_text(text)
        yield f"{path}: a draft for config/pads, since controls were shown as others"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT, help="the checkout to write to")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/gaitpad")
    options = parser.parse_args()
    try:
        for sentence in add(options.folder, options.root, options.program):
            print(sentence)
    except (Refused, OSError) as error:
        sys.exit(f"add_tested_pad.py: {error}")


if __name__ == "__main__":
    main()
