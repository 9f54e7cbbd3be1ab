"""The recordings of tested pads still decode to the controls that the person saw (docs/tested-pads.md)."""
import pytest

from support.program import ROOT
from support.tested_pad import problems

FOLDERS = sorted((ROOT / "tests/data/tested").glob("*/"))


@pytest.mark.skipif(not FOLDERS, reason="nobody has contributed a tested pad so far")
def test_tested_pads_are_decoded_as_they_were_seen(run):
    assert [problem for folder in FOLDERS for problem in problems(run, folder)] == []
