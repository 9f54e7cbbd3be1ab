#!/usr/bin/python3
"""gaitpad ik: the CSV of a solve, and what is refused."""
import csv
import math
import pathlib
import sys
import tempfile
import unittest

from program import run

GOAL = (0.1, -0.6, 0.2)
CHAIN = """goal_m = [0.1, -0.6, 0.2]
tolerance_m = 1e-6
[[dof]]
axis = [1, 0, 0]
angle_rad = 0.1
weight = 0.5
[[dof]]
axis = [0, 0, 1]
link_m = [0, -0.4, 0]
angle_rad = 0.2
[[dof]]
axis = [1, 0, 0]
link_m = [0, -0.4, 0]
angle_rad = 0.6
"""


def end_of(angles):
    """Where Rx(a) Rz(b) link Rx(c) link puts the end."""
    a, b, c = angles
    turn_x = lambda v, t: (v[0], v[1] * math.cos(t) - v[2] * math.sin(t), v[1] * math.sin(t) + v[2] * math.cos(t))
    turn_z = lambda v, t: (v[0] * math.cos(t) - v[1] * math.sin(t), v[0] * math.sin(t) + v[1] * math.cos(t), v[2])
    below = turn_x((0, -0.4, 0), c)
    return turn_x(turn_z((below[0], below[1] - 0.4, below[2]), b), a)


class Ik(unittest.TestCase):
    def run_chain(self, text, *options):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "chain.toml"
            path.write_text(text)
            return run("ik", path, *options)

    def rows(self, *options):
        done = self.run_chain(CHAIN, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = list(csv.reader(done.stdout.splitlines()))
        self.assertEqual(lines[0], ["iteration", "angle_0_rad", "angle_1_rad", "angle_2_rad", "error_m"])
        return [[float(x) for x in line] for line in lines[1:]]

    def test_rows_begin_at_the_start_and_end_at_the_goal_in_both_modes(self):
        for mode in ("paper", "robust"):
            rows = self.rows("--mode", mode)
            self.assertEqual([r[0] for r in rows], list(range(len(rows))))
            self.assertEqual(rows[0][1:4], [0.1, 0.2, 0.6])
            self.assertLess(math.dist(end_of(rows[-1][1:4]), GOAL), 2e-6)

    def test_each_rows_error_is_its_poses_distance_from_the_goal(self):
        for mode in ("paper", "robust"):
            for row in self.rows("--mode", mode):
                self.assertAlmostEqual(row[4], math.dist(end_of(row[1:4]), GOAL), delta=1e-7)  # nine digits of each angle

    def test_refuses_with_one_sentence_that_names_the_line(self):
        for text, words in ((CHAIN + "speed = 1\n", ":15: unknown key"), (CHAIN.replace("0.5", "1.5"), ":6: "),
                            ("goal_m = [0, 0]\n", ":1: ")):
            done = self.run_chain(text)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn("chain.toml" + words, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1)

    def test_no_file_is_a_failure_and_no_mode_a_usage_error(self):
        self.assertEqual(run("ik", "/none.toml").returncode, 1)
        self.assertEqual(self.run_chain(CHAIN, "--mode", "fast").returncode, 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
