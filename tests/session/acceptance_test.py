"""Walks of each motion, with every style, leg length and stick, keep every bound, judged from the exported files alone.
The cases are those of acceptance.py, which also prints their table."""
import os

import pytest

import acceptance


def pytest_generate_tests(metafunc):
    captured = acceptance.MOTIONS[:1] if metafunc.config.getoption("--quick") else acceptance.MOTIONS
    metafunc.parametrize("motion", ["default", *captured])


def test_walks_keep_every_bound(program, pytestconfig, tmp_path, motion):
    words = [str(program), "--out", str(tmp_path), "--rotate"] + (["--quick"] if pytestconfig.getoption("--quick") else [])
    options = acceptance.arguments(words)
    if motion != "default" and not os.path.exists(os.path.join(options.data, motion + ".bvh")):
        pytest.skip(f"{motion}.bvh is not in {options.data}")
    results = acceptance.run_motions([motion], options, processes=1 if pytestconfig.getoption("--slice") else 2)
    print(acceptance.summary_table(results))
    lines, count = acceptance.failures_text(results)
    assert count == 0, "\n".join(lines)
