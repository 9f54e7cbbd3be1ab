"""gaitpad figures: its files, the contract of CSV and claims.json, and several claims computed again from only the
CSVs."""
import csv
import json
import math
import os
import re
import resource

import numpy as np
import pytest

from support import slices
from support.pictures import pixels
from support.program import DATA, has_sanitizers

MOCAP = DATA / "mocap"
FIGURES = ("figure2", "figure3", "figure4", "figure5a", "figure5b", "figure5a_paper", "figure5b_paper")
STYLES = {"figure5a": ("even", "stiff_hip", "stiff_knee"),
          "figure5b": ("limp_left", "limp_left_hip", "limp_left_knee")}
MODES = {"robust": "", "paper": "_paper"}
LIMIT_S = 30.0


def columns_of(path):
    """The columns, name -> numbers; words stay words."""
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
    """The size and colours of a PNG of 8-bit RGB: (width, height, pixels of each colour in every seventh row)."""
    assert path.read_bytes()[24:26] == b"\x08\x02", "8 bits, RGB"
    picture = pixels(path)
    colours, counts = np.unique(picture[::7].reshape(-1, 3), axis=0, return_counts=True)
    return picture.shape[1], picture.shape[0], {tuple(map(int, c)): n for c, n in zip(colours, counts)}


def spread(values):
    return max(values) - min(values)


def rms(a, b):
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)) / len(a))


class Made:
    """A folder with the output of `gaitpad figures`."""

    def __init__(self, run, out):
        self.out = out
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.stdout = run("figures", "--out", out).stdout
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        self.json = json.loads((out / "claims.json").read_text())
        self.csv = {name: columns_of(out / f"{name}.csv") for name in FIGURES}

    def claim(self, name, mode):
        found = [c for c in self.json["claims"] if c["name"] == name and c["mode"] == mode]
        assert len(found) == 1, (name, mode)
        return found[0]

    def check(self, name, mode, value, delta=1e-5):
        assert self.claim(name, mode)["value"] == pytest.approx(value, abs=delta), (name, mode)


@pytest.fixture(scope="module")
def made(run, tmp_path_factory):
    return Made(run, tmp_path_factory.mktemp("figures") / "new/folder")


def test_runs_in_time_and_leaves_exactly_its_files(program, made):
    if not has_sanitizers(program):
        assert made.cpu_s < LIMIT_S
    wanted = {f"{name}.{ending}" for name in FIGURES for ending in ("png", "csv")} | {"claims.json"}
    assert set(os.listdir(made.out)) == wanted


def test_claims_hold_the_contract(made):
    assert made.json["motion"] == "procedural"
    numbers = set()
    for claim in made.json["claims"]:
        assert {"name", "section", "mode", "value", "bound", "pass"} <= set(claim)
        assert claim["mode"] in ("paper", "robust")
        assert re.search(r"^\d+ ", claim["name"])
        numbers.add(int(claim["name"].split()[0]))
        if not claim["pass"]:
            assert claim.get("note"), claim
        if claim["pass"] is None:
            assert claim["value"] is None
        elif claim["value"] is not None:
            assert claim["pass"] == judged(claim), claim
    assert numbers == set(range(1, 31))


def judged(claim):
    value, bound = claim["value"], claim["bound"]
    if ".." in bound:
        low, high = map(float, bound.split(" .. "))
        return low - 1e-4 * abs(low) <= value <= high + 1e-4 * abs(high)  # numbers are printed with six digits
    sign, limit = bound.split()
    limit = float(limit)
    return {"<=": value <= limit, "<": value < limit, ">=": value >= limit, ">": value > limit,
            "==": value == limit}[sign]


def test_summary_counts_by_mode(made):
    for mode in MODES:
        passed = sum(c["pass"] is True and c["mode"] == mode for c in made.json["claims"])
        broken = sum(c["pass"] is False and c["mode"] == mode for c in made.json["claims"])
        assert f"{mode:<6} mode: {passed} pass, {broken} fail" in made.stdout


