#!/usr/bin/python3
"""gaitpad record, monitor and live decode with a recording as the pad."""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from program import FolderCase, PROGRAM, ROOT, ROUND, run

DUALSHOCK = ROOT / "tests/data/pads/054c_09cc.hid"


def reports(path, until="999999"):
    """Bytes of the reports before a moment, in the file's own time."""
    lines = [line.split(" ", 2) for line in pathlib.Path(path).read_text().splitlines() if line.startswith("E:")]
    return [rest for _, moment, rest in lines if moment < until]


def header(path, letters):
    lines = pathlib.Path(path).read_text().splitlines()
    return [line for line in lines if line[:2] in [letter + ":" for letter in letters]]


class Record(FolderCase):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out.hid"

    def short(self):
        trace = self.folder / "short.hid"
        lines = pathlib.Path(ROUND).read_text().splitlines(keepends=True)
        trace.write_text("".join(l for l in lines if l[:2] not in ("E:", "C:", "Q:") or l[3:16] < "000002.000000"))
        return trace

    def test_has_the_same_reports_and_descriptor(self):
        trace = self.short()
        done = run("record", trace, "--out", self.out, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(reports(self.out), reports(trace))
        self.assertEqual(header(self.out, "RI"), header(trace, "RI"))
        told = json.loads(done.stdout)
        self.assertEqual((told["reports"], told["lost"]), (len(reports(trace)), 0))
        self.assertEqual((told["vendor"], told["product"]), (0x1209, 0x0001))

    def test_keeps_the_times_between_reports(self):
        trace = self.short()
        run("record", trace, "--out", self.out)
        times = [[float(line.split()[1]) for line in pathlib.Path(p).read_text().splitlines() if line[:2] == "E:"]
                 for p in (trace, self.out)]
        for mine, theirs in list(zip(times[1], times[0]))[1:]:  # a busy machine is late with the first
            self.assertAlmostEqual(times[1][-1] - mine, times[0][-1] - theirs, delta=0.0015)

    def test_replays_and_decodes(self):
        self.assertEqual(run("record", self.short(), "--out", self.out).returncode, 0)
        self.assertEqual(run("replay", self.out).returncode, 0)
        self.assertEqual(run("decode", self.out).returncode, 0)

    def test_real_pads_keep_every_byte(self):
        self.assertEqual(run("record", DUALSHOCK, "--out", self.out).returncode, 0)
        self.assertEqual(reports(self.out), reports(DUALSHOCK))

    def test_signals_and_seconds_leave_a_complete_file(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen([PROGRAM, "record", ROUND, "--out", str(self.out)], text=True,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
                time.sleep(2.5)
                process.send_signal(number)
                out, errors = process.communicate(timeout=30)
            self.assertEqual(process.returncode, 0, errors)
            self.assertIn("reports", out)
            count = len(reports(self.out))
            self.assertGreater(count, 10)
            self.assertEqual(reports(self.out), reports(ROUND)[:count])
            self.assertEqual(run("replay", self.out).returncode, 0)
        run("record", ROUND, "--out", self.out, "--seconds", "1.5")
        self.assertLess(len(reports(self.out)), count)
        self.assertEqual({p.name for p in self.folder.iterdir()}, {"out.hid"})

    def test_a_full_disk_ends_it_and_leaves_what_was_written(self):
        start = time.monotonic()
        command = f'ulimit -f 2; exec "{PROGRAM}" record "{ROUND}" --out "{self.out}" --seconds 60'
        done = subprocess.run(["sh", "-c", command],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=120)
        self.assertLess(time.monotonic() - start, 30)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertEqual(done.stderr, f"gaitpad record: {self.out}.part: cannot be written: File too large\n")
        self.assertEqual(run("replay", f"{self.out}.part").returncode, 0)

    def test_without_a_pad_nothing_is_written(self):
        self.out.write_text("kept")
        done = run("record", "no such pad", "--out", self.out, "--seconds", "0.5")
        self.assertEqual(done.returncode, 1)
        self.assertEqual(self.out.read_text(), "kept")
        self.assertEqual({p.name for p in self.folder.iterdir()}, {"out.hid"})

    def test_wrong_usage_is_2_and_what_cannot_be_is_1(self):
        self.assertEqual(run("record", ROUND).returncode, 2)
        done = run("record", ROUND, "--out", self.folder / "no/out.hid")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("no/out.hid", done.stderr)


class Monitor(unittest.TestCase):
    def test_an_object_a_second_with_rate_and_latency(self):
        done = run("monitor", ROUND, "--seconds", "3.5", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertGreaterEqual(len(lines), 3)
        for line in lines:
            self.assertLessEqual({"device", "name", "rate_hz", "jitter_us", "longest_gap_us", "latency_us_median",
                                  "latency_us_max", "lost", "axes", "sticks", "triggers", "buttons"}, set(line))
            self.assertEqual(line["name"], "Example Walk Pad")
        self.assertGreater(max(line["rate_hz"] for line in lines), 15)
        self.assertGreater(lines[-1]["sticks"]["left"][1], 0.5)  # forward, from the second second on

    def test_a_line_a_second_where_there_is_no_terminal(self):
        done = run("monitor", ROUND, "--seconds", "2.5")
        self.assertEqual(done.returncode, 0)
        self.assertGreaterEqual(len(done.stdout.splitlines()), 2)
        self.assertNotIn("\033", done.stdout)
        self.assertEqual(done.stderr, "gaitpad monitor: Example Walk Pad (recording): calibration "
                         "\"unknown stick, not calibrated\"\n")


class GivenCalibration(unittest.TestCase):
    def test_it_is_used_and_the_recording_holds_it(self):
        with tempfile.TemporaryDirectory() as folder:
            path, out = pathlib.Path(folder) / "c.toml", pathlib.Path(folder) / "out.hid"
            path.write_text('name = "turned"\n[left]\nforward = "-y"\n[left_trigger]\nreleased = 0.25\n')
            done = run("monitor", ROUND, "--seconds", "3.5", "--json", "--calibration", path)
            self.assertIn('calibration "turned"', done.stderr)
            last = json.loads(done.stdout.splitlines()[-1])
            self.assertLess(last["sticks"]["left"][1], -0.5)  # the thumb goes forward
            done = run("record", ROUND, "--out", out, "--seconds", "0.5", "--calibration", path)
            self.assertEqual(done.returncode, 0, done.stderr)
            held = [line[3:] for line in out.read_text().splitlines() if line.startswith("K:")]
            for line in ('name = "turned"', 'forward = "-y"', "released = 0.25"):
                self.assertIn(line, held)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
