"""gaitpad check: recordings judged against expectations, renewed, sharded, and told apart."""
import json
import math
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from support.bvh import angle_between, local_rotations, read_bvh, write_bvh
from support.program import ROOT, ROUND
from support.traces import EXACT_CALIBRATION, RATE_HZ, raw_stick, report, stick_report, write_trace

RECORDINGS = 8


def tap(text):
    """[(is met, path, {message, details} or None)] of a TAP plan of `count`."""
    lines = text.splitlines()
    assert lines[0] == "TAP version 14" and re.fullmatch(r"1\.\.\d+", lines[1])
    results = []
    for line in lines[2:]:
        if found := re.fullmatch(r"(not )?ok (\d+) - (.*)", line):
            assert int(found[2]) == len(results) + 1
            results.append([not found[1], found[3], {"message": "", "details": []}])
        elif found := re.fullmatch(r"  message: (.*)", line):
            results[-1][2]["message"] = json.loads(found[1])
        elif found := re.fullmatch(r"    - (.*)", line):
            results[-1][2]["details"].append(json.loads(found[1]))
        elif line.startswith("# "):
            results[-1][2]["details"].append(line[2:])
        else:
            assert line in ("  ---", "  details:", "  ..."), line
    assert lines[1] == f"1..{len(results)}"
    return results


def walk(path, forward=0.8, side=0.0, seconds=4.0, end_s=6.0):
    path.parent.mkdir(parents=True, exist_ok=True)
    return write_trace(path, [(0.5, *raw_stick(side, forward)), (seconds, 0, 0)], end_s=end_s)


@pytest.fixture
def one(tmp_path, run):
    """A recording with its expectation."""
    trace = walk(tmp_path / "one.hid")
    run("check", "--update", trace)
    return trace


@pytest.fixture(scope="module")
def many(tmp_path_factory, run):
    folder = tmp_path_factory.mktemp("many")
    for i in range(RECORDINGS):
        walk(folder / f"{'ab'[i % 2]}/walk{i:02}.hid", 0.4 + 0.03 * i, 0.02 * i)
    run("check", "--update", folder)
    return folder


def edit(path, pattern, replacement):
    text, count = re.subn(pattern, replacement, path.read_text(), flags=re.M)
    assert count > 0, f"{pattern} is not in {path}"
    path.write_text(text)


def expectation(trace):
    return trace.with_suffix(".expect.toml")


# ---- met and not met -------------------------------------------------------------------------
def test_what_was_written_is_met(many, run):
    results = tap(run("check", many).stdout)
    assert len(results) == RECORDINGS and all(met for met, *_ in results)
    assert [path for _, path, _ in results] == sorted(path for _, path, _ in results)


def test_the_hash_is_that_of_replay_with_the_same_options(run, tmp_path):
    source = tmp_path / "walked"
    run("replay", ROUND, "--out", source)
    trace = walk(tmp_path / "set/one.hid")
    expectation(trace).write_text('[replay]\nmotion = "../walked/pose.bvh"\ncharacter = ["child", "tall"]\n'
                                  'style = ["limp_left"]\nterrain = "stairs"\npace = "adult"\n')
    run("check", "--update", trace)
    done = run("replay", trace, "--motion", source / "pose.bvh", "--character", "child", "--character", "tall", "--style",
               "limp_left", "--terrain", "stairs", "--pace", "adult", "--json")
    summary = json.loads(done.stdout)
    text = expectation(trace).read_text()
    assert f'pose_hash = "{summary[0]["pose_hash"]}"' in text
    assert text.count("[[character]]") == 2
    for i in range(2):
        assert f"steps_left = {summary[i]['steps_left']}\n" in text.split("[[character]]")[i + 1]
    assert 'style = ["limp_left"]' in text, "options are kept"
    run("check", trace)


