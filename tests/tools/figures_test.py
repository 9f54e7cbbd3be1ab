#!/usr/bin/python3
"""gaitpad figures: its files, the contract of CSV and claims.json, and several claims reckoned again
from the CSVs alone."""
import csv
import json
import math
import os
import pathlib
import struct
import sys
import tempfile
import time
import unittest
import zlib

from program import PROGRAM, ROOT, run

MOCAP = ROOT.parent / "shared" / "data" / "mocap"
FIGURES = ("figure2", "figure3", "figure4", "figure5a", "figure5b", "figure5a_paper", "figure5b_paper")
STYLES = {"figure5a": ("even", "stiff_hip", "stiff_knee"),
          "figure5b": ("limp_left", "limp_left_hip", "limp_left_knee")}
MODES = {"robust": "", "paper": "_paper"}
LIMIT_S = 30.0


def figures(*arguments):
    return run("figures", *arguments)


def columns_of(path):
    """Name -> numbers; words stay words."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    found = {}
    for i, name in enumerate(rows[0]):
        cells = [row[i] for row in rows[1:]]
        try:
            found[name] = [float(c) for c in cells if c != ""]
        except ValueError:
            found[name] = cells
    return found


def colours_of(path):
    """How many pixels of each colour a PNG of 8-bit RGB has, by its specification."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    place, packed = 8, b""
    while place < len(data):
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour_type = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        place += 12 + size
    assert (depth, colour_type) == (8, 2), (depth, colour_type)
    raw, row = zlib.decompress(packed), 3 * width
    before, found = bytearray(row), {}
    for y in range(height):
        line = unfiltered(raw[y * (row + 1)], bytearray(raw[y * (row + 1) + 1:(y + 1) * (row + 1)]), before)
        if y % 7 == 0:
            for x in range(0, row, 3):
                pixel = bytes(line[x:x + 3])
                found[pixel] = found.get(pixel, 0) + 1
        before = line
    return width, height, found


