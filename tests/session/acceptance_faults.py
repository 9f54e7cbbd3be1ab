#!/usr/bin/env python3
"""Judges the judge: an own small walk, exact by construction, passes walk_check; each planted fault
in its files makes the check that is meant for it fail. Needs neither the program nor data."""
import copy
import json
import os
import sys
import tempfile

import numpy as np

import bvh_fk
import walk_bounds
import walk_check
import walk_compare
import walk_smooth
from walk_data import COLUMNS, SIDES, Walk

THIGH = SHANK = 0.42
HIP_Y, HALF_WIDTH = 0.85, 0.1
HEEL, TOE, TOE_END = (0.0, -0.08, -0.05), (0.0, -0.06, 0.13), (0.0, -0.02, 0.06)
TOE_REST = 0.02


def smooth(t):
    t = np.clip(t, 0.0, 1.0)
    return t * t * t * (t * (6 * t - 15) + 10)


def schedule(plan, strides):
    """List of (stage, side, ticks): idle, then roll R, flight L, roll L, flight R ..., idle."""
    order = [("idle", None, 60)]
    first = plan["first"]
    for _ in range(strides):
        for side in (1 - first, first):  # the foot that has landed; the other one flies next
            order += [("roll", side, plan["roll"]), ("flight", 1 - side, plan["flight"][1 - side])]
    return order


def rotate_x(vector, angle):
    """(N, 3): fixed vector turned about x by angles (rad)."""
    x, y, z = vector
    return np.stack([np.full_like(angle, x), y * np.cos(angle) - z * np.sin(angle),
                     y * np.sin(angle) + z * np.cos(angle)], -1)


class Maker:
    """Feet first (heel place and pitch), hips evenly, then the exact planar leg."""

    def __init__(self, plan, strides=18):
        self.plan, self.order = plan, schedule(plan, strides)
        self.ticks = sum(n for _, _, n in self.order)
        self.stage = np.empty(self.ticks, dtype="U6")
        self.swing = np.empty(self.ticks, dtype="U5")
        self.heel = np.zeros((2, self.ticks, 3))
        self.pitch = np.zeros((2, self.ticks))
        self.stride = np.zeros((2, self.ticks))
        self.root = np.zeros((self.ticks, 3))
        self._feet()
        self._hips()

    def _feet(self):
        plan, k = self.plan, 0
        heel_z, pitch = np.zeros(2), np.zeros(2)  # where the feet stand and end the stage before
        for number, (stage, side, n) in enumerate(self.order):
            part, t = slice(k, k + n), (np.arange(n) + 1) / n
            self.stage[part], self.swing[part] = stage, "none" if side is None else SIDES[side]
            for foot in range(2):
                self.stride[foot, part] = plan["length"][foot]
                self._foot(foot, stage, side, part, t, heel_z, pitch, number)
            if stage == "flight":
                heel_z[side] = heel_z[1 - side] + plan["length"][side]
            pitch[:] = self.pitch[:, k + n - 1]
            k += n

    def _foot(self, foot, stage, side, part, t, heel_z, pitch, number):
        n = len(t)
        flat = np.stack([np.zeros(n), np.zeros(n), np.full(n, heel_z[foot])], -1)
        if stage == "idle" or (stage == "roll" and number < 2 and foot == side):
            self.heel[foot, part] = flat
        elif stage == "roll" and foot == side:  # heel planted, toe drops
            self.pitch[foot, part] = pitch[foot] * (1 - smooth(t / 0.95))
            self.heel[foot, part] = flat
        elif stage == "flight" and foot == side:
            self._fly(foot, part, t, heel_z, pitch)
        else:  # toe planted, heel rises
            low, high = (0.0, 0.20) if stage == "flight" else (pitch[foot], 0.45)
            angle = low + (high - low) * smooth((t - 0.5) * 2 if stage == "flight" else t)
            self.pitch[foot, part] = angle
            toe = np.array([0.0, TOE_REST, heel_z[foot] + TOE[2] - HEEL[2]])
            self.heel[foot, part] = toe + rotate_x(np.subtract(HEEL, TOE), angle)

    def _fly(self, foot, part, t, heel_z, pitch):
        plan = self.plan
        start = self.heel[foot, part.start - 1]
        end = np.array([0.0, 0.0, heel_z[1 - foot] + plan["length"][foot]])
        path = start + (end - start) * smooth(t)[:, None]
        path[:, 1] = start[1] * (1 - smooth(t)) + plan["height"][foot] * 16 * (t * (1 - t)) ** 2
        self.heel[foot, part] = path
        bump = plan.get("bump", 0.0) * 16 * (t * (1 - t)) ** 2
        self.pitch[foot, part] = pitch[foot] + (-0.25 - pitch[foot]) * smooth(t) + bump

    def _hips(self):
        """Between the feet: even speed, reached smoothly within the first half second."""
        cycle = 2 * self.plan["roll"] + sum(self.plan["flight"])
        speed = sum(self.plan["length"]) / cycle
        k = np.arange(self.ticks) - 60
        self.speed_m_s = speed * 240
        self.root[:, 1] = HIP_Y
        self.root[:, 2] = -0.05 + 0.2 * self.plan["length"][0] + speed * (60 + np.cumsum(smooth(k / 120)))

    def leg_angles(self, foot):
        """Hip, knee, ankle, toe rotation about x in radians."""
        hip = self.root + [0, 0, 0]
        ankle = self.heel[foot] - rotate_x(HEEL, self.pitch[foot])
        reach = ankle - hip
        distance = np.hypot(reach[:, 1], reach[:, 2])
        bend = np.arccos(np.clip((THIGH ** 2 + SHANK ** 2 - distance ** 2) / (2 * THIGH * SHANK), -1, 1))
        line = np.arctan2(-reach[:, 2], -reach[:, 1])  # rotation about x that carries -y there
        knee = np.pi - bend
        thigh = line - knee / 2
        return thigh, knee, self.pitch[foot] - thigh - knee, -np.maximum(self.pitch[foot], 0)


