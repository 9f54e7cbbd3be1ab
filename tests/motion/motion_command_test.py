"""`gaitpad motion FILE`: exit status, the JSON's keys and types, overrides, refusals."""
import json
import re

import pytest

from support import program as programs

JOINTS = ["UpLeg", "Leg", "Foot", "ToeBase"]


def leg(side, x):
    rows = [(f"{side}UpLeg", f"{x} -2 0"), (f"{side}Leg", "0 -40 0"), (f"{side}Foot", "0 -40 0"), (f"{side}ToeBase", "0 -8 12")]
    text = ""
    for name, offset in rows:
        text += f"JOINT {name}\n{{\nOFFSET {offset}\nCHANNELS 1 Xrotation\n"
    return text + "End Site\n{\nOFFSET 0 0 6\n}\n" + "}\n" * 4


def walker(frames=2):
    text = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
    text += leg("Left", 10) + leg("Right", -10) + "}\nMOTION\n"
    text += f"Frames: {frames}\nFrame Time: 0.01\n"
    return text + "0 90 0 0 0 0 0 0 0 0 0\n" * 2


@pytest.fixture
def walk(tmp_path):
    (tmp_path / "walk.bvh").write_text(walker())
    return tmp_path / "walk.bvh"


@pytest.fixture(scope="module")
def told(run):
    return lambda *arguments: json.loads(run("motion", *arguments, "--json").stdout)


def test_says_what_a_motion_holds(run, told, walk):
    got = told(walk)
    assert set(got) == {"metres_per_unit", "frame_rate_hz", "frames", "joints", "legs", "flight", "flight_paper", "gait", "reason"}
    assert got["metres_per_unit"] == 0.01 and got["frames"] == 2 and abs(got["frame_rate_hz"] - 100) < 1e-9
    assert got["joints"] == ["Hips"] + [s + j for s in ("Left", "Right") for j in JOINTS]
    left = got["legs"]["left"]
    assert {k: left[k] for k in ("hip", "knee", "ankle", "toe")} == dict(
        hip="LeftUpLeg", knee="LeftLeg", ankle="LeftFoot", toe="LeftToeBase")
    assert abs(left["length_m"] - 0.8) < 1e-12
    assert got["flight"] == got["flight_paper"] == {"left": None, "right": None}
    assert got["gait"] is None and got["reason"].startswith("walk.bvh: has fewer than 6 frames")
    assert "gait          none, walk.bvh: has fewer than 6 frames" in run("motion", walk).stdout
    assert "LeftUpLeg - LeftLeg - LeftFoot - LeftToeBase" in run("motion", walk).stdout


def test_unit_and_legs_can_be_given(told, walk):
    assert abs(told(walk, "--metres-per-unit", "0.02")["legs"]["right"]["length_m"] - 1.6) < 1e-12
    swap = [word for side, other in (("left", "Right"), ("right", "Left"))
            for part, joint in (("hip", "UpLeg"), ("knee", "Leg"), ("ankle", "Foot"))
            for word in (f"--{side}-{part}", other + joint)]
    assert told(walk, *swap)["legs"]["left"]["toe"] == "RightToeBase"


def test_what_cannot_be_read_is_one_sentence(refuse, walk):
    refuse("motion", f"{walk}x")
    refuse("motion", walk, "--left-hip", "Nose")
    bad = walk.with_name("bad.bvh")
    bad.write_text(walker(frames=3))
    refuse("motion", bad, says="bad.bvh:")


@pytest.mark.parametrize("options", [[], ["walk.bvh", "--nonsense"], ["walk.bvh", "--metres-per-unit", "-1"]], ids=" ".join)
def test_wrong_usage_is_2(run, walk, options):
    run("motion", *options, status=2, cwd=walk.parent)


def test_the_built_in_walk_swings_its_feet_in_order(told):
    for foot in told("procedural")["flight"].values():
        assert foot["heel_off_frame"] < foot["lift_frame"] < foot["peak_frame"] < foot["land_frame"], foot


