"""Marks for the tests of the rig: test_*.py files with functions test_*, each run in a process of its own.

@cases(*KINDS)   one run for each value, which is the function's argument
@timeout(120)    seconds; 60 without it
@long            only by `rig.sh --long` (pads.LONG tells within a test)
A test fails by an exception, skips by unittest.SkipTest; what it prints is in its log. What it measured for
the reader: remark("median 0.3 ms") comes to the screen and into build/rig/results.
"""
import os
import subprocess

from pads import ROOT

BUILD = os.environ.get("RIG_BUILD") or os.path.join(ROOT, "build")
PROGRAM = os.path.join(BUILD, "gaitpad")


def cases(*values):
    def mark(function):
        function.cases = values
        return function
    return mark


def timeout(seconds):
    def mark(function):
        function.timeout = seconds
        return function
    return mark


def long(function):
    function.long = True
    return function


def remark(text):
    with open(os.environ["RIG_REMARKS"], "a") as file:
        file.write(text + "\n")


def run(*command, seconds=60, user=None, check=True):
    """Runs a command, the program's path for "gaitpad"; its output. `user`: as this number, without groups."""
    command = [PROGRAM if word == "gaitpad" else str(word) for word in command]
    if user is not None:
        command = ["setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups", *command]
    print("$", *command, flush=True)
    done = subprocess.run(command, timeout=seconds, capture_output=True, text=True)
    print(done.stdout, done.stderr, sep="", flush=True)
    if check and done.returncode != 0:
        raise AssertionError(f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()[-500:]}")
    return done
