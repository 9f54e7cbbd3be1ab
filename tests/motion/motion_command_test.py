"""`gaitpad motion FILE`: exit status, the JSON's keys and types, overrides, refusals. Usage: motion_command_test.py GAITPAD"""
import json
import os
import subprocess
import sys
import tempfile

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


def run(program, *arguments):
    done = subprocess.run([program, "motion", *arguments], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout, done.stderr


def check_json(program, path):
    status, out, _ = run(program, path, "--json")
    assert status == 0, status
    got = json.loads(out)
    assert set(got) == {"metres_per_unit", "frame_rate_hz", "frames", "joints", "legs", "flight", "flight_paper"}, got.keys()
    assert got["metres_per_unit"] == 0.01 and got["frames"] == 2 and abs(got["frame_rate_hz"] - 100) < 1e-9
    assert got["joints"] == ["Hips"] + [s + j for s in ("Left", "Right") for j in JOINTS], got["joints"]
    left = got["legs"]["left"]
    assert {k: left[k] for k in ("hip", "knee", "ankle", "toe")} == dict(
        hip="LeftUpLeg", knee="LeftLeg", ankle="LeftFoot", toe="LeftToeBase"), left
    assert abs(left["length_m"] - 0.8) < 1e-12
    assert got["flight"] == {"left": None, "right": None} and got["flight_paper"] == {"left": None, "right": None}


def check_overrides(program, path):
    _, out, _ = run(program, path, "--json", "--metres-per-unit", "0.02")
    assert abs(json.loads(out)["legs"]["right"]["length_m"] - 1.6) < 1e-12
    swap = []
    for side, other in (("left", "Right"), ("right", "Left")):
        for part, joint in (("hip", "UpLeg"), ("knee", "Leg"), ("ankle", "Foot")):
            swap += [f"--{side}-{part}", other + joint]
    _, out, _ = run(program, path, "--json", *swap)
    assert json.loads(out)["legs"]["left"]["toe"] == "RightToeBase"


def check_refusals(program, folder, path):
    for arguments in ((path + "x",), (path, "--left-hip", "Nose")):
        status, out, err = run(program, *arguments)
        assert status == 1 and out == "" and err.count("\n") == 1, (status, out, err)
    bad = os.path.join(folder, "bad.bvh")
    with open(bad, "w") as file:
        file.write(walker(frames=3))
    status, out, err = run(program, bad)
    assert status == 1 and out == "" and "bad.bvh:" in err and err.count("\n") == 1, (status, out, err)
    for arguments in ((), (path, "--nonsense"), (path, "--metres-per-unit", "-1")):
        assert run(program, *arguments)[0] == 2, arguments


def check_swings(program):
    status, out, _ = run(program, "procedural", "--json")
    assert status == 0
    for foot in json.loads(out)["flight"].values():
        assert foot["heel_off_frame"] < foot["lift_frame"] < foot["peak_frame"] < foot["land_frame"], foot


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


def check_acclaim(program, folder):
    """An .amc file finds its .asf, or is told of it in a .toml file or an option."""
    bones = "".join(BONE % (side, name, way) for side, x in (("l", "1"), ("r", "-1"))
                    for name, way in (("femur", x + " -9 0"), ("tibia", "0 -1 0"), ("foot", "0 0 1")))
    amc, asf = os.path.join(folder, "walk_01.amc"), os.path.join(folder, "sub", "body.asf")
    os.mkdir(os.path.dirname(asf))
    frames = "".join(f"{k}\nroot 0 17 0 0 0 0\nlfemur {k}\n" for k in (5, 6, 7))
    for path, text in ((amc, frames), (asf, ASF % bones), (amc + ".toml", 'file = "walk_01.amc"\nframe_rate_hz = 60\n'
                                                                         'skeleton = "sub/body.asf"\n')):
        with open(path, "w") as file:
            file.write(text)
    status, _, err = run(program, amc)
    assert status == 1 and "neither walk_01.asf nor walk.asf nor" in err and err.count("\n") == 1, err
    got = json.loads(run(program, amc, "--json", "--skeleton", asf)[1])
    assert got["frames"] == 3 and abs(got["frame_rate_hz"] - 120) < 1e-9, got
    assert abs(got["metres_per_unit"] - 0.0254 / 0.45) < 1e-12, got
    got = json.loads(run(program, amc + ".toml", "--json")[1])
    assert abs(got["frame_rate_hz"] - 60) < 1e-9 and got["legs"]["left"]["ankle"] == "lfoot", got


def check_names(program):
    """A key-framed walk by its name in config/motions; an unknown name lists the known ones."""
    status, out, err = run(program, "keyframe_walk", "--json")
    assert status == 0, err
    assert all(json.loads(out)["flight"].values())
    status, _, err = run(program, "moonwalk")
    assert status == 1 and 'no "moonwalk" in config/motions (known: ' in err and "keyframe_walk" in err, err


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "walk.bvh")
        with open(path, "w") as file:
            file.write(walker())
        check_json(program, path)
        check_overrides(program, path)
        check_refusals(program, folder, path)
        check_swings(program)
        check_acclaim(program, folder)
        check_names(program)
        status, out, _ = run(program, path)
        assert status == 0 and "LeftUpLeg - LeftLeg - LeftFoot - LeftToeBase" in out
    print("motion command: ok")


main()
