"""gaitpad doctor: its findings, its exit status, and that it changes nothing unasked."""
import json
import os
import pathlib
import re

import pytest

from support.program import ROOT

TARGET = pathlib.Path("/etc/udev/rules.d/60-gaitpad.rules")


@pytest.fixture
def doctor(run):
    return lambda *arguments, status=None, answer="": run("doctor", *arguments, status=status, input=answer)


def test_findings_have_node_cause_and_fix_and_the_exit_status_tells_whether_a_pad_is_usable(doctor):
    done = doctor("--json")
    findings = json.loads(done.stdout)
    assert findings and done.returncode == (0 if any(f["state"] == "usable" for f in findings) else 1)
    assert len(doctor().stdout.splitlines()) == len(findings), "the text is one line a finding"
    for finding in findings:
        assert list(finding) == ["state", "node", "device", "cause", "fix"]
        assert finding["state"] in ("usable", "problem", "note")
        assert finding["cause"] != ""
        assert "\n" not in finding["cause"] + finding["fix"]


@pytest.mark.parametrize("options", [["--yes"], ["--install-rules", "--json"]])
def test_wrong_usage_is_2(doctor, options):
    doctor(*options, status=2)


@pytest.fixture
def rules_stay_as_they_are():
    before = TARGET.read_bytes() if TARGET.exists() else None
    yield
    assert (TARGET.read_bytes() if TARGET.exists() else None) == before


@pytest.mark.parametrize("answer", ["", "no\n", "maybe\n"])
def test_installing_rules_shows_the_file_and_refuses_without_a_yes(doctor, rules_stay_as_they_are, answer):
    done = doctor("--install-rules", status=1, answer=answer)
    assert done.stdout.startswith((ROOT / "config/udev/60-gaitpad.rules").read_text())
    assert str(TARGET) in done.stderr


@pytest.mark.skipif(os.geteuid() != 0, reason="needs root to become somebody else")
def test_installing_rules_tells_an_ordinary_user_the_command(run, rules_stay_as_they_are):
    done = run("doctor", "--install-rules", "--yes", status=1, user=65534, group=65534, extra_groups=[])
    assert re.search(r"sudo \S*gaitpad doctor --install-rules", done.stderr)