JOINTS = [("Hips", -1, (0, 0, 0))]
for _side, _sign in (("Left", 1), ("Right", -1)):
    _at = len(JOINTS)
    JOINTS += [(_side + "UpLeg", 0, (_sign * HALF_WIDTH, 0, 0)), (_side + "Leg", _at, (0, -THIGH, 0)),
               (_side + "Foot", _at + 1, (0, -SHANK, 0)), (_side + "ToeBase", _at + 2, TOE),
               (_side + "ToeBase_End", _at + 3, TOE_END)]
JOINTS += [("Spine", 0, (0, 0.2, 0)), ("Spine_End", 11, (0, 0.3, 0))]


def pose_of(maker):
    bvh = bvh_fk.Bvh()
    bvh.names = [n for n, _, _ in JOINTS]
    bvh.parents = [p for _, p, _ in JOINTS]
    bvh.offsets = np.array([o for _, _, o in JOINTS], dtype=float) * 100
    bvh.end_site = [n.endswith("_End") for n in bvh.names]
    spin = ["Zrotation", "Xrotation", "Yrotation"]
    bvh.channels = [[] if e else spin for e in bvh.end_site]
    bvh.channels[0] = ["Xposition", "Yposition", "Zposition"] + spin
    bvh.first = list(np.cumsum([0] + [len(c) for c in bvh.channels])[:-1])
    bvh.data = np.zeros((maker.ticks, sum(len(c) for c in bvh.channels)))
    bvh.data[:, :3] = maker.root * 100
    for foot in range(2):
        for n, angle in enumerate(maker.leg_angles(foot)):
            bvh.data[:, bvh.first[1 + 5 * foot + n] + 1] = np.degrees(angle)
    cycle = 2 * maker.plan["roll"] + sum(maker.plan["flight"])
    bvh.data[:, bvh.first[11] + 2] = 5 * np.sin(2 * np.pi * np.arange(maker.ticks) / cycle)
    bvh.frame_time = 1 / 240
    return bvh


def summary_of(maker, landings):
    text = {"ticks": maker.ticks, "rate_hz": 240, "pose_hash": "0" * 16, "motion": "procedural",
            "metres_per_unit": 0.01, "leg_length_m": THIGH + SHANK, "source_leg_length_m": THIGH + SHANK,
            "ik_failures": 0, "reports": 1, "bad_reports": 0}
    for foot, side in enumerate(SIDES):
        text.update({f"{side}_toe_joint": f"{side.title()}ToeBase", f"{side}_ankle_joint": f"{side.title()}Foot",
                     f"{side}_heel_offset_m": list(HEEL), f"{side}_toe_rest_m": TOE_REST,
                     f"steps_{side}": landings[foot]})
    return text


