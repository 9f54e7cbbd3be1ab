#!/usr/bin/env python3
"""Writes synthetic `.hid` traces: a stick timeline and commands, for an own 16-bit pad.

  make_trace.py OUT.hid --stick 0:0,0 --stick 0.5:0,0.8 --command "4:style limp_left" --end 10
"""
import argparse
import math

RATE_HZ = 240
FULL = 32767
# Game Pad: X, Y, Z, Rz of 16 bits (-32767..32767), a hat, 12 buttons. No report id: 10 bytes.
DESCRIPTOR = bytes([
    0x05, 0x01, 0x09, 0x05, 0xA1, 0x01,                          # Generic Desktop, Game Pad, Application
    0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09, 0x35,              # X Y Z Rz
    0x16, 0x01, 0x80, 0x26, 0xFF, 0x7F, 0x75, 0x10, 0x95, 0x04, 0x81, 0x02,
    0x09, 0x39, 0x15, 0x00, 0x25, 0x07, 0x35, 0x00, 0x46, 0x3B, 0x01, 0x65, 0x14,
    0x75, 0x04, 0x95, 0x01, 0x81, 0x42, 0x65, 0x00, 0x45, 0x00,  # hat with null state
    0x05, 0x09, 0x19, 0x01, 0x29, 0x0C, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x0C, 0x81, 0x02,
    0xC0])
# Default calibration of the interface: radial zone, then 0.08 on the sideways axis.
DEFAULT_INNER, DEFAULT_OUTER, DEFAULT_SIDEWAYS = 0.2, 0.95, 0.08


# A calibration without zones: what the trace says is what frames.csv shows.
EXACT_CALIBRATION = """name = "exact, for tests"
devices = ["1209:0001"]

[left]
shape = "radial"
inner = 0.0
outer = 1.0

[right]
shape = "radial"
inner = 0.0
outer = 1.0
"""


def write_exact_calibration(path):
    with open(path, "w", encoding="utf-8") as file:
        file.write(EXACT_CALIBRATION)


def raw_stick(x, y, inner=DEFAULT_INNER, outer=DEFAULT_OUTER, sideways=DEFAULT_SIDEWAYS):
    """Uncalibrated position that the calibration turns into (x right, y forward). All zones 0 and
    outer 1 (an explicit calibration file) give (x, y) back."""
    x = math.copysign(sideways + (1 - sideways) * abs(x), x) if x else 0.0
    length = math.hypot(x, y)
    if length == 0:
        return 0.0, 0.0
    wanted = inner + length * (outer - inner)
    return x / length * wanted, y / length * wanted


def report(x, y):
    """Ten bytes; HID's Y grows backwards. The right stick rests, no hat, no buttons."""
    axes = [round(max(-1, min(1, v)) * FULL) for v in (x, -y, 0.0, 0.0)]
    return b"".join(a.to_bytes(2, "little", signed=True) for a in axes) + bytes([0x08, 0x00])


def _stamp(time_s):
    micros = round(time_s * 1e6)
    return f"{micros // 1000000:06d}.{micros % 1000000:06d}"


def trace_text(stick, commands=(), end_s=None, rate_hz=RATE_HZ, comment="synthetic"):
    """stick: list of (time_s, raw x, raw y); a neutral report stands at time 0. commands: (time_s, text)."""
    lines = [f"V: 1 rate_hz={rate_hz}", f"# {comment}", "D: 0",
             f"R: {len(DESCRIPTOR)} " + " ".join(f"{b:02x}" for b in DESCRIPTOR),
             "N: gaitpad test pad", "P: synthetic", "I: 3 1209 0001"]
    stick = list(stick)
    if not stick or stick[0][0] > 0:
        stick = [(0.0, 0.0, 0.0)] + stick
    events = [(t, 0, x, y) for t, x, y in stick] + [(t, 1, text, None) for t, text in commands]
    for time, kind, a, b in sorted(events, key=lambda e: (e[0], e[1])):
        if kind == 1:
            lines.append(f"C: {_stamp(time)} {a}")
        else:
            data = report(a, b)
            lines.append(f"E: {_stamp(time)} {len(data)} " + " ".join(f"{v:02x}" for v in data))
    last = max(e[0] for e in events)
    end_s = last + 1.0 if end_s is None else end_s
    lines.append(f"Q: {_stamp(end_s)} {round(end_s * rate_hz)}")
    return "\n".join(lines) + "\n"


def write_trace(path, stick, commands=(), end_s=None, rate_hz=RATE_HZ, comment="synthetic"):
    with open(path, "w", encoding="utf-8") as file:
        file.write(trace_text(stick, commands, end_s, rate_hz, comment))


def ramp(start_s, end_s, start, end, step_s=0.01):
    """A stick moved evenly from one raw position to another: list of (time, x, y)."""
    count = max(1, round((end_s - start_s) / step_s))
    mix = lambda i, a, b: a + (b - a) * i / count
    return [(mix(i, start_s, end_s), mix(i, start[0], end[0]), mix(i, start[1], end[1])) for i in range(count + 1)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out")
    parser.add_argument("--stick", action="append", default=[], metavar="T:X,Y", help="calibrated position from T on")
    parser.add_argument("--command", action="append", default=[], metavar="T:TEXT")
    parser.add_argument("--end", type=float)
    parser.add_argument("--rate", type=int, default=RATE_HZ)
    parser.add_argument("--raw", action="store_true", help="X,Y are raw: no zones are put in")
    options = parser.parse_args()
    stick = []
    for text in options.stick:
        time, _, place = text.partition(":")
        x, y = (float(v) for v in place.split(","))
        stick.append((float(time),) + ((x, y) if options.raw else raw_stick(x, y)))
    commands = [(float(t), text) for t, _, text in (c.partition(":") for c in options.command)]
    write_trace(options.out, stick, commands, options.end, options.rate)


if __name__ == "__main__":
    main()
