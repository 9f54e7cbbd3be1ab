#!/usr/bin/python3
"""gaitpad play with a recording as its pad: the session and its recording agree, and every end is a clean one."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest
import unittest.mock

from program import FolderCase, PROGRAM, ROUND, run

SECONDS = 3
LIVE_KEYS = {"overruns", "lost", "recording_lost", "tick_us_median", "tick_us_max", "wait_us_median", "wait_us_max"}


def short_trace():
    """The first moments of the bundled recording, so that it ends by itself."""
    lines = pathlib.Path(ROUND).read_text().splitlines(keepends=True)
    return "".join(line for line in lines if not line.startswith(("E:", "C:", "Q:")) or line[3:16] < "000001.500000")


class PlayCase(FolderCase):
    def setUp(self):
        super().setUp()
        self.record = str(self.folder / "session.hid")

    def replay_hash(self, *options):
        done = run("replay", self.record, "--json", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads(done.stdout)
        return (summary[0] if isinstance(summary, list) else summary)["pose_hash"]


class Session(PlayCase):
    def test_its_recording_replays_to_the_same_poses(self):
        done = run("play", ROUND, "--no-window", "--record", self.record, "--seconds", str(SECONDS), "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads(done.stdout)
        self.assertLessEqual(LIVE_KEYS, set(summary))
        self.assertEqual((summary["lost"], summary["recording_lost"]), (0, 0))
        self.assertGreater(summary["reports"], 20)
        self.assertAlmostEqual(summary["ticks"], SECONDS * 240, delta=240)
        self.assertEqual(self.replay_hash(), summary["pose_hash"])

    def test_options_of_replay_hold_and_the_keys_are_replays(self):
        options = ["--character", "child", "--character", "adult", "--style", "tired", "--rate", "120", "--ik", "paper"]
        done = run("play", ROUND, "--no-window", "--record", self.record, "--seconds", "2.5", "--json", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        live = json.loads(done.stdout)
        self.assertEqual([s["style"] for s in live], ["tired", "tired"])
        self.assertEqual(live[0]["rate_hz"], 120)
        replayed = json.loads(run("replay", self.record, "--json", *options[:-4], "--ik", "paper").stdout)
        self.assertEqual(set(live[0]) - set(replayed[0]), set(live[1]) - set(replayed[1]))
        self.assertLessEqual(set(replayed[0]), set(live[0]))
        self.assertEqual([s["pose_hash"] for s in replayed], [s["pose_hash"] for s in live])

    def test_ends_one_second_behind_the_end_of_a_recording(self):
        trace = self.folder / "short.hid"
        trace.write_text(short_trace())
        start = time.monotonic()
        done = run("play", str(trace), "--no-window", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertLess(time.monotonic() - start, 30)  # a busy machine is late
        self.assertGreaterEqual(json.loads(done.stdout)["ticks"], 2.4 * 240)

    def test_lines_of_standard_input_are_commands(self):
        done = run("play", ROUND, "--no-window", "--record", self.record, "--seconds", "2", "--json", "--commands",
                   stdin=None, input="style limp_left\nstyle moonwalk\n")
        summary = json.loads(done.stdout)
        self.assertEqual((summary["style"], summary["bad_commands"]), ("limp_left", 1))
        self.assertIn("style limp_left", pathlib.Path(self.record).read_text())
        self.assertEqual(self.replay_hash(), summary["pose_hash"])

    def test_text_for_people(self):
        done = run("play", ROUND, "--no-window", "--seconds", "1")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"pose hash [0-9a-f]{16}")
        self.assertNotIn("\033", done.stderr)  # no terminal, no line that is rewritten


class Ends(PlayCase):
    def end_by(self, number, *options):
        with subprocess.Popen([PROGRAM, "play", ROUND, "--no-window", "--record", self.record, "--json", *options],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            time.sleep(2.0)
            process.send_signal(number)
            out, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 0, errors)
        return json.loads(out)

    def test_each_signal_finishes_the_recording(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                summary = self.end_by(number)
                self.assertEqual(self.replay_hash(), summary["pose_hash"])
                self.assertEqual(os.listdir(self.folder), ["session.hid"])


    def test_two_signals_at_once_finish_the_recording_too(self):
        with subprocess.Popen([PROGRAM, "play", ROUND, "--no-window", "--record", self.record, "--json"],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            time.sleep(2.0)
            for number in (signal.SIGINT, signal.SIGINT, signal.SIGTERM):
                process.send_signal(number)
            out, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 0, errors)
        self.assertEqual(self.replay_hash(), json.loads(out)["pose_hash"])

    def test_closed_standard_descriptors_get_nothing_into_the_recording(self):
        command = f'"{PROGRAM}" play "{ROUND}" --no-window --commands --seconds 2 --record "{self.record}" <&- >&- 2>&-'
        self.assertEqual(subprocess.run(["sh", "-c", command], check=False, timeout=60).returncode, 1)
        self.replay_hash()


class Refusals(PlayCase):
    def assert_refused(self, *arguments, status=1, says=""):
        done = run("play", *arguments)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertIn(says, done.stderr)
        if status == 1:
            self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)

    def test_without_a_display_it_says_what_works(self):
        with unittest.mock.patch.dict(os.environ, {"SDL_VIDEODRIVER": "x11", "DISPLAY": ""}):
            self.assert_refused(says="no display")

    def test_what_cannot_be_is_one_sentence(self):
        self.assert_refused(str(self.folder / "none.hid"), "--no-window", "--seconds", "1", says="none.hid")
        self.assert_refused(ROUND, "--no-window", "--record", str(self.folder / "no/x.hid"), says="no/x.hid")
        self.assert_refused(ROUND, "--no-window", "--style", "moonwalk", says="moonwalk")
        (self.folder / "damaged.hid").write_text("R: 3 05 01\n")
        self.assert_refused(str(self.folder / "damaged.hid"), "--no-window", says="damaged.hid:1")

    def test_wrong_usage_is_2(self):
        self.assert_refused("--no-window", "--driver", "magic", status=2)
        self.assert_refused("--no-window", "--seconds", "0", status=2)

    def test_without_a_pad_it_says_so_once_and_waits(self):
        done = run("play", "no such pad", "--no-window", "--seconds", "1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count("no such pad"), 1, done.stderr)
        self.assertIn("gaitpad doctor", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
