#!/usr/bin/python3
"""gaitpad itself: version, help, and the benchmark's list."""
import json
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, run



class Main(unittest.TestCase):
    def test_version_and_help(self):
        self.assertRegex(run("--version").stdout, r"^gaitpad \d+\.\d+\.\d+\n$")
        for arguments in (["--help"], ["replay", "--help"], ["bench", "--help"], ["motion", "--help"]):
            done = run(*arguments)
            self.assertEqual(done.returncode, 0)
            self.assertIn("Usage:", done.stdout)

    def test_help_names_every_command(self):
        listed = run("--help").stdout
        for command in ("play", "replay", "record", "pads", "doctor", "decode", "monitor", "motion", "ik", "figures", "bench"):
            self.assertIn(f"  {command} ", listed)

    def test_a_full_disk_is_one_sentence(self):
        for arguments in (["decode", str(ROOT / "config/traces/round.hid")], ["motion", "procedural", "--json"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, text=True,
                                      check=False)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(done.stderr, "gaitpad: standard output cannot be written\n")

    def test_the_bundled_trace_is_what_its_script_writes(self):
        script = subprocess.run(["/usr/bin/python3", ROOT / "tools/make_round_trace.py"],
                                capture_output=True, text=True, check=True)
        self.assertEqual((ROOT / "config/traces/round.hid").read_text(), script.stdout)

    def test_bench_lists_times_beside_limit_and_peer(self):
        rows = {(r["name"], r["characters"]): r for r in json.loads(run("bench", "--json").stdout)}
        self.assertEqual(set(rows), {("step", 1), ("step", 4), ("leg_ik", 1), ("playback", 4)})
        self.assertTrue(all(r["time_us"] > 0 for r in rows.values()))
        four = rows["step", 4]
        self.assertEqual(four["limit_us"], 20)
        self.assertAlmostEqual(four["ratio_to_limit"], four["time_us"] / 20)
        self.assertAlmostEqual(four["ratio_to_peer"], four["time_us"] / rows["playback", 4]["time_us"])
        self.assertGreater(four["iterations_per_leg"], 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
