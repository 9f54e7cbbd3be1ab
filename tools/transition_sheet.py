#!/usr/bin/env python3
"""Draws what is not steady in a walk, a picture a change: stick figures every 0.1 s from the side, from the front and from
above, as they stand in the world. The thumb begins to move at the red line.

  transition_sheet.py PATH/TO/gaitpad FOLDER [--changes start,stop,...] [--motion FILE] [--terrain NAME] [--stick 0.8]

Left leg blue, right leg orange. Needs python3-matplotlib and python3-numpy.
"""
import argparse
import pathlib
import sys
import tempfile

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))
sys.path.insert(0, str(ROOT / "tests" / "session"))
from support.walk import SIDES
from transitions import Player

COLOURS = ("#1f5fbf", "#d9701a")
SPACING_S, POSES = 0.1, 20
WIDE_M = 0.8  # room of a figure that does not move away from its neighbour
VIEWS = {"side": (2, 1), "front": (0, 1), "above": (2, 0)}  # axes across and up; x is to the left, z ahead
HEIGHTS_M = {"side": (-0.15, 1.9), "front": (-0.15, 1.9), "above": (-0.7, 0.7)}


def changes(stick):
    """The thumb's moves (time_s, x, y) of each change, and the time from which it is drawn."""
    return {"start": ([(0.5, 0, stick)], 0.4), "stop": ([(0.5, 0, stick), (4.0, 0, 0)], 3.9),
            "reversal": ([(0.5, 0, stick), (4.0, 0, -stick)], 3.9),
            "sharp": ([(0.5, 0, stick), (3.0, stick, 0.3 * stick)], 2.9),
            "inplace": ([(0.5, stick, 0)], 0.4), "stand": ([], 1.0)}


def lines_of(walk, tick):
    """The lines of a figure at a tick, as (points (N, 3), colour): body, legs and feet."""
    b, place = walk.bvh, walk.position[tick]
    legs = {j for hip in walk.hip for j in [hip, *walk.below(hip)]}
    body = [(place[[p, j]], "#9a9a9a") for j, p in enumerate(b.parents) if p >= 0 and j not in legs]
    for i in range(len(SIDES)):
        hip, knee, ankle, toe, end = walk.hip[i], walk.knee[i], walk.ankle[i], walk.toe[i], walk.toe_end[i]
        heel = walk.heel_fk[i][tick]
        foot = np.stack([place[ankle], heel, place[toe], place[end], place[toe], place[ankle]])
        body += [(place[[walk.pelvis, hip, knee, ankle]], COLOURS[i]), (foot, COLOURS[i])]
    return body


def draw(axes, walk, ticks, view, since_s):
    across, up = VIEWS[view]
    for number, tick in enumerate(ticks):
        for points, colour in lines_of(walk, tick):
            flat = (points - walk.root[tick])[:, [across, up]]
            if up == 1:
                flat[:, 1] = points[:, 1]
            if across == 0:
                flat[:, 0] = -flat[:, 0]
            axes.plot(flat[:, 0] + number * WIDE_M, flat[:, 1], color=colour, linewidth=0.9)
    at = (since_s - ticks[0] / walk.rate) / SPACING_S * WIDE_M
    axes.axvline(at, color="#c02020", linewidth=0.6)
    low, high = HEIGHTS_M[view]
    if up == 1:
        heights = walk.root[ticks, 1] - walk.root[0, 1]
        low, high = low + min(0, heights.min()), high + max(0, heights.max())
        axes.axhline(0, color="black", linewidth=0.4)
    axes.set(xlim=(-WIDE_M, len(ticks) * WIDE_M), ylim=(low, high), aspect="equal", xticks=[], yticks=[])
    axes.set_ylabel(view, fontsize=8)


def draw_change(walk, name, from_s, path):
    first = int(round(from_s * walk.rate))
    ticks = [t for t in first + np.round(np.arange(POSES) * SPACING_S * walk.rate).astype(int) if t < walk.ticks]
    rooms = [high - low for low, high in HEIGHTS_M.values()]
    fig, axes = plt.subplots(len(VIEWS), 1, figsize=(20, 6.8), constrained_layout=True,
                             gridspec_kw={"height_ratios": rooms})
    for row, view in zip(axes, VIEWS):
        draw(row, walk, ticks, view, from_s + 0.1)
    axes[0].set_title(name, fontsize=10, loc="left")
    fig.savefig(path, dpi=90)
    plt.close(fig)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gaitpad", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--changes", default="start,stop,reversal,sharp,inplace,stand")
    parser.add_argument("--motion", type=pathlib.Path)
    parser.add_argument("--terrain")
    parser.add_argument("--stick", type=float, default=0.8)
    return parser.parse_args()


def main():
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    terrain = ["--terrain", options.terrain] if options.terrain else []
    motion = options.motion.resolve() if options.motion else None
    what = f"{motion.stem if motion else 'built-in'}, {options.terrain or 'level'}, stick {options.stick:g}"
    with tempfile.TemporaryDirectory() as folder:
        player = Player(options.gaitpad.resolve(), folder, motion, terrain)
        for name in options.changes.split(","):
            moves, from_s = changes(options.stick)[name]
            path = options.out / f"{name}.png"
            draw_change(player.walk(*moves, end_s=from_s + POSES * SPACING_S + 0.5), f"{name}: {what}", from_s, path)
            print(path)


if __name__ == "__main__":
    main()
