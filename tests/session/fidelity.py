#!/usr/bin/python3
"""Judges how much of its capture a walk keeps, from files alone: the source clip and what `gaitpad replay` exports.

  fidelity.py PROGRAM [FILE_OR_FOLDER ...] [--built-in] [--json] [--picture OUT.png] [--sheet OUT.png]

Each clip is walked straight on flat ground, style even, at its own pace (the stick that `motion --json` names in
"gait"). One row a clip; exit status 1 where a bound is broken. Clips that the program refuses are listed with its reason.

What is measured:
- Flexion in the sagittal plane: about the left-right axis of the pelvis (the line of the hips). That axis and the pelvis'
  upright axis are means over the source's stride, in the frames of pelvis and thigh; source and walk are measured about
  the same. Hip: the thigh in the pelvis' frame against the upright axis, forward positive. Knee: the shank against the
  thigh, bent positive, about the axis that the thigh carries. Ankle: from ankle to toe joint against the shank, less 90
  degrees, toe up positive, about the same axis: some captures' shanks spin about themselves, which no eye sees.
- RMS and greatest difference at the source's own frames, after the one phase shift that is best for all six joints
  together. The worse leg counts.
- Knee maxima: turning points of the cyclic curve that rise and fall by more than 1 degree; source and walk alike.
- Least knee: data below 1 degree count as 1, the least that support/judge.py allows.
- Vertical acceleration of the hips: of the point between the hip joints (some captures keep the pelvis' joint level), by
  the least-squares parabola over 1/30 s to either side (at least two frames of the source), in source and walk alike.
- Hips' speed: the forward speed of the same point within the stride, over its mean, by the same parabola: RMS of the
  difference from the source's, and how far the fastest moment of a step (the mean of both) is from the source's. Both are
  told, not judged.
- Slide of the source's own feet: while heel and toe are both within 4 % of the leg of their lowest, how far the toe
  strays from its mean place. Beyond 40 mm a clip may be 4 degrees off, for that reason.
- Second difference, planted points, floor, steps, speed, drift and repetition: as in support/judge.py.
- Changes: a second walk starts, takes strides other than the clip's own and stops twice, once in the middle of a step.
  Second difference, planted points, floor and failed solves of all its ticks.
That a mirrored stick gives the mirrored walk is judged by acceptance.py, on the built-in motion: no capture is symmetric.
"""
import argparse
import json
import pathlib
import sys
import tempfile
import time

import numpy as np

if __name__ == "__main__":
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import gait_pictures, judge, program as programs
from support.sources import BUILT_IN_FRAMES, built_in_track, read_source
from support.traces import EXACT_CALIBRATION, write_trace
from support.walk import SIDES, Walk

JOINTS = ("hip", "knee", "ankle")
RMS_DEG, SLID_RMS_DEG, MEDIAN_DEG = (3.0, 3.0, 3.5), (4.0, 4.0, 4.0), (2.0, 2.0, 2.5)
FAR_SLIDE_MM = 40.0
RIPPLE_DEG = 1.0
LEAST_KNEE_DEG, LEAST_ALLOWED_KNEE_DEG = 3.0, 1.0
FALL_M_S2, FALL_RATIO = 12.0, 1.5
D2_DEG, BUILT_IN_D2_DEG, CHANGES_D2_DEG = 0.7, 0.5, 1.3
CHANGES = [(0.5, 0, 0.8), (4.0, 0, 0.4), (7.0, 0, 1.0), (10.1, 0, 0), (12.5, 0, 0.6), (15.0, 0, 0.9), (17.35, 0, 0)]
CHANGES_S = 20.0
PLANTED_MM = 0.01
OWN_PACE = 0.01  # allowed error of the clip's speed, steps and time, relative
TOLD_PACE = 0.03  # allowed error of the gait that the frames show, relative


