"""Blender opens what `replay --gltf` writes: in pose.glb and pose.bvh the same joints at the same places at the same
times, the root where frames.csv has it. Skipped where there is no Blender (package blender).

Usage: blender_test.py GAITPAD"""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.abspath(os.path.join(HERE, "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "session"))
import make_trace

CLIP = os.path.join(ROOT, "..", "shared", "data", "mocap", "cmu_006_01_iclone.bvh")
NEAR_M = 1e-4


def scaled(joints, factor):
    return {name: [factor * x for x in place] for name, place in joints.items()}


def distance(a, b):
    return sum((p - q) ** 2 for p, q in zip(a, b)) ** 0.5


def root_of(path, time_s):
    """In Blender's axes: x the same, y back, z up."""
    with open(path, newline="") as file:
        row = next(row for row in csv.DictReader(file) if abs(float(row["time_s"]) - time_s) < 1e-6)
    x, y, z = (float(row[f"root_{axis}_m"]) for axis in "xyz")
    return [x, -z, y]


def main():
    program = sys.argv[1]
    if not shutil.which("blender"):
        print("skipped: there is no blender (package blender)")
        return 77
    runs = [[], ["--style", "carry", "--character", "child", "--motion", "keyframe_walk"]]
    runs += [["--motion", CLIP]] if os.path.exists(CLIP) else []
    with tempfile.TemporaryDirectory() as folder:
        trace = os.path.join(folder, "walk.hid")
        make_trace.write_trace(trace, [(0.5, 0, 0.8), (3, 0.4, 0.8)], (), 6)
        outs = [os.path.join(folder, str(i)) for i in range(len(runs))]
        for out, options in zip(outs, runs):
            done = subprocess.run([program, "replay", trace, "--out", out, "--gltf", *options], capture_output=True,
                                  text=True, timeout=300)
            assert done.returncode == 0, done.stderr
        files = [os.path.join(out, name) for out in outs for name in ("pose.glb", "pose.bvh")]
        done = subprocess.run(["blender", "-b", "--factory-startup", "-P", os.path.join(HERE, "blender_joints.py"),
                               "--", *files], capture_output=True, text=True, timeout=300)
        read = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
        assert len(read) == len(files), done.stdout + done.stderr
        for out, glb, bvh in zip(outs, read[0::2], read[1::2]):
            worst_m, walked_m = 0.0, 0.0
            with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
                unit_m = json.load(file)["metres_per_unit"]
            for time_s, of_glb, of_bvh in zip(glb["times_s"], glb["joints"], bvh["joints"]):
                of_bvh = scaled(of_bvh, unit_m)
                shared = of_glb.keys() & of_bvh.keys()
                assert len(shared) >= 18, shared
                worst_m = max([worst_m] + [distance(of_glb[name], of_bvh[name]) for name in shared])
                root_m = of_glb[next(iter(of_glb))]
                worst_m = max(worst_m, distance(root_m, root_of(os.path.join(out, "frames.csv"), time_s)))
                walked_m = max(walked_m, distance(root_m, glb["joints"][0][next(iter(of_glb))]))
            print(f"{os.path.basename(out)}: {len(shared)} joints, {1000 * worst_m:.4f} mm apart, {walked_m:.2f} m walked")
            assert worst_m < NEAR_M, worst_m
            assert walked_m > 1.0, "nothing moves"
    return 0


sys.exit(main())
