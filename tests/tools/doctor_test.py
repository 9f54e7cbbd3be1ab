#!/usr/bin/python3
"""gaitpad doctor: says what it found, ends by it, and changes nothing unasked."""
import json
import os
import pathlib
import subprocess
import sys
import unittest

from program import PROGRAM, ROOT, run

TARGET = pathlib.Path("/etc/udev/rules.d/60-gaitpad.rules")


def doctor(*arguments, answer=""):
    return run("doctor", *arguments, input=answer)


class Doctor(unittest.TestCase):
    def test_findings_have_node_cause_and_fix(self):
        done = doctor("--json")
        findings = json.loads(done.stdout)
        self.assertGreater(len(findings), 0)
        for finding in findings:
            self.assertEqual(list(finding), ["state", "node", "device", "cause", "fix"])
            self.assertIn(finding["state"], ("usable", "problem", "note"))
            self.assertNotEqual(finding["cause"], "")
            self.assertNotIn("\n", finding["cause"] + finding["fix"])

    def test_the_exit_status_tells_whether_a_pad_is_usable(self):
        done = doctor("--json")
        is_usable = any(f["state"] == "usable" for f in json.loads(done.stdout))
        self.assertEqual(done.returncode, 0 if is_usable else 1)

    def test_text_is_one_line_a_finding(self):
        count = len(json.loads(doctor("--json").stdout))
        self.assertEqual(len(doctor().stdout.splitlines()), count)

    def test_wrong_usage_is_2(self):
        self.assertEqual(doctor("--yes").returncode, 2)
        self.assertEqual(doctor("--install-rules", "--json").returncode, 2)


class InstallRules(unittest.TestCase):
    def setUp(self):
        self.before = TARGET.read_bytes() if TARGET.exists() else None

    def tearDown(self):
        self.assertEqual(TARGET.read_bytes() if TARGET.exists() else None, self.before)

    def test_shows_the_file_and_refuses_without_a_yes(self):
        for answer in ("", "n\n", "no\n", "\n", "maybe\n"):
            done = doctor("--install-rules", answer=answer)
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertTrue(done.stdout.startswith((ROOT / "config/udev/60-gaitpad.rules").read_text()))
            self.assertIn(str(TARGET), done.stderr)

    @unittest.skipIf(os.geteuid() != 0, "needs root to become somebody else")
    def test_tells_an_ordinary_user_the_command(self):
        done = subprocess.run([PROGRAM, "doctor", "--install-rules", "--yes"], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False, user=65534, group=65534, extra_groups=[])
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"sudo \S*gaitpad doctor --install-rules")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