def test_each_of_the_thirty_claims_has_a_line_and_each_failure_its_reason(made):
    lines = made.stdout.splitlines()
    numbers = [int(line.split()[0]) for line in lines if line[:1].isdigit()]
    assert numbers == list(range(1, 31))
    for claim in made.json["claims"]:
        told = [line for line in lines if line.startswith(f"FAIL  {claim['name']}, {claim['mode']} mode: ")]
        assert len(told) == (claim["pass"] is False), claim
        assert not told or told[0].endswith(claim["note"])
        [line] = [line for line in lines if line.split(" ")[0] == claim["name"].split(" ")[0]]
        assert claim["pass"] is not False or "FAIL" in line
    assert max(len(line) for line in lines if line[:1].isdigit()) <= 60
    assert "docs/paper.md" in lines[-1]


def test_figure_5_has_the_contracts_columns_over_one_stride(made):
    for figure, styles in STYLES.items():
        for suffix in MODES.values():
            table = made.csv[figure + suffix]
            assert next(iter(table)) == "time_s"
            for style in styles:
                for side in ("left", "right"):
                    for joint in ("hip", "knee", "ankle"):
                        assert f"{style}_{side}_{joint}_deg" in table
                    for point in ("heel", "toe"):
                        for axis in "xyz":
                            assert f"{style}_{side}_{point}_{axis}_m" in table
            time_s = table["time_s"]
            assert time_s[0] == 0.0
            assert all(abs(b - a - 1 / 240) < 1e-6 for a, b in zip(time_s, time_s[1:]))
            assert 0.7 < time_s[-1] < 1.6
            assert all(len(v) == len(time_s) for v in table.values())


@pytest.mark.parametrize("mode", MODES)
def test_figure_5a_s_claims_follow_from_its_csv(made, mode):
    t = made.csv["figure5a" + MODES[mode]]
    hip = {s: [rms(t[f"even_{side}_hip_deg"], t[f"{s}_{side}_hip_deg"]) for side in ("left", "right")]
           for s in ("stiff_hip", "stiff_knee")}
    made.check("13 RMS change of the hip of stiff_hip against even, deg", mode, min(hip["stiff_hip"]))
    worst = max(hip["stiff_knee"], key=lambda v: abs(v - 0.85))
    made.check("14 RMS change of the hip of stiff_knee against even, deg", mode, worst)
    ratio = max(spread(t[f"stiff_hip_{s}_hip_deg"]) / spread(t[f"even_{s}_hip_deg"]) for s in ("left", "right"))
    made.check("13 hip range of stiff_hip over even", mode, ratio)
    made.check("13 least knee angle of stiff_hip, deg", mode,
               min(t["stiff_hip_left_knee_deg"] + t["stiff_hip_right_knee_deg"]))
    made.check("16 heels differ in the second half of a flight, mm", mode, heels_apart_mm(t), delta=2e-5)


