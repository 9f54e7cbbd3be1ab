"""Output fits the terminal's width, measured on pseudo terminals; in a pipe no line is broken."""
import re
import subprocess

import pytest

from support.program import ROOT, ROUND
from support.terminal import Terminal

COMMANDS = ("play", "replay", "record", "pads", "doctor", "decode", "monitor", "calibrate", "forward", "selftest", "motion", "ik", "figures",
            "bench", "check", "list", "map")
WALK, WORN = ROOT / "config/motions/keyframe_walk.toml", ROOT / "config/traces/worn.hid"
OUTPUTS = (
    *([command, "--help"] for command in COMMANDS), ["--help"], ["list"], ["pads"], ["doctor"],
    ["decode", ROUND, "--descriptor"], ["decode", ROUND], ["motion", WALK], ["replay", ROUND],
    ["calibrate", "--trace", WORN, "--out", "out.toml"], ["calibrate", "--compare", "out.toml", "out.toml"],
    ["calibrate", "--trace", ROUND],
    # Errors, with a long list and with a suggestion.
    ["replay", ROUND, "--style", "sideways"], ["replay", ROUND, "--style", "limp_lefft"], ["replay", ROUND, "--no-such-option"],
    ["dance"], ["replay", ROUND, "--rate", "many"], ["replay", ROUND, "--view"], ["play"])


@pytest.fixture(autouse=True)
def no_display(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)


def shown(program, arguments, columns):
    with Terminal(program, *arguments, columns=columns) as terminal:
        terminal.wait_end(120)
    return terminal.text.replace("\r\n", "\n")


def too_long(text, columns):
    # A line that is rewritten in place has the width of its longest state; escape sequences have none.
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", text)
    return [part for line in text.split("\n") for part in line.split("\r") if len(part) > columns]


@pytest.mark.parametrize("columns", [60, 80, 120])
def test_every_output_fits_the_terminal_and_is_broken_between_words(program, tmp_path, monkeypatch, columns):
    monkeypatch.chdir(tmp_path)
    for arguments in OUTPUTS:
        text = shown(program, arguments, columns)
        assert not too_long(text, columns), (arguments, columns)
        # Nothing is lost, and words stay whole; lists without blanks are broken behind a comma.
        if arguments[-1] == "--help":
            whole = subprocess.run([program, *arguments], capture_output=True, text=True, check=False, timeout=60).stdout
            assert "".join(text.split()) == "".join(whole.split()), (arguments, columns)
            broken = [word for word in text.split() if word not in whole.split()]
            lists = [word for word in whole.split() if "," in word or 2 * len(word) >= columns]
            assert all(any(word in one for one in lists) for word in broken), (arguments, columns, broken)


def test_what_goes_on_stands_below_its_column(program):
    lines = shown(program, ["list", "styles"], 60).split("\n")
    [first] = [i for i, line in enumerate(lines) if line.startswith("  tiring ")]
    column = lines[first].index("Walks")
    assert lines[first + 1].startswith(" " * column) and lines[first + 1][column] != " ", lines[first:first + 3]


def test_in_a_pipe_every_line_stays_whole(program):
    listed = subprocess.run([program, "list", "styles"], capture_output=True, text=True, check=True, timeout=60).stdout
    files = list((ROOT / "config/styles").glob("*.toml"))
    assert len(listed.splitlines()) == len(files) + 1
    assert max(len(line) for line in listed.splitlines()) > 120
    error = subprocess.run([program, "replay", ROUND, "--style", "sideways"], capture_output=True, text=True, check=False,
                           timeout=60).stderr
    assert error.count("\n") == 1 and len(error) > 200


def test_the_nearest_style_is_named(program):
    for arguments in (["replay", ROUND, "--style", "limp_lefft"], ["play", "--no-window", "--style", "limp_lefft"]):
        done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False, timeout=60)
        assert done.returncode == 1 and 'did you mean "limp_left"?' in done.stderr, done.stderr
        assert len(done.stderr) < 120


def test_without_a_display_replay_says_which_option_to_leave_out(program):
    done = subprocess.run([program, "replay", ROUND, "--view"], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 1 and "leave out --view" in done.stderr and "--no-window" not in done.stderr, done.stderr
    done = subprocess.run([program, "play"], capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 1 and "play --no-window" in done.stderr, done.stderr
