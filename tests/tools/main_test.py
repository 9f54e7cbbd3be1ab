"""gaitpad itself: version, help, and the benchmark's list."""
import json
import re
import subprocess
import sys

import pytest

from support import slices
from support.program import ROOT, ROUND
from support.sticks import worn_trace


def test_version_is_three_numbers(run):
    assert re.fullmatch(r"gaitpad \d+\.\d+\.\d+\n", run("--version").stdout)


COMMANDS = ["play", "replay", "record", "pads", "doctor", "decode", "monitor", "calibrate", "forward", "motion", "ik", "figures", "bench",
            "list", "map"]


@pytest.mark.parametrize("words", [[], ["help"], ["--help"]], ids="-".join)
def test_help_without_a_command(run, words):
    text = run(*words).stdout
    assert "Examples:" in text and all(f"  {command} " in text for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_a_command_has_examples_that_begin_with_it(run, command):
    text = run("help", command).stdout
    assert text == run(command, "--help").stdout
    examples = text.split("Examples:\n")[1].splitlines()
    assert examples and all(f"gaitpad {command}" in line for line in examples)


@pytest.mark.parametrize("words, says", [
    (["repaly", ROUND], ['unknown command "repaly"', 'did you mean "replay"?']),
    (["dance"], ['unknown command "dance"', "known: play, replay"]),
    (["replay", ROUND, "--styel", "even"], ['gaitpad replay: unknown option "--styel"', 'did you mean "--style"?']),
    (["replay", ROUND, "--quite-unlike-any"], ['unknown option "--quite-unlike-any"']),
    (["ik", "chain.toml", "again"], ['unexpected argument "again"']),
    (["help", "repaly"], ['did you mean "replay"?']),
    (["play", "--seconds", "-1"], ["--seconds", "0.001", "1000000"]),
    (["replay", ROUND, "--rate", "0"], ["--rate", "10", "10000"])], ids=lambda value: str(value[0])[:20])
def test_wrong_words_get_a_suggestion_or_a_range(run, words, says):
    done = run(*words, status=2)
    assert len(done.stderr) < 400 and done.stdout == ""
    for part in says:
        assert part in done.stderr, done.stderr


def test_list_names_what_the_options_take(run):
    everything = json.loads(run("list", "--json").stdout)
    assert set(everything) == {"styles", "characters", "terrains", "motions", "pads", "traces"}
    for kind, folder in (("styles", "styles"), ("terrains", "terrain"), ("characters", "characters")):
        assert {e["name"] for e in everything[kind]} == {p.stem for p in (ROOT / "config" / folder).glob("*.toml")}
    assert all(e["summary"] for e in everything["styles"] + everything["terrains"])
    assert "limp_left" in run("list", "styles").stdout and "stairs" not in run("list", "styles").stdout
    assert run("list", "walks", status=2).stdout == ""


@pytest.mark.parametrize("arguments", [["decode", ROUND], ["motion", "procedural", "--json"]], ids=["decode", "motion"])
def test_a_full_disk_is_one_sentence(program, arguments):
    with open("/dev/full", "w") as full:
        done = subprocess.run([program, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (1, "gaitpad: standard output cannot be written\n")


def test_the_bundled_traces_are_what_their_scripts_write():
    script = subprocess.run([sys.executable, ROOT / "tools/make_round_trace.py"], capture_output=True, text=True, check=True)
    assert ROUND.read_text() == script.stdout
    plain = subprocess.run([sys.executable, ROOT / "tools/make_round_trace.py", "--plain"], capture_output=True, text=True,
                           check=True)
    assert (ROOT / "config/traces/walk.hid").read_text() == plain.stdout
    assert (ROOT / "config/traces/worn.hid").read_text() == worn_trace()


@pytest.fixture(scope="module")
def benched(run, tmp_path_factory):
    """The rows of a short run, which draws its picture."""
    picture = tmp_path_factory.mktemp("bench") / "cost.png"
    rows = json.loads(run("bench", "--json", "--rounds", "1", "--crowd", "64", "--plot", picture).stdout)
    assert picture.read_bytes().startswith(b"\x89PNG")
    return rows


def test_bench_lists_each_measurement(benched):
    names = [r["name"] for r in benched]
    assert set(names) == {"leg_paper", "leg_robust_even", "leg_robust_weighted", "playback", "playback_world", "character_even",
                          "characters_even", "characters_styled", "character_even_60_hz", "character_asked",
                          "ground_query", "step", "crowd", "crowd_alone",
                          "crowd_memory", "load_built_in", "load_clip", "load_cached", "load", "replay", "replay_files"}
    assert all(0 < r["ns_low"] <= r["ns"] <= r["ns_high"] for r in benched)
    assert all(r["processor"] and r["lanes"] in (4, 8, 16) for r in benched)
    widest = benched[0]["lanes"]
    assert {(r["characters"], r["width"]) for r in benched if r["name"] == "crowd"} == {
        (n, width) for n in (1, 8, 64) for width in (1, 4, 8, 16) if width <= widest}
    assert [r["characters"] for r in benched if r["name"] == "step"] == [1, 4]
    # Only benchmarks with several threads measure elapsed time.
    elapsed = {r["name"] for r in benched if r["clock"] == "elapsed"}
    assert elapsed == {"load_built_in", "load_clip", "load_cached", "load"}
    assert all(r["clock"] == "thread" for r in benched if r["name"] not in elapsed)


def test_bench_counts_in_its_peers(benched):
    ns = {r["name"]: r["ns"] for r in benched if r["characters"] <= 4 and r["name"] != "crowd"}
    for row in benched:
        assert row["time_us"] == pytest.approx(row["ns"] * row["characters"] / 1000)
        if "ratio" in row:
            assert row["over"] == ("characters_even" if row["name"] == "characters_styled" else "playback")
            assert row["ratio"] == pytest.approx(row["ns"] / ns[row["over"]])
        if row["name"] == "crowd":  # of the same builds and styles, at the same rate
            alone = next(r["ns"] for r in benched if r["name"] == "crowd_alone")
            assert row["ratio_alone"] == pytest.approx(row["ns"] / alone)
        if "at_60_hz" in row:
            assert row["at_60_hz"] == pytest.approx(1e9 / 60 / row["ns"], abs=1)
        assert row.get("bytes", 1000) >= 1000
    assert {r["name"] for r in benched if "ratio" in r} == {"character_even", "characters_even", "characters_styled", "step",
                                                         "character_even_60_hz", "character_asked", "crowd", "crowd_alone", "crowd_memory"}
    assert ns["load"] == ns["load_clip"]


def test_bench_says_which_bounds_are_met(benched):
    assert {r["name"] for r in benched if "bound_ns" in r} == {"leg_robust_even", "step", "load_built_in", "load_clip", "load", "replay",
                                                          "replay_files"}
    for row in benched:
        met = [row[value] <= row[bound] for value, bound in (("ns", "bound_ns"), ("ratio", "bound_ratio")) if bound in row]
        assert row.get("met", True) == all(met)


@pytest.mark.skipif(not slices.is_chosen("the table of bench", 3), reason=f"another slice runs it: {slices.text(3)}")
def test_bench_prints_a_table_and_refuses_a_picture_it_cannot_write(program):
    done = subprocess.run([program, "bench", "--rounds", "1", "--crowd", "1", "--plot", "/proc/mine.png"],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 1 and done.stderr.startswith("gaitpad bench: /proc/mine.png")
    assert len(done.stderr.splitlines()) == 1
    assert "bound 1024" in done.stdout and "local rotations (the peer)" in done.stdout


@pytest.mark.parametrize("arguments", [["--crowd", "0"], ["--rounds", "0"], ["--plot", "cost.jpg"]])
def test_bench_refuses_wrong_usage(program, arguments):
    assert subprocess.run([program, "bench", *arguments], capture_output=True, check=False).returncode == 2
