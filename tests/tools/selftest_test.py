"""gaitpad selftest without a pad: what it refuses, in one sentence. The rig leads a scripted person through all of it
(tools/rig/test_selftest.py)."""
from support.program import ROUND, refuse


def test_a_recording_is_no_pad(program, tmp_path):
    refuse(program, "selftest", ROUND, "--out", tmp_path / "out", says=["a recording", "the pad itself"])
    assert not (tmp_path / "out").exists()


def test_a_pad_that_is_not_there_is_said(program, tmp_path):
    refuse(program, "selftest", "1209:ffff", "--out", tmp_path / "out", says=["no pad can be opened", "gaitpad doctor"])
    assert not (tmp_path / "out").exists()


def test_an_unknown_driver_is_wrong_usage(program):
    refuse(program, "selftest", "--driver", "telepathy", status=2, says="--driver")