def test_a_planted_change_in_one_of_many_is_found_with_tick_and_joint(many, run, tmp_path):
    """The forearm of the motion is bent from a tick on; replay's own files say where and by how much."""
    base = tmp_path / "base"
    run("replay", ROUND, "--out", base)
    motion = read_bvh(base / "pose.bvh")
    folder = tmp_path / "many"
    for i in range(RECORDINGS):
        trace = walk(folder / f"walk{i:02}.hid", 0.5 + 0.02 * i)
        motion_file = folder / ("changed.bvh" if i == 5 else "kept.bvh")
        expectation(trace).write_text(f'[replay]\nmotion = "{motion_file.name}"\n')
    for name in ("kept.bvh", "changed.bvh"):
        write_bvh(motion, folder / name)
    run("check", "--update", folder)
    changed = folder / "walk05.hid"
    before = replayed(run, changed, folder / "changed.bvh", tmp_path / "before")
    joint = next(i for i, name in enumerate(motion.names) if re.search("(?i)left.*(forearm|elbow)", name))
    motion.data[:, motion.first[joint]] += 8.0 * np.sin(np.linspace(0, 40 * np.pi, len(motion.data)))
    write_bvh(motion, folder / "changed.bvh")
    after = replayed(run, changed, folder / "changed.bvh", tmp_path / "after")

    results = tap(run("check", folder, "--plot", tmp_path / "plots", status=1).stdout)
    assert [path for met, path, _ in results if not met] == [str(changed)]
    details = " | ".join(results[5][2]["details"])
    apart = angle_between(local_rotations(before), local_rotations(after))
    found = re.search(r"first different in tick (\d+) \(([\d.]+) s\): (\w+), by (less than )?([\d.]+) degrees", details)
    assert found, details
    tick = int(found[1])
    first = np.argmax(apart.max(axis=1) > 2e-6)  # files have six decimals
    assert tick <= first <= tick + 2
    assert found[3] == before.names[int(np.argmax(apart[first]))]
    assert float(found[2]) == pytest.approx(tick / RATE_HZ, abs=0.001)
    most = re.search(r"most different in tick (\d+) \([\d.]+ s\): (\w+), by ([\d.]+) degrees", details)
    assert most[2] == before.names[int(np.argmax(apart.max(axis=0)))]
    assert float(most[3]) == pytest.approx(apart.max(), abs=0.03)
    pictures = [p for p in (tmp_path / "plots").rglob("*") if p.is_file()]
    assert len(pictures) == 1 and pictures[0].read_bytes().startswith(b"\x89PNG")


def test_pictures_keep_the_folders_of_their_recordings(run, tmp_path):
    traces = [walk(tmp_path / name, seconds=1.0, end_s=1.5) for name in ("set/a/b.hid", "set/a_b.hid")]
    run("check", "--update", *traces)
    for trace in traces:
        lines = trace.read_text().splitlines(keepends=True)
        lines[-1:-1] = [report(1.2, stick_report(0.0, 0.9))]
        trace.write_text("".join(lines))
    plots = tmp_path / "plots"
    run("check", "set", "--plot", plots, cwd=tmp_path, status=1)
    assert sorted(str(p.relative_to(plots)) for p in plots.rglob("*.png")) == ["set/a/b.png", "set/a_b.png"]


def test_a_recording_of_days_is_refused_unless_it_is_asked_for(one, run):
    edit(one, r"^Q: .*$", "Q: 000500.000000 100000")
    done = run("check", "--update", one, "--max-hours", 0.1, status=1)
    assert "lasts 0.1157 hours, longer than 0.1; --max-hours raises the limit" in done.stdout


def replayed(run, trace, motion, out):
    run("replay", trace, "--motion", motion, "--out", out)
    return read_bvh(out / "pose.bvh")


def hash_until(run, trace, tick):
    """The hash of a recording of only the first ticks, with an end line."""
    cut = trace.with_name("cut.hid")
    lines = [line for line in trace.read_text().splitlines() if not line.startswith("Q:")]
    cut.write_text("\n".join(lines) + f"\nQ: {6.0:013.6f} {tick}\n")
    return json.loads(run("replay", cut, "--json").stdout)["pose_hash"]


def test_a_changed_report_is_found_in_its_very_tick_with_the_report_before_it(one, run):
    old = one.with_name("old.hid")
    old.write_text(one.read_text())
    count = one.read_text().count("\nE:")
    write_trace(one, [(0.5, *raw_stick(0, 0.8)), (2.0, *raw_stick(0.3, 0.8)), (4.0, 0, 0)], end_s=6.0)
    assert one.read_text().count("\nE:") == count + 1
    result = tap(run("check", one, status=1).stdout)[0][2]
    assert result["message"] == "one.hid changed since this expectation was written"
    assert result["details"][0].startswith("the poses differ and ")
    details = " | ".join(result["details"])
    tick = int(re.search(r"first different in tick (\d+)", details)[1])
    assert hash_until(run, one, tick) == hash_until(run, old, tick), "the tick before is the same"
    assert hash_until(run, one, tick + 1) != hash_until(run, old, tick + 1)
    number, at_s = re.search(r"the report before it: number (\d+) at ([\d.]+) s", details).groups()
    times = [float(line.split()[1]) for line in one.read_text().splitlines() if line.startswith("E:")]
    assert float(at_s) == pytest.approx(times[int(number) - 1] - times[0], abs=1e-6)
    assert math.ceil(round(float(at_s) * RATE_HZ, 3)) <= tick


