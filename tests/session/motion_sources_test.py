"""Walks from every kind of source keep the walk's bounds: key frames, and where the shared data are, Acclaim files
and bodies of other names and joints."""
import pytest

from support.judge import check_walk
from support.program import DATA
from support.traces import write_trace
from support.walk import Walk

MOCAP = DATA / "mocap"
# motion, whose body it walks on
SOURCES = [("keyframe_walk", None), ("cmu_35_01.amc", None), ("endorphin_walking.amc", None),
           ("endorphin_walking.amc", "daz3d_170_joints.bvh"), ("cmu_m21_walk.bvh", "endorphin.asf"),
           ("freebvh_mixamo_names.bvh", "cmu_07.asf"), (None, "makehuman_walk1.bvh"),
           ("cmu_006_01_iclone.bvh", "geno_stance_6channels.bvh")]


@pytest.mark.parametrize("motion, skeleton", SOURCES, ids=lambda name: name or "own")
def test_walks_keep_the_bounds(run, tmp_path, motion, skeleton):
    if motion != "keyframe_walk" and not MOCAP.is_dir():
        pytest.skip(f"there are no motions at {MOCAP}")
    trace = write_trace(tmp_path / "walk.hid", [(0.5, 0, 0.8), (6, 0, 0.4), (9, 0, 0)], (), 11)
    options = ["--motion", motion if motion == "keyframe_walk" else MOCAP / motion] if motion else []
    if skeleton:
        (tmp_path / "body.toml").write_text(f'skeleton = "{(MOCAP / skeleton).resolve()}"\n')
        options += ["--character", tmp_path / "body.toml"]
    run("replay", trace, "--out", tmp_path / "out", *options)
    broken = [f"{c.name}: {c.value:.4g} {c.note}" for c in check_walk(Walk(tmp_path / "out")) if c.ok is False]
    assert not broken, "\n".join(broken)
