"""gaitpad forward without a pad: its unit, its rule, its refusals. With pads: tools/rig/test_forward.py."""
import os
import pathlib
import shlex
import shutil
import signal
import subprocess

import pytest

from support.program import ROOT, ROUND, started

TARGET = pathlib.Path("/etc/udev/rules.d/60-gaitpad-uinput.rules")


@pytest.fixture
def install(program, run, tmp_path):
    """The unit that `forward --install` writes with these arguments, and what it says."""
    def install(*arguments, **options):
        done = run("forward", *arguments, "--install", env={**os.environ, "XDG_CONFIG_HOME": str(tmp_path)}, **options)
        unit = tmp_path / "systemd/user/gaitpad-forward.service"
        assert [p.name for p in unit.parent.iterdir()] == [unit.name], "nothing half-written beside it"
        return unit, done.stdout
    return install


def test_the_unit_starts_this_program_with_the_options(install, program, tmp_path):
    (tmp_path / "own.toml").write_text('name = "own"\ndevices = ["*:*"]\n[left]\n')
    unit, said = install("054c:09cc", "--as", "xbox360", "--calibration", "own.toml", cwd=tmp_path)
    line, = (line for line in unit.read_text().splitlines() if line.startswith("ExecStart="))
    assert shlex.split(line.removeprefix("ExecStart=")) == [str(program), "forward", "054c:09cc", "--as", "xbox360",
                                                            "--calibration", str(tmp_path / "own.toml")]
    assert str(unit) in said and "without root" in said and "systemctl --user enable --now gaitpad-forward" in said


def test_the_unit_keeps_a_name_that_systemd_would_read_otherwise(install):
    unit, _ = install('100% "$HOME" \\ pad\n')
    assert r'"100%% \"$$HOME\" \\ pad\x0a"' in unit.read_text()


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd-analyze is not installed")
def test_systemd_takes_the_unit(install):
    unit, _ = install("Pro Controller")
    done = subprocess.run(["systemd-analyze", "--user", "verify", "--man=no", unit], capture_output=True, text=True, check=False,
                          env={**os.environ, "XDG_RUNTIME_DIR": "/tmp"})
    assert "gaitpad-forward" not in done.stderr, done.stderr


def test_the_rule_is_shown_and_not_written_without_a_yes(run):
    before = TARGET.read_bytes() if TARGET.exists() else None
    done = run("forward", "--install-rules", status=1, input="no\n")
    assert done.stdout == (ROOT / "config/udev/60-gaitpad-uinput.rules").read_text()
    assert str(TARGET) in done.stderr
    assert (TARGET.read_bytes() if TARGET.exists() else None) == before


def test_the_rule_opens_uinput_and_nothing_else():
    lines = [line for line in (ROOT / "config/udev/60-gaitpad-uinput.rules").read_text().splitlines() if line and line[0] != "#"]
    assert len(lines) == 1 and lines[0].startswith('KERNEL=="uinput", SUBSYSTEM=="misc", TAG+="uaccess"')


@pytest.mark.parametrize("options", [["--yes"], ["--install", "--install-rules"], ["--as", "xbox720"]])
def test_wrong_usage_is_2(run, options):
    run("forward", *options, status=2)


def test_a_recording_is_refused(refuse):
    refuse("forward", ROUND, says=["is a recording", "replay --to uinput"])


def test_it_waits_for_a_pad_until_a_signal_ends_it(program):
    with started(program, "forward", "1209:fffe") as process:
        assert '"1209:fffe" is not there; waiting for it' in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        assert process.wait(30) == 0
