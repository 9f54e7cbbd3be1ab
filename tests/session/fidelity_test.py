"""The walk keeps its capture: the built-in motion, and a clip made of it at another pace, judged by fidelity.py from the
exported files alone. Folders of clips are judged by hand: fidelity.py PROGRAM FOLDER."""
import numpy as np
import pytest

import fidelity
from support import bvh as bvhs
from support import sources
from support.traces import write_trace
from support.walk import Walk


def judged(program, folder, *words):
    """The rows of a run, none of them refused."""
    options = fidelity.arguments([str(program), "--out", str(folder), *map(str, words)])
    rows, refused, _ = fidelity.run_all(options)
    assert not refused, refused
    return rows


def assert_kept(row):
    assert not row["broken"], "\n".join(f"{c.name}: {c.value:.4g} {c.unit}, bound {c.bound_text()} {c.note}"
                                        for c in row["broken"])


def angles_zyx(local):
    """The angles (F, 3) in degrees about Z, Y, X of rotations Z Y X."""
    return np.degrees(np.stack([np.arctan2(local[:, 1, 0], local[:, 0, 0]), np.arcsin(np.clip(-local[:, 2, 0], -1, 1)),
                                np.arctan2(local[:, 2, 1], local[:, 2, 2])], -1))


@pytest.fixture
def slow_clip(run, tmp_path):
    """Three strides of the built-in walk's curves at 100 frames a second in place of 120, as a BVH file."""
    write_trace(tmp_path / "stand.hid", [(0.5, 0, 0.8)], (), 1)
    run("replay", tmp_path / "stand.hid", "--out", tmp_path / "stand")
    walk = Walk(tmp_path / "stand")
    clip, phase = walk.bvh, np.arange(3 * sources.BUILT_IN_FRAMES + 1) / sources.BUILT_IN_FRAMES
    moves, local = sources.built_in(walk, phase)
    moves[:, walk.pelvis, 2] += 1.25 * phase * sources.BUILT_IN_FRAMES / sources.BUILT_IN_RATE_HZ
    spin = ["Zrotation", "Yrotation", "Xrotation"]
    clip.channels = [[] if end else spin for end in clip.end_site]
    clip.channels[0] = ["Xposition", "Yposition", "Zposition"] + spin
    clip.first = list(np.cumsum([0] + [len(c) for c in clip.channels])[:-1])
    clip.data = np.concatenate([moves[:, 0] / walk.summary["metres_per_unit"]] +
                               [angles_zyx(local[:, j]) for j, end in enumerate(clip.end_site) if not end], -1)
    clip.frame_time = 0.01
    bvhs.write_bvh(clip, tmp_path / "slow.bvh")
    return tmp_path / "slow.bvh"


def test_the_built_in_motion_is_kept(program, tmp_path):
    assert_kept(judged(program, tmp_path, "--built-in")[0])


def test_a_clip_is_kept_at_its_own_pace(program, tmp_path, slow_clip):
    row = judged(program, tmp_path / "out", slow_clip)[0]
    assert_kept(row)
    assert row["stride_s"] == pytest.approx(sources.BUILT_IN_FRAMES / 100, rel=0.01)