def test_another_version_of_the_walk_is_told_from_a_failure(one, run):
    """The least change of a 16-bit stick moves bits and no number."""
    x, y = raw_stick(0, 0.8)
    write_trace(one, [(0.5, x, y + 2 / 32767), (4.0, 0, 0)], end_s=6.0)
    result = tap(run("check", one, status=1).stdout)[0][2]
    assert result["details"][0].startswith("another version of the walk: ")
    assert any("pose_hash is" in line for line in result["details"])


def test_a_number_that_is_not_met_is_named(one, run):
    edit(expectation(one), r"^distance_m = .*", "distance_m = { value = 100, within = 0.5 }")
    result = tap(run("check", one, status=1).stdout)[0][2]
    assert result["message"] == "1 number is not met"
    assert re.fullmatch(r"distance_m is [\d.]+, expected 100 within 0.5", result["details"][0])


def test_numbers_are_those_of_the_files_of_a_replay(one, run, tmp_path):
    run("replay", one, "--out", tmp_path / "out")
    rows = np.genfromtxt(tmp_path / "out/frames.csv", delimiter=",", names=True, dtype=None, encoding=None)
    wanted = {key: float(value) for key, value in re.findall(r"(\w+) = \{ value = ([-\d.e]+)",
                                                             expectation(one).read_text())}
    assert wanted["end_z_m"] == pytest.approx(rows["root_z_m"][-1], abs=1e-4)
    assert wanted["heading_rad"] == pytest.approx(rows["heading_rad"][-1], abs=1e-5)
    moving = rows["stage"] != "idle"
    assert wanted["speed_m_s"] == pytest.approx(wanted["distance_m"] / (moving.sum() / RATE_HZ), rel=1e-4)
    way = np.hypot(np.diff(rows["root_x_m"]), np.diff(rows["root_z_m"])).sum()
    assert wanted["distance_m"] == pytest.approx(way, rel=0.02), "the pelvis sways about the path of the hips"
    for side in ("left", "right"):
        lands = np.flatnonzero((rows["stage"][1:] == "roll") & (rows["stage"][:-1] == "flight")
                               & (rows["swing"][1:] == side)) + 1
        assert wanted[f"step_{side}_m"] == pytest.approx(rows[f"stride_{side}_m"][lands].mean(), rel=1e-3)


# ---- files that changed ----------------------------------------------------------------------
def world(run, folder):
    """A recording with an expectation that depends on one file of each kind, in an own configuration."""
    shutil.copytree(ROOT / "config", folder / "config")
    own = folder / "set"
    own.mkdir()
    run("replay", ROUND, "--out", folder / "walked", "--fps", 60)
    shutil.copy(folder / "walked/pose.bvh", own / "walk.bvh")
    (own / "walk.toml").write_text('file = "walk.bvh"\n')
    (own / "build.toml").write_text("leg_ratio = 0.9\n")
    (own / "mine.toml").write_text("hip_sway = 1.2\n")
    shutil.copy(ROOT / "config/terrain/hills.png", own / "hills.png")
    (own / "ground.toml").write_text('[[section]]\nkind = "picture"\npicture = "hills.png"\nlow_m = -0.08\nhigh_m = 0.08\nfade_m = 2.5\n'
                                     'metres_per_pixel = 0.2\n[[zone]]\nfrom_m = 3\nto_m = 4\nstyle = "tired"\n')
    (own / "script.toml").write_text('[[event]]\nat_s = 1.5\ncommand = "style 1 muscular"\n')
    (own / "pad.toml").write_text('[[pad]]\nvendor = 0x1209\n[pad.axes]\nleft_x = "0001:0030"\n')
    (own / "worn.toml").write_text(EXACT_CALIBRATION)
    trace = write_trace(own / "one.hid", [(0.2, *raw_stick(0.2, 0.8)), (3.0, 0, 0)], [(0.5, "style 2 limp_left")], end_s=4.0)
    expectation(trace).write_text('[replay]\nmotion = "walk.toml"\ncharacter = ["build.toml", "adult"]\nstyle = ["./mine.toml"]\n'
                                  'terrain = "ground.toml"\nscript = "script.toml"\nmap = "pad.toml"\n'
                                  'calibration = "worn.toml"\n')
    return trace


