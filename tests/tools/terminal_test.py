"""No text of a device, a file or a user controls the terminal: the program escapes its output."""
import json
import os
import random
import re
import shutil
import subprocess

import pytest

from support.program import ROOT, ROUND

HOSTILE = "\x1b]0;owned\x07 \x9b2J\u202eevil\u2066 \u009b5m\u2028\ufeff"
# Control characters but the line feed, C1, what changes the direction of text, and broken UTF-8.
FORBIDDEN = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ufffd]")


@pytest.fixture
def said(program, tmp_path):
    """Runs the program and returns its text on both outputs, after checking that it is harmless."""
    def say(*arguments):
        done = subprocess.run([os.fsencode(a) for a in (program, *arguments)], capture_output=True, check=False, cwd=tmp_path,
                              timeout=60, stdin=subprocess.DEVNULL)
        text = (done.stdout + done.stderr).decode("utf-8", "replace")
        assert not FORBIDDEN.search(text), (arguments, text[:400])
        return done.returncode, text
    return say


def hostile_trace(descriptor):
    return f"R: {len(descriptor)} {bytes(descriptor).hex(' ')}\nN: {HOSTILE}\nI: 3 1209 0001\nE: 000000.000000 2 80 80\n"


PAD = [0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x02, 0x09, 0x30, 0x09, 0x31, 0x81,
       0x02, 0xc0]


def test_names_of_devices_are_escaped_also_when_their_descriptor_fails(said, tmp_path):
    for name, descriptor in (("good", PAD), ("bad", [0xc0])):
        path = tmp_path / f"{name}.hid"
        path.write_text(hostile_trace(descriptor), encoding="utf-8", errors="surrogateescape")
        for command in (["decode", path], ["decode", path, "--json"], ["replay", path], ["calibrate", "--trace", path],
                        ["calibrate", "--trace", path, "--export-sdl"], ["calibrate", "--trace", path, "--json"]):
            said(*command)


def test_names_of_files_and_unknown_options_are_escaped(said, tmp_path):
    name = HOSTILE.replace("/", "")
    (tmp_path / f"{name}.amc").write_text(":FULLY-SPECIFIED\n")
    (tmp_path / f"{name}.toml").write_text(f'skeleton = "{HOSTILE.encode("unicode_escape").decode()}"\n')
    (tmp_path / f"{name}.hid").write_text("junk\n")
    for command in (["decode", f"{name}.hid"], ["replay", f"{name}.hid"], ["replay", f"no{name}.hid"], ["motion", f"{name}.amc"],
                    ["motion", f"{name}.toml"], ["motion", f"no{name}"], ["ik", f"{name}.toml"], ["ik", f"no{name}"],
                    ["calibrate", "--trace", f"{name}.hid"], ["calibrate", "--import", f"no{name}"],
                    ["replay", ROUND, "--style", name], ["replay", ROUND, "--character", name],
                    ["replay", ROUND, "--motion", name], ["replay", ROUND, "--terrain", name],
                    ["replay", ROUND, "--map", name], ["decode", ROUND, "--map", name], ["record", "--out", f"{name}/x.hid"],
                    ["figures", "--out", "out", "--motion", f"no{name}"], [f"--{name}"], ["replay", f"--{name}"], [name],
                    ["pads", "--driver", name]):
        status, _ = said(*command)
        assert status != 0, command


@pytest.mark.parametrize("name", [HOSTILE, "broken \udcff"])
def test_a_motion_of_any_name_walks_and_is_exported(said, tmp_path, name):
    shutil.copy(ROOT / "config/motions/keyframe_walk.toml", tmp_path / f"{name}.toml")
    for command in (["motion", f"{name}.toml"], ["replay", ROUND, "--motion", f"{name}.toml", "--out", name]):
        status, text = said(*command)
        assert status == 0, text
    json.loads((tmp_path / name / "summary.json").read_text())


def test_a_calibration_on_standard_output_is_escaped(said, tmp_path):
    (tmp_path / "pad.hid").write_text(hostile_trace(PAD), encoding="utf-8", errors="surrogateescape")
    (tmp_path / "line.txt").write_text("03000000091200000100000000000000,Pad,leftx:a0,lefty:a1,platform:Linux,\n")
    status, text = said("calibrate", "--trace", "pad.hid", "--import", "line.txt", "--out", "-")
    assert status == 0 and "owned" in text, text


@pytest.mark.parametrize("command", ["motion", "ik"])
def test_every_command_names_itself(said, command):
    _, text = said(command, "nowhere.toml")
    assert text.startswith(f"gaitpad {command}: "), text


def test_random_bytes_in_names_and_files(said, tmp_path):
    chance = random.Random(16)
    for _ in range(30):
        junk = bytes(chance.choice((0x1b, 0x9b, 0xe2, 0x80, 0xae, 0x0d, 0x41, chance.randrange(1, 256))) for _ in range(24))
        name = os.fsdecode(junk.replace(b"/", b"-").replace(b"\n", b" "))
        path = tmp_path / "junk.hid"
        path.write_bytes(b"N: " + junk.replace(b"\n", b" ") + b"\nI: 3 1209 0001\n" + junk)
        said(chance.choice(("decode", "replay", "motion", "ik")), chance.choice((name, "junk.hid")))


def test_what_is_no_file_is_refused_at_once_as_a_recording(said, tmp_path):
    os.mkfifo(tmp_path / "fifo.hid")
    for name, what in (("fifo.hid", "a FIFO"), ("/dev/zero", "a device"), ("/proc/kmsg", "the kernel makes it up"),
                       (".", "a folder")):
        status, text = said("replay", name)
        assert status == 1 and what in text, text
    for command in (["decode", "fifo.hid"], ["calibrate", "--trace", "fifo.hid"], ["calibrate", "--import", "fifo.hid"],
                    ["motion", "fifo.bvh"], ["motion", "fifo.toml"], ["ik", "fifo.toml"], ["replay", ROUND, "--map", "fifo.toml"],
                    ["replay", ROUND, "--terrain", "fifo.toml"], ["replay", ROUND, "--calibration", "fifo.toml"]):
        name = command[-1]
        if not (tmp_path / name).exists():
            os.mkfifo(tmp_path / name)
        status, text = said(*command)
        assert status == 1 and "a FIFO" in text, (command, text)