# ---- a stride, of a source or of a walk ----------------------------------------------------------
class Stride:
    """Frames of one stride: phase (N,) from 0, position and rotation of every joint, pelvis and legs by index.
    legs: per side (hip, knee, ankle, toe). heel_m: per side, in the ankle's frame."""

    def __init__(self, phase, seconds, position, rotation, pelvis, legs, heel_m):
        self.phase, self.seconds, self.position, self.rotation = phase, seconds, position, rotation
        self.pelvis, self.legs, self.heel_m = pelvis, legs, heel_m
        across = np.mean([position[:, legs[0][0]] - position[:, legs[1][0]]], axis=(0, 1))
        upright = np.mean([position[:, leg[0]] - position[:, leg[2]] for leg in legs], axis=(0, 1))
        axis = int(np.argmax(np.abs(upright)))
        self.up = np.sign(upright[axis]) * np.eye(3)[axis]  # not every clip stands along y
        self.left = across - (across @ self.up) * self.up
        self.left /= np.linalg.norm(self.left)
        self.forward = np.cross(self.left, self.up)

    def seen(self, joint, vector):
        """Vectors of the world (N, 3) in the joint's frame."""
        return np.einsum("fji,fj->fi", self.rotation[:, joint], vector)

    def bone(self, a, b):
        return self.position[:, b] - self.position[:, a]

    def height(self):
        return 0.5 * (self.position[:, self.legs[0][0]] + self.position[:, self.legs[1][0]]) @ self.up


def unit(vector):
    return vector / np.linalg.norm(vector)


def standing_axes(s):
    """The sagittal plane of the source: left, up, forward of the pelvis in its own frame, and for each side the axis to
    the left in the thigh's frame."""
    across = s.bone(s.legs[1][0], s.legs[0][0])
    left = unit(s.seen(s.pelvis, across).mean(0))
    up = s.seen(s.pelvis, np.tile(s.up, (len(s.phase), 1))).mean(0)
    up = unit(up - (up @ left) * left)
    return {"pelvis": (left, up, np.cross(left, up)), "hinges": [unit(s.seen(leg[0], across).mean(0)) for leg in s.legs]}


def turn_about(axis, a, b):
    """Degrees from a to b (N, 3) about the axis, both projected along it."""
    a, b = (v - np.outer(v @ axis, axis) for v in (a, b))
    return np.degrees(np.arctan2(np.cross(a, b) @ axis, np.sum(a * b, -1)))


def flexions(s, axes):
    """(N, 6): hip, knee, ankle of the left leg, then of the right one."""
    _, up, forward = axes["pelvis"]
    columns = []
    for (hip, knee, ankle, toe), hinge in zip(s.legs, axes["hinges"]):
        thigh, shank, foot = (s.seen(hip, s.bone(a, b)) for a, b in ((hip, knee), (knee, ankle), (ankle, toe)))
        in_pelvis = s.seen(s.pelvis, s.bone(hip, knee))
        columns += [np.degrees(np.arctan2(in_pelvis @ forward, -(in_pelvis @ up))),
                    turn_about(hinge, thigh, shank), -turn_about(hinge, shank, foot) - 90]
    return np.degrees(np.unwrap(np.radians(np.stack(columns, -1)), axis=0))


def around(phase, curves, places):
    """Values of periodic curves (N, C) at other phases."""
    return np.stack([np.interp(places % 1.0, phase % 1.0, c, period=1.0) for c in curves.T], -1)


def best_shift(phase, source, walk_phase, walk):
    """The phase shift of the walk with the smallest distance of all curves from the source's frames."""
    def error(shift):
        return np.mean((around(walk_phase, walk, phase + shift) - source) ** 2)
    coarse = min(np.arange(100) / 100, key=error)
    return min(coarse + np.arange(-20, 21) / 2000, key=error)


def maxima(curve, least=RIPPLE_DEG):
    """Maxima of a cyclic curve that rise and fall by more than `least`."""
    curve = np.roll(curve, -int(np.argmin(curve)))
    count, rising, extreme = 0, False, curve[0]
    for value in [*curve, curve[0]]:
        extreme = max(extreme, value) if rising else min(extreme, value)
        if rising and value < extreme - least:
            count, rising, extreme = count + 1, False, value
        elif not rising and value > extreme + least:
            rising, extreme = True, value
    return count