PLANTED = {  # file: (its name in the sentence, what is replaced, by what)
    "set/walk.toml": ("walk.toml", 'file = "walk.bvh"', 'file = "walk.bvh"\nframe_rate_hz = 50'),
    "set/build.toml": ("build.toml", "0.9", "0.95"), "set/mine.toml": ("mine.toml", "1.2", "1.4"),
    "set/ground.toml": ("ground.toml", "high_m = 0.08", "high_m = 0.07"),
    "set/script.toml": ("script.toml", "muscular", "stiff_knee"),
    "set/pad.toml": ("pad.toml", '"0001:0030"', '"-0001:0030"'),
    "set/worn.toml": ("worn.toml", "outer = 1.0", "outer = 0.9"),
    "config/styles/limp_left.toml": ("config/styles/limp_left.toml", "flight_height = 0.5", "flight_height = 0.6"),
    "config/characters/adult.toml": ("config/characters/adult.toml", "leg_ratio = 1.0", "leg_ratio = 1.1"),
    "set/one.hid": ("one.hid", r"^E: 000000.2.*$", "E: 000000.200000 10 00 20 00 a0 00 00 00 00 08 00")}


def test_ten_planted_changes_are_named_first(run, tmp_path):
    trace = world(run, tmp_path)
    environment = {**os.environ, "GAITPAD_CONFIG": str(tmp_path / "config")}
    run("check", "--update", trace, env=environment)
    run("check", trace, env=environment)
    for name, (said, old, new) in PLANTED.items():
        path = tmp_path / name
        kept = path.read_text()
        edit(path, old, new)
        result = tap(run("check", trace, env=environment, status=1).stdout)[0][2]
        assert result["message"] == f"{said} changed since this expectation was written", name
        details = " | ".join(result["details"])
        assert re.search(r"first different in tick \d+ ", details) and "the report before it" in details, (name, details)
        assert "and 1 more" not in details and details.count("changed since") == 0
        path.write_text(kept)
    for spare in ("styles/carry.toml", "pads/sony.toml"):
        path = tmp_path / "config" / spare
        path.write_text(path.read_text() + "\n# another comment\n")
    assert "carry.toml" not in expectation(trace).read_text()
    run("check", trace, env=environment)


def test_a_picture_and_a_motion_that_changed_are_named_too(run, tmp_path):
    trace = world(run, tmp_path)
    environment = {**os.environ, "GAITPAD_CONFIG": str(tmp_path / "config")}
    run("check", "--update", trace, env=environment)
    own = trace.parent
    text = (own / "walk.bvh").read_text()
    (own / "walk.bvh").write_text(re.sub(r"(Frame Time: )\S+", r"\g<1>0.02", text))
    (own / "hills.png").write_bytes((own / "hills.png").read_bytes() + b"\0")
    result = tap(run("check", trace, env=environment, status=1).stdout)[0][2]
    named = [result["message"], *result["details"]]
    assert [line for line in named if "changed since" in line] == [
        f"{name} changed since this expectation was written" for name in ("hills.png", "walk.bvh")]
    run("check", "--update", trace, env=environment)
    run("check", trace, env=environment)


def test_a_lost_expectation_is_a_failure_if_it_is_asked_for(run, tmp_path):
    for name in ("a", "b"):
        run("check", "--update", walk(tmp_path / f"{name}.hid", seconds=1.0, end_s=1.5))
    run("check", tmp_path, "--strict")
    expectation(tmp_path / "b.hid").unlink()
    done = run("check", tmp_path)
    assert done.stderr == "gaitpad check: recordings without an expectation, left out: 1\n"
    done = run("check", tmp_path, "--strict", status=1)
    assert done.stdout.startswith("TAP version 14\n1..1\nok 1")
    assert done.stderr == (f"gaitpad check: recordings without an expectation, left out: 1; the first is {tmp_path}/b.hid\n")


