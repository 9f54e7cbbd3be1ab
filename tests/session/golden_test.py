#!/usr/bin/python3
"""Six sessions and the pose_hash that each of them has had since version 0.1.0.

A change of the code that moves a single bit of a single pose fails here. Whoever changes the walk on
purpose puts the new hashes in and says why in CHANGELOG.md. The sessions need no file from outside
the repository; they run on the program as users build it (optimised).
Usage: golden_test.py PROGRAM
"""
import json
import pathlib
import sys
import unittest

from make_trace import ramp, raw_stick, write_trace

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tools"))
from program import FolderCase, ROUND, run  # noqa: E402

CAST = ["--character", "adult", "--character", "child", "--character", "tall", "--character", "adult",
        "--style", "even", "--style", "stiff_hip", "--style", "limp_left", "--style", "tired"]
SCRIPT = """
[[event]]
at_s = 2
command = "style carry"
[[event]]
at_s = 5
command = "gait hip_sway 1.5"
[[event]]
at_s = 8
command = "style tiring"
"""
GOLDEN = {
    "flat": "ee86aa31d499535e",
    "paper": "e1bd6ecd7f6a8f8e",
    "course": "a0146462a8bb229c",
    "turning": "737383ec0f5b6481",
    "backward": "a586d103370769a2",
    "script": "fc1fb641611d43a0",
}


class GoldenHashes(FolderCase):
    def pose_hash(self, trace, *options):
        done = run("replay", trace, "--json", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads(done.stdout)
        return (summary[0] if isinstance(summary, list) else summary)["pose_hash"]

    def expect(self, name, trace, *options):
        self.assertEqual(self.pose_hash(trace, *options), GOLDEN[name], name)

    def made_trace(self, *stick, end):
        path = self.folder / "made.hid"
        write_trace(path, stick, end_s=end)
        return path

    def test_flat_robust_four_styles(self):
        self.expect("flat", ROUND, *CAST)

    def test_flat_paper_mode(self):
        self.expect("paper", ROUND, "--ik", "paper", *CAST)

    def test_terrain_course(self):
        self.expect("course", ROUND, "--terrain", "course", *CAST)

    def test_turning_in_both_directions(self):
        stick = [*ramp(0, 1, (0, 0), raw_stick(0.6, 0.6)), (6, *raw_stick(-0.9, 0.3)),
                 (9, *raw_stick(1, 0)), (12, 0, 0)]
        self.expect("turning", self.made_trace(*stick, end=14))

    def test_backward_on_stairs(self):
        stick = [(0, *raw_stick(0, 0.8)), (7, 0, 0), (9, *raw_stick(0.1, -0.7)), (15, 0, 0)]
        self.expect("backward", self.made_trace(*stick, end=17), "--terrain", "stairs")

    def test_script_on_a_motion_file(self):
        """The built-in walk, exported and read again: a captured motion as far as the reader knows."""
        out = self.folder / "out"
        self.assertEqual(run("replay", ROUND, "--out", out).returncode, 0)
        script = self.folder / "script.toml"
        script.write_text(SCRIPT)
        self.expect("script", ROUND, "--motion", out / "pose.bvh", "--script", script)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
