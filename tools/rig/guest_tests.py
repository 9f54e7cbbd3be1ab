#!/usr/bin/python3
"""guest_tests.py [--only NAME] [--list]: runs the test_*.py files of this folder in the guest, one line a test.

Logs go to /results/NAME.log. Exit status 1 where one failed, or none ran.
"""
import argparse
import glob
import importlib
import os
import signal
import sys
import time
import traceback
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
RESULTS = "/results"
PASSED, FAILED, SKIPPED = 0, 1, 77


def find_tests():
    """(name, function, arguments) of all tests."""
    for path in sorted(glob.glob(os.path.join(HERE, "test_*.py"))):
        module = importlib.import_module(os.path.basename(path)[:-3])
        for name, function in vars(module).items():
            if not name.startswith("test_") or function.__module__ != module.__name__:
                continue
            short = f"{module.__name__[5:]}.{name[5:]}"
            if hasattr(function, "cases"):
                yield from ((f"{short}[{case}]", function, (case,)) for case in function.cases)
            else:
                yield short, function, ()


def run_child(name, function, arguments):
    """In the child: never returns."""
    os.setsid()
    log = os.open(f"{RESULTS}/{name}.log", os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    os.dup2(log, 1)
    os.dup2(log, 2)
    status = FAILED
    try:
        function(*arguments)
        status = PASSED
    except unittest.SkipTest as reason:
        print(f"skipped: {reason}")
        status = SKIPPED
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def run_test(name, function, arguments):
    """(status, seconds); whatever the test started in its session is ended."""
    start = time.monotonic()
    limit_s = getattr(function, "timeout", 60)
    child = os.fork()
    if child == 0:
        run_child(name, function, arguments)
    status = None
    while status is None:
        ended, code = os.waitpid(child, os.WNOHANG)
        if ended:
            status = os.waitstatus_to_exitcode(code)
        elif time.monotonic() - start > limit_s:
            with open(f"{RESULTS}/{name}.log", "a") as log:
                log.write(f"\nended after {limit_s} s\n")
            os.killpg(child, signal.SIGKILL)
            os.waitpid(child, 0)
            status = FAILED
        else:
            time.sleep(0.02)
    try:
        os.killpg(child, signal.SIGKILL)
    except ProcessLookupError:
        pass
    return status, time.monotonic() - start


def report(name, status, seconds):
    word = {PASSED: "ok  ", SKIPPED: "SKIP"}.get(status, "FAIL")
    with open(f"{RESULTS}/{name}.log", errors="replace") as log:
        lines = log.read().splitlines()
    reason = f": {lines[-1]}" if status == SKIPPED else ""
    print(f"{word} {name} {seconds:.1f} s{reason}", flush=True)
    if word == "FAIL":
        print("\n".join("     " + line for line in lines[-25:]), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="tests whose name contains this")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    sys.path.insert(0, HERE)
    wanted_long = os.environ.get("RIG_LONG") == "1"
    tests = [test for test in find_tests()
             if arguments.only in test[0] and (wanted_long or not getattr(test[1], "long", False))]
    if arguments.list:
        print("\n".join(test[0] for test in tests))
        return 0
    os.environ["RIG_REMARKS"] = f"{RESULTS}/remarks"
    counts = {PASSED: 0, FAILED: 0, SKIPPED: 0}
    shown = 0
    for name, function, values in tests:
        status, seconds = run_test(name, function, values)
        counts[status if status in counts else FAILED] += 1
        report(name, status, seconds)
        if os.path.exists(os.environ["RIG_REMARKS"]):
            with open(os.environ["RIG_REMARKS"]) as file:
                remarks = file.read().splitlines()
            print("".join(f"     {line}\n" for line in remarks[shown:]), end="", flush=True)
            shown = len(remarks)
    os.system(f"dmesg >{RESULTS}/dmesg")
    print(f"{counts[PASSED]} passed, {counts[FAILED]} failed, {counts[SKIPPED]} skipped "
          f"on Linux {os.uname().release}", flush=True)
    return 1 if counts[FAILED] or not counts[PASSED] else 0


if __name__ == "__main__":
    sys.exit(main())