# ---- renewing --------------------------------------------------------------------------------
def test_styles_of_the_users_folder_are_checked_only_if_they_are_asked_for(run, tmp_path):
    """One style with a bundled name, a damaged one, and one with its own name that the recording asks for."""
    trace = write_trace(tmp_path / "old.hid", [(0.2, *raw_stick(0, 0.8))], [(0.5, "style limp_left"), (1.0, "style mine")],
                        end_s=2.0)
    run("check", "--update", trace)
    styles = tmp_path / "gaitpad/styles"
    styles.mkdir(parents=True)
    for name, text in (("limp_left", "hip_sway = 3\n"), ("even", "hip_sway =\n"), ("mine", "hip_sway = 3\n")):
        (styles / f"{name}.toml").write_text(text)
    environment = {**os.environ, "XDG_CONFIG_HOME": str(tmp_path)}
    run("check", trace, env=environment)
    told = tap(run("check", trace, "--user-styles", env=environment, status=1).stdout)[0][2]
    assert re.search(r"first different in tick 2\d\d ", " | ".join(told["details"])), told
    run("check", "--update", trace, "--user-styles", env=environment)
    told = tap(run("check", trace, env=environment, status=1).stdout)[0][2]
    assert any("mine.toml), which a replay reads with --user-styles alone" in line for line in told["details"]), told
    run("check", trace, "--user-styles", env=environment)


def test_update_says_what_changed_and_keeps_the_rest(one, run):
    edit(expectation(one), r"^# .*", "# The walk to the door.")
    edit(expectation(one), r"^(speed_m_s = .*within = )[\d.]+", r"\g<1>0.123")
    edit(expectation(one), r"^end_x_m = .*\n", "")
    run("check", one)
    old = expectation(one).read_text()
    walk(one, 0.6)
    done = tap(run("check", "--update", one).stdout)[0]
    text = expectation(one).read_text()
    hashes = [re.search(r'pose_hash = "(\w+)"', t)[1] for t in (old, text)]
    assert f"pose_hash: {hashes[0]} -> {hashes[1]}" in done[2]["details"]
    assert any(line.startswith("distance_m: ") for line in done[2]["details"])
    assert any(line.startswith("first different in tick") for line in done[2]["details"])
    assert text.startswith("# The walk to the door.\n")
    assert "within = 0.123" in text and "end_x_m" not in text
    run("check", one)
    before = {p.name: p.stat().st_mtime_ns for p in one.parent.iterdir()}
    assert tap(run("check", "--update", one).stdout)[0][2]["details"] == ["unchanged"]
    assert before == {p.name: p.stat().st_mtime_ns for p in one.parent.iterdir()}


def test_expectations_written_together_are_those_written_apart(run, tmp_path):
    """A thread loads the files that successive recordings share once; each expectation still lists all of its files."""
    def written(*groups):
        for expected in tmp_path.glob("*.expect.*"):
            expected.unlink()
        for group in groups:
            run("check", "--update", "-j", 1, *group)
        return {p.name: p.read_bytes() for p in tmp_path.glob("*.expect.*")}
    traces = [walk(tmp_path / f"{name}.hid", 0.4 + 0.1 * i, seconds=2, end_s=3) for i, name in enumerate("abc")]
    run("play", traces[0], "--no-window", "--style", "tired", "--seconds", 1, "--record", tmp_path / "d.hid")
    traces.append(tmp_path / "d.hid")
    together = written(traces)
    assert len(together) == 8 and together == written(*([trace] for trace in traces))


def test_without_kept_poses_the_tick_is_not_known(one, run):
    poses = one.with_suffix(".expect.poses")
    assert poses.exists()
    edit(expectation(one), "^pose_hash = .*", 'pose_hash = "0000000000000000"\nkeep_poses = false')
    run("check", "--update", one)
    assert not poses.exists()
    walk(one, 0.7)
    assert "so the tick is not known" in run("check", one, status=1).stdout


@pytest.mark.parametrize("damage", [b"", b"gaitpad poses 1\n", b"\0" * 100, None])
def test_damaged_poses_are_said_to_be(one, run, damage):
    poses = one.with_suffix(".expect.poses")
    poses.write_bytes(poses.read_bytes()[:-9] if damage is None else damage)
    run("check", one)
    walk(one, 0.7)
    details = tap(run("check", one, status=1).stdout)[0][2]["details"]
    assert any(line.startswith(f"{poses}: ") for line in details), details