def unfiltered(kind, line, up):
    if kind == 0:
        return line
    for i, value in enumerate(line):
        a, b, c = (line[i - 3] if i >= 3 else 0), up[i], (up[i - 3] if i >= 3 else 0)
        if kind == 4:
            guess = a + b - c
            best = min((abs(guess - a), 0, a), (abs(guess - b), 1, b), (abs(guess - c), 2, c))
            line[i] = (value + best[2]) & 255
        else:
            line[i] = (value + (a if kind == 1 else b if kind == 2 else (a + b) // 2)) & 255
    return line


def spread(values):
    return max(values) - min(values)


def rms(a, b):
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)) / len(a))


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.scratch.name) / "new" / "folder"
        began = time.monotonic()
        cls.done = figures("--out", cls.out)
        cls.time_s = time.monotonic() - began
        if cls.done.returncode == 0:
            cls.json = json.loads((cls.out / "claims.json").read_text())
            cls.csv = {name: columns_of(cls.out / f"{name}.csv") for name in FIGURES}

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def claim(self, name, mode):
        found = [c for c in self.json["claims"] if c["name"] == name and c["mode"] == mode]
        self.assertEqual(len(found), 1, (name, mode))
        return found[0]

    def assert_claim(self, name, mode, value, delta=1e-5):
        self.assertAlmostEqual(self.claim(name, mode)["value"], value, delta=delta, msg=(name, mode))

    def test_runs_in_time_and_leaves_exactly_its_files(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        if b"__asan_init" not in pathlib.Path(PROGRAM).read_bytes():  # the sanitizers take their time
            self.assertLess(self.time_s, LIMIT_S)
        wanted = {f"{name}.{ending}" for name in FIGURES for ending in ("png", "csv")} | {"claims.json"}
        self.assertEqual(set(os.listdir(self.out)), wanted)

    def test_claims_hold_the_contract(self):
        self.assertEqual(self.json["motion"], "procedural")
        numbers = set()
        for claim in self.json["claims"]:
            self.assertLessEqual({"name", "section", "mode", "value", "bound", "pass"}, set(claim))
            self.assertIn(claim["mode"], ("paper", "robust"))
            self.assertRegex(claim["name"], r"^\d+ ")
            numbers.add(int(claim["name"].split()[0]))
            if not claim["pass"]:
                self.assertTrue(claim.get("note"), claim)
            if claim["pass"] is None:
                self.assertIsNone(claim["value"])
            elif claim["value"] is not None:
                self.assertEqual(claim["pass"], self.judged(claim), claim)
        self.assertEqual(numbers, set(range(1, 31)))

    def judged(self, claim):
        value, bound = claim["value"], claim["bound"]
        if ".." in bound:
            low, high = map(float, bound.split(" .. "))
            return low - 1e-4 * abs(low) <= value <= high + 1e-4 * abs(high)  # six digits are printed
        sign, limit = bound.split()
        limit = float(limit)
        return {"<=": value <= limit, "<": value < limit, ">=": value >= limit, ">": value > limit,
                "==": value == limit}[sign]

    def test_summary_counts_by_mode(self):
        for mode in MODES:
            passed = sum(c["pass"] is True and c["mode"] == mode for c in self.json["claims"])
            broken = sum(c["pass"] is False and c["mode"] == mode for c in self.json["claims"])
            self.assertIn(f"{mode:<6} mode: {passed} pass, {broken} fail", self.done.stdout)

    def test_figure_5_has_the_contracts_columns_over_one_stride(self):
        for figure, styles in STYLES.items():
            for suffix in MODES.values():
                table = self.csv[figure + suffix]
                self.assertEqual(next(iter(table)), "time_s")
                for style in styles:
                    for side in ("left", "right"):
                        for joint in ("hip", "knee", "ankle"):
                            self.assertIn(f"{style}_{side}_{joint}_deg", table)
                        for point in ("heel", "toe"):
                            for axis in "xyz":
                                self.assertIn(f"{style}_{side}_{point}_{axis}_m", table)
                time_s = table["time_s"]
                self.assertEqual(time_s[0], 0.0)
                self.assertTrue(all(abs(b - a - 1 / 240) < 1e-6 for a, b in zip(time_s, time_s[1:])))
                self.assertTrue(0.7 < time_s[-1] < 1.6)
                self.assertTrue(all(len(v) == len(time_s) for v in table.values()))

    def test_figure_5a_s_claims_follow_from_its_csv(self):
        for mode, suffix in MODES.items():
            t = self.csv["figure5a" + suffix]
            hip = {s: [rms(t[f"even_{side}_hip_deg"], t[f"{s}_{side}_hip_deg"]) for side in ("left", "right")]
                   for s in ("stiff_hip", "stiff_knee")}
            self.assert_claim("13 RMS change of the hip of stiff_hip against even, deg", mode, min(hip["stiff_hip"]))
            worst = max(hip["stiff_knee"], key=lambda v: abs(v - 0.85))
            self.assert_claim("14 RMS change of the hip of stiff_knee against even, deg", mode, worst)
            ratio = max(spread(t[f"stiff_hip_{s}_hip_deg"]) / spread(t[f"even_{s}_hip_deg"]) for s in ("left", "right"))
            self.assert_claim("13 hip range of stiff_hip over even", mode, ratio)
            self.assert_claim("13 least knee angle of stiff_hip, deg", mode,
                              min(t["stiff_hip_left_knee_deg"] + t["stiff_hip_right_knee_deg"]))
            self.assert_claim("16 swinging heels differ, mm", mode, self.heels_apart_mm(t), delta=2e-5)

    def heels_apart_mm(self, t):
        most = 0.0
        for side in ("left", "right"):
            for style in ("stiff_hip", "stiff_knee"):
                for k, flies in enumerate(t[f"{side}_in_flight"]):
                    if flies:
                        gap = math.dist(*([t[f"{s}_{side}_heel_{a}_m"][k] for a in "xyz"] for s in ("even", style)))
                        most = max(most, 1000 * gap)
        return most

    def test_figure_5b_s_claims_follow_from_its_csv(self):
        for mode, suffix in MODES.items():
            t = self.csv["figure5b" + suffix]
            self.assert_claim("20 left hip's range of limp_left_hip over limp_left", mode,
                              spread(t["limp_left_hip_left_hip_deg"]) / spread(t["limp_left_left_hip_deg"]))
            apart = max(abs(a - b) for s in ("limp_left_hip", "limp_left_knee") for j in ("hip", "knee", "ankle")
                        for a, b in zip(t[f"limp_left_right_{j}_deg"], t[f"{s}_right_{j}_deg"]))
            self.assertLessEqual(apart, self.claim("20 right leg's angles change by, deg", mode)["value"] + 1e-5)
            self.assertLessEqual(apart, 1.0)

    def test_figure_4_moves_the_root_less_and_the_second_joint_more(self):
        t = self.csv["figure4"]
        for mode in MODES:
            change = {w: [abs(t[f"{mode}_root_weight_{w}_joint_{j}_deg"][-1] - t[f"{mode}_root_weight_{w}_joint_{j}_deg"][0])
                          for j in (1, 2)] for w in ("1", "0.2")}
            self.assert_claim("10 root's change at weight 0.2 over even", mode, change["0.2"][0] / change["1"][0])
            self.assert_claim("10 second joint's change at root weight 0.2 over even", mode,
                              change["0.2"][1] / change["1"][1], delta=1e-4)
            for weight in ("1", "0.2"):
                self.assertLess(self.end_off_goal(t, f"{mode}_root_weight_{weight}"), 2e-5)

    def end_off_goal(self, t, stem):
        """The chain's end by its own forward kinematics: both modes and weights reach one place."""
        def end(columns):
            angle, place = 0.0, [0.0, 0.0]
            for joint in range(1, 5):
                angle += math.radians(t[f"{columns}_joint_{joint}_deg"][-1])
                place = [place[0] + 0.25 * math.cos(angle), place[1] + 0.25 * math.sin(angle)]
            return place
        return math.dist(end(stem), end("paper_root_weight_0.1"))

    def test_figure_3_plants_the_points_of_table_1(self):
        t = self.csv["figure3"]
        planted = {}
        for time_s, stage, swing, point, stands in zip(t["time_s"], t["stage"], t["swing"], t["point"], t["planted"]):
            planted.setdefault((time_s, stage, swing), set()).update({point} if stands else set())
        self.assertEqual([(k[1:], v) for k, v in planted.items()], [
            (("flight", "right"), {"left_heel", "left_toe", "right_toe"}),
            (("roll", "right"), {"left_toe", "right_heel"}),
            (("flight", "left"), {"right_heel", "right_toe", "left_toe"}),
            (("roll", "left"), {"right_toe", "left_heel"})])

    def test_figure_2_s_targets_lie_in_their_bands(self):
        t = self.csv["figure2"]
        height, low, high = t["right_ankle_height_m"], t["low_threshold_m"][0], t["high_threshold_m"][0]
        self.assertAlmostEqual(low, min(height) + 0.1 * spread(height), delta=1e-8)
        place = {int(v): k for k, v in enumerate(t["paper_target"]) if v}
        self.assertTrue(place[1] < place[2] < place[3])
        self.assertTrue(height[place[1]] <= low and height[place[2]] >= high and height[place[3]] <= low)

    def test_pictures_show_something_in_the_papers_colours(self):
        for name in FIGURES:
            width, height, found = colours_of(self.out / f"{name}.png")
            self.assertGreaterEqual(width * height, 1000 * 600)
            self.assertGreater(len(found), 20, name)
            self.assertLess(max(found.values()), 0.97 * sum(found.values()), name)
        for name in ("figure5a", "figure5b", "figure5a_paper"):
            found = colours_of(self.out / f"{name}.png")[2]
            for colour in (b"\xc6\x28\x28", b"\x2e\x8b\x3d", b"\x1f\x5f\xbf"):
                self.assertGreater(found.get(colour, 0), 100, (name, colour))

    def test_is_the_same_again_but_for_times(self):
        with tempfile.TemporaryDirectory() as other:
            self.assertEqual(figures("--out", other).returncode, 0)
            for name in FIGURES:
                for ending in ("png", "csv"):
                    self.assertEqual((self.out / f"{name}.{ending}").read_bytes(),
                                     (pathlib.Path(other) / f"{name}.{ending}").read_bytes(), name)
            again = json.loads((pathlib.Path(other) / "claims.json").read_text())
            timeless = lambda claims: [c for c in claims if not c["name"].startswith("21 ")]
            self.assertEqual(timeless(self.json["claims"]), timeless(again["claims"]))

    def test_failures_are_one_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            done = figures("--out", folder, "--motion", "/none.bvh")
            self.assertEqual((done.returncode, os.listdir(folder)), (1, []))
            self.assertEqual(len(done.stderr.strip().splitlines()), 1)
            self.assertIn("/none.bvh", done.stderr)
            blocked = pathlib.Path(folder) / "file"
            blocked.write_text("")
            done = figures("--out", blocked / "below")
            self.assertEqual(done.returncode, 1)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1)
        self.assertEqual(figures().returncode, 2)

    def test_captured_motions_get_nulls_with_reasons(self):
        if not MOCAP.exists():
            self.skipTest(f"no {MOCAP}")
        with tempfile.TemporaryDirectory() as folder:
            done = figures("--out", folder, "--motion", MOCAP / "cmu_m21_walk.bvh", "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            claims = json.loads(done.stdout)
            self.assertEqual(claims, json.loads((pathlib.Path(folder) / "claims.json").read_text()))
            untested = [c for c in claims["claims"] if c["pass"] is None]
            self.assertTrue(any(c["name"].startswith("24 mirrored") for c in untested))
            self.assertTrue(all(c["value"] is None and c["note"] for c in untested))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
