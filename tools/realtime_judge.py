#!/usr/bin/python3
"""Judges the measurement of tools/realtime.sh: realtime_judge.py SUMMARY.json CONTROL.json --steal N --seconds N.

Exit status 1 if it failed, 0 if it passed or cannot be judged.
"""
import argparse
import json
import sys

MOST_LATE_PER_MILLE = 1.0


def per_mille(count, ticks):
    return 1000.0 * count / max(ticks, 1)


def broken_promises(s, seconds):
    """Failures that neither a slow host nor an ordinary priority excuses, one sentence each."""
    ticks, rate_hz, time_s = s["ticks"], s["rate_hz"], s["time_s"]
    # Tick 0 is due at time 0. At the end, late ticks may be missing.
    due = int((time_s - s["skipped_s"]) * rate_hz) + 1
    under_way = 1 + int(s["late_us_max"] * 1e-6 * rate_hz)
    if not due - under_way <= ticks <= due + 1:
        yield f"{ticks} ticks ran, {due} were due: some were left out or run twice"
    if time_s < 0.95 * seconds:
        yield f"it ran for {time_s:.1f} s of {seconds:.0f}"
    if s["steps_left"] + s["steps_right"] < 0.5 * time_s:
        yield "nobody walked"


def is_punctual(overruns, ticks):
    return per_mille(overruns, ticks) < MOST_LATE_PER_MILLE


def reasons_not_to_judge(s, steal):
    if not s["time_policy"].startswith("SCHED_FIFO"):
        yield f"SCHED_FIFO was refused (the loop ran at {s['time_policy']})"
    if steal > 0:
        yield f"the host took {steal * 10} ms away (steal)"


def verdict(s, control, steal, seconds):
    """The verdict as (sentence, exit status)."""
    broken = list(broken_promises(s, seconds))
    found = (f"{per_mille(s['overruns'], s['ticks']):.3f} in 1000 ticks began more than one period late, "
             f"{s['skipped_s']:.1f} s were skipped, none ran twice")
    is_kept = is_punctual(s["overruns"], s["ticks"]) and s["skipped_s"] == 0
    if broken:
        return f"FAILED: {'; '.join(broken)}; {found}", 1
    if is_kept and steal == 0 and s["time_policy"].startswith("SCHED_FIFO"):
        return f"PASSED: {found}", 0
    if reasons := list(reasons_not_to_judge(s, steal)):
        return f"NOT JUDGED: {' and '.join(reasons)}; {found}", 0
    blame = f"; a thread that only sleeps was late {control['late']} times" if control.get("late") else ""
    return f"FAILED: {found}{blame}", 1


def print_numbers(s, control, steal):
    print(f"ticks          {s['ticks']} in {s['time_s']:.2f} s at {s['rate_hz']} Hz, {s['time_policy']}")
    print(f"overruns       {s['overruns']} ({per_mille(s['overruns'], s['ticks']):.3f} per mille)")
    if control:
        print(f"control        {control['late']} (a thread that only sleeps), "
              f"at most {control['worst_us']} us late")
    print(f"steal          {steal * 10} ms")
    print(f"skipped        {s['skipped_s']:.3f} s")
    print(f"lateness       {s['late_us_median']:.0f} us, at most {s['late_us_max']:.0f} us")
    print(f"a tick         {s['tick_us_median']:.0f} us, at most {s['tick_us_max']:.0f} us")
    print(f"a report waits {s['wait_us_median']:.0f} us, at most {s['wait_us_max']:.0f} us")
    drawn = f"{s['frames_per_second']:.1f} frames a second" if "frames_per_second" in s else "nothing"
    print(f"drawn          {drawn}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("summary")
    parser.add_argument("control")
    parser.add_argument("--steal", type=int, required=True, help="hundredths of a second")
    parser.add_argument("--seconds", type=float, required=True)
    options = parser.parse_args()
    with open(options.summary, encoding="utf-8") as file:
        s = json.load(file)
    s = s[0] if isinstance(s, list) else s
    with open(options.control, encoding="utf-8") as file:
        control = json.loads(file.read() or "{}")
    print_numbers(s, control, options.steal)
    sentence, status = verdict(s, control, options.steal, options.seconds)
    print(sentence)
    return status


if __name__ == "__main__":
    sys.exit(main())
