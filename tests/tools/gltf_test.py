"""`replay --gltf`: pose.glb holds the walk of pose.bvh, read by code of its own. Usage: gltf_test.py GAITPAD"""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

import glb

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "session"))
import bvh_fk
import make_trace

PROGRAM = sys.argv[1]


def run(*arguments):
    return subprocess.run([PROGRAM, "replay", *arguments], capture_output=True, text=True, timeout=300)


def replayed(folder, *arguments):
    done = run(os.path.join(folder, "walk.hid"), "--out", os.path.join(folder, "out"), "--gltf", *arguments)
    assert done.returncode == 0, done.stderr
    return os.path.join(folder, "out")


def check_same_walk(out, suffix=""):
    """Positions within 0.1 mm at every frame, all joints of the BVH found by name."""
    file = glb.Glb(os.path.join(out, f"pose{suffix}.glb"))
    bvh = bvh_fk.read_bvh(os.path.join(out, f"pose{suffix}.bvh"))
    scale = json.load(open(os.path.join(out, f"summary{suffix}.json")))["metres_per_unit"]
    expected, _ = bvh_fk.forward_kinematics(bvh.parents, bvh_fk.translations(bvh) * scale, bvh_fk.local_rotations(bvh))
    times, translations, rotations = file.tracks()
    assert np.allclose(times, np.arange(len(times)) * bvh.frame_time, atol=1e-5)
    assert np.all(np.diff(times) > 0) and len(times) == len(expected)
    position, _ = glb.world(file, len(times), translations, rotations)
    shared = [n for n in bvh.names if n in file.names]
    assert len(shared) >= len([n for n in bvh.names if not n.endswith("_End")])
    gap = max(np.abs(position[:, file.names.index(n)] - expected[:, bvh.index(n)]).max() for n in shared)
    print(f"{os.path.basename(file.names[-1])}{suffix}: {len(shared)} joints, {len(times)} frames, {1e3 * gap:.4f} mm apart")
    assert gap < 1e-4, gap
    return file, rotations


def check_quaternions(rotations):
    for node, q in rotations.items():
        assert np.abs(np.linalg.norm(q.astype(float), axis=1) - 1).max() < 1e-6, node
        assert np.sum(q[1:] * q[:-1], axis=1).min() > 0, f"node {node} goes the long way round"


def check_skin(file):
    """In the rest pose every joint's matrix times its inverse bind matrix is the identity; each vertex lies
    near the joint that carries it, on the floor or above."""
    skin = file.json["skins"][0]
    position, rotation = glb.world(file, 1, {}, {})
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


def check_options(folder):
    trace = os.path.join(folder, "walk.hid")
    assert run(trace, "--gltf").returncode == 2, "--gltf needs --out"
    out = os.path.join(folder, "plain")
    assert run(trace, "--out", out).returncode == 0
    assert sorted(os.listdir(out)) == ["frames.csv", "pose.bvh", "summary.json"]


def main():
    with tempfile.TemporaryDirectory() as folder:
        make_trace.write_trace(os.path.join(folder, "walk.hid"), [(0.5, 0, 0.8), (3, 0.5, 0.7), (7, 0, 0)], (), 9)
        out = replayed(folder)
        file, rotations = check_same_walk(out)
        check_quaternions(rotations)
        check_skin(file)
        assert sorted(os.listdir(out)) == ["frames.csv", "pose.bvh", "pose.glb", "summary.json"], os.listdir(out)
        out = replayed(folder, "--fps", "30", "--character", "child", "--character", "tall")
        check_same_walk(out)
        check_same_walk(out, "-2")
        check_options(folder)
    print("gltf: ok")


main()
