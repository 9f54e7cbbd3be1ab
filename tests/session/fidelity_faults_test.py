"""Judges session/fidelity.py: what is planted in an exact walk, or in a small clip, is what it finds. Needs neither the
program nor data."""
import numpy as np
import pytest

import fidelity
from support import sources
from support.exact_walk import Files, faults_mark

pytestmark = faults_mark("support/judge", "support/sources", "session/fidelity", "session/fidelity_faults_test")
LEFT_KNEE, RIGHT_KNEE = ("LeftLeg", "Xrotation"), ("RightLeg", "Xrotation")


def stride_of(change=lambda files: None):
    files = Files()
    change(files)
    return fidelity.stride_of_walk(files.load())[0]


@pytest.fixture(scope="module")
def exact():
    return stride_of()


def wave(files, height_deg, share, width):
    """One bump a stride at the phase `share`, counted from the right foot's landing."""
    landings = np.nonzero((files.col["stage"][:-1] == "flight") & (files.col["stage"][1:] == "roll") &
                          (files.col["swing"][1:] == "right"))[0] + 1
    phase = (np.arange(len(files.col["tick"])) - landings[0]) / np.diff(landings).mean()
    return height_deg * np.exp(-0.5 * (((phase - share + 0.5) % 1.0 - 0.5) / width) ** 2)


def add(files, channel, degrees):
    files.channel(*channel)[:] += degrees


def test_a_walk_is_its_own_source(exact):
    found = fidelity.compare(exact, exact)
    assert max(found["greatest_deg"]) < 1e-9 and found["shift"] == 0


def test_the_phase_shift_is_found(exact):
    later = fidelity.Stride(exact.phase + 0.3, exact.seconds, exact.position, exact.rotation, exact.pelvis, exact.legs,
                            exact.heel_m)
    found = fidelity.compare(exact, later)
    assert found["shift"] == pytest.approx(0.3, abs=1e-9) and max(found["greatest_deg"]) < 1e-6


@pytest.mark.parametrize("side", ["Left", "Right"])
@pytest.mark.parametrize("joint, bone", enumerate(["UpLeg", "Leg", "Foot"]))
def test_five_degrees_are_five_degrees_in_that_joint_alone(exact, joint, bone, side):
    found = fidelity.compare(exact, stride_of(lambda files: add(files, (side + bone, "Xrotation"), 5)))
    assert found["rms_deg"][joint] == pytest.approx(5, abs=0.4)  # minus the part that the phase shift takes
    assert all(v < 0.8 for j, v in enumerate(found["rms_deg"]) if j != joint), found["rms_deg"]


def test_five_degrees_in_both_knees_are_five_degrees(exact):
    found = fidelity.compare(exact, stride_of(lambda f: (add(f, LEFT_KNEE, 5), add(f, RIGHT_KNEE, 5))))
    assert found["rms_deg"][1] == pytest.approx(5, abs=0.1) and found["greatest_deg"][1] == pytest.approx(5, abs=0.6)


@pytest.mark.parametrize("height_deg, more", [(4, 1), (0.8, 0)])
def test_a_bump_is_a_maximum_and_a_ripple_is_none(height_deg, more):
    phase = np.arange(400) / 400
    knee = 20 - 20 * np.cos(2 * np.pi * phase)
    bumps = knee + height_deg * np.exp(-0.5 * ((phase - 0.02) / 0.005) ** 2)
    assert fidelity.maxima(knee) == 1
    assert fidelity.maxima(bumps) == 1 + more
    assert fidelity.maxima(np.roll(bumps, 123)) == 1 + more


def test_a_bump_in_the_exported_knee_counts(exact):
    found = fidelity.compare(exact, stride_of(lambda f: add(f, RIGHT_KNEE, wave(f, 6, 0.3, 0.01))))
    (left, left_walk), (right, right_walk) = found["knee_maxima"]
    assert left_walk == left and right_walk == right + 1


def test_the_least_knee_is_told(exact):
    found = fidelity.compare(exact, stride_of(lambda f: add(f, LEFT_KNEE, 4)))
    data, ours = found["least_knee_deg"][0]
    assert ours - data == pytest.approx(4, abs=1e-6)