def heels_apart_mm(t):
    """In the second half of the flights of the figure's stride."""
    most = 0.0
    for side in ("left", "right"):
        flies = [bool(f) for f in t[f"{side}_in_flight"]]
        begins = [k for k in range(1, len(flies)) if flies[k] and not flies[k - 1]]
        for begin in begins:
            end = next((k for k in range(begin, len(flies)) if not flies[k]), len(flies))
            for k in range(begin + (end - begin + 1) // 2, end):
                for style in ("stiff_hip", "stiff_knee"):
                    gap = math.dist(*([t[f"{s}_{side}_heel_{a}_m"][k] for a in "xyz"] for s in ("even", style)))
                    most = max(most, 1000 * gap)
    return most


@pytest.mark.parametrize("mode", MODES)
def test_figure_5b_s_claims_follow_from_its_csv(made, mode):
    t = made.csv["figure5b" + MODES[mode]]
    made.check("20 left hip's range of limp_left_hip over limp_left", mode,
               spread(t["limp_left_hip_left_hip_deg"]) / spread(t["limp_left_left_hip_deg"]))
    apart = max(abs(a - b) for s in ("limp_left_hip", "limp_left_knee") for j in ("hip", "knee", "ankle")
                for a, b in zip(t[f"limp_left_right_{j}_deg"], t[f"{s}_right_{j}_deg"]))
    assert apart <= made.claim("20 right leg's angles change by, deg", mode)["value"] + 1e-5
    assert apart <= 1.0


def test_figure_4_moves_the_root_less_and_the_second_joint_more(made):
    t = made.csv["figure4"]
    for mode in MODES:
        change = {w: [abs(t[f"{mode}_root_weight_{w}_joint_{j}_deg"][-1] - t[f"{mode}_root_weight_{w}_joint_{j}_deg"][0])
                      for j in (1, 2)] for w in ("1", "0.2")}
        made.check("10 root's change at weight 0.2 over even", mode, change["0.2"][0] / change["1"][0])
        made.check("10 second joint's change at root weight 0.2 over even", mode,
                   change["0.2"][1] / change["1"][1], delta=1e-4)


def test_figure_3_plants_the_points_of_table_1(made):
    t = made.csv["figure3"]
    planted = {}
    for time_s, stage, swing, point, stands in zip(t["time_s"], t["stage"], t["swing"], t["point"], t["planted"]):
        planted.setdefault((time_s, stage, swing), set()).update({point} if stands else set())
    assert [(k[1:], v) for k, v in planted.items()] == [
        (("flight", "right"), {"left_heel", "left_toe", "right_toe"}),
        (("roll", "right"), {"left_toe", "right_heel"}),
        (("flight", "left"), {"right_heel", "right_toe", "left_toe"}),
        (("roll", "left"), {"right_toe", "left_heel"})]


def test_figure_2_s_targets_lie_in_their_bands(made):
    t = made.csv["figure2"]
    height, low, high = t["right_ankle_height_m"], t["low_threshold_m"][0], t["high_threshold_m"][0]
    assert low == pytest.approx(min(height) + 0.1 * spread(height), abs=1e-8)
    place = {int(v): k for k, v in enumerate(t["paper_target"]) if v}
    assert place[1] < place[2] < place[3]
    assert height[place[1]] <= low and height[place[2]] >= high and height[place[3]] <= low


def test_pictures_show_something_in_the_papers_colours(made):
    for name in FIGURES:
        width, height, found = colours_of(made.out / f"{name}.png")
        assert width * height >= 1000 * 600
        assert len(found) > 20, name
        assert max(found.values()) < 0.97 * sum(found.values()), name
    for name in ("figure5a", "figure5b", "figure5a_paper"):
        found = colours_of(made.out / f"{name}.png")[2]
        for colour in ((0xC6, 0x28, 0x28), (0x2E, 0x8B, 0x3D), (0x1F, 0x5F, 0xBF)):
            assert found.get(colour, 0) > 100, (name, colour)


@pytest.mark.skipif(not slices.is_chosen("figures, again", 4), reason=f"another slice runs it: {slices.text(4)}")
def test_is_the_same_again_but_for_times(run, made, tmp_path):
    again = Made(run, tmp_path)
    for name in FIGURES:
        for ending in ("png", "csv"):
            assert (made.out / f"{name}.{ending}").read_bytes() == (again.out / f"{name}.{ending}").read_bytes(), name
    timeless = lambda claims: [c for c in claims if not c["name"].startswith("21 ")]
    assert timeless(made.json["claims"]) == timeless(again.json["claims"])


def test_failures_are_one_sentence(run, refuse, tmp_path):
    refuse("figures", "--out", tmp_path, "--motion", "/none.bvh", says="/none.bvh")
    assert os.listdir(tmp_path) == []
    (tmp_path / "file").write_text("")
    refuse("figures", "--out", tmp_path / "file/below")
    run("figures", status=2)


@pytest.mark.skipif(not MOCAP.exists(), reason=f"there is no {MOCAP}")
@pytest.mark.skipif(not slices.is_chosen("figures, captured", 4), reason=f"another slice runs it: {slices.text(4)}")
def test_captured_motions_get_nulls_with_reasons(run, tmp_path):
    done = run("figures", "--out", tmp_path, "--motion", MOCAP / "cmu_m21_walk.bvh", "--json")
    claims = json.loads(done.stdout)
    assert claims == json.loads((tmp_path / "claims.json").read_text())
    untested = [c for c in claims["claims"] if c["pass"] is None]
    assert any(c["name"].startswith("24 mirrored") for c in untested)
    assert all(c["value"] is None and c["note"] for c in untested)
