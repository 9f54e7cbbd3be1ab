"""Walks keep every bound, judged from the exported files alone: of each motion with every style, leg length and stick (the
cases of acceptance.py, which also prints their table), from every kind of source, and of a crowd's members."""
import json
import os

import pytest

import acceptance
from support import judge
from support.judge import Check
from support.program import DATA
from support.traces import write_trace
from support.walk import Walk

MOCAP = DATA / "mocap"
# Key frames, Acclaim files, bodies with other names and joints: a motion, and the body that walks it.
SOURCES = [("keyframe_walk", None), ("cmu_35_01.amc", None), ("endorphin_walking.amc", None),
           ("endorphin_walking.amc", "daz3d_170_joints.bvh"), ("cmu_m21_walk.bvh", "endorphin.asf"),
           ("freebvh_mixamo_names.bvh", "cmu_07.asf"), (None, "makehuman_walk1.bvh"),
           ("cmu_006_01_iclone.bvh", "geno_stance_6channels.bvh")]
MEMBERS, JUDGED = 200, 32


def pytest_generate_tests(metafunc):
    if "case_motion" in metafunc.fixturenames:
        captured = acceptance.MOTIONS[:1] if metafunc.config.getoption("--quick") else acceptance.MOTIONS
        metafunc.parametrize("case_motion", ["default", *captured])


def broken(checks, label=""):
    return [f"{label}{c.name}: {c.value:.4g} {c.note}" for c in checks if c.ok is False]


def test_walks_keep_every_bound(program, pytestconfig, tmp_path, case_motion):
    words = [str(program), "--out", str(tmp_path), "--part"] + (["--quick"] if pytestconfig.getoption("--quick") else [])
    options = acceptance.arguments(words)
    if case_motion != "default" and not os.path.exists(os.path.join(options.data, case_motion + ".bvh")):
        pytest.skip(f"{case_motion}.bvh is not in {options.data}")
    results = acceptance.run_motions([case_motion], options, processes=1 if pytestconfig.getoption("--slice") else 2)
    print(acceptance.summary_table(results))
    lines, count = acceptance.failures_text(results)
    assert count == 0, "\n".join(lines)


@pytest.mark.parametrize("motion, skeleton", SOURCES, ids=lambda name: name or "own")
def test_walks_from_every_kind_of_source_keep_the_bounds(run, tmp_path, motion, skeleton):
    if motion != "keyframe_walk" and not MOCAP.is_dir():
        pytest.skip(f"there are no motions at {MOCAP}")
    trace = write_trace(tmp_path / "walk.hid", [(0.5, 0, 0.8), (6, 0, 0.4), (9, 0, 0)], (), 11)
    options = ["--motion", motion if motion == "keyframe_walk" else MOCAP / motion] if motion else []
    if skeleton:
        (tmp_path / "body.toml").write_text(f'skeleton = "{(MOCAP / skeleton).resolve()}"\n')
        options += ["--character", tmp_path / "body.toml"]
    run("replay", trace, "--out", tmp_path / "out", *options)
    assert not broken(c for c in judge.check_walk(Walk(tmp_path / "out")) if not acceptance.is_not_met_yet("", c))


def test_members_of_a_crowd_keep_the_bounds_of_single_walkers(run, pytestconfig, tmp_path):
    size = 64 if pytestconfig.getoption("--quick") else MEMBERS
    trace = tmp_path / "trace.hid"
    write_trace(trace, [(0.5, 0.0, 0.8), (5.0, 0.3, 0.7), (7.0, 0.0, 0.5), (9.0, 0.0, 0.0)], (), 12.0, comment="crowd")
    run("replay", trace, "--crowd", size, "--out", tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["crowd"] == size
    found = []
    for index in range(2, 2 + JUDGED):
        walk = Walk(tmp_path, index=index)
        assert sum(walk.summary[f"steps_{side}"] for side in ("left", "right")) > 8
        # Members follow their places in the crowd, so their sticks always change: judge legs as during such a change.
        legs = [check for check in judge.leg_checks(walk) if check.name.startswith("leg d2")]
        sharpest = max(legs, key=lambda check: check.value)
        found += broken(judge.file_checks(walk) + judge.stage_checks(walk) + judge.contact_checks(walk) +
                        [Check("leg d2", sharpest.value, 1.3, note=sharpest.note)], f"member {index - 1}: ")
    assert not found, "\n".join(found)
