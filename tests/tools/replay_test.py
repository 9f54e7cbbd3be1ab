#!/usr/bin/python3
"""gaitpad replay as a user meets it: what it writes, when an event counts, and what it refuses."""
import csv
import json
import os
import resource
import subprocess
import sys
import unittest
import unittest.mock

from program import FolderCase, PROGRAM, run

RATE_HZ = 240
COLUMNS = (
    "tick,time_s,stick_x,stick_y,stride_left_m,stride_right_m,speed_m_s,turn_rate_rad_s,heading_rad,"
    "root_x_m,root_y_m,root_z_m,stage,swing,left_heel_planted,left_toe_planted,right_heel_planted,"
    "right_toe_planted,left_heel_x_m,left_heel_y_m,left_heel_z_m,left_toe_x_m,left_toe_y_m,left_toe_z_m,"
    "right_heel_x_m,right_heel_y_m,right_heel_z_m,right_toe_x_m,right_toe_y_m,right_toe_z_m,"
    "left_ik_iterations,right_ik_iterations,left_ik_error_m,right_ik_error_m"
)
DESCRIPTOR = (
    "05 01 09 05 a1 01 15 00 26 ff 00 75 08 95 04 09 30 09 31 09 32 09 35 81 02 "
    "05 09 15 00 25 01 75 01 95 08 19 01 29 08 81 02 c0"
).split()
HEADER = f"R: {len(DESCRIPTOR)} {' '.join(DESCRIPTOR)}\nN: Made Pad\nI: 3 1209 0001\n"


def report(seconds, x=0x80, y=0x80):
    return f"E: {seconds:013.6f} 5 {x:02x} {y:02x} 80 80 00\n"


def end(seconds):
    return f"Q: {seconds:013.6f} {round(seconds * RATE_HZ)}\n"


