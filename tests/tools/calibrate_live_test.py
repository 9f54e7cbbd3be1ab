"""gaitpad calibrate at a terminal; its pad is a recording of a hand that follows the steps."""
import math
import os
import signal
import subprocess
import time
import tomllib

import pytest

from support import traces
from support.hands import Hand
from support.terminal import Terminal

REACH = 0.9
CENTRE = {"left": (0.05, -0.03), "right": (-0.04, 0.06)}


class MadeHand(Hand):
    """A hand at the 16-bit test pad."""

    def data(self):
        noise = 0.002 * math.sin(len(self.lines) * 2.4)
        axes = [raw for x, y in CENTRE.values()
                for raw in (x + REACH * self.place[0] + noise, -(y + REACH * self.place[1] + noise))]
        data = b"".join(round(max(-1, min(1, raw)) * traces.FULL).to_bytes(2, "little", signed=True) for raw in axes)
        triggers = 1 << 6 | 1 << 7 if self.is_pulled else 0
        return data + (0x08 | triggers << 4).to_bytes(2, "little")

    def write(self, path):
        path.write_text(traces.device(traces.DESCRIPTOR, "gaitpad test pad", physical="synthetic") + "".join(self.lines))
        return path


@pytest.fixture(scope="module")
def round_trace(tmp_path_factory):
    hand = MadeHand()
    hand.hold(0.5)
    hand.releases(0, 7)
    hand.hold(2.2)
    hand.turns(2.5)
    hand.pushes()
    hand.triggers()
    hand.hold(3.0)
    return hand.write(tmp_path_factory.mktemp("round") / "round.hid")


@pytest.fixture(scope="module")
def rest_trace(tmp_path_factory):
    hand = MadeHand()
    hand.hold(30.0)
    return hand.write(tmp_path_factory.mktemp("rest") / "rest.hid")


@pytest.fixture
def environment(tmp_path):
    return {**os.environ, "XDG_CONFIG_HOME": str(tmp_path)}


@pytest.fixture
def at_terminal(program, environment):
    return lambda trace, **size: Terminal(program, "calibrate", trace, env=environment, **size)


@pytest.fixture
def files(tmp_path):
    """A function that returns this user's calibrations: name -> text."""
    return lambda: {path.name: path.read_text() for path in (tmp_path / "gaitpad/calibration").glob("*")}


@pytest.fixture
def written(run, round_trace, environment, files):
    """A calibration that exists already: the file that the tool itself would write."""
    run("calibrate", "--trace", round_trace, env=environment)
    assert len(files()) == 1
    return files()


def test_the_steps_lead_to_a_file(at_terminal, round_trace, files):
    with at_terminal(round_trace) as terminal:
        place = 0
        for number, step in enumerate(("rest", "turning", "push forward", "push right", "push back", "push left",
                                       "triggers"), 1):
            place = terminal.wait_for(f"Step {number} of 7: {step} ", since=place).end()
        terminal.wait_for("Enter writes", since=place)
        assert files() == {}
        terminal.wait_for("[0-9] of 6 releases")
        terminal.wait_for("4[0-9] of 48 directions")
        terminal.wait_for("now let go")
        time.sleep(0.2)
        terminal.press("\n")
        assert terminal.wait_end() == 0, terminal.text
        assert terminal.is_as_before()
    names = [name for name in files() if name.endswith(".toml")]
    assert len(names) == 1, files()
    told = tomllib.loads(files()[names[0]])
    assert told["devices"] == ["1209:0001"]
    for stick, centre in CENTRE.items():
        for axis, middle in zip("xy", centre):
            assert told[stick][axis]["centre"] == pytest.approx(middle, abs=0.002)
            assert told[stick][axis]["min"] == pytest.approx(max(-1, middle - REACH), abs=0.01)
            assert told[stick][axis]["max"] == pytest.approx(min(1, middle + REACH), abs=0.01)


@pytest.mark.parametrize("rows, columns", [(24, 80), (24, 40), (6, 60)])
def test_a_line_never_is_wider_than_the_screen_and_the_screen_never_fuller(at_terminal, rest_trace, rows, columns):
    with at_terminal(rest_trace, rows=rows, columns=columns) as terminal:
        terminal.wait_for("releases")
        terminal.press("?s")
        time.sleep(0.4)
        terminal.press("q")
        terminal.wait_end()
        for screen in terminal.text.split("\033[J"):
            lines = screen.replace("\033[K", "").replace("\r", "").split("\n")
            if "releases" in screen or "directions" in screen:
                assert max(len(line.split("A")[-1]) for line in lines) <= columns, screen
                assert len(lines) <= rows, screen


