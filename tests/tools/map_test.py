"""gaitpad map, with a recording as its pad: a person who pushes each requested control."""
import os

import pytest

from support import traces

# X Y Z Rz Rx of 8 bits, twelve buttons: SDL counts the kernel's axes X Y Z RX RZ, so Rz is a4 and Rx is a3.
DESCRIPTOR = bytes.fromhex("05 01 09 05 a1 01 15 00 26 ff 00 75 08 95 05 09 30 09 31 09 32 09 35 09 33 81 02"
                           "05 09 15 00 25 01 75 01 95 0c 19 01 29 0c 81 02 75 04 95 01 81 03 c0")
REST = [0x80, 0x80, 0x80, 0x80, 0x00, 0, 0]


def held(place, value):
    report = list(REST)
    report[place] = value
    return report


def with_button(number):
    bits = 1 << (number - 1)
    return [*REST[:5], bits & 0xFF, bits >> 8]


# The left stick is Z and Rz, upside down; the right one X and Y; the trigger Rx; the lower button is number 3.
PUSHES = [held(3, 0xFF), held(2, 0xFF), held(1, 0x00), held(0, 0xFF), held(4, 0xFF), with_button(8), with_button(3)]


@pytest.fixture
def person(tmp_path):
    """A recording of these pushes, each for a while after a while of rest."""
    def make(pushes, name="person.hid"):
        text, time_s = traces.device(DESCRIPTOR, "Odd Pad"), 0.0
        for push in pushes:
            for report, seconds in ((REST, 0.9), (push, 0.3)):
                for _ in range(int(seconds / 0.05)):
                    text += traces.report(time_s, report)
                    time_s += 0.05
        for _ in range(20):
            text += traces.report(time_s, REST)
            time_s += 0.05
        (tmp_path / name).write_text(text)
        return tmp_path / name
    return make


def test_each_control_is_found_and_kept_as_a_line_of_sdls(run, person, tmp_path):
    environment = {**os.environ, "XDG_CONFIG_HOME": str(tmp_path / "config")}
    done = run("map", person(PUSHES), env=environment)
    line = done.stdout.strip()
    parts = line.split(",")
    for part in ("lefty:a4~", "leftx:a2", "righty:a1", "rightx:a0", "lefttrigger:a3", "righttrigger:b7", "a:b2"):
        assert part in parts, line
    kept = tmp_path / "config/gaitpad/gamecontrollerdb.txt"
    assert line in kept.read_text().splitlines()
    assert "7 controls of Odd Pad are kept in" in done.stderr
    run("map", person(PUSHES, "again.hid"), env=environment)
    assert kept.read_text().count("Odd Pad") == 1, "the new line replaces the old one"


def test_without_the_left_stick_nothing_is_kept(refuse, run, person, tmp_path):
    done = run("map", person([held(3, 0xFF)]), "--out", tmp_path / "lines.txt", status=1)
    assert "nothing is kept" in done.stderr and done.stdout == ""
    assert not (tmp_path / "lines.txt").exists()


def test_through_sdl_nothing_is_left_to_name(run):
    done = run("map", "--driver", "sdl", status=1)
    assert "the driver sdl has named the controls already: take evdev or hidraw" in done.stderr
