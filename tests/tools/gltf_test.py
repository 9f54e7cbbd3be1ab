"""`replay --gltf`: pose.glb holds the walk of pose.bvh, read by code of its own; Khronos' validator accepts it, and
Blender finds the joints of both files at the same places."""
import csv
import json
import os
import shutil
import subprocess

import numpy as np
import pytest

from support import bvh as bvhs
from support.glb import Glb, world
from support.program import DATA, ROOT
from support.traces import write_trace

CLIP = DATA / "mocap/cmu_006_01_iclone.bvh"  # a body of a hundred joints
MODULES = ROOT / "build/gltf/node_modules"
NEAR_M = 1e-4


@pytest.fixture(scope="module")
def trace(tmp_path_factory):
    return write_trace(tmp_path_factory.mktemp("trace") / "walk.hid", [(0.5, 0, 0.8), (3, 0.5, 0.7), (7, 0, 0)], (), 9)


@pytest.fixture(scope="module")
def exported(run, trace, tmp_path_factory):
    """The folder of a replay with these options; each is made once."""
    folders = {}

    def export(*options):
        if options not in folders:
            folders[options] = tmp_path_factory.mktemp("out")
            run("replay", trace, "--out", folders[options], "--gltf", *options)
        return folders[options]
    return export


CHARACTERS = ("--fps", "30", "--character", "child", "--character", "tall")


@pytest.mark.parametrize("options, suffix", [((), ""), (CHARACTERS, ""), (CHARACTERS, "-2")], ids=["plain", "child", "tall"])
def test_all_joints_of_the_bvh_are_at_the_same_places_at_every_frame(exported, options, suffix):
    out = exported(*options)
    file, bvh = Glb(out / f"pose{suffix}.glb"), bvhs.read_bvh(out / f"pose{suffix}.bvh")
    scale = json.loads((out / f"summary{suffix}.json").read_text())["metres_per_unit"]
    expected, _ = bvhs.forward_kinematics(bvh.parents, bvhs.translations(bvh) * scale, bvhs.local_rotations(bvh))
    times, translations, rotations = file.tracks()
    assert np.allclose(times, np.arange(len(times)) * bvh.frame_time, atol=1e-5)
    assert np.all(np.diff(times) > 0) and len(times) == len(expected)
    position, _ = world(file, len(times), translations, rotations)
    shared = [n for n in bvh.names if n in file.names]
    assert len(shared) >= len([n for n in bvh.names if not n.endswith("_End")])
    gap_m = max(np.abs(position[:, file.names.index(n)] - expected[:, bvh.index(n)]).max() for n in shared)
    assert gap_m < NEAR_M


def test_quaternions_are_of_unit_length_and_go_the_short_way_round(exported):
    for node, q in Glb(exported() / "pose.glb").tracks()[2].items():
        assert np.abs(np.linalg.norm(q.astype(float), axis=1) - 1).max() < 1e-6, node
        assert np.sum(q[1:] * q[:-1], axis=1).min() > 0, f"node {node} goes the long way round"


def test_the_skin_fits_its_joints_in_the_rest_pose(exported):
    """Every joint's matrix times its inverse bind matrix is the identity; each vertex lies near the joint that
    carries it, on the floor or above."""
    file = Glb(exported() / "pose.glb")
    skin = file.json["skins"][0]
    position, rotation = world(file, 1, {}, {})
    inverse = file.values(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
    for k, node in enumerate(skin["joints"]):
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = rotation[0, node], position[0, node]
        assert np.abs(matrix @ inverse[k] - np.eye(4)).max() < 1e-5, file.names[node]
    attributes = file.json["meshes"][0]["primitives"][0]["attributes"]
    place, joint = file.values(attributes["POSITION"]), file.values(attributes["JOINTS_0"])[:, 0]
    assert np.linalg.norm(place - position[0, np.array(skin["joints"])[joint]], axis=1).max() < 0.6
    assert -0.01 < place[:, 1].min() < 0.05 and 1.4 < place[:, 1].max() < 2.2, "metres, y up, on the floor"
    ahead = position[0, file.names.index("LeftToeBase")] - position[0, file.names.index("LeftFoot")]
    assert ahead[2] > 0.1, "faces +z"
    assert position[0, file.names.index("LeftFoot"), 0] > 0 > position[0, file.names.index("RightFoot"), 0]
    normal = file.values(attributes["NORMAL"])
    corners = place.reshape(-1, 3, 3)
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.sum(faces * normal[::3], axis=1) > 0).all(), "triangles face outward as their normals say"


