"""gaitpad play with a recording as its pad: the session and its recording agree, and every end is a clean one."""
import json
import os
import re
import signal
import subprocess

import pytest

from support.program import ROUND, end_by, wait_until_recorded
from support.traces import beginning

SECONDS = 3
LIVE_KEYS = {"overruns", "lost", "recording_lost", "tick_us_median", "tick_us_max", "wait_us_median", "wait_us_max"}


@pytest.fixture
def record(tmp_path):
    (tmp_path / "session").mkdir()
    return tmp_path / "session/session.hid"


@pytest.fixture
def replay(run, record):
    """The summary of the recording's replay, a list if there are several characters."""
    return lambda *options: json.loads(run("replay", record, "--json", *options).stdout)


def test_its_recording_replays_to_the_same_poses(run, record, replay):
    done = run("play", ROUND, "--no-window", "--record", record, "--seconds", SECONDS, "--json")
    summary = json.loads(done.stdout)
    assert LIVE_KEYS <= set(summary)
    assert (summary["lost"], summary["recording_lost"]) == (0, 0)
    assert summary["reports"] > 20
    assert 240 < summary["ticks"] <= SECONDS * 240 + 240  # a busy machine skips time
    assert replay()["pose_hash"] == summary["pose_hash"]


def test_options_of_replay_hold_and_the_keys_are_replays(run, record, replay):
    options = ["--character", "child", "--character", "adult", "--style", "tired", "--ik", "paper"]
    done = run("play", ROUND, "--no-window", "--record", record, "--seconds", "2.5", "--json", "--rate", "120", *options)
    live = json.loads(done.stdout)
    assert [s["style"] for s in live] == ["tired", "tired"]
    assert live[0]["rate_hz"] == 120
    replayed = replay(*options)
    assert set(live[0]) - set(replayed[0]) == set(live[1]) - set(replayed[1])
    assert set(replayed[0]) <= set(live[0])
    assert [s["pose_hash"] for s in replayed] == [s["pose_hash"] for s in live]


def test_commands_that_are_left_out_are_a_failure(run):
    done = run("play", ROUND, "--no-window", "--seconds", "1", "--commands", input="mark " + "x" * 2000 + "\n", status=1)
    assert "1 commands could not be obeyed" in done.stderr


def test_ends_one_second_behind_the_end_of_a_recording(run, tmp_path):
    trace = tmp_path / "short.hid"
    trace.write_text(beginning(ROUND, 1.5))
    ticks = json.loads(run("play", trace, "--no-window", "--json").stdout)["ticks"]
    assert 240 < ticks < 10 * 240  # round.hid goes on for 20 s; a busy machine skips time


def test_lines_of_standard_input_are_commands(run, record, replay):
    done = run("play", ROUND, "--no-window", "--record", record, "--seconds", "2", "--json", "--commands",
               input="style limp_left\nstyle moonwalk\n", status=1)
    summary = json.loads(done.stdout)
    assert (summary["style"], summary["bad_commands"]) == ("limp_left", 1)
    assert "style limp_left" in record.read_text()
    assert replay()["pose_hash"] == summary["pose_hash"]


WRONG = (
    ("foo", ["unknown command \"foo\"", "style, set, gait"]),
    ("style limp", ["unknown style \"limp\"", "known: even, ", "limp_left"]),
    ("style 7 even", ["no character 7", "1 to 1"]),
    ("set left_leg.stride_lenght 0.5", ["left_leg.stride_lenght", "did you mean \"left_leg.stride_length\"?"]),
    ("set left_leg.stride_length 9", ["9", "0 .. 1.5"]),
    ("gait speed 1", ["unknown gait parameter \"speed\"", "speed_m_s"]),
    ("gait speed_m_s 99", ["99", "0 .. 20"]),
    ("set", ["no command", "set [CHARACTER] KEY VALUE"]))