def columns_of(maker):
    n = maker.ticks
    col = {name: np.zeros(n) for name in COLUMNS}
    col["tick"] = np.arange(n)
    col["time_s"] = np.arange(n) / 240
    col["stage"], col["swing"] = maker.stage, maker.swing
    walking = maker.stage != "idle"
    col["stick_y"] = np.where(walking, 0.8, 0.0)
    col["speed_m_s"] = np.where(walking, maker.speed_m_s, 0)
    for axis, name in enumerate("xyz"):
        col[f"root_{name}_m"] = maker.root[:, axis]
    for foot, side in enumerate(SIDES):
        landed = (maker.stage == "roll") & (maker.swing == side)
        lifted = (maker.stage != "idle") & (maker.swing == side) & (maker.stage == "flight")
        behind = (maker.stage == "roll") & (maker.swing != side)
        col[f"{side}_heel_planted"] = (maker.stage == "idle") | landed
        col[f"{side}_toe_planted"] = ~lifted & (~landed | behind)
        col[f"stride_{side}_m"] = maker.stride[foot]
        place = maker.heel[foot] + [HALF_WIDTH if foot == 0 else -HALF_WIDTH, 0, 0]
        toe = place + rotate_x(np.subtract(TOE, HEEL), maker.pitch[foot])
        for axis, name in enumerate("xyz"):
            col[f"{side}_heel_{name}_m"], col[f"{side}_toe_{name}_m"] = place[:, axis], toe[:, axis]
    return col


class Files:
    """The three exported files in memory, to be spoilt and written."""

    def __init__(self, **plan):
        base = {"first": 0, "roll": 60, "flight": (180, 180), "length": (0.32, 0.32), "height": (0.1, 0.1)}
        maker = Maker({**base, **plan})
        self.bvh, self.col = pose_of(maker), columns_of(maker)
        landings = [int(((maker.stage[:-1] == "flight") & (maker.stage[1:] == "roll") &
                         (maker.swing[1:] == s)).sum()) for s in SIDES]
        self.summary = summary_of(maker, landings)

    def load(self, changes=()):
        with tempfile.TemporaryDirectory() as folder:
            bvh_fk.write_bvh(self.bvh, os.path.join(folder, "pose.bvh"), 7)
            with open(os.path.join(folder, "summary.json"), "w", encoding="utf-8") as file:
                json.dump(self.summary, file)
            texts = [v if v.dtype.kind == "U" else v.astype(int).astype(str) if v.dtype.kind in "bi" else
                     np.char.mod("%.9f", v) for v in self.col.values()]
            with open(os.path.join(folder, "frames.csv"), "w", encoding="utf-8") as file:
                file.write(",".join(self.col) + "\n" + "\n".join(",".join(row) for row in zip(*texts)) + "\n")
            return Walk(folder, changes=changes)

    def channel(self, joint, name):
        j = self.bvh.index(joint)
        return self.bvh.data[:, self.bvh.first[j] + self.bvh.channels[j].index(name)]


class Spot:
    """Where faults are planted: ticks of the 8th flight and roll of the left foot, and its channels."""

    def __init__(self, files):
        self.files, self.col, self.bvh, self.summary = files, files.col, files.bvh, files.summary
        self.lift, self.strike = self._stage("flight")
        self.land, self.rolled = self._stage("roll")
        self.fly = (self.lift + self.strike) // 2

    def _stage(self, stage):
        return walk_bounds.runs((self.col["stage"] == stage) & (self.col["swing"] == "left"))[8]

    def add(self, joint, channel, degrees, first=0, last=None):
        self.files.channel(joint, channel)[first:last] += degrees

    def column(self, name, add=0.0, tick=slice(None), factor=1.0):
        self.col[name][tick] = self.col[name][tick] * factor + add

    def slide(self, first, last):  # 0.3 mm sideways
        self.bvh.data[first:last, 0] += np.linspace(0, 0.03, last - first)

    def told(self, name, add=0.0, factor=1.0):
        self.summary[name] = self.summary[name] * factor + add


def _swap_columns(s):
    s.files.col = {k: s.col[k] for k in list(s.col)[1:]} | {"tick": s.col["tick"]}


def _drop_frame(s):
    s.bvh.data = s.bvh.data[:-1]