# ---- shares of the work ----------------------------------------------------------------------
def test_shards_share_the_recordings(many, run):
    whole = [path for _, path, _ in tap(run("check", many, "-j", "2").stdout)]
    parts = [[path for _, path, _ in tap(run("check", many, "--shard", f"{i}/3", "-j", "1").stdout)] for i in (1, 2, 3)]
    assert sorted(sum(parts, [])) == whole
    assert max(map(len, parts)) - min(map(len, parts)) <= 1
    environment = {**os.environ, "GAITPAD_SHARD_INDEX": "2", "GAITPAD_SHARD_TOTAL": "3"}
    assert [path for _, path, _ in tap(run("check", many, env=environment).stdout)] == parts[1]
    assert len(tap(run("check", many, "--shard", "1/1", env=environment).stdout)) == RECORDINGS
    assert run("check", many / "a/walk00.hid", "--shard", "2/2").stdout == "TAP version 14\n1..0\n"


@pytest.mark.parametrize("shard", ["0/2", "3/2", "1", "x/2", "1/2/3", "1/0", ""])
def test_a_shard_that_there_is_not_is_refused(many, program, refuse, shard):
    if shard:
        refuse("check", many, "--shard", shard, status=2)
    environment = {**os.environ, "GAITPAD_SHARD_INDEX": shard.partition("/")[0],
                   "GAITPAD_SHARD_TOTAL": shard.partition("/")[2]}
    refuse("check", many, env=environment, says="GAITPAD_SHARD_INDEX", status=2)


def test_junit_has_a_case_each(many, run, tmp_path):
    bad = walk(tmp_path / "set/a <&\"'.hid", 0.5)
    run("check", "--update", bad)
    walk(bad, 0.9)
    run("check", bad, many / "a", "--junit", tmp_path / "results.xml", status=1)
    suite = ET.parse(tmp_path / "results.xml").getroot().find("testsuite")
    cases = suite.findall("testcase")
    assert int(suite.get("tests")) == len(cases) == RECORDINGS / 2 + 1
    assert [case.get("name") for case in cases if case.find("failure") is not None] == [str(bad)]
    assert int(suite.get("failures")) == 1
    assert all(float(case.get("time")) > 0 for case in cases)


# ---- refusals --------------------------------------------------------------------------------
def test_what_cannot_be_checked_is_not_ok(tmp_path, run, refuse):
    refuse("check", tmp_path, says="no recording is there")
    refuse("check", tmp_path / "missing", says="missing: no such file or folder")
    (tmp_path / "note.txt").write_text("")
    refuse("check", tmp_path / "note.txt", says="note.txt: neither a folder")
    trace = walk(tmp_path / "one.hid")
    refuse("check", tmp_path, says="no recording has an expectation beside it; --update writes them")
    assert "has no expectation beside it" in run("check", trace, status=1).stdout
    expectation(trace).write_text('[replay]\nstyle = ["no such style"]\n')
    assert "expects nothing yet" in run("check", trace, status=1).stdout
    expectation(trace).write_text('ticks = 1\n[replay]\nstyle = ["nosuch"]\n')
    assert "nosuch" in run("check", trace, status=1).stdout
    expectation(trace).write_text('ticks = 1\ntocks = 2\n')
    assert f"{expectation(trace)}:2: unknown key" in run("check", trace, status=1).stdout
    expectation(trace).write_text("ticks = 1\n")
    trace.unlink()
    assert f"{trace}: there is no such file" in run("check", tmp_path, status=1).stdout


def test_names_are_quoted_for_tap(tmp_path, run):
    trace = walk(tmp_path / "a # b\\c.hid")
    assert " - " + str(trace).replace("\\", "\\\\").replace("#", "\\#") in run("check", "--update", trace).stdout


def test_results_that_cannot_be_written_are_one_sentence(one, run, program):
    done = run("check", one, "--junit", "/proc/results.xml", status=1)
    assert done.stderr.startswith("gaitpad check: /proc/results.xml: ")
    with open("/dev/full", "w") as full:
        done = subprocess.run([program, "check", one], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, "gaitpad: standard output cannot be written\n")