def test_what_is_wrong_with_a_command_is_said_and_fails(run):
    done = run("play", ROUND, "--no-window", "--seconds", "1", "--commands", status=1,
               input="".join(line + "\n" for line, _ in WRONG))
    for (line, says), sentence in zip(WRONG, done.stderr.splitlines()):
        for part in says:
            assert part in sentence, (line, done.stderr)
    assert len(done.stderr.splitlines()) >= len(WRONG)


def test_text_for_people(run):
    done = run("play", ROUND, "--no-window", "--seconds", "1")
    assert re.search(r"pose hash [0-9a-f]{16}", done.stdout)
    assert "\033" not in done.stderr  # without a terminal no line is rewritten


@pytest.mark.parametrize("signals", [["SIGHUP"], ["SIGINT", "SIGINT", "SIGTERM"]], ids="-".join)
def test_signals_finish_the_recording(started, record, replay, signals):
    with started("play", ROUND, "--no-window", "--record", record, "--json") as process:
        wait_until_recorded(record)
        out, _ = end_by(process, *(getattr(signal, name) for name in signals))
    assert replay()["pose_hash"] == json.loads(out)["pose_hash"]
    assert os.listdir(record.parent) == ["session.hid"]


def test_closed_standard_descriptors_get_nothing_into_the_recording(program, record, replay):
    command = f'"{program}" play "{ROUND}" --no-window --commands --seconds 2 --record "{record}" <&- >&- 2>&-'
    assert subprocess.run(["sh", "-c", command], check=False, timeout=60).returncode == 1
    replay()


def test_the_times_of_reports_replace_a_link_and_not_the_file_behind_it(run, refuse, tmp_path):
    other, times = tmp_path / "other.txt", tmp_path / "times.csv"
    other.write_text("another file")
    times.symlink_to(other)
    run("play", ROUND, "--no-window", "--seconds", SECONDS, "--report-times", times)
    assert other.read_text() == "another file"
    assert not times.is_symlink()
    header, *rows = times.read_text().splitlines()
    assert header == "tick,device,arrival_ns,begin_ns"
    assert len(rows) > 20
    assert all(re.fullmatch(r"\d+,\d+,\d+,\d+", row) for row in rows)
    refuse("play", ROUND, "--no-window", "--report-times", tmp_path / "no/times.csv", says="no/times.csv")


def test_what_cannot_be_is_one_sentence(refuse, tmp_path):
    refuse("play", tmp_path / "none.hid", "--no-window", "--seconds", "1", says="none.hid")
    refuse("play", ROUND, "--no-window", "--record", tmp_path / "no/x.hid", says="no/x.hid")
    refuse("play", ROUND, "--no-window", "--style", "moonwalk", says="moonwalk")
    (tmp_path / "damaged.hid").write_text("R: 3 05 01\n")
    refuse("play", tmp_path / "damaged.hid", "--no-window", says="damaged.hid:1")


@pytest.mark.parametrize("options", [["--driver", "magic"], ["--seconds", "0"]])
def test_wrong_usage_is_2(refuse, options):
    refuse("play", "--no-window", *options, status=2)


def test_without_the_pad_that_was_asked_for_it_says_so_once_and_fails(run):
    done = run("play", "no such pad", "--no-window", "--seconds", "1", status=1)
    assert done.stderr.count("no such pad") == 1, done.stderr
    assert "gaitpad doctor" in done.stderr


def test_without_any_pad_nothing_is_recorded_and_that_is_a_failure(run, record):
    done = run("play", "no such pad", "--no-window", "--seconds", "1", "--record", record, status=1)
    assert "nothing was recorded" in done.stderr and done.stdout == ""
    assert os.listdir(record.parent) == []


def test_a_folder_of_configuration_that_is_none_is_an_error(refuse):
    environment = {**os.environ, "GAITPAD_CONFIG": "/nonexistent"}
    refuse("replay", ROUND, says=["GAITPAD_CONFIG", "/nonexistent"], env=environment)
