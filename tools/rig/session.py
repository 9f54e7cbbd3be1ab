"""The program in a test: run("gaitpad", "pads"), and a `gaitpad play` beside the test with what its recording says,
`with Session(...) as session: ...`. What a test measured for the reader: remark("median 0.3 ms") comes to the
screen and into build/rig/results."""
import collections
import contextlib
import csv
import json
import os
import re
import signal
import subprocess
import time

import outside
from pads import PATIENCE, ROOT, wait_for
from support import terminal

BUILD = os.environ.get("RIG_BUILD") or os.path.join(ROOT, "build")
PROGRAM = os.path.join(BUILD, "gaitpad")
IDS = {"generic": "1209:0001", "ds4": "054c:09cc", "dualsense": "054c:0ce6", "switch": "057e:2009",
       "xbox360": "045e:028e", "xboxone": "045e:02ea"}
HAS_SANITIZERS = BUILD.rstrip("/").endswith(("-asan", "-tsan"))
TICK_S = 1 / 240


def remark(text):
    with open("/results/remarks", "a") as file:
        file.write(text + "\n")


def run(*command, seconds=60, columns=()):
    """Runs a command, which must succeed, and returns its output; "gaitpad" is the program. Runs outside the guest if
    it opens no device."""
    command = [PROGRAM if word == "gaitpad" else str(word) for word in command]
    print("$", *command, flush=True)
    if command[0] == PROGRAM and command[1] in outside.COMMANDS:
        done = outside.ask(command, columns, PATIENCE * seconds)
    else:
        done = subprocess.run(command, timeout=PATIENCE * seconds, capture_output=True, text=True, check=False)
    print(done.stdout[:2000], done.stderr, sep="", flush=True)
    assert done.returncode == 0, f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()[-500:]}"
    return done


def record(*arguments, reports=1, user=()):
    """The lines of a `gaitpad record` by the command `user` as another user; it runs until it has that number of
    reports, because a busy host may take long to open the pad."""
    path = "/tmp/recorded.hid"

    def lines():
        with contextlib.suppress(FileNotFoundError), open(path if os.path.exists(path) else path + ".part") as file:
            return file.read().splitlines()
        return []

    with contextlib.suppress(FileNotFoundError):
        os.unlink(path)
    command = [*user, PROGRAM, "record", *arguments, "--out", path]
    print("$", *command, flush=True)
    with subprocess.Popen(command) as process:
        try:
            wait_for(lambda: sum(line.startswith("E:") for line in lines()) >= reports or process.poll() is not None, 60,
                     f"{reports} reports in the recording")
            process.send_signal(signal.SIGINT)
            assert process.wait(60 * PATIENCE) == 0, f"record ended with {process.returncode}"
        finally:
            process.kill()
    return lines()


class Terminal(terminal.Terminal):
    """A terminal with the guest's patience."""

    def wait_for(self, pattern, seconds=20.0, since=0):
        return super().wait_for(pattern, PATIENCE * seconds, since)

    def wait_end(self, seconds=20.0):
        return super().wait_end(PATIENCE * seconds)


