"""Tests the checks themselves: a small walk that is exact by construction passes all of them, and each fault planted
in its files fails the check that is meant for it. Needs neither the program nor data."""
import copy

import numpy as np
import pytest

from support import bvh as bvhs
from support import judge
from support.exact_walk import Files, faults_mark

pytestmark = faults_mark("support/judge", "session/acceptance_faults_test")


class Spot:
    """Places of the planted faults: ticks of the 8th flight and roll of the left foot, and its channels."""

    def __init__(self, files):
        self.files, self.col, self.bvh, self.summary = files, files.col, files.bvh, files.summary
        self.lift, self.strike = self._stage("flight")
        self.land, self.rolled = self._stage("roll")
        self.fly = (self.lift + self.strike) // 2

    def _stage(self, stage):
        return judge.runs((self.col["stage"] == stage) & (self.col["swing"] == "left"))[8]

    def add(self, joint, channel, degrees, first=0, last=None):
        self.files.channel(joint, channel)[first:last] += degrees

    def column(self, name, add=0.0, tick=slice(None), factor=1.0):
        self.col[name][tick] = self.col[name][tick] * factor + add

    def slide(self, first, last):  # 0.3 mm to the side
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


# Each fault has the name of the check that has to find it.
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
    "leg d2, changing": lambda s: s.add("LeftLeg", "Xrotation", 1.3, 100),
    "hips and above d2 over the capture's": lambda s: s.add("Spine", "Yrotation", 0.5, -700),
    "strides 10 and last differ": lambda s: s.add("Spine", "Xrotation", 0.2, -700),
}


@pytest.fixture(scope="module")
def sound():
    return Files()


@pytest.fixture(scope="module")
def even(sound):
    return sound.load()


def failed(checks):
    return [c.name for c in checks if c.ok is False]


def test_the_exact_walk_passes_every_check(even):
    assert failed(judge.check_walk(even)) == []


@pytest.mark.parametrize("name", [*FILE_FAULTS, *CONTACT_FAULTS, *JOINT_FAULTS])
def test_a_planted_fault_is_seen_by_its_check(sound, name):
    files = copy.deepcopy(sound)
    {**FILE_FAULTS, **CONTACT_FAULTS, **JOINT_FAULTS}[name](Spot(files))
    try:
        checks = judge.check_walk(files.load())
    except (ValueError, IndexError):  # files that cannot be measured count as seen
        return
    assert [c.ok for c in checks if c.name == name][:1] == [False]


def test_a_mirrored_walk_passes_and_an_unmirrored_one_fails(even):
    assert failed(judge.mirror_checks(even, Files(first=1).load())) == []
    assert "mirrored walk, all joints" in failed(judge.mirror_checks(even, even))


def test_a_limp_of_the_asked_measure_passes(even):
    # Both peaks are measured from the floor: the height at lift-off does not belong to the flight.
    limp = Files(length=(0.16, 0.32), flight=(138, 180), height=(0.008, 0.1)).load()
    assert failed(judge.limp_checks(even, limp)) == []


def test_no_limp_fails_all_but_the_right_step(even):
    assert len(failed(judge.limp_checks(even, even))) == 3


def test_rms_of_weights_grows_with_the_change(even):
    small, big = (judge.weight_figures(even, Files(bump=bump).load(), 0)["rms"] for bump in (0.12, 0.6))
    assert 0 < small < big


def test_weights_without_a_change_or_with_moved_landings_fail(even):
    assert failed(judge.weight_checks(even, even, 1.5))
    moved = Files(length=(0.33, 0.31)).load()
    assert "weights, left: heel at landing" in failed(judge.weight_checks(even, moved, 0.0))


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


@pytest.mark.parametrize("fault, seen", [({}, None), ({"spread": 0.03}, "landings off their circle"),
                                         ({"drift": 0.004}, "circle closes")], ids=["sound", "spread", "drift"])
def test_landings_off_their_circle_are_seen(fault, seen):
    bad = {name.split(" ", 1)[1] for name in failed(judge.circle_checks(Ring(**fault)))}
    assert seen in bad if seen else not bad


def test_quaternions_give_the_matrices_back():
    angles = np.random.default_rng(1).uniform(-170, 170, (200, 3))
    m = bvhs.axis_matrices("Z", angles[:, 0]) @ bvhs.axis_matrices("X", angles[:, 1]) @ \
        bvhs.axis_matrices("Y", angles[:, 2])
    assert np.abs(bvhs.matrices_of(bvhs.quaternions(m)) - m).max() < 1e-12


def test_second_differences_of_0_1_3_6_degrees_are_1():
    turn = bvhs.axis_matrices("Y", np.array([0.0, 1.0, 3.0, 6.0]))[:, None]
    assert np.allclose(bvhs.second_differences(turn)[1:-1], 1.0)


def test_the_spline_follows_a_sine():
    x, places = np.linspace(0, 6, 61), np.arange(200, 400) * 0.1
    y = judge._spline(np.sin(x)[:, None], places)
    assert np.abs(y[:, 0] - np.sin(0.1 * places)).max() < 1e-4
