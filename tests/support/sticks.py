"""Recordings of a pad whose sticks are known: centre, range and noise.

A second derivation of tests/stick/made_stick.h, written independently and with another random source. """
import math
import random

from support import traces

FORWARD, RIGHT, BACK, LEFT = (0, 1), (1, 0), (0, -1), (-1, 0)


def descriptor(bits):
    """Game Pad with X Y Z Rz of 8 or 16 unsigned bits, Brake and Accelerator of 8 bits, 8 buttons."""
    top = [0x26, 0xFF, 0x00] if bits == 8 else [0x27, 0xFF, 0xFF, 0x00, 0x00]
    return bytes([0x05, 0x01, 0x09, 0x05, 0xA1, 0x01, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09, 0x35, 0x15, 0x00] + top +
                 [0x75, bits, 0x95, 0x04, 0x81, 0x02, 0x05, 0x02, 0x09, 0xC5, 0x09, 0xC4, 0x26, 0xFF, 0x00,
                  0x75, 0x08, 0x95, 0x02, 0x81, 0x02, 0x05, 0x09, 0x19, 0x01, 0x29, 0x08, 0x25, 0x01, 0x75, 0x01,
                  0x95, 0x08, 0x81, 0x02, 0xC0])


class Stick:
    """A stick. Positions are raw fractions, +x right, +y forward. `path` is where a thumb puts it, in reach: -1..1."""

    def __init__(self, centre=(0.0, 0.0), reach=(1.0, 1.0), sigma=0.0, hysteresis=0.0, drift=(0.0, 0.0), seed=1):
        self.centre, self.reach, self.sigma, self.hysteresis, self.drift = centre, reach, sigma, hysteresis, drift
        self.random = random.Random(seed)

    def position(self, time_s, place, side):
        """The position. `side`: unit vector to where it was released; it matters at rest only."""
        rest = [self.hysteresis / 2 * s if place == (0, 0) else 0.0 for s in side]
        return [self.centre[i] + self.reach[i] * place[i] + rest[i] + self.drift[i] * time_s +
                self.random.gauss(0, self.sigma) for i in range(2)]


def thumb(turns=3, releases=8, rest_s=0.6, rate_hz=250, pushes=(FORWARD, RIGHT, BACK, LEFT)):
    """A thumb as (time, place, side): it rests, releases from all sides, turns, pushes and holds, and rests."""
    steps, time = [], 0.0

    def stay(seconds, place, side):
        nonlocal time
        for _ in range(round(seconds * rate_hz)):
            steps.append((time, place, side))
            time += 1 / rate_hz

    def go(seconds, start, end, side):
        nonlocal time
        count = round(seconds * rate_hz)
        for i in range(count):
            f = (i + 1) / (count + 1)
            steps.append((time, tuple(a + (b - a) * f for a, b in zip(start, end)), side))
            time += 1 / rate_hz

    side = (0.0, 0.0)
    stay(1.5, (0, 0), side)
    for i in range(releases):
        angle = 2 * math.pi * i / releases
        side = (math.cos(angle), math.sin(angle))
        go(0.1, (0, 0), side, side)
        stay(0.15, side, side)
        go(0.05, side, (0, 0), side)
        stay(rest_s, (0, 0), side)
    if turns:
        go(0.1, (0, 0), (1, 0), side)
        count = round(turns * 1.5 * rate_hz)
        for i in range(count):
            angle = 2 * math.pi * turns * i / count
            steps.append((time, (math.cos(angle), math.sin(angle)), side))
            time += 1 / rate_hz
        side = (1.0, 0.0)
        go(0.1, side, (0, 0), side)
        stay(rest_s, (0, 0), side)
    for push in pushes:
        go(0.1, (0, 0), push, push)
        stay(0.5, push, push)
        go(0.1, push, (0, 0), push)
        stay(rest_s, (0, 0), push)
    return steps


def counts(value, bits):
    top = (1 << bits) - 1
    return min(top, max(0, round((value + 1) / 2 * top)))


def trace_text(left, right, steps, bits=16, serial="", swap=lambda x, y: (x, y), name="made pad", product=0x0002):
    """The trace. `swap`: from the housing's x right, y forward to what the pad reports as such (left stick)."""
    text = traces.device(descriptor(bits), name, ids=f"3 1209 {product:04x}", physical="made", unique=serial)
    for time, place, side in steps:
        axes = [*swap(*left.position(time, place, side)), *right.position(time, place, side)]
        axes[1], axes[3] = -axes[1], -axes[3]  # HID's y grows towards the player
        squeeze = round(255 * max(0.0, place[1]))
        data = b"".join(counts(a, bits).to_bytes(bits // 8, "little") for a in axes) + bytes([squeeze, squeeze, 0])
        text += traces.report(time, data)
    return text


def worn_trace():
    """config/traces/worn.hid, the bundled recording of a worn left and a good right stick."""
    worn = Stick(centre=(0.11, -0.07), reach=(0.82, 0.76), sigma=0.012, hysteresis=0.06)
    good = Stick(centre=(0.01, 0.005), sigma=0.002, seed=2)
    return ("# Made by tests/support/sticks.py: a worn left stick, a good right one.\n" +
            trace_text(worn, good, thumb(turns=2, rest_s=0.5, rate_hz=125), bits=8, name="Worn pad (made)"))