class Session:
    """Plays until the block ends, by Ctrl-C, and then replays its recording. `summary`, `replayed` and `reports`
    are known afterwards; `reports` are the decoded ones, in order."""

    def __init__(self, *arguments, name="session", awaited=1):
        self.path = f"/results/{name}.hid"
        self.awaited = awaited  # number of pads to wait for
        self._read, self._lines = 0, collections.defaultdict(list)
        self._command = [PROGRAM, "play", *map(str, arguments), "--no-window", "--json", "--record", self.path]

    def __enter__(self):
        print("$", *self._command, flush=True)
        with contextlib.suppress(FileNotFoundError):
            os.unlink(self.path)  # an earlier session's file, which lines() would read instead of this session's
        self.process = subprocess.Popen(self._command, stdout=subprocess.PIPE, text=True)
        try:
            wait_for(lambda: self.lines("V:") and self.plugged() >= self.awaited or self.process.poll() is not None, 60,
                     "the session and its pad")
        except BaseException:
            self.process.kill()
            self.process.wait()
            raise
        return self

    def __exit__(self, kind, *_):
        if kind is not None:
            self.process.kill()
            self.process.communicate()
            return
        self.process.send_signal(signal.SIGINT)
        output, _ = self.process.communicate(timeout=60 * PATIENCE)
        assert self.process.returncode == 0, f"play ended with {self.process.returncode}"
        self.summary = json.loads(output)
        self.replayed = json.loads(run("gaitpad", "replay", self.path, "--json", seconds=300).stdout)
        assert self.summary["recording_lost"] == 0, self.summary
        assert self.summary["pose_hash"] == self.replayed["pose_hash"], "the replay differs from the session"

    def lines(self, start=""):
        """The lines of the recording so far: all, or those that begin with these two characters."""
        path = self.path if os.path.exists(self.path) else self.path + ".part"
        with contextlib.suppress(FileNotFoundError), open(path, "rb") as file:
            file.seek(self._read)  # read only new lines, because a test asks many times a second
            data = file.read()
            data = data[:data.rfind(b"\n") + 1]
            self._read += len(data)
            for line in data.decode().splitlines():
                self._lines[line[:2]].append(line)
                self._lines[""].append(line)
        return list(self._lines[start])

    def plugged(self):
        return sum(line.endswith(" add") for line in self.lines("H:"))

    def unplugged(self):
        return sum(line.endswith(" remove") for line in self.lines("H:"))

    def show(self, driver, pad, seconds, **state):
        """Sets the pad's state for at least that time. SDL keeps only the newest state, and on a busy host the program
        may read later; so with its driver this waits until the state is in the recording."""
        before = len(self.lines("E:"))
        pad.set(**state)
        time.sleep(seconds)
        if driver == "sdl":
            wait_for(lambda: len(self.lines("E:")) > before, 10, f"a report of {state}")

    def wait_quiet(self, seconds=0.5):
        """Waits until no report has come for that time, so that the recording holds all reports even on a busy host."""
        before = -1
        while before != (before := len(self.lines("E:"))):
            time.sleep(seconds)

    def wait_plugged(self, count, seconds=30):
        wait_for(lambda: self.plugged() >= count, seconds, f"pad number {count} in the recording")

    def wait_unplugged(self, count, seconds=10):
        wait_for(lambda: self.unplugged() >= count, seconds, f"unplugging number {count} in the recording")

    def handles(self):
        """The program's number of open file descriptors."""
        return len(os.listdir(f"/proc/{self.process.pid}/fd"))

    def decoded(self):
        """Every report of the recording as `gaitpad decode` prints it."""
        rows = map(json.loads, run("gaitpad", "decode", self.path, "--json", seconds=300).stdout.splitlines())
        return [row for row in rows if "axes" in row]

    def frames(self):
        """The replay's ticks from frames.csv: a list of dictionaries of texts."""
        text = run("gaitpad", "replay", self.path, columns=("stage", "stick_x", "stick_y"), seconds=300).stdout
        return list(csv.DictReader(text.splitlines()))


def tick_times_ns(lines):
    """A function that returns the due time of a tick by CLOCK_MONOTONIC."""
    rate_hz, starts = 240, []
    for line in lines:
        if found := re.match(r"V: \d rate_hz=(\d+)", line):
            rate_hz = int(found[1])
        if found := re.match(r"# tick (\d+) began at CLOCK_MONOTONIC (\d+)\.(\d{9})", line):
            starts.append((int(found[1]), int(found[2]) * 10**9 + int(found[3])))

    def time_ns(tick):
        first, start_ns = [start for start in starts if start[0] <= tick][-1]
        return start_ns + (tick - first) * 10**9 // rate_hz
    return time_ns


def ticks_of(lines, wanted):
    """The tick of each line of a recording for which wanted(line) is true."""
    tick, found = 0, []
    for line in lines:
        if line.startswith("T: "):
            tick = int(line[3:])
        elif wanted(line):
            found.append(tick)
    return found
