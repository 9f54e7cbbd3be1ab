"""Khronos' validator finds no error and no warning in what `replay --gltf` writes: the built-in walk, a limp, a
child, a body of a hundred joints where there is one. Skipped where tools/gltf/install.sh has not put it.

Usage: gltf_validator_test.py GAITPAD"""
import json
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "session"))
import make_trace

MODULES = os.path.join(ROOT, "build", "gltf", "node_modules")
CLIP = os.path.join(ROOT, "..", "shared", "data", "mocap", "cmu_006_01_iclone.bvh")


def validated(paths):
    done = subprocess.run(["node", os.path.join(ROOT, "tools", "gltf", "validate.js"), *paths],
                          env=dict(os.environ, NODE_PATH=MODULES), capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return [json.loads(line) for line in done.stdout.splitlines()]


def broken(path):
    """The same file with a quaternion that is none: the validator must see it."""
    data = bytearray(open(path, "rb").read())
    data[-16:] = b"\0\0\x80\x40" * 4
    other = path.replace(".glb", "_broken.glb")
    open(other, "wb").write(data)
    return other


def main():
    program = sys.argv[1]
    if not shutil.which("node") or not os.path.isdir(os.path.join(MODULES, "gltf-validator")):
        print("skipped: no node, or the validator is not there (bash tools/gltf/install.sh)")
        return 77
    runs = [[], ["--style", "limp_left", "--fps", "60", "--character", "child", "--character", "tall"],
            ["--motion", "keyframe_walk"]]
    runs += [["--motion", CLIP, "--fps", "30"]] if os.path.exists(CLIP) else []
    with tempfile.TemporaryDirectory() as folder:
        trace = os.path.join(folder, "walk.hid")
        make_trace.write_trace(trace, [(0.5, 0, 0.8), (3, 0.4, 0.8)], (), 6)
        paths = []
        for i, options in enumerate(runs):
            out = os.path.join(folder, str(i))
            done = subprocess.run([program, "replay", trace, "--out", out, "--gltf", *options], capture_output=True,
                                  text=True, timeout=300)
            assert done.returncode == 0, done.stderr
            paths += sorted(os.path.join(out, name) for name in os.listdir(out) if name.endswith(".glb"))
        assert len(paths) == len(runs) + 1, paths
        reports = validated(paths + [broken(paths[0])])
    for report in reports[:-1]:
        issues = report["issues"]
        print(os.path.relpath(report["path"], folder), {k: v for k, v in issues.items() if k.startswith("num")})
        assert issues["numErrors"] == 0 and issues["numWarnings"] == 0, issues["messages"]
        assert report["info"]["animationCount"] == 1 and report["info"]["hasSkins"], report["info"]
    assert reports[-1]["issues"]["numErrors"] > 0, "the validator is asleep"
    return 0


sys.exit(main())