def closed(curve):
    """Closes a captured stride, which does not end in its first pose: the difference is spread evenly over it."""
    return curve - np.linspace(0, 1, len(curve)) * (curve[-1] - curve[0])


def parabolas(track, rate_hz, half_s, first, last, power):
    """A coefficient of the parabolas through all values within half_s, about the samples first..last that have them, and
    the first of those samples."""
    half = max(1, round(half_s * rate_hz))
    t = np.arange(-half, half + 1) / rate_hz
    weights = np.linalg.pinv(np.stack([np.ones_like(t), t, t * t], -1))[power]
    return np.convolve(track, weights[::-1], "valid")[max(0, first - half):max(1, last + 1 - half)], max(first, half)


def vertical_acceleration(height, rate_hz, half_s, first, last):
    """The (least, greatest) m/s^2 of these heights about the samples first..last."""
    found = 2 * parabolas(height, rate_hz, half_s, first, last, 2)[0]
    return float(found.min()), float(found.max())


def forward_speed(place, up, phase, rate_hz, half_s, first, last):
    """The (phases, speeds over their mean) along the way from sample `first` to `last` of a place (F, 3); one phase for
    each sample."""
    way = place[last] - place[first]
    found, start = parabolas(place @ unit(way - (way @ up) * up), rate_hz, half_s, first, last, 1)
    return phase[start:start + len(found)], found / found.mean()


def speed_off(source, walk, shift):
    """Differences of two forward_speed(), the walk's read `shift` later: RMS in % of the mean speed, and of the fastest
    moment in % of a step."""
    at = lambda curve, phase: around(curve[0], curve[1][:, None], phase)[:, 0]
    rms = np.sqrt(np.mean((at(walk, source[0] + shift) - source[1]) ** 2))
    even = np.arange(200) / 400
    ours, theirs = (int(np.argmax(at(curve, even + by) + at(curve, even + by + 0.5)))
                    for curve, by in ((walk, shift), (source, 0.0)))
    apart = abs(ours - theirs) / 200
    return 100 * float(rms), 100 * min(apart, 1 - apart)


def foot_slide_mm(s):
    """Largest distance of a standing toe from its mean place in the source."""
    worst = 0.0
    leg_m = np.linalg.norm(s.bone(*s.legs[0][:2])[0]) + np.linalg.norm(s.bone(*s.legs[0][1:3])[0])
    for (_, _, ankle, toe), heel_m in zip(s.legs, s.heel_m):
        heel = s.position[:, ankle] + s.rotation[:, ankle] @ heel_m
        flat = np.ones(len(s.phase), dtype=bool)
        for track in (heel @ s.up, s.position[:, toe] @ s.up):
            flat &= track < track.min() + 0.04 * leg_m
        for a, b in judge.runs(flat):
            if (b - a) / len(flat) * s.seconds > 0.1:
                place = s.position[a:b, toe] - np.outer(s.position[a:b, toe] @ s.up, s.up)
                worst = max(worst, 1000 * np.linalg.norm(place - place.mean(0), axis=-1).max())
    return worst


def compare(source, walk):
    """The figures of a walk's stride compared with its source's."""
    axes = standing_axes(source)
    ours, theirs = flexions(walk, axes), flexions(source, axes)
    ours += 360 * np.round((theirs.mean(0) - ours.mean(0)) / 360)
    shift = best_shift(source.phase, theirs, walk.phase, ours)
    off = around(walk.phase, ours, source.phase + shift) - theirs
    rms, most = np.sqrt(np.mean(off ** 2, 0)).reshape(2, 3), np.abs(off).max(0).reshape(2, 3)
    knees = [(theirs[:, c], ours[:, c]) for c in (1, 4)]
    even = np.arange(400) / 400
    return {"rms_deg": list(map(float, rms.max(0))), "greatest_deg": list(map(float, most.max(0))),
            "shift": float(shift),
            "knee_maxima": [(maxima(closed(a)), maxima(b)) for a, b in knees],
            "least_knee_deg": [(float(a.min()), float(b.min())) for a, b in knees],
            "curves": {"phase": even, "source": around(source.phase, np.column_stack([theirs, closed(source.height())]), even),
                       "walk": around(walk.phase, np.column_stack([ours, closed(walk.height())]), even + shift)}}


