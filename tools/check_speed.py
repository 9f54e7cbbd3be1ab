#!/usr/bin/python3
"""check_speed.py [COUNT...] [--program build/gaitpad] [--jobs 2]: measures the elapsed and processor time of `gaitpad
check` for COUNT recordings of 20 s (default: 250, 500 and 1000), and that it grows linearly; then that of `gaitpad
replay` for the smallest COUNT, in one process and in a process each, with and without files."""
import argparse
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))
from support.traces import raw_stick, write_trace  # noqa: E402

SECONDS = 20
REPORTS_HZ = 125


def write_walk(path, number):
    """A stick that is pushed, circles and is released, at 125 reports a second."""
    turn = (number % 41 - 20) / 40
    timeline = [(0.0, 0.0, 0.0)]
    for i in range(1, (SECONDS - 3) * REPORTS_HZ):
        forward = 0.5 + 0.4 * (i % (5 * REPORTS_HZ)) / (5 * REPORTS_HZ)
        timeline.append((i / REPORTS_HZ, *raw_stick(turn * (i % 7) / 7, forward)))
    timeline.append((SECONDS - 3, 0.0, 0.0))
    write_trace(path, timeline, end_s=SECONDS)


def timed(command):
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure_replays(program, recordings, out):
    """The same replays in one process and in a process each. The files go to one folder, so that the last ones remain."""
    count = len(recordings)
    for files, name in (([], "replay"), (["--out", out], "replay --out")):
        wall, cpu = timed([program, "replay", *recordings, *files])
        print(f"{count:>10} {wall:8.1f} {cpu:8.1f} {1000 * cpu / count:12.1f}   {name}, one process")
        each = [timed([program, "replay", recording, *files]) for recording in recordings]
        wall, cpu = map(sum, zip(*each))
        print(f"{count:>10} {wall:8.1f} {cpu:8.1f} {1000 * cpu / count:12.1f}   {name}, {count} processes")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("counts", nargs="*", type=int, default=[250, 500, 1000])
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/gaitpad")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    print(f"{'recordings':>10} {'wall s':>8} {'cpu s':>8} {'cpu ms each':>12}   ({SECONDS} s each, -j {arguments.jobs})")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        most = max(arguments.counts)
        (folder / "all").mkdir()
        for i in range(most):
            write_walk(folder / f"all/walk{i:05}.hid", i)
        wall, cpu = timed([arguments.program, "check", "--update", "-j", str(arguments.jobs), folder / "all"])
        print(f"{most:>10} {wall:8.1f} {cpu:8.1f} {1000 * cpu / most:12.1f}   --update")
        recordings = sorted((folder / "all").glob("*.hid"))
        for count in arguments.counts:
            wall, cpu = timed([arguments.program, "check", "-j", str(arguments.jobs), *recordings[:count]])
            print(f"{count:>10} {wall:8.1f} {cpu:8.1f} {1000 * cpu / count:12.1f}")
        measure_replays(arguments.program, recordings[:min(arguments.counts)], folder / "out")


if __name__ == "__main__":
    main()
