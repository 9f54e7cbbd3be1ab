#!/usr/bin/python3
"""gaitpad calibrate at a terminal, a recording being the pad that a hand moves through the steps."""
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

from program import PROGRAM, ROOT
sys.path[:0] = [str(ROOT / "tests/session"), str(ROOT / "tools/rig")]
from make_trace import DESCRIPTOR, FULL  # noqa: E402
from terminal import Terminal  # noqa: E402

REACH = 0.9
CENTRE = {"left": (0.05, -0.03), "right": (-0.04, 0.06)}
PERIOD_S = 0.01


class Hand:
    """Reports of the 16-bit test pad, both sticks moved at once: positions from rest, +y forward."""

    def __init__(self):
        self.time_s, self.lines, self.place, self.buttons = 0.0, [], (0.0, 0.0), 0

    def report(self):
        self.time_s += PERIOD_S
        noise = 0.002 * math.sin(len(self.lines) * 2.4)
        data = b""
        for centre in CENTRE.values():
            for raw in (centre[0] + self.place[0] + noise, -(centre[1] + self.place[1] + noise)):
                data += round(max(-1, min(1, raw)) * FULL).to_bytes(2, "little", signed=True)
        data += (0x08 | self.buttons << 4).to_bytes(2, "little")
        micros = round(self.time_s * 1e6)
        self.lines.append(f"E: {micros // 1000000:06d}.{micros % 1000000:06d} {len(data)} " +
                          " ".join(f"{byte:02x}" for byte in data))

    def hold(self, seconds):
        for _ in range(round(seconds / PERIOD_S)):
            self.report()

    def push(self, x, y, held_s, rest_s):
        self.place = (x * REACH, y * REACH)
        self.hold(held_s)
        self.place = (0.0, 0.0)
        self.hold(rest_s)

    def releases(self, count):
        for i in range(count):
            angle = 2 * math.pi * i / count + 0.2
            self.push(math.cos(angle), math.sin(angle), 0.1, 0.68)

    def turns(self, count, turn_s=0.9):
        for i in range(round(count * turn_s / PERIOD_S)):
            angle = 2 * math.pi * i * PERIOD_S / turn_s
            self.place = (REACH * math.cos(angle), REACH * math.sin(angle))
            self.report()
        self.place = (0.0, 0.0)
        self.hold(0.2)

    def pushes(self):
        for x, y in ((0, 1), (1, 0), (0, -1), (-1, 0)):
            self.push(x, y, 0.4, 0.3)

    def triggers(self):
        self.buttons = 1 << 6 | 1 << 7
        self.hold(0.4)
        self.buttons = 0
        self.hold(0.2)

    def write(self, path):
        header = [f"R: {len(DESCRIPTOR)} " + " ".join(f"{byte:02x}" for byte in DESCRIPTOR),
                  "N: gaitpad test pad", "P: synthetic", "I: 3 1209 0001"]
        path.write_text("\n".join(header + self.lines) + "\n")