def test_the_feet_swing_in_the_stride_that_is_walked(run):
    """The walked one of four key-framed strides; frames beyond the file belong to the next round of its loop."""
    text = run("motion", "keyframe_walk").stdout
    frames, first = (float(word) for word in re.search(r"gait +([\d.]+) frames from frame ([\d.]+)", text).groups())
    lifts = [int(word) for word in re.findall(r"flight +heel off .*?, lift (\d+)", text)]
    assert len(lifts) == 2 and all(first <= lift < first + frames for lift in lifts), text


def test_the_stride_that_is_walked_is_told(run, told):
    gait = told("procedural")["gait"]
    assert list(gait) == ["first_frame", "frames", "stride_s", "step_left_m", "step_right_m", "speed_m_s", "turn_rad", "own_stick"]
    assert gait["first_frame"] == 0 and gait["turn_rad"] == 0
    assert gait["own_stick"] == gait["speed_m_s"] / 1.5, "the built-in motion has the adult's pace"
    assert abs(gait["frames"] - gait["stride_s"] * 120) < 1e-9
    assert abs(gait["step_left_m"] + gait["step_right_m"] - gait["speed_m_s"] * gait["stride_s"]) < 1e-9
    keyframed = told("keyframe_walk")
    assert 0 <= keyframed["gait"]["first_frame"] < keyframed["frames"]
    assert "gait          134.0 frames from frame 0.0 on: 1.12 s, steps 0.70 m left and 0.70 m right" in run("motion", "procedural").stdout


ASF = """:units
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
:bonedata
%s:hierarchy
  begin
    root lfemur rfemur
    lfemur ltibia
    ltibia lfoot
    rfemur rtibia
    rtibia rfoot
  end
"""
BONE = "begin\nname %s%s\ndirection %s\nlength 7\naxis 0 0 0 XYZ\ndof rx\nend\n"


def test_an_amc_file_finds_its_asf_or_is_told_of_it(refuse, told, tmp_path):
    bones = "".join(BONE % (side, name, way) for side, x in (("l", "1"), ("r", "-1"))
                    for name, way in (("femur", x + " -9 0"), ("tibia", "0 -1 0"), ("foot", "0 0 1")))
    amc, asf, notes = tmp_path / "walk_01.amc", tmp_path / "sub/body.asf", tmp_path / "walk_01.amc.toml"
    asf.parent.mkdir()
    amc.write_text("".join(f"{k}\nroot 0 17 0 0 0 0\nlfemur {k}\n" for k in (5, 6, 7)))
    asf.write_text(ASF % bones)
    notes.write_text('file = "walk_01.amc"\nframe_rate_hz = 60\nskeleton = "sub/body.asf"\n')
    refuse("motion", amc, says="neither walk_01.asf nor walk.asf nor")
    got = told(amc, "--skeleton", asf)
    assert got["frames"] == 3 and abs(got["frame_rate_hz"] - 120) < 1e-9
    assert abs(got["metres_per_unit"] - 0.0254 / 0.45) < 1e-12
    got = told(notes)
    assert abs(got["frame_rate_hz"] - 60) < 1e-9 and got["legs"]["left"]["ankle"] == "lfoot"


def test_a_key_framed_walk_goes_by_its_name_and_an_unknown_name_lists_the_known_ones(refuse, told):
    assert all(told("keyframe_walk")["flight"].values())
    refuse("motion", "moonwalk", says=('no "moonwalk" in config/motions (known: ', "keyframe_walk"))


def test_feet_of_a_walk_on_the_spot_do_not_fly(run, told):
    clip = programs.ROOT.parent / "shared/data/mocap/makehuman_walk1.bvh"
    if not clip.exists():
        pytest.skip("the shared motions are not here")
    got = told(clip)
    assert got["flight"] == got["flight_paper"] == {"left": None, "right": None}
    assert "walks on the spot" in got["reason"] and got["gait"] is None