# ---- which frames ------------------------------------------------------------------------------
def stride_of_track(track, legs, heel_m, first, frames, margin=0):
    """The whole frames of [first, first + frames], `margin` more at either end where the file has them; the place of
    the stride's first and last frame among them."""
    a, b = int(np.ceil(first - 1e-9)), int(np.floor(first + frames + 1e-9))
    last = len(track.position) - 1  # in a looping clip the stride may exceed it
    low, high, b = max(0, a - margin), min(last, b + margin), min(last, b)
    part = slice(low, high + 1)
    chains = []
    for leg in legs:
        chains.append([])
        joint = leg[0]
        while joint >= 0:
            chains[-1].append(joint)
            joint = track.parents[joint]
    pelvis = next(j for j in chains[0] if j in chains[1])
    phase = (np.arange(low, high + 1) - first) / frames
    stride = Stride(phase, frames / track.rate_hz, track.position[part], track.rotation[part], pelvis, legs, heel_m)
    return stride, a - low, b - low


def stride_of_walk(w):
    """The last whole steady stride, ticks counted from the right foot's landing."""
    cycles = w.cycles(1, w.steady)
    if len(cycles) < 2:
        raise ValueError("the walk has no two steady strides")
    period = (cycles[-1][1] - cycles[0][0]) / len(cycles)
    a = cycles[-2][0]
    part = slice(a, a + int(np.ceil(period)) + 1)
    phase = np.arange(part.stop - a) / period
    legs = list(zip(w.hip, w.knee, w.ankle, w.toe))
    heel_m = [np.array(w.summary[f"{s}_heel_offset_m"]) for s in SIDES]
    return Stride(phase, period / w.rate, w.position[part], w.rotation[part], w.pelvis, legs, heel_m), a


def trimmed(s, a, b):
    """The track without the frames outside the stride, and without the frame that repeats the first."""
    part = slice(a, b + 1 - (s.phase[b] > 1 - 1e-6 and s.phase[a] < 1e-6))
    return Stride(s.phase[part], s.seconds, s.position[part], s.rotation[part], s.pelvis, s.legs, s.heel_m)


# ---- a clip --------------------------------------------------------------------------------------
def replay(options, folder, motion, sticks, seconds):
    folder.mkdir(exist_ok=True)
    (folder / "exact.toml").write_text(EXACT_CALIBRATION)
    write_trace(folder / "walk.hid", sticks, (), seconds)
    words = ["replay", folder / "walk.hid", "--out", folder, "--calibration", folder / "exact.toml", "--style", "even"]
    return programs.run(options.program, *words, *(["--motion", motion] if motion else []), status=None)


def reason_of(done):
    return (done.stderr.strip().splitlines() or ["no message"])[-1].removeprefix("gaitpad ").strip()