@pytest.mark.parametrize("rate_hz", [24, 60, 120, 240])
def test_free_fall_is_free_fall_at_any_rate(rate_hz):
    t = np.arange(rate_hz) / rate_hz
    half_s = max(1 / 30, 2 / rate_hz)
    low, high = fidelity.vertical_acceleration(1 - 4.905 * t * t, rate_hz, half_s, 0, len(t) - 1)
    assert low == pytest.approx(-9.81) and high == pytest.approx(-9.81)


def swinging(swing, fastest, rate_hz=120, up=1):
    """forward_speed() of a stride of 1 s, a third of one more at either end, whose speed swings by `swing` of its mean."""
    phase = np.arange(-40, 161) / 120
    place = np.zeros((len(phase), 3))
    place[:, 2] = 1.3 * (phase + swing / (4 * np.pi) * np.sin(4 * np.pi * (phase - fastest)))
    return fidelity.forward_speed(place, np.eye(3)[up], phase, rate_hz, 1 / 30, 40, 160)


def test_hips_that_keep_their_speed_are_not_off():
    phase, speed = swinging(0.2, 0.05)
    assert phase[0] == 0 and phase[-1] == 1 and np.ptp(speed) == pytest.approx(0.4, abs=0.02)
    assert max(fidelity.speed_off((phase, speed), (phase, speed), 0.0)) < 1e-9
    rms, late = fidelity.speed_off((phase, speed), swinging(0.2, 0.15), 0.1)
    assert rms < 0.5 and late <= 1  # a shift of all phases is none


def test_hips_that_swing_less_or_later_are_off():
    rms, late = fidelity.speed_off(swinging(0.2, 0.05), swinging(0.1, 0.05), 0.0)
    assert rms == pytest.approx(100 * 0.1 / np.sqrt(2), abs=0.5) and late <= 1
    rms, late = fidelity.speed_off(swinging(0.2, 0.05), swinging(0.2, 0.15), 0.0)
    assert late == pytest.approx(20, abs=1) and rms > 10


def test_a_sliding_source_is_named(exact):
    sliding = exact.position.copy()
    sliding[:, :, 0] += np.linspace(0, 0.6, len(sliding))[:, None]
    track = fidelity.Stride(exact.phase, exact.seconds, sliding, exact.rotation, exact.pelvis, exact.legs, exact.heel_m)
    assert fidelity.foot_slide_mm(exact) < 10 and fidelity.foot_slide_mm(track) > fidelity.FAR_SLIDE_MM


def test_a_source_that_stands_along_z_is_measured_alike(exact):
    lie = sources.bvhs.axis_matrices("X", np.array([90.0]))[0]
    turned = fidelity.Stride(exact.phase, exact.seconds, exact.position @ lie.T, lie @ exact.rotation, exact.pelvis,
                             exact.legs, exact.heel_m)
    assert turned.height() == pytest.approx(exact.height())
    assert max(fidelity.compare(turned, exact)["greatest_deg"]) < 1e-9


def test_a_stride_between_frames_is_cut_out():
    class Clip:
        rate_hz, parents = 100.0, [-1, 0, 0, 0, 0, 0, 0, 0, 0]
        position, rotation = np.zeros((60, 9, 3)), np.tile(np.eye(3), (60, 9, 1, 1))
    Clip.position[:, 1:5, 0], Clip.position[:, [1, 5], 1] = 0.2, 1.0
    wide, a, b = fidelity.stride_of_track(Clip, [[1, 2, 3, 4], [5, 6, 7, 8]], [np.zeros(3)] * 2, 10.5, 40.25, margin=4)
    inside = fidelity.trimmed(wide, a, b)
    assert len(wide.phase) == 48 and len(inside.phase) == 40 and inside.seconds == pytest.approx(0.4025)
    assert inside.phase[0] == pytest.approx(0.5 / 40.25) and inside.phase[-1] < 1
    wide, a, b = fidelity.stride_of_track(Clip, [[1, 2, 3, 4], [5, 6, 7, 8]], [np.zeros(3)] * 2, 30, 40, margin=4)
    assert (a, b) == (4, 33) and wide.phase[b] == 29 / 40