def test_the_file_is_written_only_where_it_is_asked_for(run, trace, exported, tmp_path):
    assert sorted(os.listdir(exported())) == ["frames.csv", "pose.bvh", "pose.glb", "summary.json"]
    run("replay", trace, "--gltf", status=2)  # the option needs --out
    run("replay", trace, "--out", tmp_path / "plain")
    assert sorted(os.listdir(tmp_path / "plain")) == ["frames.csv", "pose.bvh", "summary.json"]


def captured(*options):
    return pytest.param(("--motion", CLIP, *options), id="captured",
                        marks=pytest.mark.skipif(not CLIP.exists(), reason=f"there is no {CLIP}"))


def validated(path):
    done = subprocess.run(["node", ROOT / "tools/gltf/validate.js", path], env={**os.environ, "NODE_PATH": str(MODULES)},
                          capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


needs_validator = pytest.mark.skipif(not shutil.which("node") or not (MODULES / "gltf-validator").is_dir(),
                                     reason="no node, or the validator is not there (bash tools/gltf/install.sh)")


@needs_validator
@pytest.mark.parametrize("options", [
    pytest.param((), id="plain"),
    pytest.param(("--style", "limp_left", "--fps", "60", "--character", "child", "--character", "tall"), id="limp"),
    pytest.param(("--motion", "keyframe_walk"), id="keyframe"), captured("--fps", "30")])
def test_khronos_validator_finds_no_error_and_no_warning(exported, options):
    paths = sorted(exported(*options).glob("*.glb"))
    assert len(paths) == max(1, options.count("--character"))
    for path in paths:
        report = validated(path)
        assert report["issues"]["numErrors"] == 0 and report["issues"]["numWarnings"] == 0, report["issues"]["messages"]
        assert report["info"]["animationCount"] == 1 and report["info"]["hasSkins"], report["info"]


@needs_validator
def test_khronos_validator_sees_a_quaternion_that_is_none(exported, tmp_path):
    data = bytearray((exported() / "pose.glb").read_bytes())
    data[-16:] = b"\0\0\x80\x40" * 4
    (tmp_path / "broken.glb").write_bytes(data)
    assert validated(tmp_path / "broken.glb")["issues"]["numErrors"] > 0, "the validator is asleep"


def root_of(path, time_s):
    """The root's place in Blender's axes: x the same, y back, z up."""
    with open(path, newline="") as file:
        row = next(row for row in csv.DictReader(file) if abs(float(row["time_s"]) - time_s) < 1e-6)
    x, y, z = (float(row[f"root_{axis}_m"]) for axis in "xyz")
    return np.array([x, -z, y])


@pytest.mark.skipif(not shutil.which("blender"), reason="there is no blender (package blender)")
def test_blender_sees_the_same_joints_at_the_same_places(exported):
    outs = [exported("--style", "carry", "--character", "child", "--motion", "keyframe_walk")]
    outs += [exported("--motion", CLIP)] if CLIP.exists() else []
    files = [out / f"pose.{ending}" for out in outs for ending in ("glb", "bvh")]
    done = subprocess.run(["blender", "-b", "--factory-startup", "-P", ROOT / "tests/tools/blender_joints.py", "--", *files],
                          capture_output=True, text=True, timeout=300, check=False)
    read = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    assert len(read) == len(files), done.stdout + done.stderr
    for i, out in enumerate(outs):
        check_joints(out, read[2 * i:2 * i + 2])


def check_joints(out, read):
    """Blender's joints of the .glb and the .bvh in one unit, and the pelvis compared with frames.csv."""
    unit_m = json.loads((out / "summary.json").read_text())["metres_per_unit"]
    roots = []
    for time_s, of_glb, of_bvh in zip(read[0]["times_s"], read[0]["joints"], read[1]["joints"]):
        shared = of_glb.keys() & of_bvh.keys()
        assert len(shared) >= 18, shared
        for name in shared:
            assert np.linalg.norm(np.array(of_glb[name]) - unit_m * np.array(of_bvh[name])) < NEAR_M, (name, time_s)
        roots.append(np.array(next(iter(of_glb.values()))))
        assert np.linalg.norm(roots[-1] - root_of(out / "frames.csv", time_s)) < NEAR_M, time_s
    assert max(np.linalg.norm(root - roots[0]) for root in roots) > 1.0, "nothing moves"
