#!/usr/bin/env python3
"""Judges the judge: an own small walk, exact by construction, passes walk_check; each planted fault
in its files makes the check that is meant for it fail. Needs neither the program nor data."""
import copy
import sys

import numpy as np

import bvh_fk
import walk_bounds
import walk_check
import walk_compare
import walk_smooth
from exact_walk import Files


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
