#!/usr/bin/env python3
"""The independent judge of `gaitpad replay --out DIR`: measures every bound that can be seen from the
exported files and prints value, bound, verdict. Exit status 1 where a bound is broken.

  walk_check.py DIR [--motion FILE.bvh] [--trace FILE.hid] [--changes 4.0,8.0] [--raw]
  walk_check.py DIR --mirror DIR2
  walk_check.py --limp DIR_even DIR_limp
  walk_check.py --weights DIR_even DIR_other [--expect hip|knee] [--leg left|right|both]
"""
import argparse
import json
import sys

import bvh_fk
import walk_bounds
import walk_compare
import walk_smooth
from walk_data import SETTLE_S, Walk, trace_changes


def check_walk(walk, source=None, raw=False):
    checks = (walk_bounds.file_checks(walk) + walk_bounds.stage_checks(walk) + walk_bounds.contact_checks(walk) +
              walk_bounds.step_checks(walk) + walk_bounds.speed_checks(walk) + walk_bounds.repeat_check(walk) +
              walk_bounds.circle_checks(walk) + walk_bounds.look_checks(walk) + walk_smooth.leg_checks(walk) +
              walk_smooth.upper_checks(walk, source))
    return checks + (walk_compare.raw_checks(walk, source) if raw and source is not None else [])


def weight_bounds(expect):
    """Issue's figures: hip 0.2 at least 1.5 degrees; knee 0.8 between 0.2 and 1.5, extremes within 3."""
    return {"hip": (1.5, None, None), "knee": (0.2, 1.5, 3.0), None: (0.0, None, None)}[expect]


def table(checks):
    lines = []
    for c in checks:
        value = "-" if c.value is None else f"{c.value:.4g}"
        verdict = {None: "", True: "ok", False: "FAIL"}[c.ok]
        lines.append(f"{c.name:42s} {value:>10s} {c.unit:10s} {c.bound_text():>12s} {verdict:4s} {c.note}".rstrip())
    return "\n".join(lines)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dir", nargs="?")
    parser.add_argument("--index", type=int, default=1, help="the n-th character")
    parser.add_argument("--motion", help="the source BVH")
    parser.add_argument("--trace", help="the replayed trace: its commands count as changes")
    parser.add_argument("--changes", default="", help="times in s at which the style changed")
    parser.add_argument("--settle", type=float, default=SETTLE_S, help="s after a change until steady")
    parser.add_argument("--raw", action="store_true", help="slide of raw playback (needs --motion)")
    parser.add_argument("--mirror", metavar="DIR2")
    parser.add_argument("--limp", nargs=2, metavar=("EVEN", "LIMP"))
    parser.add_argument("--weights", nargs=2, metavar=("EVEN", "OTHER"))
    parser.add_argument("--expect", choices=("hip", "knee"), help="which weight --weights lowers")
    parser.add_argument("--leg", choices=("left", "right", "both"), default="both")
    parser.add_argument("--json", action="store_true")
    return parser.parse_args()


def gather(options):
    changes = [float(t) for t in options.changes.split(",") if t]
    changes += trace_changes(options.trace) if options.trace else []
    load = lambda folder: Walk(folder, options.index, changes, options.settle)
    if options.limp:
        return walk_compare.limp_checks(*map(load, options.limp))
    if options.weights:
        sides = {"left": (0,), "right": (1,), "both": (0, 1)}[options.leg]
        low, high, extremes = weight_bounds(options.expect)
        return walk_compare.weight_checks(*map(load, options.weights), low, high, extremes, sides)
    walk = load(options.dir)
    if options.mirror:
        return walk_compare.mirror_checks(walk, load(options.mirror))
    source = bvh_fk.read_bvh(options.motion) if options.motion else None
    return check_walk(walk, source, options.raw)


def main():
    options = arguments()
    if not (options.dir or options.limp or options.weights):
        print("walk_check.py: a folder is needed", file=sys.stderr)
        return 2
    checks = gather(options)
    failed = [c for c in checks if c.ok is False]
    if options.json:
        print(json.dumps([c.as_dict() for c in checks], indent=1))
    else:
        print(table(checks))
        print(f"{len(failed)} of {sum(c.ok is not None for c in checks)} bounds broken")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