def judge_clip(options, folder, path=None):
    """The row of one clip (a dict), or {"refused": reason}."""
    started = time.time()
    name = pathlib.Path(path).name if path else "built-in"
    done = programs.run(options.program, "motion", path or "procedural", "--json", status=None)
    if done.returncode:
        return {"clip": name, "refused": reason_of(done)}
    told = json.loads(done.stdout)
    gait = told["gait"] or {"own_stick": 0.8, "stride_s": 1.2}  # the gait of clips that replay refuses
    done = replay(options, folder, path, [(0.5, 0, gait["own_stick"])], 4 + 24 * gait["stride_s"])
    if done.returncode:
        return {"clip": name, "refused": reason_of(done)}
    w = Walk(folder)
    heel_m = [np.array(w.summary[f"{s}_heel_offset_m"]) for s in SIDES]
    heel_m = [h * w.summary["source_leg_length_m"] / w.leg_length for h in heel_m]
    if path:
        track = read_source(path, told["metres_per_unit"], told["frame_rate_hz"])
        legs = [[track.index(told["legs"][s][j]) for j in ("hip", "knee", "ankle", "toe")] for s in SIDES]
        first, frames = gait["first_frame"], gait["frames"]
    else:
        track = built_in_track(w, gait["speed_m_s"], strides=3)
        legs, first, frames = list(zip(w.hip, w.knee, w.ankle, w.toe)), BUILT_IN_FRAMES, float(BUILT_IN_FRAMES)
    half_s = max(1 / 30, 2 / track.rate_hz)
    wide, a, b = stride_of_track(track, legs, heel_m, first, frames, margin=round(half_s * track.rate_hz))
    source = trimmed(wide, a, b)
    ends = wide.position[[a, b], wide.pelvis]
    way_m = np.linalg.norm(ends[1] - ends[0] - ((ends[1] - ends[0]) @ wide.up) * wide.up) * frames / (b - a)
    row = {"clip": name, "first_frame": first, "frames": frames, "stride_s": source.seconds,
           "speed_m_s": way_m / source.seconds, "slide_mm": foot_slide_mm(source)}
    walk, at = stride_of_walk(w)
    row.update(compare(source, walk))
    hips_m = 0.5 * (w.position[:, w.hip[0], 1] + w.position[:, w.hip[1], 1])
    row["fall_m_s2"] = [vertical_acceleration(wide.height(), track.rate_hz, half_s, a, b),
                        vertical_acceleration(hips_m, w.rate, half_s, at, at + len(walk.phase) - 1)]
    hips = lambda position, legs: 0.5 * (position[:, legs[0]] + position[:, legs[1]])
    theirs = forward_speed(hips(wide.position, [leg[0] for leg in legs]), wide.up, wide.phase, track.rate_hz, half_s, a, b)
    ours = forward_speed(hips(w.position, w.hip), np.eye(3)[1], (np.arange(w.ticks) - at) * walk.phase[1], w.rate, half_s, at,
                         at + len(walk.phase) - 1)
    row["speed_off"] = speed_off(theirs, ours, row["shift"])
    row["d2_deg"], row["d2_joint"] = sharpest_leg_joint(w, np.nonzero(w.steady)[0])
    row["walk_stride_s"], row["walk_speed_m_s"] = walk.seconds, float(w.col["speed_m_s"][at])
    replay(options, folder / "changes", path, CHANGES, CHANGES_S)
    row["checks"] = judge_row(row, w, walk, gait, path is None) + change_checks(Walk(folder / "changes"))
    row["broken"] = [c for c in row["checks"] if c.ok is False]
    row["strides"], row["parents"] = (source, walk), (track.parents, w.bvh.parents)
    row["seconds"] = time.time() - started
    return row


def sharpest_leg_joint(w, ticks):
    """Largest second difference in degrees / tick^2 at 240 Hz, and its joint."""
    joints = sorted(set(w.leg_joints[0] + w.leg_joints[1]))
    d2 = w.second_differences[np.ix_(ticks, joints)].max(0)
    return float(d2.max()), w.bvh.names[joints[int(d2.argmax())]]


def contacts(w):
    return [judge.Check(c.name, c.value, PLANTED_MM, unit="mm", note=c.note) if c.name.endswith("moves") else c
            for c in judge.contact_checks(w)]


def change_checks(w):
    """The figures of the walk's starts, stops and changes of stride."""
    value, joint = sharpest_leg_joint(w, np.arange(w.ticks))
    checks = [judge.Check("second difference", value, CHANGES_D2_DEG, unit="deg/tick2", note=joint), *contacts(w),
              *(c for c in judge.file_checks(w) if c.name == "ik_failures")]
    for check in checks:
        check.name = f"at changes: {check.name}"
    return checks


