"""Six sessions and the pose_hash that each of them has had since version 0.1.0.

A change that moves a single bit of a single pose fails here. Whoever changes the walk on purpose puts the new
hashes in and says why in CHANGELOG.md. The sessions need no file from outside the repository.
"""
import json

import pytest

from support.program import ROUND
from support.traces import ramp, raw_stick, write_trace

CAST = ["--character", "adult", "--character", "child", "--character", "tall", "--character", "adult",
        "--style", "even", "--style", "stiff_hip", "--style", "limp_left", "--style", "tired"]
SCRIPT = """
[[event]]
at_s = 2
command = "style carry"
[[event]]
at_s = 5
command = "gait hip_sway 1.5"
[[event]]
at_s = 8
command = "style tiring"
"""


@pytest.fixture
def pose_hash(run):
    def replay(trace, *options):
        done = run("replay", trace, "--json", *options)
        assert done.returncode == 0, done.stderr
        summary = json.loads(done.stdout)
        return (summary[0] if isinstance(summary, list) else summary)["pose_hash"]
    return replay


@pytest.fixture
def made_trace(tmp_path):
    def write(*stick, end):
        write_trace(tmp_path / "made.hid", stick, end_s=end)
        return tmp_path / "made.hid"
    return write


def test_flat_in_robust_mode_with_four_styles(pose_hash):
    assert pose_hash(ROUND, *CAST) == "136affb142b0ce04"


def test_flat_in_paper_mode(pose_hash):
    assert pose_hash(ROUND, "--ik", "paper", *CAST) == "d53e4cb05fce1676"


def test_terrain(pose_hash):
    assert pose_hash(ROUND, "--terrain", "course", *CAST) == "5a08ec3cbed42d4a"


def test_turning_to_both_sides(pose_hash, made_trace):
    trace = made_trace(*ramp(0, 1, (0, 0), raw_stick(0.6, 0.6)), (6, *raw_stick(-0.9, 0.3)), (9, *raw_stick(1, 0)),
                       (12, 0, 0), end=14)
    assert pose_hash(trace) == "31081c769ca2cf8d"


def test_backward_on_stairs(pose_hash, made_trace):
    trace = made_trace((0, *raw_stick(0, 0.8)), (7, 0, 0), (9, *raw_stick(0.1, -0.7)), (15, 0, 0), end=17)
    assert pose_hash(trace, "--terrain", "stairs") == "7449a841412d1452"


def test_script_on_a_motion_file(pose_hash, run, tmp_path):
    """The built-in walk, exported and read back, which the reader treats as a captured motion."""
    assert run("replay", ROUND, "--out", tmp_path).returncode == 0
    script = tmp_path / "script.toml"
    script.write_text(SCRIPT)
    assert pose_hash(ROUND, "--motion", tmp_path / "pose.bvh", "--script", script) == "413f319cbb6eb868"
