#!/usr/bin/python3
"""Writes the tables of docs/calibration.md: verdicts of simulated sticks with known faults.

  verdict_table.py build/tests/stick_verdicts [STICKS OF EACH KIND]
"""
import pathlib
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "calibration.md"
BEGIN, END = "<!-- begin: verdict_table.py -->\n", "<!-- end: verdict_table.py -->\n"


def main():
    sticks = sys.argv[2] if len(sys.argv) > 2 else "112"  # gives 2,016 sticks
    # Exit status 1: some stick was not judged as it must be; the tables say how many.
    tables = subprocess.run([sys.argv[1], sticks], check=False, text=True, stdout=subprocess.PIPE).stdout
    before, rest = PAGE.read_text().split(BEGIN)
    after = rest.split(END)[1]
    note = f"{sticks} sticks of each kind, every fourth on any pad.\n\n"
    PAGE.write_text(before + BEGIN + note + tables + END + after)


if __name__ == "__main__":
    main()
