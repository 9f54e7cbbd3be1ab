#!/usr/bin/python3
"""Exports clips and lints each (support/clip_lint.py): clips.py PROGRAM [--json]

Thirty clips of a straight walk at 60 frames a second: all styles that reach a steady walk, three builds at three speeds,
backwards, and the shipped keyframe motion. (`tiring` tires: it has no steady stride.) Exit status 1 if a clip has a fault.
"""
import argparse
import json
import pathlib
import sys
import tempfile

if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import program as programs
from support.clip_lint import CHECKS, Clip, faults, lint
from support.traces import EXACT_CALIBRATION, write_trace

STYLES = ("carry", "even", "heavy_slack", "limp_left", "limp_left_hip", "limp_left_knee", "look_down", "muscular", "rail_left",
          "stiff_arms", "stiff_hip", "stiff_knee", "tired")
CLIPS = [(f"style {style}", 0.8, ("--style", style)) for style in STYLES]
CLIPS += [(f"{build} stick {stick}", stick, ("--character", build)) for build in ("adult", "child", "tall")
          for stick in (0.4, 0.7, 1.0)]
CLIPS += [(f"back {stick}", -stick, ()) for stick in (0.5, 1.0)]
CLIPS += [(f"keyframe_walk stick {stick}", stick, ("--motion", "keyframe_walk")) for stick in (0.5, 0.8, 1.0)]
CLIPS += [(f"{style} child", 0.8, ("--style", style, "--character", "child")) for style in ("limp_left", "stiff_knee", "heavy_slack")]
SECONDS = 16


def exported(program, folder, stick, options):
    trace = write_trace(folder / "walk.hid", [(0.5, 0, stick)], (), SECONDS)
    (folder / "exact.toml").write_text(EXACT_CALIBRATION)
    programs.run(program, "replay", trace, "--out", folder / "out", "--gltf", "--fps", 60,
                 "--calibration", folder / "exact.toml", *options)
    return Clip(folder / "out")


def rows(found):
    """The rows for tools/measured.py: each check with its worst clip."""
    for name, (_, unit, allowed) in CHECKS.items():
        value, where = max((figures[name], clip) for clip, figures in found.items())
        failed = sum(name in faults(figures) for figures in found.values())
        yield {"name": name, "worst": value, "unit": unit, "allowed": f"<= {allowed}" if allowed else "== 0",
               "runs": len(found), "failed": failed, "where": where if value > 0 else ""}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--json", action="store_true", help="rows for tools/measured.py")
    options = parser.parse_args()
    found = {}
    for name, stick, words in CLIPS:
        with tempfile.TemporaryDirectory() as folder:
            found[name] = lint(exported(options.program.resolve(), pathlib.Path(folder), stick, words))
        if not options.json:
            print(f"{name:28}" + " ".join(f"{value:9.3g}" for value in found[name].values()) + "  " + ", ".join(faults(found[name])))
    if options.json:
        print(json.dumps(list(rows(found)), indent=1))
    return 1 if any(faults(figures) for figures in found.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
