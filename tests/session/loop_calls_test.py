"""The system calls of the loop's thread, by strace: only its sleep, and waking a sleeping thread, whatever walks,
records and streams at the same time. GAITPAD_ALL=1: for a minute, else for a few seconds."""
import collections
import re
import shutil
import subprocess

import pytest

from support import slices
from support.program import ROUND, has_sanitizers

SECONDS = 60 if slices.ALL else 3
# Each write must be a wake-up: the eight bytes of an eventfd.
SLEEP, WAKE_UPS = "clock_nanosleep", (r"futex\(.*FUTEX_WAKE", r'write\(\d+, "\\1(\\0){7}", 8\b')


def calls_of(trace, thread):
    """The lines of that thread's calls, in order, from its first sleep to its last."""
    number, lines = None, collections.defaultdict(list)
    for line in trace.splitlines():
        task, call = line.split(maxsplit=1)
        lines[task].append(call)
        if call.startswith(f'prctl(PR_SET_NAME, "{thread}"'):
            number = task
    calls = lines[number]
    sleeps = [i for i, call in enumerate(calls) if call.startswith(SLEEP)]
    assert sleeps, f"{thread} never slept: {calls[-20:]}"
    return [call for call in calls[sleeps[0]:sleeps[-1] + 1] if "resumed>" not in call]


def others(calls):
    return [call for call in calls if not re.match("|".join((SLEEP, *WAKE_UPS)), call)]


@pytest.fixture
def traced(program, tmp_path):
    if shutil.which("strace") is None:
        pytest.skip("strace is not installed")
    if subprocess.run(["strace", "-o", "/dev/null", "true"], capture_output=True, check=False).returncode != 0:
        pytest.skip("strace may not trace here")
    if has_sanitizers(program):
        pytest.skip("a program with sanitizers asks the kernel for more")

    def trace(*arguments):
        out = tmp_path / "calls"
        done = subprocess.run(["strace", "-f", "-s", "64", "-o", out, program, "play", "--no-window", "--seconds", str(SECONDS),
                               *map(str, arguments)], capture_output=True, text=True, check=False, timeout=300)
        assert done.returncode == 0, done.stderr
        return out.read_text()
    return trace


@pytest.mark.parametrize("arguments", [(), (ROUND, "--crowd", "20"), (ROUND, "--stream", "json://127.0.0.1:39540")],
                         ids=["no pad", "a recording and a crowd", "a recording and a stream"])
def test_the_loop_sleeps_and_wakes_and_asks_for_nothing_else(traced, tmp_path, arguments):
    record = ("--record", tmp_path / "walk.hid") if arguments else ()  # without a pad there is nothing to record
    calls = calls_of(traced(*arguments, *record), "gaitpad-loop")
    sleeps = sum(call.startswith(SLEEP) for call in calls)
    print(f"{sleeps} sleeps, {len(calls) - sleeps} wake-ups in {SECONDS} s")
    assert sleeps > 5 * SECONDS, sleeps  # a traced program is slow: some ticks are late and follow at once
    assert not others(calls), collections.Counter(re.split(r"[( ]", call)[0] for call in others(calls))


def test_a_call_that_is_no_wake_up_is_found():
    trace = "\n".join(["7 prctl(PR_SET_NAME, \"gaitpad-loop\") = 0", "7 mlockall(3) = 0", "7 clock_nanosleep(1) = 0",
                       "8 openat(AT_FDCWD, \"x\") = 3", "7 futex(0x1, FUTEX_WAKE_PRIVATE, 1) = 1",
                       '7 write(5, "\\1\\0\\0\\0\\0\\0\\0\\0", 8) = 8', "7 clock_nanosleep(1 <unfinished ...>", "8 close(3) = 0",
                       "7 <... clock_nanosleep resumed>) = 0", '7 write(5, "hello", 5) = 5', "7 clock_nanosleep(1) = 0",
                       "7 exit(0) = ?"])
    calls = calls_of(trace, "gaitpad-loop")
    assert len(calls) == 6 and others(calls) == ['write(5, "hello", 5) = 5']