def judge_row(row, w, walk, gait, is_built_in):
    """Every bound as a Check of support/judge.py."""
    check = judge.Check
    slid = row["slide_mm"] > FAR_SLIDE_MM
    note = f"the capture's own feet slide {row['slide_mm']:.0f} mm" if slid else ""
    checks = [check(f"{j} RMS", v, b, unit="deg", note=note)
              for j, v, b in zip(JOINTS, row["rms_deg"], SLID_RMS_DEG if slid else RMS_DEG)]
    extra = [ours - data for data, ours in row["knee_maxima"]]
    apart = [abs(ours - max(data, LEAST_ALLOWED_KNEE_DEG)) for data, ours in row["least_knee_deg"]]
    data, ours = (max(-low, high) for low, high in row["fall_m_s2"])
    checks += [check("knee maxima beyond the data's", max(extra), 0),
               check("least knee off the data's", max(apart), LEAST_KNEE_DEG, unit="deg"),
               check("vertical acceleration of the hips", ours, max(FALL_M_S2, FALL_RATIO * data), unit="m/s2"),
               check("hips' speed in the stride off the data's", row["speed_off"][0], unit="%"),
               check("hips' fastest moment off the data's", row["speed_off"][1], unit="% of a step"),
               check("second difference", row["d2_deg"], BUILT_IN_D2_DEG if is_built_in else D2_DEG, unit="deg/tick2",
                     note=row["d2_joint"])]
    checks += contacts(w)
    checks += judge.stage_checks(w) + judge.step_checks(w) + judge.speed_checks(w) + judge.repeat_check(w)
    checks += [c for c in judge.file_checks(w) if c.name.startswith(("FK", "ik_fail", "Euler", "steps"))]
    return checks + pace_checks(row, w, walk, gait, is_built_in)


def pace_checks(row, w, walk, gait, is_built_in):
    """Compares the walk with the gait that the program printed, and that gait with the file's frames. The built-in
    motion has an adult's pace: its stick sets its speed, with an adult's steps."""
    steps = [np.mean([m for k, m in judge.realised_steps(w, side) if w.steady[k]]) for side in (0, 1)]
    pairs = [("stride's time", walk.seconds, gait["stride_s"], OWN_PACE),
             ("left step", steps[0], gait["step_left_m"], OWN_PACE), ("right step", steps[1], gait["step_right_m"], OWN_PACE),
             ("speed", sum(steps) / walk.seconds, gait["speed_m_s"], OWN_PACE),
             ("told stride's time", gait["stride_s"], row["stride_s"], TOLD_PACE),
             ("told speed", gait["speed_m_s"], row["speed_m_s"], TOLD_PACE)]
    if is_built_in:
        pairs = pairs[3:]
    return [judge.Check(f"{name} off the clip's", 100 * abs(ours / own - 1), 100 * share, unit="%",
                        note=f"{own:.4g} -> {ours:.4g}") for name, ours, own, share in pairs]


# ---- the table -----------------------------------------------------------------------------------
HEAD = (f"{'clip':28s} {'s':>5s} {'m/s':>5s} {'slide':>5s} {'hip':>10s} {'knee':>10s} {'ankle':>10s} {'maxima':>9s} "
        f"{'least knee':>13s} {'fall m/s2':>9s} {'speed %':>8s} {'d2':>5s} {'moves':>6s} {'time':>5s}  broken")


def short(row):
    pairs = "  ".join(f"{v:4.1f} ({m:2.0f})".rjust(9) for v, m in zip(row["rms_deg"], row["greatest_deg"]))
    count = " ".join(f"{a}>{b}" for a, b in row["knee_maxima"])
    least = " ".join(f"{a:.0f}>{b:.0f}" for a, b in row["least_knee_deg"])
    falls = ">".join(f"{max(-low, high):.0f}" for low, high in row["fall_m_s2"])
    speed = "{:.1f} ({:.0f})".format(*row["speed_off"])
    moves = max(c.value for c in row["checks"] if c.name.endswith("moves"))
    broken = ", ".join(c.name for c in row["broken"])
    return (f"{row['clip'][:28]:28s} {row['stride_s']:5.2f} {row['speed_m_s']:5.2f} {row['slide_mm']:5.0f}  {pairs} {count:>9s} "
            f"{least:>13s} {falls:>9s} {speed:>8s} {row['d2_deg']:5.2f} {moves:6.3f} {row['seconds']:5.1f}  {broken or 'none'}")


