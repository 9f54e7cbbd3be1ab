"""Runs the rig's tests in the guest, each in its own process with a time limit, and prints one line per test.

A test fails by an exception and skips by pytest.skip; what it prints is in /results/NAME.log. Marks:
  @pytest.mark.timeout(120)  seconds on a free machine, 60 without it: the test is ended after pads.PATIENCE times as
                             long, with whatever it started
  @pytest.mark.long          only by `rig.sh --long` (pads.LONG tells within a test)
  @pytest.mark.other_slice   another run's part of a table (cells.py)
"""
import collections
import os
import pathlib
import select
import signal
import sys
import time

import pytest
from _pytest.runner import runtestprotocol

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))  # for `support`
from pads import PATIENCE  # noqa: E402
from support import slices  # noqa: E402
pytest.register_assert_rewrite("session")

RESULTS = pathlib.Path("/results")
REMARKS = RESULTS / "remarks"
PASSED, FAILED, SKIPPED = 0, 1, 77
WORDS = {PASSED: "ok  ", FAILED: "FAIL", SKIPPED: "SKIP"}
counts = dict.fromkeys(WORDS, 0)
parts_s, parts_busy_s = collections.Counter(), collections.Counter()  # seconds by file
shown = 0  # number of remarks shown so far


def pytest_addoption(parser):
    parser.addoption("--only", default="", help="tests whose name contains this")
    parser.addoption("--without", default="", help="no tests whose name contains this")


@pytest.hookimpl(trylast=True)
def pytest_configure(config):
    config.addinivalue_line("markers", "timeout(seconds): on a free machine; 60 without it")
    config.addinivalue_line("markers", "long: only by rig.sh --long")
    config.addinivalue_line("markers", "other_slice: not in this run's part of a table")
    if not config.option.collectonly:
        config.pluginmanager.unregister(name="terminalreporter")  # the hooks below print instead of it


def name_of(item):
    return f"{item.path.stem}.{item.name}".replace("test_", "")


def pytest_collection_modifyitems(config, items):
    is_long = os.environ.get("RIG_LONG") == "1"
    only, without = config.option.only, config.option.without
    is_whole = is_long or only or slices.ALL
    items[:] = [item for item in items if only in name_of(item) and not (without and without in name_of(item)) and
                (is_long or not item.get_closest_marker("long")) and
                (is_whole or not item.get_closest_marker("other_slice"))]
    print("Every cell of its tables" if is_whole else f"Of the tables slice {slices.NUMBER}", flush=True)


def pytest_collectreport(report):
    if report.failed:
        counts[FAILED] += 1
        print(report.longreprtext, flush=True)


def pytest_internalerror(excrepr):
    print(excrepr, flush=True)


def run_child(item, log):
    """In the child: never returns."""
    os.setsid()
    file = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    os.dup2(file, 1)
    os.dup2(file, 2)
    sys.stdout.reconfigure(line_buffering=True)  # keeps the output of a test that is killed
    status = FAILED
    try:
        reports = runtestprotocol(item, log=False, nextitem=None)
        for report in reports:
            if report.failed:
                print(report.longreprtext)
            elif report.skipped:
                print(f"skipped: {report.longrepr[2].removeprefix('Skipped: ')}")
        outcomes = {report.outcome for report in reports}
        status = FAILED if "failed" in outcomes else SKIPPED if "skipped" in outcomes else PASSED
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def end_session(child):
    try:
        os.killpg(child, signal.SIGKILL)
    except ProcessLookupError:
        pass


def busy_s():
    """Seconds that the guest's processor has worked, which is what the emulator costs its host."""
    user, nice, system, _, _, irq, softirq = map(int, pathlib.Path("/proc/stat").read_text().split(maxsplit=8)[1:8])
    return (user + nice + system + irq + softirq) / os.sysconf("SC_CLK_TCK")


def run_test(item, log):
    """The test's result as (status, seconds)."""
    start = time.monotonic()
    mark = item.get_closest_marker("timeout")
    limit_s = PATIENCE * (mark.args[0] if mark else 60)
    child = os.fork()
    if child == 0:
        run_child(item, log)
    ended = os.pidfd_open(child)
    is_ended = bool(select.select([ended], [], [], limit_s)[0])
    os.close(ended)
    if not is_ended:
        end_session(child)
        os.waitpid(child, 0)
        with open(log, "a") as file:
            file.write(f"\nended after {limit_s} s\n")
        return FAILED, time.monotonic() - start
    _, status = os.waitpid(child, 0)
    end_session(child)
    status = os.waitstatus_to_exitcode(status)
    return status if status in counts else FAILED, time.monotonic() - start


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item):
    global shown
    log = RESULTS / f"{name_of(item)}.log"
    before_s = busy_s()
    status, seconds = run_test(item, log)
    busy = busy_s() - before_s
    counts[status] += 1
    part = item.path.stem.removeprefix("test_")
    parts_s[part] += seconds
    parts_busy_s[part] += busy
    lines = log.read_text(errors="replace").splitlines()
    reason = f": {lines[-1]}" if status == SKIPPED else ""
    print(f"{WORDS[status]} {name_of(item)} {seconds:.1f} s, {busy:.1f} s busy{reason}", flush=True)
    if status == FAILED:
        print("\n".join("     " + line for line in lines[-40:]), flush=True)
    remarks = REMARKS.read_text().splitlines() if REMARKS.exists() else []
    print("".join(f"     {line}\n" for line in remarks[shown:]), end="", flush=True)
    shown = len(remarks)
    return True


def pytest_sessionfinish(session):
    if session.config.option.collectonly:
        return
    os.system(f"dmesg >{RESULTS}/dmesg")
    print("Seconds (the processor busy): " +
          ", ".join(f"{part} {seconds:.0f} ({parts_busy_s[part]:.0f})" for part, seconds in parts_s.items()))
    print(f"{counts[PASSED]} passed, {counts[FAILED]} failed, {counts[SKIPPED]} skipped "
          f"on Linux {os.uname().release}", flush=True)
    session.exitstatus = 1 if counts[FAILED] or not counts[PASSED] else 0
