"""Runs gaitpad and judges how it ended."""
import contextlib
import os
import pathlib
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Real recordings and motions: beside the repository, unless GAITPAD_DATA names another folder.
DATA = pathlib.Path(os.environ.get("GAITPAD_DATA") or ROOT.parent / "shared/data")
ROUND = ROOT / "config/traces/round.hid"


def has_sanitizers(program):
    """True for a program with sanitizers: it is slower, and AddressSanitizer delays the reuse of freed memory."""
    return b"__asan_init" in program.read_bytes()


def run(program, *arguments, status=0, **options):
    """Runs a command to its end and expects that exit status (None: any)."""
    stdin = {} if "input" in options else {"stdin": subprocess.DEVNULL}
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False,
                          **{**stdin, "timeout": 300, **options})
    assert status is None or done.returncode == status, \
        f"{' '.join(map(str, arguments))} ended with {done.returncode}, not {status}: {done.stdout[-2000:]}{done.stderr}"
    return done


def call(*command, **options):
    """The output of another program, which must succeed."""
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def refuse(program, *arguments, says=(), status=1, **options):
    """Expects a failure with only one sentence on stderr that contains each of `says`."""
    done = run(program, *arguments, status=status, **options)
    assert done.stdout == "", f"{arguments}: {done.stdout}"
    if status == 1:
        assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    for part in [says] if isinstance(says, str) else says:
        assert part in done.stderr, f"{part!r} is not in {done.stderr!r}"
    return done


@contextlib.contextmanager
def started(program, *arguments, **options):
    """Runs a program beside the test and kills it, if it still runs, when the block ends."""
    with subprocess.Popen([program, *map(str, arguments)], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          **{"stdin": subprocess.DEVNULL, **options}) as process:
        try:
            yield process
        finally:
            if process.poll() is None:
                process.kill()


def wait_until(condition, most_s=60):
    """Waits until condition() is true, at most that number of seconds."""
    deadline = time.monotonic() + most_s
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def wait_until_recorded(path):
    """Waits until the session that records there has written reports."""
    part = pathlib.Path(f"{path}.part")
    wait_until(lambda: part.exists() and part.read_bytes().count(b"\nE: ") > 20)


def wait_until_works(process, seconds=0.5):
    """Waits until a started program has used that processor time."""
    def used_s():
        fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    wait_until(lambda: used_s() > seconds)


def end_by(process, *signals, status=0):
    """Ends a started program by these signals and returns (stdout, stderr)."""
    for number in signals:
        process.send_signal(number)
    out, errors = process.communicate(timeout=60)
    assert process.returncode == status, errors
    return out, errors
