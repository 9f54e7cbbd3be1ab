#!/usr/bin/python3
"""Repeats the reports of a trace until it lasts long enough: long_trace.py IN.hid OUT.hid SECONDS.

Commands, ticks and the end are left out: it is to be played as a pad.
"""
import pathlib
import re
import sys

EVENT = re.compile(r"E: (\d+)\.(\d{6}) (.*)")
HEADER = ("D:", "R:", "N:", "P:", "I:", "U:", "B:", "M:", "K:")


def main():
    source, target, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    lines = pathlib.Path(source).read_text().splitlines()
    header = [line for line in lines if line.startswith(HEADER)]
    events = [(int(e[1]) * 1_000_000 + int(e[2]), e[3]) for e in map(EVENT.fullmatch, lines) if e]
    period_us = events[-1][0] - events[0][0] + 8000
    rounds = int(seconds * 1e6 / period_us) + 1
    with open(target, "w", encoding="utf-8") as file:
        print("\n".join(header), file=file)
        for i in range(rounds):
            for time_us, rest in events:
                time_us += i * period_us
                print(f"E: {time_us // 1_000_000:06d}.{time_us % 1_000_000:06d} {rest}", file=file)


if __name__ == "__main__":
    main()
