"""What all tests share: `--program`, its runs, and the words by which tools/ctest.sh knows skipped cases.

/usr/bin/python3 -m pytest -q -p no:cacheprovider tests/tools/play_test.py --program build/gaitpad
"""
import functools
import os
import pathlib

import pytest

pytest.register_assert_rewrite("support")
from support import program as programs  # noqa: E402

ALL_SKIPPED = 77  # the exit status that ctest counts as skipped


def pytest_addoption(parser):
    parser.addoption("--program", type=pathlib.Path, default=programs.ROOT / "build/gaitpad", help="the gaitpad to test")
    parser.addoption("--quick", action="store_true", help="fewer walks, for a program with sanitizers")
    parser.addoption("--slice", metavar="K/N", help="only the K-th of N parts, for ctest to run the parts side by side")


def pytest_configure(config):
    # No test sees the calibrations of whoever runs it, nor the strides in the cache.
    folder = config.getoption("--program").resolve().parent
    os.environ.setdefault("XDG_CONFIG_HOME", str(folder / "no-user-config"))
    os.environ["XDG_CACHE_HOME"] = str(folder / "no-user-cache")


def pytest_collection_modifyitems(config, items):
    """Chooses the part of this run. Neighbours stay together, so that a part still shares what a file's tests share."""
    if config.getoption("--slice"):
        part, parts = map(int, config.getoption("--slice").split("/"))
        first, last = (len(items) * k // parts for k in (part - 1, part))
        config.hook.pytest_deselected(items=items[:first] + items[last:])
        items[:] = items[first:last]


@pytest.fixture(scope="session")
def program(pytestconfig):
    path = pytestconfig.getoption("--program").resolve()
    assert path.exists(), f"{path} is not built"
    return path


@pytest.fixture(scope="session")
def run(program):
    """A function that runs the program: run("pads", "--json").stdout"""
    return functools.partial(programs.run, program)


@pytest.fixture(scope="session")
def refuse(program):
    return functools.partial(programs.refuse, program)


@pytest.fixture(scope="session")
def started(program):
    return functools.partial(programs.started, program)


def pytest_terminal_summary(terminalreporter):
    """Prints a pair of lines for each skipped case, as GoogleTest does."""
    for report in terminalreporter.stats.get("skipped", ()):
        path, line, reason = report.longrepr
        terminalreporter.write_line(f"{path}:{line}: Skipped\n{reason.removeprefix('Skipped: ')}")


def pytest_sessionfinish(session):
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if session.exitstatus == 0 and reporter.stats.get("skipped") and not reporter.stats.get("passed"):
        session.exitstatus = ALL_SKIPPED
