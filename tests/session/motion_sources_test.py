"""Walks from every kind of source keep the walk's bounds: key frames, and where the shared data are, Acclaim files
and bodies of other names and joints. Usage: motion_sources_test.py GAITPAD"""
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import make_trace
import walk_check
from walk_data import Walk

DATA = os.path.join(HERE, "..", "..", "..", "shared", "data", "mocap")
SHARED = [("cmu_35_01.amc", None), ("endorphin_walking.amc", None), ("endorphin_walking.amc", "daz3d_170_joints.bvh"),
          ("cmu_m21_walk.bvh", "endorphin.asf"), ("freebvh_mixamo_names.bvh", "cmu_07.asf"),
          (None, "makehuman_walk1.bvh"), ("cmu_006_01_iclone.bvh", "geno_stance_6channels.bvh")]


def broken(program, folder, motion, skeleton=None):
    command = [program, "replay", os.path.join(folder, "walk.hid"), "--out", os.path.join(folder, "out")]
    command += ["--motion", motion] if motion else []
    if skeleton:
        character = os.path.join(folder, "body.toml")
        with open(character, "w", encoding="utf-8") as file:
            file.write(f'skeleton = "{os.path.abspath(skeleton)}"\n')
        command += ["--character", character]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    checks = walk_check.check_walk(Walk(os.path.join(folder, "out")))
    failed = [f"{c.name}: {c.value:.4g} {c.note}" for c in checks if c.ok is False]
    print(f"{os.path.basename(motion or 'procedural')} on {os.path.basename(skeleton or 'its own body')}: "
          f"{len(checks)} bounds, {len(failed)} broken")
    return failed


def main():
    program, failed = sys.argv[1], []
    with tempfile.TemporaryDirectory() as folder:
        make_trace.write_trace(os.path.join(folder, "walk.hid"), [(0.5, 0, 0.8), (6, 0, 0.4), (9, 0, 0)], (), 11)
        failed += broken(program, folder, "keyframe_walk")
        if not os.path.isdir(DATA):
            print("no shared data beside the repository: key frames alone")
            return failed
        for motion, skeleton in SHARED:
            failed += broken(program, folder, motion and os.path.join(DATA, motion),
                             skeleton and os.path.join(DATA, skeleton))
    return failed


problems = main()
print("\n".join(problems) or "motion sources: ok")
sys.exit(1 if problems else 0)
