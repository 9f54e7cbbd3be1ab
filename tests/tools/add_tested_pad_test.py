"""tools/add_tested_pad.py: a folder of `gaitpad selftest` becomes a row, a test recording and, where needed, a draft."""
import json
import subprocess
import sys

import pytest

from support import tested_pad, traces
from support.program import ROOT

REST = bytes(8) + bytes([0x08, 0x00])


def pressed(button):
    """A report with button 1..12 of the made pad pressed, from bit 4 of the ninth byte on."""
    bits = 0x08 | 1 << (3 + button)
    return bytes(8) + bits.to_bytes(2, "little")


def forward():
    return bytes(2) + (-32767 & 0xffff).to_bytes(2, "little") + bytes(4) + REST[8:]


@pytest.fixture
def checkout(tmp_path):
    root = tmp_path / "checkout"
    (root / "docs").mkdir(parents=True)
    (root / "docs/tested-pads.md").write_text((ROOT / "docs/tested-pads.md").read_text())
    return root


@pytest.fixture
def folder(tmp_path):
    """A folder in which button 2 was asked for as `a` and seen, `left_y+` as well, and button 6 was asked for as
    `guide`."""
    path = tmp_path / "tested"
    path.mkdir()
    lines = [traces.device(traces.DESCRIPTOR, "Made | pad", ids="3 1209 0002")]
    moves = [REST, forward(), REST, pressed(2), REST, pressed(6), REST]
    lines += [traces.report(0.5 * i, data) for i, data in enumerate(moves)]
    (path / "controls.hid").write_text("".join(lines))
    controls = [{"control": name, "result": result, "others": [], "from_s": at - 0.2, "to_s": at + 0.6}
                for name, result, at in (("left_y+", "seen", 0.5), ("a", "seen", 1.5), ("guide", "wrong", 2.5))]
    report = {"format": 1, "program": "gaitpad 9", "date": "2024-02-29",
              "pad": {"name": "Made | pad", "bus": 3, "vendor": 0x1209, "product": 2, "version": 1},
              "system": {"kernel": "6.1.0"},
              "drivers": [{"driver": "hidraw", "opened": True, "rate": {"rate_hz": 250.4}},
                          {"driver": "usb", "opened": False}],
              "controls": controls, "unplugging": {"left_out": False, "is_back": True},
              "rumble": {"strong": "felt", "weak": "none"}, "calibration": {"left": {"verdict": "good"}},
              "walk": {"steps": 9, "aside_m": -0.014}, "failures": ["guide"]}
    (path / "report.json").write_text(json.dumps(report))
    return path


def add(program, folder, checkout):
    return subprocess.run([sys.executable, ROOT / "tools/add_tested_pad.py", folder, "--root", checkout,
                           "--program", program], capture_output=True, text=True, check=False)


def test_adds_a_row_a_recording_and_a_draft(program, folder, checkout):
    done = add(program, folder, checkout)
    assert done.returncode == 0, done.stderr
    last = (checkout / "docs/tested-pads.md").read_text().splitlines()[-1]
    assert last == ("| Made ? pad | 1209:0002, USB | 6.1.0, 2024-02-29 | hidraw 250 Hz, usb: no | 2 seen; wrong: guide | "
                    "came back | strong felt, weak none | left good | 9 steps, 1 cm aside |")
    kept = checkout / "tests/data/tested/1209_0002-1"
    assert sorted(path.name for path in kept.iterdir()) == ["controls.hid", "report.json"]
    draft = (folder / "1209_0002.toml").read_text()
    assert 'guide = "button 6"' in draft and "products = [0x0002]" in draft and "left_y" not in draft


def test_the_draft_is_a_pad_file_that_mends_it(program, run, folder, checkout):
    add(program, folder, checkout)
    lines = run("decode", folder / "controls.hid", "--json", "--map", folder / "1209_0002.toml").stdout.splitlines()
    assert any("guide" in row["buttons"] for row in map(json.loads, lines) if "buttons" in row)


def test_its_recording_is_judged_as_it_was_seen(run, folder):
    assert list(tested_pad.problems(run, folder)) == []
    text = (folder / "report.json").read_text()
    (folder / "report.json").write_text(text.replace('"control": "a"', '"control": "b"'))
    assert [problem for problem in tested_pad.problems(run, folder) if ": b was seen" in problem]


def test_a_second_one_of_the_model_gets_its_own_folder(program, folder, checkout):
    add(program, folder, checkout)
    assert "has this row already" in add(program, folder, checkout).stderr
    report = json.loads((folder / "report.json").read_text())
    (folder / "report.json").write_text(json.dumps({**report, "date": "2024-03-01"}))
    assert add(program, folder, checkout).returncode == 0
    assert (checkout / "tests/data/tested/1209_0002-2").is_dir()


@pytest.mark.parametrize("line", ["U: 00:11:22:33:44:55", "P: usb-0000:00:14.0-2/input0"])
def test_refuses_what_identifies_a_pad(program, folder, checkout, line):
    path = folder / "controls.hid"
    path.write_text(path.read_text().replace("I: ", line + "\nI: ", 1))
    done = add(program, folder, checkout)
    assert done.returncode == 1 and "controls.hid:3: identifies the pad" in done.stderr
    assert not (checkout / "tests").exists()


def test_refuses_what_is_no_report(program, tmp_path, checkout):
    (tmp_path / "report.json").write_text('{"format": 1}')
    done = add(program, tmp_path, checkout)
    assert done.returncode == 1 and "no report of gaitpad selftest" in done.stderr