def row_of(walk, source, **figures):
    return {**fidelity.compare(source, fidelity.stride_of_walk(walk)[0]), "slide_mm": 0.0, "d2_deg": 0.1, "d2_joint": "knee",
            "fall_m_s2": [(-4, 4), (-4, 4)], "speed_off": (1.0, 2.0), "stride_s": 2.0, "speed_m_s": 0.32, **figures}


GAIT = {"stride_s": 2.0, "step_left_m": 0.32, "step_right_m": 0.32, "speed_m_s": 0.32}
BOUNDS = [({}, {}, []), ({"slide_mm": 41.0, "rms_deg": [3.9, 3.9, 3.9]}, {}, []),
          ({"rms_deg": [3.1, 2.9, 3.6]}, {}, ["hip RMS", "ankle RMS"]),
          ({"knee_maxima": [(2, 2), (2, 3)]}, {}, ["knee maxima beyond the data's"]),
          ({"least_knee_deg": [(-7.0, 3.9), (5.0, 1.9)]}, {}, ["least knee off the data's"]),
          ({"fall_m_s2": [(-7, 9), (-13, 13.4)]}, {}, []),
          ({"fall_m_s2": [(-7, 8), (-13, 7)]}, {}, ["vertical acceleration of the hips"]),
          ({"speed_off": (40.0, 40.0)}, {}, []),
          ({"d2_deg": 0.71}, {}, ["second difference"]),
          ({}, {"step_left_m": 0.33}, ["left step off the clip's"]),
          ({}, {"stride_s": 2.1}, ["stride's time off the clip's", "told stride's time off the clip's"]),
          ({"speed_m_s": 0.3}, {}, ["told speed off the clip's"])]


@pytest.mark.parametrize("figures, gait, names", BOUNDS)
def test_each_bound_breaks_alone(exact, figures, gait, names):
    walk = Files().load()
    stride, _ = fidelity.stride_of_walk(walk)
    checks = fidelity.judge_row(row_of(walk, exact, **figures), walk, stride, {**GAIT, **gait}, False)
    assert [c.name for c in checks if c.ok is False] == names


def test_a_jerk_at_a_change_is_seen():
    assert all(c.ok is not False for c in fidelity.change_checks(Files().load()))
    files = Files()
    files.channel(*RIGHT_KNEE)[200] += 1.1  # one tick before the walk is steady
    broken = [c.name for c in fidelity.change_checks(files.load()) if c.ok is False]
    assert "at changes: second difference" in broken


ASF = """:units
  length 1.0
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
:bonedata
  begin
    name thigh
    direction 0 -1 0
    length 2
    axis 0 0 90 XYZ
    dof rx rz
  end
  begin
    name shank   # has no dof
    direction 0 -1 0
    length 3
    axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root thigh
    thigh shank
  end
"""


def test_an_acclaim_bone_turns_in_its_own_axes(tmp_path):
    (tmp_path / "legs.asf").write_text(ASF)
    (tmp_path / "legs_01.amc").write_text(":FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 10 0 0 0 0\nthigh 90 0\n"
                                          "2\nroot 0 10 0 0 90 0\nthigh 0 90\n")
    track = sources.read_source(tmp_path / "legs_01.amc", 0.5, 120)
    assert track.names == ["root", "thigh", "shank", "shank_End"] and track.tail(1) == 3
    # The bone's x axis is the world's y axis, so a hanging thigh turns about its own axis.
    assert track.position[0] * 2 == pytest.approx(np.array([[1, 10, 0], [1, 10, 0], [1, 8, 0], [1, 5, 0]]))
    # About z it swings towards +x, and the root carries +x to -z.
    assert track.position[1, 2:] * 2 == pytest.approx(np.array([[0, 10, -2], [0, 10, -5]]))


def test_the_built_in_walk_is_rebuilt_from_its_curves():
    walk = Files().load()
    moves, local = sources.built_in(walk, np.arange(256) / 256)
    knees = sources.bvhs.rotation_vectors(local[:, walk.knee])[..., 0]
    assert knees.min() == pytest.approx(1.68, abs=0.01) and knees.max() == pytest.approx(63.54, abs=0.01)
    assert local[:128, walk.knee[0]] == pytest.approx(local[128:, walk.knee[1]])
    assert 20 < 1000 * np.ptp(moves[:, walk.pelvis, 1]) < 60
