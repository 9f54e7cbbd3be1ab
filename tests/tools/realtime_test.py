#!/usr/bin/env python3
"""tools/realtime.sh: what it calls passed, failed and not judged; a short run through the program."""
import os
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))
import realtime_judge  # noqa: E402

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
GOOD = {"ticks": 72001, "rate_hz": 240, "time_s": 300.0, "overruns": 71, "skipped_s": 0.0, "late_us_max": 9000.0,
        "steps_left": 250, "steps_right": 250, "time_policy": "SCHED_FIFO 20"}
ON_TIME = {"late": 0, "worst_us": 90}


def verdict(control=ON_TIME, steal=0, **changes):
    return realtime_judge.verdict({**GOOD, **changes}, control, steal, 300.0)


class Judgement(unittest.TestCase):
    def expect(self, word, status, outcome):
        self.assertTrue(outcome[0].startswith(word), outcome)
        self.assertEqual(outcome[1], status)

    def test_fewer_than_one_in_a_thousand_late_is_passed_and_one_in_a_thousand_is_not(self):
        self.expect("PASSED", 0, verdict())
        self.expect("FAILED", 1, verdict(overruns=73))
        self.expect("FAILED", 1, verdict(ticks=72000, overruns=72))

    def test_steal_and_ordinary_priority_are_not_judged(self):
        self.expect("NOT JUDGED", 0, verdict(steal=1))
        self.expect("NOT JUDGED", 0, verdict(steal=1, overruns=5000))
        self.expect("NOT JUDGED", 0, verdict(time_policy="normal priority"))

    def test_late_ticks_fail_also_where_the_control_was_late_which_is_told(self):
        self.expect("FAILED", 1, verdict({}, overruns=80))
        sentence, status = verdict({"late": 60, "worst_us": 64000}, overruns=80)
        self.assertEqual(status, 1)
        self.assertIn("only sleeps was late 60 times", sentence)

    def test_a_tick_left_out_or_run_twice_is_a_failure_whatever_the_host_did(self):
        for ticks in (71900, 72010):
            self.expect("FAILED", 1, verdict(ticks=ticks, steal=50))
        # What was late at the end may be missing: nine milliseconds are two ticks.
        self.expect("PASSED", 0, verdict(ticks=71998))

    def test_skipped_time_is_a_failure_and_accounts_for_its_ticks(self):
        self.expect("FAILED", 1, verdict(skipped_s=1.5, ticks=72001 - 360))
        self.expect("NOT JUDGED", 0, verdict(skipped_s=1.5, ticks=72001 - 360, steal=100))
        self.expect("FAILED", 1, verdict(skipped_s=1.5, steal=100))

    def test_who_stands_or_ends_early_proves_nothing(self):
        self.expect("FAILED", 1, verdict(steps_left=0, steps_right=3))
        self.expect("FAILED", 1, verdict(time_s=100.0, ticks=24001))


class Run(unittest.TestCase):
    def test_a_short_run_walks_and_counts_every_tick(self):
        done = subprocess.run(["bash", ROOT / "tools/realtime.sh", "6", "--no-window", "--no-rumble"], text=True,
                              capture_output=True, env={**os.environ, "REALTIME_BUILD": str(PROGRAM.parent)},
                              timeout=120, check=False)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertRegex(done.stdout, r"\n(PASSED|FAILED|NOT JUDGED): ")
        for wrong in ("left out or run twice", "nobody walked", "it ran for"):
            self.assertNotIn(wrong, done.stdout)
        ticks = int(re.search(r"ticks +(\d+) in", done.stdout)[1])
        self.assertGreater(ticks, 5.5 * 240)


if __name__ == "__main__":
    unittest.main()
