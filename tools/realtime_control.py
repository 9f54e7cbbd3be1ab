#!/usr/bin/python3
"""Measures whether the machine itself keeps time: realtime_control.py RATE_HZ, until SIGTERM.

On each processor a process of the highest priority only sleeps until its next tick, at the rate of
the loop. If it wakes late, the machine stood still, whatever `steal` says. Prints {"late": ticks more than one period late on the worst processor, "worst_us": ...},
or {} where SCHED_FIFO is refused.
"""
import json
import os
import signal
import sys
import time


def watch(processor, period_s, answer):
    """Counts late ticks until SIGTERM, then writes `late worst_us`."""
    os.sched_setaffinity(0, {processor})
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(os.sched_get_priority_max(os.SCHED_FIFO)))
    is_over = []
    signal.signal(signal.SIGTERM, lambda *_: is_over.append(True))
    late, worst_s, due = 0, 0.0, time.monotonic()
    while not is_over:
        due += period_s
        if (left := due - time.monotonic()) > 0:
            time.sleep(left)
        behind = time.monotonic() - due
        worst_s = max(worst_s, behind)
        late += behind > period_s
    os.write(answer, f"{late} {worst_s * 1e6:.0f}\n".encode())


def main():
    period_s = 1.0 / float(sys.argv[1])
    reading, writing = os.pipe()
    children = []
    for processor in sorted(os.sched_getaffinity(0)):
        if (child := os.fork()) == 0:
            try:
                watch(processor, period_s, writing)
            except OSError:
                pass
            os._exit(0)
        children.append(child)
    os.close(writing)
    for ending in (signal.SIGTERM, signal.SIGINT):
        signal.signal(ending, lambda *_: [os.kill(child, signal.SIGTERM) for child in children])
    with os.fdopen(reading) as answers:
        found = [tuple(map(int, line.split())) for line in answers]
    worst = {"late": max(f[0] for f in found), "worst_us": max(f[1] for f in found)} if found else {}
    print(json.dumps(worst))


if __name__ == "__main__":
    main()