def medians(rows):
    """Checks the median over the clips, without the built-in motion."""
    clips = [r["rms_deg"] for r in rows if r["clip"] != "built-in"]
    return [judge.Check(f"median {j} RMS", float(v), b, unit="deg", note=f"{len(clips)} clips")
            for j, v, b in zip(JOINTS, np.median(clips, 0), MEDIAN_DEG)] if clips else []


def for_machines(row):
    kept = {k: v for k, v in row.items() if k not in ("strides", "parents", "curves", "checks", "broken")}
    if "checks" in row:
        kept["checks"] = [c.as_dict() for c in row["checks"]]
    return kept


# ---- all of it -------------------------------------------------------------------------------------
def clips_of(paths):
    found = []
    for path in map(pathlib.Path, paths):
        found += sorted(p for p in path.iterdir() if p.suffix.lower() in (".bvh", ".amc")) if path.is_dir() else [path]
    return found


def arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("clips", nargs="*", metavar="FILE_OR_FOLDER", help=".bvh or .amc (its .asf beside it)")
    parser.add_argument("--built-in", action="store_true", help="the built-in motion, too")
    parser.add_argument("--json", action="store_true", help="every figure, for machines")
    parser.add_argument("--picture", metavar="OUT.png", help="curves of all clips")
    parser.add_argument("--sheet", metavar="OUT.png", help="stick figures of all clips")
    parser.add_argument("--out", type=pathlib.Path, help="keep what replay writes there, a folder a clip")
    options = parser.parse_intermixed_args(words)
    if not options.clips and not options.built_in:
        parser.error("name a clip, a folder or --built-in")
    options.program = options.program.resolve()
    if not options.program.exists():
        parser.error(f"{options.program} is not built")
    return options


def run_all(options, say=lambda text: None):
    """Runs all of them and returns (rows judged, rows refused, checks of the medians)."""
    rows, refused = [], []
    with tempfile.TemporaryDirectory() as scratch:
        out = (options.out or pathlib.Path(scratch)).resolve()
        out.mkdir(parents=True, exist_ok=True)
        for path in ([None] if options.built_in else []) + clips_of(options.clips):
            name = path.name if path else "built-in"
            try:
                row = judge_clip(options, out / name, path)
            except Exception as error:  # a clip that cannot be measured has failed; the others are still judged
                row = {"clip": name, "refused": f"CANNOT BE JUDGED: {type(error).__name__}: {error}", "failed": True}
            (refused if "refused" in row else rows).append(row)
            say(f"{row['clip'][:28]:28s} {row['refused']}" if "refused" in row else short(row))
    return rows, refused, medians(rows)


def main():
    options = arguments()
    say = (lambda text: None) if options.json else (lambda text: print(text, flush=True))
    say(HEAD)
    rows, refused, middle = run_all(options, say)
    for check in middle:
        say(f"{check.name:28s} {check.value:.2f} {check.bound_text()} {'ok' if check.ok else 'FAIL'} ({check.note})")
    failed = [r for r in rows if r["broken"]] + [r for r in refused if r.get("failed")]
    for row in rows if not options.json else ():
        for c in row["broken"]:
            print(f"  {row['clip']}: {c.name} {c.value:.4g} {c.unit}, bound {c.bound_text()} {c.note}".rstrip())
    say(f"{len(rows)} clips judged, {len(failed)} broken, {len(refused)} refused")
    if options.json:
        print(json.dumps({"clips": list(map(for_machines, rows)), "refused": refused,
                          "medians": [c.as_dict() for c in middle]}, indent=1))
    if options.picture and rows:
        gait_pictures.draw_curves(rows, options.picture)
    if options.sheet and rows:
        gait_pictures.draw_sheet(rows, options.sheet)
    return 1 if failed or any(c.ok is False for c in middle) or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