def _drift(s):
    s.bvh.data[:, 0] += np.linspace(0, 0.5, len(s.bvh.data))
    s.col["root_x_m"] += np.linspace(0, 0.005, len(s.bvh.data))


def _knee_backwards(s):
    knee = s.files.channel("LeftLeg", "Xrotation")
    s.files.channel("LeftUpLeg", "Xrotation")[s.fly] += knee[s.fly]
    knee[s.fly] *= -1


def _raise(s, units):
    s.bvh.data[:, 1] += units


# The name is that of the check which has to see the fault.
FILE_FAULTS = {
    "columns missing or out of order": _swap_columns,
    "rows minus pose frames": _drop_frame,
    "rows minus summary ticks": lambda s: s.told("ticks", 1),
    "not finite numbers": lambda s: s.column("left_heel_x_m", np.nan, s.fly),
    "tick, time_s off": lambda s: s.column("time_s", 0.5 / 240),
    "root OFFSET": lambda s: s.bvh.offsets.__setitem__((0, 1), 1.0),
    "frame time * rate - 1": lambda s: setattr(s.bvh, "frame_time", 1.01 / 240),
    "Euler triples not the nearest": lambda s: s.add("Spine", "Yrotation", 360, s.fly, s.fly + 1),
    "ik_failures": lambda s: s.told("ik_failures", 1),
    "largest ik_error": lambda s: s.column("left_ik_error_m", 0.001, s.fly),
    "FK heel/toe/pelvis - columns": lambda s: s.column("left_heel_x_m", 0.0002, s.fly),
    "steps_left - landings": lambda s: s.told("steps_left", 1),
    "leg_length_m - mean of both": lambda s: s.told("leg_length_m", factor=1.02),
    "planted columns against Table I": lambda s: s.col["left_heel_planted"].__setitem__(s.fly, True),
    "stages out of order": lambda s: s.col["swing"].__setitem__(slice(s.land + 5, s.land + 7), "right"),
}
CONTACT_FAULTS = {
    "planted heel moves": lambda s: s.slide(s.land, s.rolled),
    "planted toe moves": lambda s: s.slide(s.lift, s.strike),
    "planted heel off rest height": lambda s: _raise(s, 0.3),
    "heel below floor": lambda s: _raise(s, -0.3),
    "planted toe off rest height": lambda s: s.told("left_toe_rest_m", 0.003),
    "toe_rest_m against the idle pose": lambda s: s.told("left_toe_rest_m", 0.003),
    "toe below its rest height": lambda s: s.add("LeftFoot", "Xrotation", 90, s.lift + 130, s.lift + 150),
    "toe end below its rest height": lambda s: s.add("LeftToeBase", "Xrotation", 15, s.land + 5, s.rolled),
    "step length error / allowed": lambda s: s.column("stride_left_m", factor=1.006),
    "root speed error": lambda s: s.column("speed_m_s", factor=1.012),
    "lateral drift a stride": _drift,
    "lowest toe at heel strike": lambda s: s.add("LeftFoot", "Xrotation", 20, s.land - 40, s.land + 1),
}
JOINT_FAULTS = {
    "smallest knee angle": _knee_backwards,
    "largest knee angle": lambda s: s.files.channel("LeftLeg", "Xrotation").__setitem__(s.fly, 155),
    "leg d2, steady": lambda s: s.add("LeftLeg", "Xrotation", 0.6, s.fly),
    "toe joint d2, steady": lambda s: s.add("LeftToeBase", "Xrotation", 0.6, s.fly),
    "leg d2, changing": lambda s: s.add("LeftLeg", "Xrotation", 1.1, 100),
    "hips and above d2 over the capture's": lambda s: s.add("Spine", "Yrotation", 0.5, -700),
    "strides 10 and last differ": lambda s: s.add("Spine", "Xrotation", 0.2, -700),
}


def expect(what, condition, failures, detail=""):
    print(f"{'ok  ' if condition else 'FAIL'} {what} {detail}".rstrip())
    if not condition:
        failures.append(what)


def run_faults(failures):
    sound = Files()
    broken = [f"{c.name} {c.value:.4g}" for c in walk_check.check_walk(sound.load()) if c.ok is False]
    expect("the exact walk passes every check", not broken, failures, "; ".join(broken))
    for name, plant in {**FILE_FAULTS, **CONTACT_FAULTS, **JOINT_FAULTS}.items():
        files = copy.deepcopy(sound)
        plant(Spot(files))
        try:
            hit = [c for c in walk_check.check_walk(files.load()) if c.name == name]
            seen, detail = bool(hit) and hit[0].ok is False, f"{hit[0].value:.4g}" if hit else "no such check"
        except (ValueError, IndexError) as error:  # damaged beyond measuring counts as seen
            seen, detail = True, f"refused: {error}"
        expect(f"fault seen: {name}", seen, failures, detail)