class Calibrate(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.traces = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.traces.name)
        cls.round, cls.rest = folder / "round.hid", folder / "rest.hid"
        hand = Hand()
        hand.hold(0.5)
        hand.releases(7)
        hand.hold(2.2)
        hand.turns(2.5)
        hand.pushes()
        hand.triggers()
        hand.hold(3.0)
        hand.write(cls.round)
        hand = Hand()
        hand.hold(30.0)
        hand.write(cls.rest)

    @classmethod
    def tearDownClass(cls):
        cls.traces.cleanup()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.config = pathlib.Path(folder.name)
        self.folder = self.config / "gaitpad/calibration"

    def at_terminal(self, trace, **size):
        return Terminal(PROGRAM, "calibrate", trace, env={"XDG_CONFIG_HOME": str(self.config)}, **size)

    def files(self):
        return {path.name: path.read_text() for path in self.folder.glob("*")} if self.folder.exists() else {}

    def written(self):
        """A calibration is there already: the file that the tool itself would write."""
        with self.at_terminal(self.rest) as terminal:
            terminal.wait_for("Step 1 of 7")
            time.sleep(0.7)
            terminal.press("sssssss")
            terminal.wait_for("Enter writes")
            time.sleep(0.2)
            terminal.press("\n")
            terminal.wait_end()
        return self.files()

    def test_the_steps_lead_to_a_file(self):
        with self.at_terminal(self.round) as terminal:
            place = 0
            for number, step in enumerate(("rest", "turning", "push forward", "push right", "push back", "push left",
                                           "triggers"), 1):
                place = terminal.wait_for(f"Step {number} of 7: {step} ", since=place).end()
            terminal.wait_for("Enter writes", since=place)
            self.assertEqual(self.files(), {})
            terminal.wait_for("[0-9] of 6 releases")
            terminal.wait_for("4[0-9] of 48 directions")
            terminal.wait_for("now let go")
            time.sleep(0.2)
            terminal.press("\n")
            self.assertEqual(terminal.wait_end(), 0, terminal.text)
            self.assertTrue(terminal.is_as_before())
        names = [name for name in self.files() if name.endswith(".toml")]
        self.assertEqual(len(names), 1, self.files())
        told = tomllib.loads(self.files()[names[0]])
        self.assertEqual(told["devices"], ["1209:0001"])
        for stick, centre in CENTRE.items():
            for axis, middle in zip("xy", centre):
                self.assertAlmostEqual(told[stick][axis]["centre"], middle, delta=0.002)
                self.assertAlmostEqual(told[stick][axis]["min"], max(-1, middle - REACH), delta=0.01)
                self.assertAlmostEqual(told[stick][axis]["max"], min(1, middle + REACH), delta=0.01)

    def test_a_line_never_is_wider_than_the_screen_and_the_screen_never_fuller(self):
        for rows, columns in ((24, 80), (24, 40), (6, 60)):
            with self.at_terminal(self.rest, rows=rows, columns=columns) as terminal:
                terminal.wait_for("releases")
                terminal.press("?s")
                time.sleep(0.4)
                terminal.press("q")
                terminal.wait_end()
                for screen in terminal.text.split("\033[J"):
                    lines = screen.replace("\033[K", "").replace("\r", "").split("\n")
                    if "releases" in screen or "directions" in screen:
                        self.assertLessEqual(max(len(line.split("A")[-1]) for line in lines), columns, screen)
                        self.assertLessEqual(len(lines), rows, screen)

    def test_ctrl_c_leaves_the_old_file_and_the_terminal_as_they_were(self):
        before = self.written()
        self.assertEqual(len(before), 1)
        for press in (lambda t: t.press("\x03"), lambda t: t.send_signal(signal.SIGTERM), lambda t: t.press("q"),
                      lambda t: t.press("\x04")):
            with self.at_terminal(self.rest) as terminal:
                terminal.wait_for("Step 1 of 7")
                self.assertFalse(terminal.is_cooked())
                press(terminal)
                self.assertEqual(terminal.wait_end(), 1)
                self.assertTrue(terminal.is_as_before())
                self.assertIn("nothing written", terminal.text)
            self.assertEqual(self.files(), before)

    def test_ctrl_c_and_q_at_the_question_leave_the_old_file(self):
        before = self.written()
        for key in ("\x03", "q"):
            with self.at_terminal(self.rest) as terminal:
                terminal.wait_for("Step 1 of 7")
                time.sleep(0.7)
                terminal.press("sssssss")
                terminal.wait_for("Enter writes")
                time.sleep(0.2)
                terminal.press(key)
                self.assertEqual(terminal.wait_end(), 1)
                self.assertTrue(terminal.is_as_before())
            self.assertEqual(self.files(), before)

    def test_keys_skip_repeat_and_go_back(self):
        with self.at_terminal(self.round) as terminal:
            terminal.wait_for("2 of 6 releases")
            terminal.press("r")
            at = len(terminal.text)
            at = terminal.wait_for(" 0 of 6 releases", since=at).end()
            terminal.press("\n")
            at = terminal.wait_for("Step 2 of 7", since=at).end()
            terminal.press("s")
            at = terminal.wait_for("Step 3 of 7", since=at).end()
            terminal.press("\x1b[B")  # an arrow is no b
            time.sleep(0.2)
            self.assertNotIn("Step 2", terminal.text[at:])
            terminal.press("b")
            at = terminal.wait_for("Step 2 of 7", since=at).end()
            terminal.press("?")
            terminal.wait_for("nothing is written", since=at)
            terminal.press("q")
            terminal.wait_end()

    def test_stopped_it_gives_the_terminal_back_and_takes_it_again(self):
        with self.at_terminal(self.rest) as terminal:
            terminal.wait_for("Step 1 of 7")
            terminal.press("\x1a")
            terminal.wait_stopped()
            self.assertTrue(terminal.is_as_before())
            terminal.go_on()
            at = len(terminal.text)
            terminal.wait_for("Step 1 of 7", since=at)
            self.assertFalse(terminal.is_cooked())
            terminal.press("q")
            terminal.wait_end()
            self.assertTrue(terminal.is_as_before())

    def test_without_a_terminal_lines_do(self):
        with subprocess.Popen([PROGRAM, "calibrate", str(self.rest)], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True,
                              env={**os.environ, "XDG_CONFIG_HOME": str(self.config)}) as process:
            time.sleep(1.0)
            process.stdin.write("s\nskip\nb\nq\n")
            process.stdin.flush()
            _, errors = process.communicate(timeout=20)
        self.assertNotIn("\033", errors)
        self.assertIn("Step 1 of 7: rest", errors)
        self.assertIn("left stick: 0 of 6 releases", errors)
        self.assertIn("nothing written", errors)
        self.assertEqual(self.files(), {})

    def test_the_end_of_input_gives_up(self):
        done = subprocess.run([PROGRAM, "calibrate", str(self.rest)], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, check=False, timeout=20, env={**os.environ, "XDG_CONFIG_HOME": str(self.config)})
        self.assertIn("nothing written", done.stderr)
        self.assertEqual(self.files(), {})

    def test_a_pad_without_a_stick_is_told(self):
        trace = self.config / "buttons.hid"
        trace.write_text("R: 23 05 01 09 05 a1 01 05 09 19 01 29 08 15 00 25 01 75 01 95 08 81 02 c0\n"
                         "N: Buttons\nI: 3 1209 0002\nE: 000000.000000 1 00\nE: 000005.000000 1 00\n")
        with self.at_terminal(trace) as terminal:
            terminal.wait_for("stick", 10)
            self.assertEqual(terminal.wait_end(), 1, terminal.text)
            self.assertTrue(terminal.is_as_before())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
