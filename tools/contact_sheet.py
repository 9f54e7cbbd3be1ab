#!/usr/bin/env python3
"""Draws a contact sheet: stick figures over two cycles in side view, the source's own strip above
the walks made from it, heel strikes of the right foot at the left edge; knee curves beside.

  contact_sheet.py PATH/TO/gaitpad OUT.png [--motions A.bvh,B.bvh] [--styles even,limp_left] [--stick 0.8]
  contact_sheet.py --walk DIR[,DIR...] OUT.png [--source FILE.bvh]

Left leg blue, right leg orange. Needs python3-matplotlib and python3-numpy.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, os.path.join(ROOT, "tests"))
from support import bvh as bvhs
from support.program import DATA
from support.traces import EXACT_CALIBRATION, write_trace
from support.walk import SIDES, Walk

COLOURS = ("#1f5fbf", "#d9701a")
POSES_A_CYCLE, SPACING_M, FIGURE_M = 12, 0.55, 1.9


class Strip:
    """Positions (F, J, 3) in metres seen from the walker: x forward from the pelvis, y up."""

    def __init__(self, title, names, parents, position, heels, legs, pelvis, marks):
        self.title, self.names, self.parents, self.position = title, names, parents, position
        self.heels, self.legs, self.pelvis, self.marks = heels, legs, pelvis, marks


def cycle_marks(ankle, pelvis, forward, rate):
    """Numbers of the frames where the ankle is farthest ahead of the pelvis, at least 0.5 s apart."""
    ahead = (ankle - pelvis) @ forward
    found = []
    for k in range(1, len(ahead) - 1):
        if ahead[k] >= ahead[k - 1] and ahead[k] > ahead[k + 1] and ahead[k] > 0.6 * ahead.max():
            if found and k - found[-1] < 0.5 * rate:
                found[-1] = k if ahead[k] > ahead[found[-1]] else found[-1]
            else:
                found.append(k)
    return found


def walk_strip(walk, title):
    steady = walk.cycles(1, walk.steady)
    if not steady:
        raise SystemExit(f"{walk.folder}: no steady cycle to draw")
    a = steady[max(0, len(steady) - 3)][0]
    later = [k for k in walk.landings[1] if k >= a][:3]
    legs = [[walk.hip[i], walk.knee[i], walk.ankle[i], walk.toe[i], walk.toe_end[i]] for i in range(2)]
    return Strip(title, walk.bvh.names, walk.bvh.parents, walk.position, walk.heel_fk, legs, walk.pelvis, later)


def source_strip(path, walk, title):
    """The clip itself, with the joints of the walk made from it and the floor at the lowest heel."""
    bvh = bvhs.read_bvh(path)
    scale = float(walk.summary["metres_per_unit"])
    position, rotation = bvhs.forward_kinematics(
        bvh.parents, bvhs.translations(bvh) * scale, bvhs.local_rotations(bvh))
    ratio = float(walk.summary["source_leg_length_m"]) / walk.leg_length
    find = lambda j: bvh.index(walk.bvh.names[j])
    legs = [[find(j) for j in (walk.hip[i], walk.knee[i], walk.ankle[i], walk.toe[i])] for i in range(2)]
    for leg in legs:
        end = leg[3]
        while bvh.children(end):
            end = bvh.children(end)[-1]
        leg.append(end)
    heels = [position[:, leg[2]] + rotation[:, leg[2]] @ (np.array(walk.summary[f"{s}_heel_offset_m"]) * ratio)
             for leg, s in zip(legs, SIDES)]
    pelvis = find(walk.pelvis)
    first = 1 if np.linalg.norm(position[1, pelvis] - position[0, pelvis]) > 0.3 else 0
    travel = position[-1, pelvis] - position[first, pelvis]
    forward = travel * [1, 0, 1] / np.linalg.norm(travel * [1, 0, 1])
    marks = cycle_marks(position[:, legs[1][2]], position[:, pelvis], forward, 1 / bvh.frame_time)
    marks = [k for k in marks if k >= first][:3]
    floor = np.percentile(np.minimum(heels[0][:, 1], heels[1][:, 1])[first:], 2)
    for track in (position, *heels):
        track[..., 1] -= floor
    return Strip(title, bvh.names, bvh.parents, position, heels, legs, pelvis, marks)


def side_view(strip, k):
    """Places (J, 2) of joints and (2, 2) of heels at frame k: forward from the pelvis, up."""
    a, b = strip.marks[0], strip.marks[-1]
    travel = (strip.position[b, strip.pelvis] - strip.position[a, strip.pelvis]) * [1, 0, 1]
    forward = travel / np.linalg.norm(travel)
    origin = strip.position[k, strip.pelvis]
    flat = lambda p: np.stack([(p - origin) @ forward, p[..., 1]], -1)
    return flat(strip.position[k]), flat(np.stack([h[k] for h in strip.heels]))


def draw_figure(axes, strip, k, shift):
    points, heels = side_view(strip, k)
    points, heels = points + [shift, 0], heels + [shift, 0]
    in_legs = {j for leg in strip.legs for j in leg}
    hands = [n for n in strip.names if any(w in n.lower() for w in ("thumb", "finger", "index", "hand_end"))]
    for j, p in enumerate(strip.parents):
        if p >= 0 and j not in in_legs and strip.names[j] not in hands and not _below_leg(strip, j):
            axes.plot(*points[[p, j]].T, color="#9a9a9a", linewidth=0.7)
    for side in (0, 1):
        hip, knee, ankle, toe, end = strip.legs[side]
        axes.plot(*points[[strip.pelvis, hip, knee, ankle]].T, color=COLOURS[side], linewidth=1.4)
        foot = np.stack([points[ankle], heels[side], points[toe], points[ankle]])
        axes.plot(*foot.T, color=COLOURS[side], linewidth=1.0)
        axes.plot(*points[[toe, end]].T, color=COLOURS[side], linewidth=1.0)
        axes.plot(*heels[side], "o", color=COLOURS[side], markersize=1.8)


def _below_leg(strip, joint):
    hips = {leg[0] for leg in strip.legs}
    while joint >= 0:
        if joint in hips:
            return True
        joint = strip.parents[joint]
    return False


def frames_of(strip):
    """The frames of two cycles; of one cycle if the clip has only one, of the whole clip if it has none."""
    marks = strip.marks if len(strip.marks) > 1 else [0, len(strip.position) - 1]
    strip.marks = marks
    frames = [np.linspace(a, b, POSES_A_CYCLE, endpoint=False) for a, b in zip(marks[:-1], marks[1:])]
    return np.round(np.concatenate(frames)).astype(int)


def draw_strip(axes, strip):
    for i, k in enumerate(frames_of(strip)):
        draw_figure(axes, strip, k, i * SPACING_M)
    axes.axhline(0, color="black", linewidth=0.6)
    axes.set_xlim(-0.8, 2 * POSES_A_CYCLE * SPACING_M + 0.2)
    axes.set_ylim(-0.08, FIGURE_M)
    axes.set_aspect("equal")
    axes.set_yticks([0, 0.5, 1.0])
    axes.set_xticks([])
    axes.set_title(strip.title, fontsize=9, loc="left")


def draw_knees(axes, strip):
    """Draws the knee bend over one cycle of each leg from the right heel strike, degrees."""
    a, b = strip.marks[:2]
    for side in (0, 1):
        hip, knee, ankle = (strip.position[a:b + 1, j] for j in strip.legs[side][:3])
        thigh, shank = knee - hip, ankle - knee
        bend = np.degrees(np.arctan2(np.linalg.norm(np.cross(thigh, shank), axis=-1), np.sum(thigh * shank, -1)))
        axes.plot(np.linspace(0, 100, len(bend)), bend, color=COLOURS[side], linewidth=1)
        height = 100 * strip.heels[side][a:b + 1, 1]
        axes.plot(np.linspace(0, 100, len(height)), height, color=COLOURS[side], linewidth=0.6, linestyle=":")
    axes.set_ylim(-2, 80)
    axes.set_title("knee (deg), heel height (cm, dotted)", fontsize=7, loc="left")
    axes.tick_params(labelsize=6)
    axes.grid(linewidth=0.3)


def draw_sheet(strips, path):
    fig, axes = plt.subplots(len(strips), 2, figsize=(19, 2.5 * len(strips)), squeeze=False,
                             gridspec_kw={"width_ratios": [6, 1]}, constrained_layout=True)
    for row, strip in zip(axes, strips):
        draw_strip(row[0], strip)
        draw_knees(row[1], strip)
    fig.savefig(path, dpi=110)
    plt.close(fig)


def replay(gaitpad, folder, motion, style, stick):
    os.makedirs(folder, exist_ok=True)
    trace, exact = os.path.join(folder, "trace.hid"), os.path.join(folder, "exact.toml")
    with open(exact, "w", encoding="utf-8") as file:
        file.write(EXACT_CALIBRATION)
    write_trace(trace, [(0.5, 0, stick)], end_s=10.0)
    command = [gaitpad, "replay", trace, "--out", folder, "--calibration", exact, "--style", style]
    done = subprocess.run(command + (["--motion", motion] if motion else []), capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"gaitpad replay: {done.stderr.strip()}")
    return Walk(folder)


def strips_by_replay(options):
    strips = []
    for motion in [None] + [m for m in options.motions.split(",") if m]:
        name = "default" if motion is None else os.path.basename(motion)
        if motion and not os.path.exists(motion):
            print(f"skipped: {motion} is absent", file=sys.stderr)
            continue
        for number, style in enumerate(options.styles.split(",")):
            with tempfile.TemporaryDirectory() as folder:
                walk = replay(options.gaitpad, folder, motion, style, options.stick)
            source = motion or options.default_source
            if number == 0 and source:
                strips.append(source_strip(source, walk, f"{name}: the source itself"))
            speed = walk.col["speed_m_s"][walk.steady].mean()
            strips.append(walk_strip(walk, f"{name}: {style}, {speed:.2f} m/s"))
    return strips


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gaitpad", nargs="?")
    parser.add_argument("out")
    parser.add_argument("--motions", default=",".join(str(DATA / "mocap" / (m + ".bvh")) for m in
                                                     ("cmu_m21_walk", "bvhtoolbox_walk01")))
    parser.add_argument("--styles", default="even,limp_left")
    parser.add_argument("--stick", type=float, default=0.8)
    parser.add_argument("--default-source", help="a BVH of the default motion, for its own strip")
    parser.add_argument("--walk", default="", help="exported folders instead of replays")
    parser.add_argument("--source", help="with --walk: the BVH that they were made from")
    return parser.parse_args()


def main():
    options = arguments()
    if options.walk:
        walks = [Walk(folder) for folder in options.walk.split(",")]
        strips = [source_strip(options.source, walks[0], "the source itself")] if options.source else []
        strips += [walk_strip(w, w.folder) for w in walks]
    elif options.gaitpad:
        strips = strips_by_replay(options)
    else:
        print("contact_sheet.py: a gaitpad or --walk is needed", file=sys.stderr)
        return 2
    draw_sheet(strips, options.out)
    print(options.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