def run_comparisons(failures):
    even, twin = Files().load(), Files(first=1).load()
    fails = lambda checks: [c.name for c in checks if c.ok is False]
    expect("a mirrored walk passes", not fails(walk_compare.mirror_checks(even, twin)), failures)
    expect("an unmirrored walk fails", "mirrored walk, all joints" in
           fails(walk_compare.mirror_checks(even, even)), failures)
    # Both peaks count from the floor, and the lift-off height is not the flight's.
    limp = Files(length=(0.16, 0.32), flight=(138, 180), height=(0.008, 0.1)).load()
    checks = walk_compare.limp_checks(even, limp)
    expect("a limp of the asked measure passes", not fails(checks), failures,
           "; ".join(f"{c.name} {c.value:.3f}" for c in checks))
    expect("no limp fails all but the right step", len(fails(walk_compare.limp_checks(even, even))) == 3, failures)
    small, big = Files(bump=0.12).load(), Files(bump=0.6).load()
    figures = [walk_compare.weight_figures(even, other, 0)["rms"] for other in (small, big)]
    expect("weights: RMS grows with the change", 0 < figures[0] < figures[1], failures, str(np.round(figures, 2)))
    expect("weights: no change fails", bool(fails(walk_compare.weight_checks(even, even, 1.5))), failures)
    moved = Files(length=(0.33, 0.31)).load()
    expect("weights: moved landings fail", "weights, left: heel at landing" in
           fails(walk_compare.weight_checks(even, moved, 0.0)), failures)


class Ring:
    """Landings of two feet on circles, for circle_checks alone."""

    def __init__(self, spread=0.0, drift=0.0):
        n = 40
        k = np.arange(n)
        heading = 0.3 * k
        self.col = {"heading_rad": heading, "speed_m_s": np.full(n, 1.2), "turn_rate_rad_s": np.full(n, 0.6)}
        self.steady, self.straight = np.full(n, True), np.full(n, False)
        self.landings, self.heel_fk = [k[1::2], k[2::2]], []
        for radius in (1.9, 2.1):
            r = radius * (1 + spread * (k % 3 - 1))
            self.heel_fk.append(np.stack([r * np.sin(heading) + drift * k, 0 * k, r * np.cos(heading)], -1))


def run_circles(failures):
    bad = lambda **fault: sorted({c.name.split(" ", 1)[1] for c in walk_bounds.circle_checks(Ring(**fault))
                                  if c.ok is False})
    expect("a circle passes", bad() == [], failures)
    expect("a spread of radii fails", "landings off their circle" in bad(spread=0.03), failures)
    expect("a drifting circle fails to close", "circle closes" in bad(drift=0.004), failures)


def run_mathematics(failures):
    random = np.random.default_rng(1)
    angles = random.uniform(-170, 170, (200, 3))
    m = bvh_fk.axis_matrices("Z", angles[:, 0]) @ bvh_fk.axis_matrices("X", angles[:, 1]) @ \
        bvh_fk.axis_matrices("Y", angles[:, 2])
    expect("quaternions give the matrices back",
           np.abs(bvh_fk.matrices_of(bvh_fk.quaternions(m)) - m).max() < 1e-12, failures)
    turn = bvh_fk.axis_matrices("Y", np.array([0.0, 1.0, 3.0, 6.0]))[:, None]
    expect("second differences of 0 1 3 6 degrees are 1",
           np.allclose(bvh_fk.second_differences(turn)[1:-1], 1.0), failures)
    x = np.linspace(0, 6, 61)
    y = walk_smooth._spline(np.sin(x)[:, None], np.arange(200, 400) * 0.1)
    expect("the spline follows a sine",
           np.abs(y[:, 0] - np.sin(0.1 * np.arange(200, 400) * 0.1)).max() < 1e-4, failures)


def main():
    failures = []
    run_mathematics(failures)
    run_faults(failures)
    run_comparisons(failures)
    run_circles(failures)
    print(f"{len(failures)} of the judge's own tests failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
