"""A folder of `gaitpad selftest`, checked again: its recording must still show each control that the person saw."""
import json

SHOWN = 0.6  # share of an axis' way that counts as shown


def shows(row, name):
    axis, sign = name.rstrip("+-"), -1 if name.endswith("-") else 1
    if axis in row["axes"]:
        return row["axes"][axis] * sign > SHOWN
    return name in row["buttons"]


def problems(run, folder):
    """One sentence for each control that the person saw and the recording no longer shows."""
    report = json.loads((folder / "report.json").read_text())
    lines = run("decode", folder / "controls.hid", "--json").stdout.splitlines()
    rows = [row for row in map(json.loads, lines) if "axes" in row]
    for control in report["controls"]:
        if control["result"] != "seen":
            continue
        during = [row for row in rows if control["from_s"] <= row["time_s"] <= control["to_s"]]
        if not any(shows(row, control["control"]) for row in during):
            yield f"{folder.name}: {control['control']} was seen and is not shown any more"