GIVE_UP = {"ctrl-c": lambda t: t.press("\x03"), "sigterm": lambda t: t.send_signal(signal.SIGTERM),
           "ctrl-d": lambda t: t.press("\x04")}


@pytest.mark.parametrize("give_up", GIVE_UP.values(), ids=GIVE_UP)
def test_giving_up_leaves_the_old_file_and_the_terminal_as_they_were(at_terminal, rest_trace, files, written, give_up):
    with at_terminal(rest_trace) as terminal:
        terminal.wait_for("Step 1 of 7")
        assert not terminal.is_cooked()
        give_up(terminal)
        assert terminal.wait_end() == 1
        assert terminal.is_as_before()
        assert "nothing written" in terminal.text
    assert files() == written


def test_q_at_the_question_leaves_the_old_file(at_terminal, round_trace, files, written):
    with at_terminal(round_trace) as terminal:
        terminal.wait_for("Enter writes")
        time.sleep(0.2)
        terminal.press("q")
        assert terminal.wait_end() == 1
        assert terminal.is_as_before()
        assert "nothing written" in terminal.text
    assert files() == written


def test_steps_that_are_skipped_leave_the_sticks_unknown(at_terminal, rest_trace, files, written):
    with at_terminal(rest_trace) as terminal:
        terminal.wait_for("Step 1 of 7")
        time.sleep(0.7)
        terminal.press("sssssss")
        assert terminal.wait_end() == 1
        assert terminal.is_as_before()
        assert "Enter writes" not in terminal.text
        assert "nothing is written" in " ".join(terminal.text.split())
    assert files() == written


def test_keys_skip_repeat_and_go_back(at_terminal, round_trace):
    with at_terminal(round_trace) as terminal:
        terminal.wait_for("2 of 6 releases")
        terminal.press("r")
        at = len(terminal.text)
        at = terminal.wait_for(" 0 of 6 releases", since=at).end()
        terminal.press("\n")
        at = terminal.wait_for("Step 2 of 7", since=at).end()
        terminal.press("s")
        at = terminal.wait_for("Step 3 of 7", since=at).end()
        terminal.press("\x1b[B")  # an arrow does not count as `b`
        time.sleep(0.2)
        assert "Step 2" not in terminal.text[at:]
        terminal.press("b")
        at = terminal.wait_for("Step 2 of 7", since=at).end()
        terminal.press("?")
        terminal.wait_for("nothing is written", since=at)
        terminal.press("q")
        terminal.wait_end()


def test_stopped_it_gives_the_terminal_back_and_takes_it_again(at_terminal, rest_trace):
    with at_terminal(rest_trace) as terminal:
        terminal.wait_for("Step 1 of 7")
        terminal.press("\x1a")
        terminal.wait_stopped()
        assert terminal.is_as_before()
        terminal.go_on()
        terminal.wait_for("Step 1 of 7", since=len(terminal.text))
        assert not terminal.is_cooked()
        terminal.press("q")
        terminal.wait_end()
        assert terminal.is_as_before()


def test_without_a_terminal_lines_do(started, environment, rest_trace, files):
    # Each answer comes once the tool has asked: a busy machine is slow to ask.
    dialogue = (("left stick: 0 of 6 releases", "s"), ("Step 2 of 7", "skip"), ("Step 3 of 7", "b"), ("Step 2 of 7", "q"))
    told = []
    with started("calibrate", rest_trace, stdin=subprocess.PIPE, env=environment) as process:
        for asks, answer in dialogue:
            for line in process.stderr:
                told.append(line)
                if asks in line:
                    break
            print(answer, file=process.stdin, flush=True)
        told += process.stderr
    assert told[0].startswith("Step 1 of 7: rest")
    assert "nothing written" in told[-1]
    assert "\033" not in "".join(told)
    assert files() == {}


def test_the_end_of_input_gives_up(run, environment, rest_trace, files):
    done = run("calibrate", rest_trace, status=None, timeout=20, env=environment)
    assert "nothing written" in done.stderr
    assert files() == {}


def test_a_pad_without_a_stick_is_told(at_terminal, tmp_path):
    buttons = bytes.fromhex("05 01 09 05 a1 01 05 09 19 01 29 08 15 00 25 01 75 01 95 08 81 02 c0")
    trace = tmp_path / "buttons.hid"
    trace.write_text(traces.device(buttons, "Buttons", ids="3 1209 0002") + traces.report(0, b"\0") + traces.report(5, b"\0"))
    with at_terminal(trace) as terminal:
        terminal.wait_for("stick", 10)
        assert terminal.wait_end() == 1, terminal.text
        assert terminal.is_as_before()
