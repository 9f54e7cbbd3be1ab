"""Writes traces (`.hid`) of made pads line by line or from a stick's timeline, and reads traces."""
import math
import pathlib

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
# Default calibration of the interface: radial zone, then 0.11 on the sideways axis.
DEFAULT_INNER, DEFAULT_OUTER, DEFAULT_SIDEWAYS = 0.2, 0.95, 0.11
# A calibration without zones: frames.csv shows the values of the trace.
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


def raw_stick(x, y):
    """The raw position that the default calibration maps to (x right, y forward)."""
    x = math.copysign(DEFAULT_SIDEWAYS + (1 - DEFAULT_SIDEWAYS) * abs(x), x) if x else 0.0
    length = math.hypot(x, y)
    if length == 0:
        return 0.0, 0.0
    wanted = DEFAULT_INNER + length * (DEFAULT_OUTER - DEFAULT_INNER)
    return x / length * wanted, y / length * wanted


# ---- lines -----------------------------------------------------------------------------------
def device(descriptor, name, ids="3 1209 0001", physical="", unique=""):
    """The lines of a trace that describe a pad. ids: bus, vendor and product in hexadecimal."""
    lines = [f"R: {len(descriptor)} {bytes(descriptor).hex(' ')}", f"N: {name}"]
    lines += [f"P: {physical}"] if physical else []
    return "\n".join(lines + [f"I: {ids}"] + ([f"U: {unique}"] if unique else [])) + "\n"


def report(time_s, data):
    return f"E: {time_s:013.6f} {len(data)} {bytes(data).hex(' ')}\n"


def command(time_s, text):
    return f"C: {time_s:013.6f} {text}\n"


def end(time_s, rate_hz=RATE_HZ):
    return f"Q: {time_s:013.6f} {round(time_s * rate_hz)}\n"


# ---- a stick's timeline ----------------------------------------------------------------------
def stick_report(x, y):
    """Ten bytes; HID's Y grows backwards. The right stick rests, no hat, no buttons."""
    axes = [round(max(-1, min(1, v)) * FULL) for v in (x, -y, 0.0, 0.0)]
    return b"".join(a.to_bytes(2, "little", signed=True) for a in axes) + bytes([0x08, 0x00])


def trace_text(stick, commands=(), end_s=None, rate_hz=RATE_HZ, comment="synthetic"):
    """The text of a trace. stick: list of (time_s, raw x, raw y); a neutral report is at time 0. commands: (time_s,
    text)."""
    stick = list(stick)
    if not stick or stick[0][0] > 0:
        stick = [(0.0, 0.0, 0.0)] + stick
    events = [(t, 0, report(t, stick_report(x, y))) for t, x, y in stick]
    events += [(t, 1, command(t, text)) for t, text in commands]
    events.sort(key=lambda e: e[:2])
    text = f"V: 1 rate_hz={rate_hz}\n# {comment}\nD: 0\n" + device(DESCRIPTOR, "gaitpad test pad", physical="synthetic")
    return text + "".join(e[2] for e in events) + end(events[-1][0] + 1.0 if end_s is None else end_s, rate_hz)


def write_trace(path, *timeline, **options):
    path = pathlib.Path(path)
    path.write_text(trace_text(*timeline, **options))
    return path


def ramp(start_s, end_s, start, end, step_s=0.01):
    """A stick that is moved evenly from one raw position to another, as a list of (time, x, y)."""
    count = max(1, round((end_s - start_s) / step_s))
    mix = lambda i, a, b: a + (b - a) * i / count
    return [(mix(i, start_s, end_s), mix(i, start[0], end[0]), mix(i, start[1], end[1])) for i in range(count + 1)]


# ---- what a trace holds ----------------------------------------------------------------------
def lines(path, letters):
    """The lines with these letters, as (letter, rest)."""
    text = pathlib.Path(path).read_text(errors="replace")
    return [(line[0], line[3:]) for line in text.splitlines() if line[1:2] == ":" and line[0] in letters]


def reports(path):
    """The reports, as (time_s, bytes)."""
    words = [rest.split() for _, rest in lines(path, "E")]
    return [(float(w[0]), bytes.fromhex("".join(w[2:]))) for w in words]


def trace_changes(path):
    """Times of the commands and plug events of a trace, seconds from the first event."""
    events = [(letter, float(rest.split()[0])) for letter, rest in lines(path, "ECH")]
    return [time_s - events[0][1] for letter, time_s in events if letter != "E"]


def beginning(path, seconds):
    """The trace up to that time, without its end line."""
    kept = [line for line in pathlib.Path(path).read_text().splitlines(keepends=True)
            if line[:2] not in ("E:", "C:", "Q:") or float(line.split()[1]) < seconds]
    return "".join(kept)
