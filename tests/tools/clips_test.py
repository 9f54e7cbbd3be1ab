"""Exported clips as a game's import would judge them (support/clip_lint.py), and the judge itself with planted faults.
tests/tools/clips.py lints thirty of them."""
import numpy as np
import pytest

from support import slices
from support.clip_lint import CHECKS, Clip, faults, lint
from tools.clips import CLIPS, exported


@pytest.fixture(scope="module")
def even(program, tmp_path_factory):
    return exported(program, tmp_path_factory.mktemp("even"), 0.8, ("--style", "even"))


@pytest.mark.parametrize("name, stick, options", slices.chosen(CLIPS, 10, name=lambda clip: clip[0]), ids=lambda part: str(part))
def test_clips_have_no_fault(program, tmp_path, name, stick, options):
    figures = lint(exported(program, tmp_path, stick, options))
    assert not faults(figures), (name, figures)


def flip(clip):
    keys = clip.turns[max(clip.turns)]
    keys[len(keys) // 2:] *= -1


def bend(clip, degrees):
    """Turns a joint within the loop by these degrees, an array over its frames."""
    a, b = clip.loop
    keys = clip.turns[max(clip.turns)]
    for i, half in zip(range(a, b + 1), np.radians(degrees) / 2):
        x, y, z, w = keys[i]
        keys[i] = np.cos(half) * np.array([x, y, z, w]) + np.sin(half) * np.array([w, z, -y, -x])


def share(clip):
    """The elapsed share of the loop, 0 to 1."""
    a, b = clip.loop
    return np.linspace(0, 1, b - a + 1)


def break_the_loop(clip):
    bend(clip, 5 * share(clip))


def jerk_at_the_seam(clip):
    """A parabola that is smooth within the loop and 0 at both ends, where its velocity reverses."""
    bend(clip, 160 * share(clip) * (1 - share(clip)))


def hurry(clip):
    clip.position[:, clip.root, 2] *= 1.02


def slide(clip):
    clip.track["left", "toe"][:, 2] += 0.002 * np.arange(len(clip.times)) % 0.004


PLANTED = {"quaternion flips": flip, "loop closure": break_the_loop,
           "velocity jump at the seam over the largest inside": jerk_at_the_seam,
           "root motion's speed against the feet's": hurry, "a planted heel or toe slides": slide}


@pytest.mark.parametrize("name", CHECKS)
def test_the_judge_sees_a_planted_fault(even, name):
    clip = Clip.__new__(Clip)
    clip.__dict__.update(even.__dict__)
    clip.loop = even.loop
    clip.turns = {node: keys.copy() for node, keys in even.turns.items()}
    clip.position = even.position.copy()
    clip.track = {key: track.copy() for key, track in even.track.items()}
    assert not faults(lint(even))
    PLANTED[name](clip)
    assert name in faults(lint(clip)), lint(clip)