class ReplayCase(FolderCase):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return str(self.folder / name)

    def run_program(self, trace_text, *options):
        trace = self.write("made.hid", trace_text)
        return run("replay", trace, "--out", self.out, *options)

    def replay(self, trace_text, *options):
        """Rows of frames.csv and the summary."""
        done = self.run_program(trace_text, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.out / "frames.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        return rows, json.loads((self.out / "summary.json").read_text())

    def assert_refused(self, trace_text, *options, says=(), status=1):
        done = self.run_program(trace_text, *options)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        for part in says:
            self.assertIn(part, done.stderr)


WALK = HEADER + report(0) + report(0.5, y=0x10) + report(3, x=0x40, y=0x10) + report(6) + end(7)


class Files(ReplayCase):
    def test_columns_rows_and_poses_are_those_of_the_contract(self):
        rows, summary = self.replay(WALK)
        lines = (self.out / "frames.csv").read_text().splitlines()
        self.assertEqual(lines[0], COLUMNS + ",left_heel_ground_m,left_toe_ground_m,right_heel_ground_m,right_toe_ground_m")
        self.assertEqual(len(rows), 7 * RATE_HZ)
        self.assertEqual(summary["ticks"], 7 * RATE_HZ)
        self.assertRegex(summary["pose_hash"], "^[0-9a-f]{16}$")
        self.assertEqual([int(r["tick"]) for r in rows], list(range(7 * RATE_HZ)))
        self.assertTrue(all(abs(float(r["time_s"]) - k / RATE_HZ) < 1e-8 for k, r in enumerate(rows)))
        self.assertEqual(sorted(p.name for p in self.out.iterdir()),
                         ["frames.csv", "pose.bvh", "summary.json"])

    def test_row_and_pose_of_a_tick_are_the_same(self):
        rows, _ = self.replay(WALK)
        text = (self.out / "pose.bvh").read_text().splitlines()
        motion = text.index("MOTION")
        self.assertEqual(text[motion + 1].split(), ["Frames:", str(len(rows))])
        poses = text[motion + 3:]
        self.assertEqual(len(poses), len(rows))
        for row, pose in zip(rows[::97], poses[::97]):
            root = [float(v) for v in pose.split()[:3]]
            for value, axis in zip(root, "xyz"):
                self.assertAlmostEqual(value, float(row[f"root_{axis}_m"]), places=6)

    def test_fps_thins_out_poses_alone(self):
        for fps, expected in ((60, 7 * 60), (50, 7 * 50), (240, 7 * 240)):
            rows, _ = self.replay(WALK, "--fps", str(fps))
            text = (self.out / "pose.bvh").read_text()
            self.assertEqual(len(rows), 7 * RATE_HZ)
            self.assertIn(f"Frames: {expected}", text)
            self.assertEqual(len(text.split("Frame Time:")[1].splitlines()) - 1, expected)
        self.assert_refused(WALK, "--fps", "241", says=("241",))

    def test_further_characters_have_numbered_files_and_one_hash(self):
        self.replay(WALK, "--character", "adult", "--character", "child", "--style", "even",
                    "--style", "limp_left", "--style", "tired")
        summaries = [json.loads((self.out / f"summary{n}.json").read_text()) for n in ("", "-2", "-3")]
        self.assertEqual(len({s["pose_hash"] for s in summaries}), 1)
        self.assertLess(summaries[1]["leg_length_m"], summaries[0]["leg_length_m"])
        self.assertEqual(summaries[2]["leg_length_m"], summaries[1]["leg_length_m"])  # the last repeats
        self.assertTrue((self.out / "pose-3.bvh").exists() and (self.out / "frames-3.csv").exists())

    def test_the_same_trace_gives_the_same_files(self):
        self.replay(WALK)
        first = {p.name: p.read_bytes() for p in self.out.iterdir()}
        self.replay(WALK)
        self.assertEqual(first, {p.name: p.read_bytes() for p in self.out.iterdir()})

    def test_json_is_the_summary(self):
        done = self.run_program(WALK, "--json")
        self.assertEqual(json.loads(done.stdout), json.loads((self.out / "summary.json").read_text()))

    def test_a_mirrored_stick_mirrors_the_heading_at_every_tick(self):
        left, _ = self.replay(HEADER + report(0, x=0x30, y=0x20) + end(6))
        right, _ = self.replay(HEADER + report(0, x=0xCF, y=0x20) + end(6))
        for a, b in zip(left, right):
            self.assertAlmostEqual(float(a["heading_rad"]), -float(b["heading_rad"]), places=8)
        self.assertGreater(float(left[-1]["heading_rad"]), 0.5)
        self.assertLess(float(left[-1]["stick_x"]), 0)


class Ticks(ReplayCase):
    def first_tick_with_stick(self, rows):
        return next(k for k, row in enumerate(rows) if float(row["stick_y"]) > 0.5)

    def test_an_event_belongs_to_the_first_tick_that_starts_at_or_after_it(self):
        # Tick 24 starts at exactly 0.1 s; a microsecond later the next one has to take the report.
        for seconds, tick in ((0.1, 24), (0.100001, 25), (0.099999, 24)):
            rows, _ = self.replay(HEADER + report(0) + report(seconds, y=0) + end(1))
            self.assertEqual(self.first_tick_with_stick(rows), tick)

    def test_ticks_count_from_the_first_event(self):
        rows, _ = self.replay(HEADER + report(5) + report(5.1, y=0))
        self.assertEqual(self.first_tick_with_stick(rows), 24)
        # without Q: one second after the last event
        self.assertIn(len(rows), (round(1.1 * RATE_HZ), round(1.1 * RATE_HZ) + 1))

    def test_tick_lines_overrule_times(self):
        rows, _ = self.replay(f"V: 1 rate_hz={RATE_HZ}\n" + HEADER + "T: 0\n" + report(0) + "T: 100\n" +
                              report(0.1, y=0) + end(1))
        self.assertEqual(self.first_tick_with_stick(rows), 100)

    def test_the_rate_of_the_trace_holds(self):
        trace = "V: 1 rate_hz=120\n" + HEADER + report(0) + "Q: 000001.000000 120\n"
        rows, summary = self.replay(trace)
        self.assertEqual((len(rows), summary["rate_hz"]), (120, 120))
        self.assert_refused(trace, "--rate", "240", says=("120", "240"))

    def test_a_style_command_counts_from_its_tick_on(self):
        trace = HEADER + report(0, y=0x10) + "C: 000003.000000 style limp_left\n" + end(7)
        rows, summary = self.replay(trace)
        self.assertEqual(summary["style"], "limp_left")
        before, after = rows[700], rows[-1]
        self.assertAlmostEqual(float(before["stride_left_m"]) / float(before["stride_right_m"]), 1, 2)
        self.assertAlmostEqual(float(after["stride_left_m"]) / float(after["stride_right_m"]), 0.5, 2)

    def test_an_unknown_command_is_counted(self):
        _, summary = self.replay(HEADER + report(0) + "C: 000000.500000 style none\n" + end(1))
        self.assertEqual(summary["bad_commands"], 1)

    def test_an_unplugged_pad_is_neutral_until_seen_near_its_centre_again(self):
        rows, _ = self.replay(HEADER + report(0, y=0) + "H: 000001.000000 remove\n" +
                              "H: 000002.000000 add\n" + report(2.5, y=0) + report(3) +
                              report(3.5, y=0) + end(4))
        stick = [float(row["stick_y"]) for row in rows]
        self.assertTrue(all(y > 0.9 for y in stick[:240]))
        self.assertTrue(all(y == 0 for y in stick[240:840]))
        self.assertTrue(all(y > 0.9 for y in stick[840:]))

    def test_the_calibration_of_the_recording_counts_unless_another_is_given(self):
        carried = HEADER + "K: [left]\nK: outer = 0.5\n" + report(0, y=0x38) + end(0.5)
        full, _ = self.replay(carried)
        self.assertGreater(float(full[-1]["stick_y"]), 0.99)
        own = self.write("own.toml", "[left]\nouter = 0.9\n")
        part, _ = self.replay(carried, "--calibration", own)
        self.assertLess(float(part[-1]["stick_y"]), 0.7)

    def test_short_reports_are_counted_and_change_nothing(self):
        rows, summary = self.replay(HEADER + report(0, y=0) + "E: 000000.500000 2 80 80\n" + end(1))
        self.assertEqual((summary["reports"], summary["bad_reports"]), (2, 1))
        self.assertGreater(float(rows[-1]["stick_y"]), 0.9)


class Refusals(ReplayCase):
    def test_damaged_traces_name_file_and_line(self):
        cases = {
            "cut in a report": HEADER + report(0) + "E: 000000.100000 5 80 80\n",
            "longer than it says": HEADER + report(0) + "E: 000000.100000 2 80 80 80\n",
            "not hexadecimal": HEADER + report(0) + "E: 000000.100000 5 80 8x 80 80 00\n",
            "time goes back": HEADER + report(1) + report(0.5),
            "a gap of eleven minutes": HEADER + report(0) + report(660),
        }
        for name, trace in cases.items():
            with self.subTest(name):
                self.assert_refused(trace, says=("made.hid:5",))
        self.assert_refused(HEADER.replace(f"R: {len(DESCRIPTOR)}", "R: 99") + report(0), says=("made.hid:1",))
        self.assertFalse(self.out.exists())

    def test_lenient_skips_and_counts_damaged_lines(self):
        trace = HEADER + report(0) + "E: 000000.100000 5 80 80\n" + report(0.2) + end(1)
        _, summary = self.replay(trace, "--lenient")
        self.assertEqual((summary["damaged_lines"], summary["reports"]), (1, 2))

    def test_lying_descriptors(self):
        cut = DESCRIPTOR[:20] + ["26", "ff"]
        self.assert_refused(f"R: {len(cut)} {' '.join(cut)}\nN: Made Pad\nI: 3 1209 0001\n" + report(0),
                            says=("made.hid: device 0: Made Pad",))

    def test_a_device_that_is_no_pad(self):
        keyboard = [b if k != 3 else "06" for k, b in enumerate(DESCRIPTOR)]
        self.assert_refused(f"R: {len(keyboard)} {' '.join(keyboard)}\n" + report(0), says=("pad",))

    def test_styles_and_characters(self):
        weight = self.write("heavy.toml", "[legs]\nweight = { hip = 1.5 }\n")
        key = self.write("odd.toml", "fatigeu = 0.2\n")
        self.assert_refused(WALK, "--style", weight, says=("heavy.toml:2",))
        self.assert_refused(WALK, "--style", key, says=("odd.toml:1", "fatigeu"))
        self.assert_refused(WALK, "--style", "moonwalk", says=("moonwalk", "limp_left"))
        self.assert_refused(WALK, "--character", key, says=("odd.toml:1",))
        self.assert_refused(WALK, "--calibration", key, says=("odd.toml:1",))
        self.assert_refused(WALK, "--map", key, says=("odd.toml",))
        self.assertFalse(self.out.exists())

    def test_motions(self):
        legless = self.write("legless.bvh", "HIERARCHY\nROOT a\n{\n\tOFFSET 0 0 0\n\tCHANNELS 3 Xrotation "
                             "Yrotation Zrotation\n\tEnd Site\n\t{\n\t\tOFFSET 0 1 0\n\t}\n}\nMOTION\n"
                             "Frames: 1\nFrame Time: 0.01\n0 0 0\n")
        self.assert_refused(WALK, "--motion", legless, says=("legless.bvh", "legs"))
        self.assert_refused(WALK, "--motion", str(self.folder / "none.bvh"), says=("none.bvh",))

    def test_a_file_beside_a_motion_says_its_unit_and_legs(self):
        notes = self.write("notes.toml", 'file = "none.bvh"\nmetres_per_unit = 0.01\n')
        self.assert_refused(WALK, "--motion", notes, says=("none.bvh",))
        notes = self.write("notes.toml", 'file = "none.bvh"\n[left_leg]\nhipp = "a"\n')
        self.assert_refused(WALK, "--motion", notes, says=("notes.toml:3", "hipp"))
        self.assert_refused(WALK, "--motion", self.write("empty.toml", ""), says=("empty.toml", "file"))

    def test_a_character_brings_its_own_skeleton(self):
        # The program's own pose, twice as large, as a stranger's file.
        self.replay(HEADER + report(0) + end(0.1), "--character", self.write("twice.toml", "scale = 2\n"))
        (self.out / "pose.bvh").rename(self.folder / "giant.bvh")
        _, summary = self.replay(WALK, "--character", self.write("giant.toml", 'skeleton = "giant.bvh"\n'))
        self.assertEqual(summary["ik_failures"], 0)
        self.assertAlmostEqual(summary["source_leg_length_m"], 0.84)
        self.assertAlmostEqual(summary["metres_per_unit"], 1.0)
        self.assertEqual(summary["motion"], "procedural")
        self.assertGreater(summary["steps_left"], 3)

    def test_a_character_whose_skeleton_is_none(self):
        self.assert_refused(WALK, "--character", self.write("a.toml", 'skeleton = "none.bvh"\n'),
                            says=("none.bvh", "no such file"))
        self.write("pole.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n"
                               "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n0 0 0\n")
        self.assert_refused(WALK, "--character", self.write("a.toml", 'skeleton = "pole.bvh"\n'),
                            says=("pole.bvh", "no two legs"))

    def test_terrains_are_read_strictly_and_a_window_needs_a_display(self):
        self.assert_refused(WALK, "--terrain", "steps", says=("steps", "stairs"))
        broken = self.write("broken.toml", '[[section]]\nkind = "hole"\n')
        self.assert_refused(WALK, "--terrain", broken, says=("broken.toml:2:", "hole"))
        with unittest.mock.patch.dict(os.environ, {"SDL_VIDEODRIVER": "x11", "DISPLAY": ""}):
            self.assert_refused(WALK, "--view", says=("window",))
        flat, without = self.replay(WALK, "--terrain", "flat")[1], self.replay(WALK)[1]
        self.assertEqual(flat, without)
        self.assertEqual((flat["terrain"], flat["terrain_scale"]), ("flat", 1))

    def test_the_ground_grows_where_the_longest_foot_does_not_fit_its_treads(self):
        long_legs = self.write("long.toml", "leg_ratio = 1.5")
        summary = self.replay(WALK, "--terrain", "stairs", "--character", "adult",
                              "--character", long_legs)[1]
        self.assertEqual(summary["terrain"], "stairs")
        self.assertAlmostEqual(summary["terrain_scale"], 1.5, 9)
        summary = self.replay(WALK, "--terrain", "stairs", "--character", "child")[1]
        self.assertEqual(summary["terrain_scale"], 1)

    def test_an_unwritable_folder(self):
        self.write("file", "")
        self.out = self.folder / "file" / "out"
        self.assert_refused(WALK, says=("file/out",))

    def test_too_large_a_file_is_a_failed_write(self):
        limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
        done = subprocess.run([PROGRAM, "replay", self.write("made.hid", WALK), "--out", str(self.out)],
                              capture_output=True, text=True, check=False, preexec_fn=limited)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("cannot be written", done.stderr)
        self.assertEqual(list(self.out.iterdir()), [])

    def test_a_failure_leaves_the_files_of_an_earlier_run(self):
        self.replay(WALK)
        before = {p.name: p.read_bytes() for p in self.out.iterdir()}
        (self.out / "summary-2.json").mkdir()
        self.assert_refused(WALK, "--character", "child", "--character", "tall", says=("summary-2.json",))
        (self.out / "summary-2.json").rmdir()
        self.assert_refused(WALK[:-40] + "\n")
        self.assertEqual(before, {p.name: p.read_bytes() for p in self.out.iterdir()})

    def test_wrong_usage_is_2(self):
        for options in (["--speed", "3"], ["--ik", "magic"], ["--rate", "0"]):
            self.assertEqual(self.run_program(WALK, *options).returncode, 2, options)
        for arguments in ([], ["dance"], ["replay"]):
            done = subprocess.run([PROGRAM, *arguments], capture_output=True, check=False)
            self.assertEqual(done.returncode, 2, arguments)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
