#!/usr/bin/python3
"""gaitpad calibrate with recordings: what it finds, the file it keeps, what it refuses."""
import json
import math
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tomllib
import unittest

from program import FolderCase, ROOT, run
from stick_trace import Stick, thumb, trace_text

SHARED = ROOT.parent / "shared/data/hid"
SERIAL = "AA:BB:01"


class Calibrate(FolderCase):
    def setUp(self):
        super().setUp()
        self.own = self.folder / "config/gaitpad/calibration"

    def run_program(self, *arguments, environment=None, before=None):
        own = {"XDG_CONFIG_HOME": str(self.folder / "config")} if environment is None else environment
        kept = {k: v for k, v in os.environ.items() if k not in ("XDG_CONFIG_HOME", "HOME")}
        return run(*arguments, env={**kept, **own}, preexec_fn=before, cwd=self.folder)

    def trace(self, left=None, right=None, steps=None, **options):
        path = self.folder / f"{options.pop('file', 'made')}.hid"
        path.write_text(trace_text(left or Stick(), right or Stick(seed=2), steps or thumb(), **options))
        return path

    def calibrated(self, *arguments):
        done = self.run_program("calibrate", "--json", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout)

    def written(self):
        files = list(self.own.glob("*.toml"))
        self.assertEqual(len(files), 1)
        return files[0]

    def refused(self, *arguments, says, **options):
        done = self.run_program("calibrate", *arguments, **options)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        last = done.stderr.strip().splitlines()[-1]
        self.assertIn(says, last)
        return done

    def test_finds_what_the_sticks_are(self):
        left = Stick(centre=(0.06, -0.04), reach=(0.85, 0.8), sigma=0.004, hysteresis=0.05)
        told = self.calibrated("--trace", self.trace(left, serial=SERIAL))["sticks"]
        found = told["left"]
        self.assertAlmostEqual(found["centre_x"], 0.06, delta=0.05 / 4)
        self.assertAlmostEqual(found["centre_y"], -0.04, delta=0.05 / 4)
        for key, truth in (("min_x", 0.06 - 0.85), ("max_x", 0.06 + 0.85), ("min_y", -0.84), ("max_y", 0.76)):
            self.assertAlmostEqual(found[key], truth, delta=max(0.01 * abs(truth), 0.008), msg=key)
        for key in ("sigma_x", "sigma_y"):
            self.assertAlmostEqual(found[key], 0.004, delta=0.15 * 0.004)
        self.assertAlmostEqual(found["hysteresis"], 0.05, delta=0.01)
        self.assertEqual(found["drift_per_s"], 0)
        self.assertAlmostEqual(found["rate_hz"], 250, delta=2)
        self.assertAlmostEqual(found["inner_zone"], max(0.05, 3 * 0.004 + 0.05), delta=0.01)
        perfect = told["right"]
        self.assertEqual(perfect["verdict"], "good")
        self.assertLess(perfect["circularity_error"], 0.5)
        self.assertEqual(perfect["inner_zone"], 0.05)

    def test_says_null_for_what_a_recording_cannot_tell(self):
        still = [(i / 250, (0, 0), (0, 0)) for i in range(500)]
        found = self.calibrated("--trace", self.trace(steps=still))["sticks"]["left"]
        self.assertAlmostEqual(found["centre_x"], 0, delta=1e-4)
        for key in ("hysteresis", "min_x", "max_y", "circularity_error"):
            self.assertIsNone(found[key], key)
        self.assertEqual(found["verdict"], "unknown")

    def test_sees_a_drift_and_says_that_no_zone_cures_it(self):
        drifting = Stick(sigma=0.002, drift=(0.006, 0.0))
        found = self.calibrated("--trace", self.trace(drifting))["sticks"]["left"]
        self.assertAlmostEqual(found["drift_per_s"], 0.006, delta=0.001)
        self.assertIn("dead zone", found["reason"])
        self.assertNotEqual(found["verdict"], "good")

    def test_several_recordings_of_a_pad_count_together(self):
        rest = [(i / 250, (0, 0), (0, 0)) for i in range(500)]
        turn = thumb(releases=0, pushes=())
        both = self.calibrated("--trace", self.trace(steps=rest, file="rest"), "--trace", self.trace(steps=turn, file="turn"))
        self.assertIsNotNone(both["sticks"]["left"]["circularity_error"])
        other = self.trace(product=3, file="other")
        self.refused("--trace", self.folder / "rest.hid", "--trace", other, says="is not the pad of")

    def test_writes_the_devices_own_file_and_keeps_the_old_one(self):
        self.calibrated("--trace", self.trace(Stick(centre=(0.1, 0)), serial=SERIAL))
        own = tomllib.loads(self.written().read_text())
        self.assertEqual(own["unique_id"], SERIAL)
        self.assertAlmostEqual(own["left"]["x"]["centre"], 0.1, delta=0.001)
        self.assertIn("measured", own["left"])
        first = self.written().read_text()
        self.calibrated("--trace", self.trace(Stick(centre=(-0.1, 0)), serial=SERIAL))
        self.assertAlmostEqual(tomllib.loads(self.written().read_text())["left"]["x"]["centre"], -0.1, delta=0.001)
        self.assertEqual(pathlib.Path(f"{self.written()}.old").read_text(), first)

    def test_a_stick_that_was_not_seen_keeps_its_calibration(self):
        self.calibrated("--trace", self.trace(Stick(centre=(0.1, 0), reach=(0.8, 0.8)), serial=SERIAL))
        before = tomllib.loads(self.written().read_text())["left"]
        turning = [(t, (math.cos(9 * t), math.sin(9 * t)), (0, 0)) for t in (i / 250 for i in range(800))]
        still = Stick(centre=(0, 0.1), reach=(0, 0))
        self.calibrated("--trace", self.trace(Stick(), still, steps=turning, serial=SERIAL))
        after = tomllib.loads(self.written().read_text())
        self.assertAlmostEqual(after["right"]["y"]["centre"], 0.1, delta=0.001)
        self.assertEqual(after["left"], before)  # `measured` too

    def test_play_and_record_use_it_and_the_recording_carries_it(self):
        trace = self.trace(Stick(centre=(0.3, 0.3), reach=(0.6, 0.6)), serial=SERIAL)
        self.calibrated("--trace", trace)
        out = self.folder / "played.hid"
        done = self.run_program("play", trace, "--no-window", "--record", out, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        embedded = "\n".join(line[3:] for line in out.read_text().splitlines() if line.startswith("K: "))
        self.assertAlmostEqual(tomllib.loads(embedded)["left"]["x"]["centre"], 0.3, delta=0.002)
        # Nothing else is needed: another user's replay gives the same poses.
        replayed = self.run_program("replay", out, "--json", environment={"XDG_CONFIG_HOME": "/nonexistent"})
        self.assertEqual(json.loads(replayed.stdout)["pose_hash"], json.loads(done.stdout)["pose_hash"])
        # A replay hangs on no user's folder.
        plain = [self.run_program("replay", trace, "--json", **kind).stdout
                 for kind in ({}, {"environment": {"XDG_CONFIG_HOME": "/nonexistent"}})]
        self.assertEqual(*plain)

    def test_learns_swapped_and_inverted_axes_from_pushes(self):
        kinds = {(a, b): swap for a, b, swap in [
            ("x", "y", lambda x, y: (x, y)), ("-x", "y", lambda x, y: (-x, y)), ("x", "-y", lambda x, y: (x, -y)),
            ("-x", "-y", lambda x, y: (-x, -y)), ("y", "x", lambda x, y: (y, x)), ("-y", "x", lambda x, y: (y, -x)),
            ("y", "-x", lambda x, y: (-y, x)), ("-y", "-x", lambda x, y: (-y, -x))]}
        for (right, forward), swap in kinds.items():
            with self.subTest(right=right, forward=forward):
                trace = self.trace(Stick(centre=(0.05, -0.1), sigma=0.003), serial=SERIAL, swap=swap)
                told = self.calibrated("--trace", trace, "--pushes", "forward,right,back,left")
                left = tomllib.loads(self.written().read_text())["left"]
                self.assertEqual((left.get("right", "x"), left.get("forward", "y")), (right, forward))
                self.assertAlmostEqual(told["sticks"]["left"]["centre_x"], 0.05, delta=0.003)
                self.assertAlmostEqual(told["sticks"]["left"]["centre_y"], -0.1, delta=0.003)

    def test_checks_todays_stick_against_its_file(self):
        self.calibrated("--trace", self.trace(Stick(sigma=0.003), serial=SERIAL))
        same = self.calibrated("--trace", self.trace(Stick(sigma=0.003, seed=9), serial=SERIAL), "--check", self.written())
        self.assertEqual(same["changes"], [])
        before = self.written().read_text()
        moved = self.trace(Stick(centre=(0.08, 0), sigma=0.012), serial=SERIAL)
        told = self.calibrated("--trace", moved, "--check", self.written())["changes"]
        self.assertTrue(any("left" in c and "centre" in c for c in told), told)
        self.assertFalse(any("right" in c for c in told), told)
        self.assertEqual(self.written().read_text(), before)

    def test_says_that_a_file_is_another_pads_or_that_nothing_could_be_compared(self):
        own = self.trace(serial=SERIAL)
        self.calibrated("--trace", own)
        same = self.run_program("calibrate", "--trace", own, "--check", self.written())
        self.assertEqual((same.returncode, same.stderr), (0, ""))
        self.assertIn("nothing that was seen has changed since", same.stdout)
        other = self.run_program("calibrate", "--trace", self.trace(product=3, file="other"), "--check", self.written())
        self.assertEqual(other.returncode, 0)
        self.assertIn(f"{self.written()}: is the file of ", other.stderr)
        turning = [(t, (math.cos(9 * t), math.sin(9 * t)), (0, 0)) for t in (i / 250 for i in range(800))]
        unseen = self.refused("--trace", self.trace(steps=turning, serial=SERIAL), "--check", self.written(),
                              says="no stick was seen at rest")
        self.assertNotIn("has changed", unseen.stdout)

    def test_draws_a_picture_that_others_can_read(self):
        picture = self.folder / "sticks.png"
        self.calibrated("--trace", self.trace(), "--plot", picture)
        self.assertIn("PNG image data", subprocess.run(["file", picture], capture_output=True, text=True, check=True).stdout
                      if shutil.which("file") else "PNG image data")
        import matplotlib.image
        pixels = matplotlib.image.imread(picture)
        self.assertGreater(pixels.shape[1], 800)
        self.assertGreater(pixels.std(), 0.02)

    def test_prints_and_writes_where_it_is_told(self):
        trace = self.trace(serial=SERIAL)
        done = self.run_program("calibrate", "--trace", trace, "--out", "-")
        self.assertEqual(tomllib.loads(done.stdout)["unique_id"], SERIAL)
        self.assertFalse(self.own.exists())
        (self.folder / "-").write_text("left = nonsense\n")  # a file of that name is no business of `--out -`
        again = self.run_program("calibrate", "--trace", trace, "--out", "-")
        self.assertEqual((again.stdout, again.stderr), (done.stdout, ""))
        out = self.folder / "mine.toml"
        done = self.run_program("calibrate", "--trace", trace, "--out", out)
        self.assertIn("left stick: good.", done.stdout)
        self.assertEqual(self.run_program("replay", trace, "--calibration", out).returncode, 0)
        self.assertFalse(self.own.exists())

    def test_imports_and_exports_other_tools_words(self):
        trace = self.trace(serial=SERIAL)
        line = self.run_program("calibrate", "--trace", trace, "--export-sdl").stdout
        self.assertIn("leftx:a0,", line)
        (self.folder / "jscal").write_text(
            "jscal -s 6,1,0,30000,35535,17895,17895,1,0,30000,35535,17895,17895,1,0,32767,32767,16384,16384,"
            "1,0,32767,32767,16384,16384,1,0,127,127,4227201,4227201,1,0,127,127,4227201,4227201 /dev/input/js0\n")
        done = self.run_program("calibrate", "--trace", trace, "--import", self.folder / "jscal")
        self.assertEqual(done.returncode, 0, done.stderr)
        left = tomllib.loads(self.written().read_text())["left"]
        self.assertGreater(left["inner"], 0.05)
        # A mapping names controls and leaves the zones as they were.
        (self.folder / "sdl").write_text(line.replace("leftx:a0,", "leftx:a2,").replace("rightx:a2,", "rightx:a0,"))
        done = self.run_program("calibrate", "--trace", trace, "--import", self.folder / "sdl")
        self.assertEqual(done.returncode, 0, done.stderr)
        own = tomllib.loads(self.written().read_text())
        self.assertEqual(own["left"], left)
        self.assertNotIn("measured_on", own)
        self.assertIn("leftx:a2,", own["mapping"])
        (self.folder / "junk").write_text("hello\n")
        self.refused("--trace", trace, "--import", self.folder / "junk", says="junk")

    def test_refusals_are_one_sentence_and_lose_nothing(self):
        good = self.trace(serial=SERIAL)
        self.calibrated("--trace", good)
        kept = self.written().read_text()
        damaged = self.folder / "damaged.hid"
        damaged.write_text(good.read_text().replace("E: 000001.000000 11", "E: 000001.000000 12", 1))
        self.refused("--trace", damaged, says="damaged.hid:")
        self.refused("--trace", self.folder / "none.hid", says="none.hid")
        self.refused("--trace", good, "--out", "/proc/mine.toml", says="/proc/mine.toml")
        self.refused("--trace", good, "--out", self.folder, says=str(self.folder))
        self.refused("--trace", good, "--plot", "/proc/mine.png", says="/proc/mine.png")
        self.refused("--trace", good, "--check", self.folder / "none.toml", says="none.toml")
        self.refused("--trace", good, environment={}, says="--out")
        full = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))
        self.refused("--trace", good, before=full, says=self.written().name)
        self.assertEqual(self.written().read_text(), kept)
        self.assertEqual(sorted(p.name for p in self.own.iterdir() if ".toml" not in p.name), [])

    def test_options_that_contradict_each_other_are_wrong_usage(self):
        trace = ("--trace", self.trace())
        for options in (("--trace", "a", "PAD"), ("--trace", "a", "--driver", "evdev"), ("--check", "a", "--out", "b"),
                        ("--import", "a", "--check", "b"), ("--import", "a", "--json"), ("--export-sdl", "--import", "a"),
                        ("--export-sdl", "--plot", "a.png"), ("--pushes", "forward,right"), (*trace, "--pushes", "up"),
                        (*trace, "--plot", "a.jpg"), (*trace, "--json", "--out", "-")):
            with self.subTest(options=options):
                self.assertEqual(self.run_program("calibrate", *options).returncode, 2)

    def test_a_damaged_file_of_its_own_is_told_and_replaced(self):
        trace = self.trace(serial=SERIAL)
        self.calibrated("--trace", trace)
        self.written().write_text("left = nonsense\n")
        done = self.run_program("calibrate", "--trace", trace)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(".toml:1", done.stderr)
        self.assertIn("left", tomllib.loads(self.written().read_text()))

    @unittest.skipUnless(SHARED.exists(), f"no recordings at {SHARED}")
    def test_a_real_stick_at_rest_never_walks(self):
        zones = self.folder / "zones.toml"
        turned = [SHARED / f"dualsense_usb_{side}_stick.hid" for side in ("left", "right")]
        done = self.run_program("calibrate", "--out", zones, *[a for t in turned for a in ("--trace", t)])
        self.assertEqual(done.returncode, 0, done.stderr)
        for path in sorted(SHARED.glob("dualsense_usb_*.hid")):
            if path in turned or path.name.endswith("rdesc.hid"):
                continue
            shown = self.run_program("replay", path, "--calibration", zones, "--out", self.folder / "walk")
            self.assertEqual(shown.returncode, 0, shown.stderr)
            rows = (self.folder / "walk/frames.csv").read_text().splitlines()
            if not any(name in path.name for name in ("_l1", "_l3")):
                self.assertEqual({tuple(row.split(",")[2:4]) for row in rows[1:]}, {("0.000000000", "0.000000000")}, path.name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
