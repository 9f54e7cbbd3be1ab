#!/usr/bin/python3
"""Writes config/traces/round.hid: the stick of a synthetic pad over twenty seconds, in the format of hid-recorder.

Stand, walk on, a curve to the left and one to the right, limp for a while (a command), stop. The pad
sends a report when something has changed, at most every 8 ms. Usage: make_round_trace.py > round.hid
--plain writes config/traces/walk.hid: the same stick without commands.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests"))
from support import traces  # noqa: E402

RATE_HZ = 240
PERIOD_US = 8000
END_S = 20

# Game pad: X Y Z Rz of 8 bits, a hat, 12 buttons; no report id.
DESCRIPTOR = bytes.fromhex("""
05 01 09 05 a1 01
15 00 26 ff 00 75 08 95 04 09 30 09 31 09 32 09 35 81 02
15 00 25 07 75 04 95 01 09 39 81 42
05 09 15 00 25 01 75 01 95 0c 19 01 29 0c 81 02
c0
""")

# seconds, sideways (+ right), forward; the stick moves in straight lines between these points
STICK = [
    (0.0, 0.0, 0.0),
    (1.0, 0.0, 0.0),
    (1.3, 0.0, 0.8),
    (5.0, 0.0, 0.8),
    (5.3, -0.5, 0.7),
    (8.0, -0.5, 0.7),
    (8.3, 0.0, 0.9),
    (9.5, 0.0, 0.9),
    (9.8, 0.5, 0.7),
    (12.5, 0.5, 0.7),
    (12.8, 0.0, 0.8),
    (18.0, 0.0, 0.8),
    (18.3, 0.0, 0.0),
    (END_S, 0.0, 0.0),
]
COMMANDS = [(13.0, "style limp_left"), (16.5, "style even")]


def stick_at(t):
    for (t0, x0, y0), (t1, x1, y1) in zip(STICK, STICK[1:]):
        if t <= t1:
            u = (t - t0) / (t1 - t0)
            return x0 + (x1 - x0) * u, y0 + (y1 - y0) * u
    return 0.0, 0.0


def count(value):
    return max(0, min(255, math.floor(127.5 + 127.5 * value + 0.5)))


def report_at(t):
    """The report at that time. The thumb trembles by less than a count; the middle rests at 0x7f or 0x80."""
    x, y = stick_at(t)
    tremble = 0.003 * math.sin(2 * math.pi * 9.0 * t) if (x, y) != (0.0, 0.0) else 0.0
    return [count(x + tremble), count(-y - tremble), 0x80, 0x80, 0x08, 0x00]


def main():
    is_plain = "--plain" in sys.argv[1:]
    lines = [f"V: 1 rate_hz={RATE_HZ}\n"]
    if is_plain:
        lines.append("# A walk of twenty seconds without commands: characters keep the styles that were chosen.\n")
    lines.append(traces.device(DESCRIPTOR, "Example Walk Pad"))
    commands = [] if is_plain else list(COMMANDS)
    last = None
    for us in range(0, END_S * 1_000_000, PERIOD_US):
        while commands and commands[0][0] * 1_000_000 <= us:
            lines.append(traces.command(*commands.pop(0)))
        report = report_at(us / 1_000_000)
        if report != last:
            lines.append(traces.report(us / 1_000_000, report))
            last = report
    print("".join(lines) + traces.end(END_S, RATE_HZ), end="")


if __name__ == "__main__":
    main()
