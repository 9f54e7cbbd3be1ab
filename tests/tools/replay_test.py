"""gaitpad replay for users: its files, the tick of an event, and its errors."""
import contextlib
import csv
import json
import os
import pathlib
import re
import resource
import signal
import subprocess

import pytest

from support import traces
from support.program import ROUND, end_by, has_sanitizers, wait_until
from support.terminal import Terminal
from support.traces import RATE_HZ, end, raw_stick, write_trace
from support.walk import COLUMNS

# Four axes of 8 bits, eight buttons.
DESCRIPTOR = bytes.fromhex("05 01 09 05 a1 01 15 00 26 ff 00 75 08 95 04 09 30 09 31 09 32 09 35 81 02"
                           "05 09 15 00 25 01 75 01 95 08 19 01 29 08 81 02 c0")
HEADER = traces.device(DESCRIPTOR, "Made Pad")


def report(seconds, x=0x80, y=0x80):
    return traces.report(seconds, [x, y, 0x80, 0x80, 0])


class Made:
    """A made trace and what its replay writes."""

    def __init__(self, run, refuse, folder):
        self._run, self._refuse, self.folder, self.out = run, refuse, folder, folder / "out"

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def run(self, trace_text, *options, **more):
        return self._run("replay", self.write("made.hid", trace_text), "--out", self.out, *options, **more)

    def replay(self, trace_text, *options):
        """The rows of frames.csv, and the summary."""
        self.run(trace_text, *options)
        with open(self.out / "frames.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        return rows, json.loads((self.out / "summary.json").read_text())

    def refuse(self, trace_text, *options, says=()):
        return self._refuse("replay", self.write("made.hid", trace_text), "--out", self.out, *options, says=says)

    def files(self):
        return {p.name: p.read_bytes() for p in self.out.iterdir()}


@pytest.fixture
def made(run, refuse, tmp_path):
    return Made(run, refuse, tmp_path)


WALK = HEADER + report(0) + report(0.5, y=0x10) + report(3, x=0x40, y=0x10) + report(6) + end(7)


def test_columns_rows_and_poses_are_those_of_the_contract(made):
    rows, summary = made.replay(WALK)
    lines = (made.out / "frames.csv").read_text().splitlines()
    columns = [*COLUMNS, "left_heel_ground_m", "left_toe_ground_m", "right_heel_ground_m", "right_toe_ground_m"]
    assert lines[0].split(",")[:len(columns)] == columns  # further columns may follow
    assert len(rows) == 7 * RATE_HZ
    assert summary["ticks"] == 7 * RATE_HZ
    assert re.search("^[0-9a-f]{16}$", summary["pose_hash"])
    assert [int(r["tick"]) for r in rows] == list(range(7 * RATE_HZ))
    assert all(abs(float(r["time_s"]) - k / RATE_HZ) < 1e-8 for k, r in enumerate(rows))
    assert sorted(made.files()) == ["frames.csv", "pose.bvh", "summary.json"]


@pytest.mark.parametrize("fps", [60, 50, 240])
def test_fps_thins_out_poses_alone(made, fps):
    rows, _ = made.replay(WALK, "--fps", fps)
    text = (made.out / "pose.bvh").read_text()
    assert len(rows) == 7 * RATE_HZ
    assert f"Frames: {7 * fps}" in text
    assert len(text.split("Frame Time:")[1].splitlines()) - 1 == 7 * fps


def test_more_frames_than_ticks_are_refused(made):
    made.refuse(WALK, "--fps", "241", says="241")


def test_further_characters_have_numbered_files_and_one_hash(made):
    made.replay(WALK, "--character", "adult", "--character", "child", "--style", "even",
                "--style", "limp_left", "--style", "tired")
    summaries = [json.loads((made.out / f"summary{n}.json").read_text()) for n in ("", "-2", "-3")]
    assert len({s["pose_hash"] for s in summaries}) == 1
    assert summaries[1]["leg_length_m"] < summaries[0]["leg_length_m"]
    assert summaries[2]["leg_length_m"] == summaries[1]["leg_length_m"]  # the last one repeats
    assert (made.out / "pose-3.bvh").exists() and (made.out / "frames-3.csv").exists()


def test_json_is_the_summary(made):
    done = made.run(WALK, "--json")
    assert json.loads(done.stdout) == json.loads((made.out / "summary.json").read_text())


def first_tick_with_stick(rows):
    return next(k for k, row in enumerate(rows) if float(row["stick_y"]) > 0.5)


# Tick 24 starts at exactly 0.1 s; a microsecond later the next one has to take the report.
@pytest.mark.parametrize("seconds, tick", [(0.1, 24), (0.100001, 25), (0.099999, 24)])
def test_an_event_belongs_to_the_first_tick_that_starts_at_or_after_it(made, seconds, tick):
    rows, _ = made.replay(HEADER + report(0) + report(seconds, y=0) + end(1))
    assert first_tick_with_stick(rows) == tick


def test_ticks_count_from_the_first_event(made):
    rows, _ = made.replay(HEADER + report(5) + report(5.1, y=0))
    assert first_tick_with_stick(rows) == 24
    # without Q: one second after the last event
    assert len(rows) in (round(1.1 * RATE_HZ), round(1.1 * RATE_HZ) + 1)


def test_tick_lines_overrule_times(made):
    rows, _ = made.replay(f"V: 1 rate_hz={RATE_HZ}\n" + HEADER + "T: 0\n" + report(0) + "T: 100\n" +
                          report(0.1, y=0) + end(1))
    assert first_tick_with_stick(rows) == 100


def test_the_rate_of_the_trace_holds(made):
    trace = "V: 1 rate_hz=120\n" + HEADER + report(0) + "Q: 000001.000000 120\n"
    rows, summary = made.replay(trace)
    assert (len(rows), summary["rate_hz"]) == (120, 120)
    made.refuse(trace, "--rate", "240", says=("120", "240"))


def test_the_pad_that_is_moved_walks_beside_one_that_never_reports(made):
    receiver = "D: 0\n" + traces.device(DESCRIPTOR, "Receiver")
    pad = "D: 1\n" + HEADER
    # The thumb takes 100 ms.
    push = report(0) + "".join(report(1 + k / 240, y=0x80 - 0x80 * k // 24) for k in range(25)) + report(5) + end(7)
    _, alone = made.replay(HEADER + push)
    _, beside = made.replay(receiver + pad + push)
    _, recorded = made.replay("V: 2 rate_hz=240\n" + receiver + pad + push)
    _, before = made.replay("V: 1 rate_hz=240\n" + receiver + pad + push)
    steps = lambda summary: summary["steps_left"] + summary["steps_right"]
    assert steps(beside) == steps(alone) >= 5
    assert beside["pose_hash"] == recorded["pose_hash"]
    assert steps(before) == 0, "as it was recorded"


def test_a_style_command_counts_from_its_tick_on(made):
    trace = HEADER + report(0, y=0x10) + "C: 000003.000000 style limp_left\n" + end(7)
    rows, summary = made.replay(trace)
    assert summary["style"] == "limp_left"
    before, after = rows[700], rows[-1]
    assert float(before["stride_left_m"]) / float(before["stride_right_m"]) == pytest.approx(1, abs=0.5e-2)
    assert float(after["stride_left_m"]) / float(after["stride_right_m"]) == pytest.approx(0.5, abs=0.5e-2)


def test_an_unknown_command_is_counted(made):
    _, summary = made.replay(HEADER + report(0) + "C: 000000.500000 style none\n" + end(1))
    assert summary["bad_commands"] == 1


def test_an_unplugged_pad_is_neutral_until_seen_near_its_centre_again(made):
    rows, _ = made.replay(HEADER + report(0, y=0) + "H: 000001.000000 remove\n" +
                          "H: 000002.000000 add\n" + report(2.5, y=0) + report(3) +
                          report(3.5, y=0) + end(4))
    stick = [float(row["stick_y"]) for row in rows]
    assert all(y > 0.9 for y in stick[:240])
    assert all(y == 0 for y in stick[240:840])
    assert all(y > 0.9 for y in stick[840:])


def test_the_calibration_of_the_recording_counts_unless_another_is_given(made):
    carried = HEADER + "K: [left]\nK: outer = 0.5\n" + report(0, y=0x38) + end(0.5)
    full, _ = made.replay(carried)
    assert float(full[-1]["stick_y"]) > 0.99
    own = made.write("own.toml", "[left]\nouter = 0.9\n")
    part, _ = made.replay(carried, "--calibration", own)
    assert float(part[-1]["stick_y"]) < 0.7


def test_short_reports_are_counted_and_change_nothing(made):
    rows, summary = made.replay(HEADER + report(0, y=0) + "E: 000000.500000 2 80 80\n" + end(1))
    assert (summary["reports"], summary["bad_reports"]) == (2, 1)
    assert float(rows[-1]["stick_y"]) > 0.9


@pytest.mark.parametrize("line, trace", [
    pytest.param(5, HEADER + report(0) + "E: 000000.100000 5 80 80\n", id="cut in a report"),
    pytest.param(5, HEADER + report(0) + report(660), id="a gap of eleven minutes"),
    pytest.param(1, HEADER.replace(f"R: {len(DESCRIPTOR)}", "R: 99") + report(0), id="descriptor of another size")])
def test_damaged_traces_name_file_and_line(made, line, trace):
    made.refuse(trace, says=f"made.hid:{line}")
    assert not made.out.exists()


def test_lenient_skips_and_counts_damaged_lines(made):
    trace = HEADER + report(0) + "E: 000000.100000 5 80 80\n" + report(0.2) + end(1)
    _, summary = made.replay(trace, "--lenient")
    assert (summary["damaged_lines"], summary["reports"]) == (1, 2)


def test_devices_that_are_no_pads(made):
    cut = DESCRIPTOR[:20] + b"\x26\xff"
    made.refuse(traces.device(cut, "Made Pad") + report(0), says="made.hid: device 0: Made Pad")
    keyboard = DESCRIPTOR[:3] + b"\x06" + DESCRIPTOR[4:]
    made.refuse(traces.device(keyboard, "Made Keyboard") + report(0), says="pad")


@pytest.mark.parametrize("option, word, says", [
    ("--style", "odd.toml", ("odd.toml:1", "fatigeu")), ("--style", "moonwalk", ("moonwalk", "limp_left")),
    ("--character", "odd.toml", "odd.toml:1"), ("--character", "pole.toml", ("pole.bvh", "no two legs")),
    ("--calibration", "odd.toml", "odd.toml:1"), ("--map", "odd.toml", "odd.toml"),
    ("--terrain", "odd.toml", "odd.toml:1"), ("--terrain", "steps", ("steps", "stairs")),
    ("--motion", "odd.toml", "odd.toml:1"), ("--motion", "pole.bvh", ("pole.bvh", "legs")), ("--motion", "none.bvh", "none.bvh")])
def test_what_an_option_names_is_read_strictly(made, option, word, says):
    made.write("odd.toml", "fatigeu = 0.2\n")
    made.write("pole.toml", 'skeleton = "pole.bvh"\n')
    made.write("pole.bvh", "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n"
                           "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n0 0 0\n")
    made.refuse(WALK, option, made.folder / word if "." in word else word, says=says)
    assert not made.out.exists()


def test_a_character_brings_its_own_skeleton(made):
    # The program's own pose, twice as large, as a stranger's file.
    made.replay(HEADER + report(0) + end(0.1), "--character", made.write("twice.toml", "scale = 2\n"))
    (made.out / "pose.bvh").rename(made.folder / "giant.bvh")
    _, summary = made.replay(WALK, "--character", made.write("giant.toml", 'skeleton = "giant.bvh"\n'))
    assert summary["ik_failures"] == 0
    assert summary["source_leg_length_m"] == pytest.approx(0.84, abs=0.5e-7)
    assert summary["metres_per_unit"] == pytest.approx(1.0, abs=0.5e-7)
    assert summary["motion"] == "procedural"
    assert summary["steps_left"] > 3


def test_the_flat_terrain_is_the_default(made):
    flat, without = made.replay(WALK, "--terrain", "flat")[1], made.replay(WALK)[1]
    assert flat == without
    assert (flat["terrain"], flat["terrain_scale"]) == ("flat", 1)


def test_the_ground_grows_where_the_longest_foot_does_not_fit_its_treads(made):
    long_legs = made.write("long.toml", "leg_ratio = 1.5")
    summary = made.replay(WALK, "--terrain", "stairs", "--character", "adult",
                          "--character", long_legs)[1]
    assert summary["terrain"] == "stairs"
    assert summary["terrain_scale"] == pytest.approx(1.5, abs=0.5e-9)
    summary = made.replay(WALK, "--terrain", "stairs", "--character", "child")[1]
    assert summary["terrain_scale"] == 1


def test_an_unwritable_folder(made):
    made.write("file", "")
    made.out = made.folder / "file" / "out"
    made.refuse(WALK, says="file/out")


def test_too_large_a_file_is_a_failed_write(made):
    limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
    assert "cannot be written" in made.run(WALK, status=1, preexec_fn=limited).stderr
    assert not made.out.exists()


def test_a_failed_write_leaves_no_new_folder_and_every_older_one(made):
    limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
    (made.folder / "older").mkdir()
    for out in ("older", "older/new", "new/newer/newest"):
        made.out = made.folder / out
        made.run(WALK, status=1, preexec_fn=limited)
    assert sorted(p.name for p in made.folder.iterdir()) == ["made.hid", "older"]
    assert list((made.folder / "older").iterdir()) == []


def test_a_failure_leaves_the_files_of_an_earlier_run(made):
    made.replay(WALK)
    before = made.files()
    (made.out / "summary-2.json").mkdir()
    made.refuse(WALK, "--character", "child", "--character", "tall", says="summary-2.json")
    (made.out / "summary-2.json").rmdir()
    made.refuse(WALK[:-40] + "\n")
    assert before == made.files()


@pytest.mark.parametrize("options", [["--speed", "3"], ["--ik", "magic"], ["--rate", "0"]], ids=" ".join)
def test_wrong_options_are_wrong_usage(made, options):
    made.run(WALK, *options, status=2)


@pytest.mark.parametrize("arguments", [["dance"], ["replay"]], ids=" ".join)
def test_an_unknown_command_and_no_trace_are_wrong_usage(run, arguments):
    run(*arguments, status=2)


def test_a_crowd_has_files_of_its_first_members_and_one_hash(made):
    trace = HEADER + report(0) + report(0.5, y=0x10) + report(2, x=0x40, y=0x10) + end(3)
    rows, summary = made.replay(trace, "--crowd", "5", "--crowd-files", "3")
    numbers = ["", "-2", "-3", "-4"]
    assert sorted(made.files()) == sorted(
        name for n in numbers for name in (f"frames{n}.csv", f"pose{n}.bvh", f"summary{n}.json"))
    assert summary["crowd"] == 5
    before = made.files()
    made.replay(trace, "--crowd", "5", "--crowd-files", "3")
    assert made.files() == before
    members = [json.loads(before[f"summary{n}.json"]) for n in numbers]
    assert {m["pose_hash"] for m in members} == {summary["pose_hash"]}
    assert len({m["leg_length_m"] for m in members}) > 1
    for number in numbers[1:]:
        text = before[f"frames{number}.csv"].decode().splitlines()
        member = list(csv.DictReader(text))
        assert len(member) == len(rows)
        assert float(member[0]["root_z_m"]) < -0.9
        assert float(member[-1]["root_z_m"]) - float(member[0]["root_z_m"]) > 1
    alone, without = made.replay(trace)
    assert alone == rows, "a crowd behind does not change the first character's walk"
    assert without["pose_hash"] != summary["pose_hash"]
    assert "crowd" not in without


@pytest.mark.parametrize("options, says", [
    (["--crowd", "-1"], ["--crowd", "100000"]),
    (["--crowd", "100001"], ["--crowd", "100000"]),
    (["--crowd", "many"], ["--crowd"]),
    (["--crowd", "3", "--crowd-files", "257"], ["--crowd-files", "256"]),
])
def test_a_crowd_that_cannot_be_is_refused(made, refuse, options, says):
    refuse("replay", made.write("made.hid", WALK), "--out", made.out, *options, says=says, status=2)


# 11 KB that ask for 11.7 million ticks.
def test_a_recording_of_many_hours_is_refused_unless_it_is_asked_for(made):
    reports = "".join(report(540 * i) for i in range(91))
    made.refuse(HEADER + reports, says=("made.hid: lasts 13.5 hours, longer than 12; --max-hours raises the limit",))
    made.refuse(WALK, "--max-hours", "0.0019", says=("--max-hours",))
    made.run(WALK, "--max-hours", "0.002")


# The links have the temporary names that would contain only the process id.
def test_a_link_in_the_way_is_not_followed(program, made):
    kept = made.write("kept", "mine")
    trace = made.write("made.hid", WALK)
    made.out.mkdir()
    script = 'for f in pose.bvh frames.csv summary.json; do ln -s "$1" "$2/.$f.$$"; done; exec "$3" replay "$4" --out "$2"'
    subprocess.run(["sh", "-c", script, "sh", kept, made.out, program, trace], check=True, capture_output=True)
    assert kept.read_text() == "mine"
    assert (made.out / "pose.bvh").read_text().startswith("HIERARCHY")


def has_begun(process, out):
    """True if the program has begun to write a file there, which has no name yet."""
    for fd in pathlib.Path(f"/proc/{process.pid}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):  # the file was closed meanwhile
            if os.readlink(fd).startswith(str(out)) and fd.stat().st_size > 100_000:
                return True
    return False


def test_control_c_ends_it_at_once_and_leaves_nothing(started, tmp_path):
    trace = write_trace(tmp_path / "long.hid", [(0.0, 0.0, 0.0), (0.5, *raw_stick(0.0, 0.8))], end_s=500)
    out = tmp_path / "out"
    with started("replay", trace, "--out", out) as process:
        wait_until(lambda: has_begun(process, out))
        _, errors = end_by(process, signal.SIGINT, status=130)
    assert "nothing was written" in errors and not out.exists()


def test_a_killed_replay_leaves_nothing_and_what_earlier_ones_left_is_removed(started, run, tmp_path):
    trace = write_trace(tmp_path / "long.hid", [(0.0, 0.0, 0.0), (0.5, *raw_stick(0.0, 0.8))], end_s=500)
    out = tmp_path / "out"
    with started("replay", trace, "--out", out) as process:
        wait_until(lambda: has_begun(process, out))
        process.kill()
        process.wait()
    assert list(out.iterdir()) == []
    (out / f".pose.bvh.{process.pid}.0123456789abcdef").touch()  # a named temporary file
    run("replay", ROUND, "--out", out, "--fps", 60)
    assert sorted(p.name for p in out.iterdir()) == ["frames.csv", "pose.bvh", "summary.json"]


def test_long_gaps_take_the_time_of_their_ticks_and_show_progress(program, made):
    gap_s, gaps = 540, 30  # progress is shown after two seconds; all of it takes three times as long
    reports = [report(gap_s * i, y=0x10) for i in range(gaps + 1)]
    path = made.write("gaps.hid", HEADER + "".join(reports) + end(gaps * gap_s))
    with Terminal(program, "replay", path) as terminal:
        terminal.wait_for(r"replay: \d+ %, (\d+ min )?\d+ s left", 60)
        assert terminal.wait_end(300) == 0
    assert f"{gaps * gap_s * RATE_HZ} ticks at {RATE_HZ} Hz" in terminal.text


# ---- several recordings in one process -------------------------------------------------------
def files_below(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.fixture(scope="module")
def walks(tmp_path_factory, run):
    """Recordings that share something with the one before, or nothing: by order, rate, style, files that they hold."""
    folder = tmp_path_factory.mktemp("walks")
    stick = [(0.2, *raw_stick(0.0, 0.8)), (1.5, *raw_stick(0.3, 0.6))]
    write_trace(folder / "a.hid", stick, end_s=2)
    write_trace(folder / "b.hid", stick[:1], [(0.5, "style limp_left")], end_s=2)
    write_trace(folder / "c.hid", stick, end_s=2, rate_hz=120)
    write_trace(folder / "d.hid", stick[1:], [(0.5, "style tiring"), (0.6, "dance")], end_s=2)
    for name, options in (("e", []), ("f", []), ("g", ["--style", "tired", "--character", "child"])):
        run("play", folder / "a.hid", "--no-window", *options, "--terrain", "stairs", "--seconds", 1,
            "--record", folder / f"{name}.hid")
    return sorted(folder.glob("*.hid"))


@pytest.mark.parametrize("options", [[], ["--style", "stiff_hip", "--style", "tired", "--crowd", "2", "--gltf", "--fps", "30"],
                                     ["--terrain", "zones", "--stick", "points", "--ik", "paper"]], ids=" ".join)
def test_each_of_several_recordings_gives_the_bytes_of_its_own_process(run, walks, tmp_path, options):
    together, apart = tmp_path / "together", tmp_path / "apart"
    done = run("replay", *walks, *options, "--out", together)
    for walk in walks:
        alone = run("replay", walk, *options, "--out", apart / walk.stem)
        assert alone.stdout.replace(str(apart), str(together)) in done.stdout
        for line in alone.stderr.splitlines():
            assert line.split(": ", 1)[1] in done.stderr, "remarks"
    assert files_below(together) == files_below(apart)
    assert {p.name for p in together.iterdir()} == {walk.stem for walk in walks}


def test_remarks_on_several_recordings_name_theirs(run, walks):
    assert f"gaitpad replay: {walks[3]}: 1 of 2 commands could not be obeyed\n" in run("replay", *walks[2:4]).stderr


def test_a_bad_recording_is_told_and_the_others_are_replayed(run, walks, tmp_path):
    bad, out = tmp_path / "bad.hid", tmp_path / "out"
    bad.write_text(walks[0].read_text().replace("E: 000000.200000", "E: 000000.2000x0"))
    line = bad.read_text().splitlines().index(next(l for l in bad.read_text().splitlines() if "x0" in l)) + 1
    done = run("replay", walks[0], bad, walks[1], "--out", out, status=1)
    said = done.stderr.splitlines()
    assert len(said) == 2 and f"{bad}:{line}: " in said[0]
    assert said[1] == "gaitpad replay: 1 of 3 recordings were not replayed"
    assert sorted(p.name for p in out.iterdir()) == ["a", "b"]
    run("replay", walks[0], walks[1], "--out", tmp_path / "good")
    assert files_below(out) == files_below(tmp_path / "good")


def test_where_every_recording_fails_nothing_is_left(run, walks, tmp_path):
    limited = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
    done = run("replay", *walks[:2], "--out", tmp_path / "out/deep", status=1, preexec_fn=limited)
    assert "2 of 2 recordings were not replayed" in done.stderr and not (tmp_path / "out").exists()


def test_a_wrong_option_is_told_once(run, walks):
    said = run("replay", *walks[:3], "--style", "nowhere", status=1).stderr.splitlines()
    assert len(said) == 2 and "nowhere" in said[0] and said[1].endswith("3 of 3 recordings were not replayed")


def test_two_recordings_of_one_name_are_refused_before_anything_is_written(refuse, run, walks, tmp_path):
    out = tmp_path / "out"
    for other in (tmp_path / "a.hid", tmp_path / "a.rec"):
        other.write_bytes(walks[0].read_bytes())
        done = refuse("replay", walks[1], walks[0], other, "--out", out, status=2)
        assert done.stderr == (f"gaitpad replay: {walks[0]} and {other} would both be written to {out}/a; "
                               "rename one, or replay them apart\n")
    assert not out.exists()
    assert run("replay", walks[0], tmp_path / "a.hid").stdout.count("pose hash") == 2


def test_names_of_dots_stay_below_the_folder(run, walks, tmp_path):
    odd = tmp_path / "..hid"
    odd.write_bytes(walks[0].read_bytes())
    (tmp_path / "...").write_bytes(walks[0].read_bytes())
    run("replay", odd, tmp_path / "...", "--out", tmp_path / "out")
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["...", "..hid"]


@pytest.mark.parametrize("options", [["--view"], ["--view", "--frames", "3"], ["--to", "uinput"], ["--to", "x.evemu"]], ids=" ".join)
def test_what_takes_one_recording_is_refused_for_several(refuse, walks, tmp_path, options):
    done = refuse("replay", *walks[:3], *options, status=2, cwd=tmp_path)
    assert done.stderr == f"gaitpad replay: {options[0]} takes one recording, and 3 are given\n"
    assert not (tmp_path / "x.evemu").exists()


def test_json_of_several_lists_summaries_and_failures(run, walks):
    done = run("replay", walks[0], "missing.hid", walks[1], "--json", "--style", "even", "--style", "tired", status=1)
    first, missing, last = json.loads(done.stdout)
    assert missing == {"trace": "missing.hid", "error": missing["error"]} and "missing.hid: " in missing["error"]
    for walk, listed in ((walks[0], first), (walks[1], last)):
        alone = json.loads(run("replay", walk, "--json", "--style", "even", "--style", "tired").stdout)
        assert listed == {"trace": str(walk), "summary": alone}


def test_control_c_leaves_the_recordings_before_it(started, walks, tmp_path):
    trace = write_trace(tmp_path / "long.hid", [(0.0, 0.0, 0.0), (0.5, *raw_stick(0.0, 0.8))], end_s=500)
    out = tmp_path / "out"
    with started("replay", walks[0], trace, walks[1], "--out", out) as process:
        wait_until(lambda: has_begun(process, out / "long"))
        _, errors = end_by(process, signal.SIGINT, status=130)
    assert errors.splitlines()[0].endswith("long.hid: ended before its last tick; nothing was written")
    assert errors.splitlines()[1] == "gaitpad replay: 2 of 3 recordings were not replayed"
    assert [p.name for p in out.iterdir()] == ["a"]


# ---- a replay depends on its recording alone -------------------------------------------------
def test_files_of_the_users_folder_change_no_replay(run, tmp_path):
    """round.hid names limp_left in a command; a user has a style of that name, and a damaged one. A crowd walks in all
    styles that there are."""
    def hash_of(*options, **environment):
        done = run("replay", ROUND, "--crowd", 3, "--json", *options, env={**os.environ, **environment})
        return json.loads(done.stdout)["pose_hash"], done.stderr
    bundled = hash_of()
    styles = tmp_path / "gaitpad/styles"
    styles.mkdir(parents=True)
    (styles / "limp_left.toml").write_text("hip_sway = 3\n")
    (styles / "even.toml").write_text("hip_sway =\n")
    assert hash_of(XDG_CONFIG_HOME=str(tmp_path)) == bundled
    (styles / "a_fine_one.toml").write_text("hip_sway = 3\n")
    (styles / "mine.toml").write_text("hip_sway =\n")
    assert hash_of(XDG_CONFIG_HOME=str(tmp_path)) == bundled
    pose_hash, said = hash_of("--user-styles", XDG_CONFIG_HOME=str(tmp_path))
    assert pose_hash != bundled[0]
    assert f"{styles}/mine.toml:1: " in said and "the session goes on without this style" in said
    assert "mine.toml" in run("replay", ROUND, "--style", "mine", env={**os.environ, "XDG_CONFIG_HOME": str(tmp_path)},
                              status=1).stderr


def test_a_users_style_that_a_recording_names_is_read_if_it_is_asked_for(run, refuse, tmp_path):
    trace = write_trace(tmp_path / "old.hid", [(0.2, 0, 100)], [(0.4, "style mine")], end_s=1.5)
    ground = tmp_path / "zone.toml"
    ground.write_text('[[section]]\nkind = "flat"\nlength_m = 9\n[[zone]]\nfrom_m = 1\nto_m = 2\nstyle = "mine"\n')
    environment = {**os.environ, "XDG_CONFIG_HOME": str(tmp_path)}
    (tmp_path / "gaitpad/styles").mkdir(parents=True)
    mine = tmp_path / "gaitpad/styles/mine.toml"
    def replayed(*options):
        done = run("replay", trace, "--json", *options, env=environment)
        return json.loads(done.stdout), done.stderr
    without, said = replayed()
    assert without["bad_commands"] == 1 and "--user-styles" not in said
    mine.write_text("hip_sway = 3\n")
    left_out, said = replayed()
    assert left_out["pose_hash"] == without["pose_hash"] and left_out["bad_commands"] == 1
    sentence = f'"mine" is a style of your own ({mine}), which a replay reads with --user-styles alone'
    assert sentence in said
    taken, said = replayed("--user-styles")
    assert taken["pose_hash"] != without["pose_hash"] and taken["bad_commands"] == 0 and not said
    named, _ = replayed("--style", "mine")
    assert named["bad_commands"] == 0, "what the command line names is read"
    refuse("replay", trace, "--terrain", ground, env=environment, says=[f"zone.toml:7: there is no style \"mine\"; {sentence}"])


def test_a_recorded_session_replays_without_its_options(run, tmp_path):
    own = tmp_path / "own.toml"
    own.write_text("hip_sway = 2\n")
    played = json.loads(run("play", ROUND, "--no-window", "--style", own, "--style", "tired", "--character", "child",
                            "--terrain", "stairs", "--crowd", 3, "--seconds", 1.5, "--record", tmp_path / "r.hid",
                            "--json").stdout)
    own.unlink()
    (tmp_path / "empty").mkdir()
    replayed = json.loads(run("replay", tmp_path / "r.hid", "--json", cwd="/",
                              env={**os.environ, "GAITPAD_CONFIG": str(tmp_path / "empty")}).stdout)
    assert [r["pose_hash"] for r in replayed] == [p["pose_hash"] for p in played]
    assert "/tmp" not in (tmp_path / "r.hid").read_text().split("F: ")[2], "bundled files have no paths of this machine"


# ---- what hostile use found ------------------------------------------------------------------
def test_large_files_are_refused_before_they_are_read(program, refuse, tmp_path):
    """A file of 600 MB of holes, with 200 MB of memory (AddressSanitizer itself needs more)."""
    small = lambda: resource.setrlimit(resource.RLIMIT_AS, (200 << 20, 200 << 20))
    limits = {} if has_sanitizers(program) else {"preexec_fn": small}
    for name, option in (("large.bvh", ["--motion"]), ("large.toml", ["--style"]), ("large.hid", [])):
        path = tmp_path / name
        path.touch()
        os.truncate(path, 600 << 20)
        trace = [] if name == "large.hid" else [ROUND]
        refuse("replay", *trace, *option, path, says=f"{name}: larger than", **limits)


def test_skipped_damage_asks_for_no_hours_of_work(made, refuse):
    """A recording with a hundred gaps of ten minutes, and a damaged line."""
    text = HEADER + "".join(report(599 * i) for i in range(100)) + "E: damaged\n"
    made.refuse(text, "--lenient", says=["made.hid: lasts 16.4", "longer than 1;", "--max-hours"])
    made.refuse(HEADER + "".join(report(599 * i) for i in range(10)) + "E: damaged\n", "--lenient", says="longer than 1;")
    made.run(HEADER + "".join(report(60 * i) for i in range(3)) + "E: damaged\n", "--lenient")


def test_ground_without_a_number_is_said_to_be(made, run):
    ground = made.write("ground.toml", '[[section]]\nkind = "rough"\nlength_m = 5\nheight_m = 0\nwavelength_m = 1\n'
                                       'fade_m = 1e-300\n')
    assert "bends infinitely per metre" in run("replay", ROUND, "--terrain", ground, status=1).stderr


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may become somebody without a thread")
def test_where_no_thread_can_be_started_a_crowd_walks_on_one(run, tmp_path):
    def alone():
        os.setgroups([])
        os.setgid(47631)
        os.setuid(47631)
        resource.setrlimit(resource.RLIMIT_NPROC, (0, 0))
    # The leaks are looked for by a thread of their own.
    off = {**os.environ, "GAITPAD_CACHE": "off", "ASAN_OPTIONS": "detect_leaks=0"}
    done = run("replay", ROUND, "--crowd", 100, "--json", preexec_fn=alone, env=off, cwd="/")
    assert json.loads(done.stdout)["pose_hash"] == json.loads(
        run("replay", ROUND, "--crowd", 100, "--json").stdout)["pose_hash"]
