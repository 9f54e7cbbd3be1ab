"""gaitpad itself: version, help, and the benchmark's list."""
import json
import re
import subprocess
import sys

import pytest

from support.program import ROOT, ROUND
from support.sticks import worn_trace


def test_version_is_three_numbers(run):
    assert re.fullmatch(r"gaitpad \d+\.\d+\.\d+\n", run("--version").stdout)


@pytest.mark.parametrize("command", [[], ["replay"], ["bench"], ["motion"]])
def test_each_command_has_help(run, command):
    assert "Usage:" in run(*command, "--help").stdout


@pytest.mark.parametrize("command", ["play", "replay", "record", "pads", "doctor", "decode", "monitor", "motion", "ik",
                                     "figures", "bench"])
def test_help_names_every_command(run, command):
    assert f"  {command} " in run("--help").stdout


@pytest.mark.parametrize("arguments", [["decode", ROUND], ["motion", "procedural", "--json"]], ids=["decode", "motion"])
def test_a_full_disk_is_one_sentence(program, arguments):
    with open("/dev/full", "w") as full:
        done = subprocess.run([program, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, "gaitpad: standard output cannot be written\n")


def test_the_bundled_traces_are_what_their_scripts_write():
    script = subprocess.run([sys.executable, ROOT / "tools/make_round_trace.py"], capture_output=True, text=True, check=True)
    assert ROUND.read_text() == script.stdout
    assert (ROOT / "config/traces/worn.hid").read_text() == worn_trace()


def test_bench_lists_times_beside_limit_and_peer(run):
    rows = {(r["name"], r["characters"]): r for r in json.loads(run("bench", "--json").stdout)}
    assert set(rows) == {("step", 1), ("step", 4), ("leg_ik", 1), ("playback", 4), ("load_built_in", 1), ("load_clip", 1),
                         ("load_cached", 1)}
    assert all(r["time_us"] > 0 for r in rows.values())
    four = rows["step", 4]
    assert four["limit_us"] == 20
    assert four["ratio_to_limit"] == pytest.approx(four["time_us"] / 20, abs=1e-7)
    assert four["ratio_to_peer"] == pytest.approx(four["time_us"] / rows["playback", 4]["time_us"], abs=1e-7)
    assert four["iterations_per_leg"] > 0
    assert rows["load_built_in", 1]["limit_us"] == 150000 and rows["load_clip", 1]["limit_us"] == 800000
    assert rows["load_cached", 1]["time_us"] < rows["load_clip", 1]["time_us"]
