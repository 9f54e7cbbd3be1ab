#!/usr/bin/python3
"""Repeats the reports of a trace until it lasts long enough: long_trace.py IN.hid OUT.hid SECONDS.

Commands, ticks and the end are left out, because the result is played as a pad. """
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests"))
from support import traces  # noqa: E402


def main():
    source, target, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    reports = traces.reports(source)
    period_s = reports[-1][0] - reports[0][0] + 0.008
    with open(target, "w", encoding="utf-8") as file:
        file.writelines(f"{letter}: {rest}\n" for letter, rest in traces.lines(source, "DRNPIUBMK"))
        for i in range(int(seconds / period_s) + 1):
            file.writelines(traces.report(i * period_s + time_s, data) for time_s, data in reports)


if __name__ == "__main__":
    main()
