"""Repeated plugging: pads of all kinds in turn, each with one short push that the session must see.

Four times each kind, a thousand times with --long, in sessions of fifty. Then at the full speed of the guest, by uhid: a pad
alone, and one behind a receiver that stays. A thousand times each, in less than 20 minutes:

  bash tools/rig.sh --long --kernel 6.1 --only at_full_speed
"""
import contextlib
import os
import random
import statistics
import time

import pytest

from pads import KINDS, LONG, Pad, wait_for
from session import HAS_SANITIZERS, IDS, Session, remark, ticks_of
from test_matrix import VALUES
from uhid_pad import EMPTY_PLUG, FULL_PLUG, UhidPad

SESSIONS, TURNS = (20, 50) if LONG else (1, 12 if HAS_SANITIZERS else 24)
PUSH_S = 0.15  # duration of a tap of the stick
CYCLES = 1000 if LONG else 10 if HAS_SANITIZERS else 50  # number of cycles at full speed, for each of two pads
# The byte of a recorded report that holds the stick's y, or its higher part, and its value at the rim.
RIM = {"generic": (1, 0x00), "ds4": (2, 0x00), "dualsense": (2, 0x00), "switch": (8, 0xe0), "xbox360": (3, 0x80),
       "xboxone": (3, 0x80)}
MOST_S = 3.0  # limit of the median time from the node to the session


def wait_rim(session, before, byte, value):
    """Waits until one of the recording's reports after the first `before` has the rim, as this value of this byte. A way
    back that begins sooner might come within the same tick on a busy host, or into the kernel's full queue."""
    wait_for(lambda: any(line.split()[3 + byte] == f"{value:02x}" for line in session.lines("E:")[before:]), 30,
             "the rim in the recording")


def push(pad, session):
    """Pushes the stick from rest to the rim and back, as a thumb does."""
    values, before = VALUES[pad.kind], len(session.lines("E:"))
    pad.move(ly=(values["rest"], values["forward"]))
    time.sleep(PUSH_S)
    wait_rim(session, before, *RIM[pad.kind])
    pad.move(ly=(values["forward"], values["rest"]))
    time.sleep(0.1)


def sticks_of(session):
    return [float(frame["stick_y"]) for frame in session.frames()]


def seen_pushes(session, sticks):
    """How often the pad was there and its stick went beyond 0.9. Where a busy host holds the guest up the pad is silent,
    and its stick goes to rest and comes back in the middle of a push."""
    ends = ticks_of(session.lines(), lambda line: line.startswith("H:") and line.endswith(" remove"))
    return sum(max(sticks[begin:end], default=0.0) > 0.9 for begin, end in zip([0, *ends], ends))


@pytest.mark.timeout(7200 if LONG else 900)
def test_every_push_after_plugging_in_is_seen():
    chance, waits_s = random.Random(1), []
    with contextlib.ExitStack() as stack:
        pads = [stack.enter_context(Pad(kind, index, plug=False)) for index, kind in enumerate(KINDS)]
        for number in range(SESSIONS):
            with Session("--no-rumble", name=f"plugging-{number}", awaited=0) as session:
                for turn in range(TURNS):
                    pad = pads[turn % len(pads)]
                    pad.plug()
                    start = time.monotonic()
                    session.wait_plugged(turn + 1, 30)
                    waits_s.append(time.monotonic() - start)
                    print(f"{turn} {pad.kind}: {waits_s[-1]:.2f} s", flush=True)
                    time.sleep(chance.uniform(0.2, 0.5))
                    push(pad, session)
                    pad.unplug()
                    session.wait_unplugged(turn + 1)
            seen = seen_pushes(session, sticks_of(session))
            assert seen == TURNS, f"session {number}: {seen} of {TURNS} pushes were seen"
            assert session.summary["plugged"] == session.summary["unplugged"] == TURNS
    ordered = sorted(waits_s)
    remark(f"plugging in: {len(waits_s)} times, each push of {PUSH_S} s was seen; open {statistics.median(ordered):.2f} s after "
           f"its node is there (median), {ordered[int(0.99 * (len(ordered) - 1))]:.2f} s (99th percentile), "
           f"{ordered[-1]:.2f} s at most")
    assert statistics.median(ordered) < MOST_S, ordered


@pytest.mark.timeout(200)
@pytest.mark.parametrize("case", ["generic-hidraw", "generic-usb", "xbox360-evdev"])
def test_a_pad_that_rests_when_it_is_opened_counts_from_its_first_push(case):
    """The pad has sent nothing since it was plugged in, so only a request shows that its stick rests. An event node
    cannot be asked: its axes are 0 until the first report, which is an Xbox pad's middle and a HID pad's edge."""
    kind, driver = case.split("-")
    times = 20 if LONG else 5
    with Pad(kind, plug=False) as pad, Session(IDS[kind], "--driver", driver, "--no-rumble", name=f"rest-{case}",
                                               awaited=0) as session:
        for turn in range(times):
            pad.plug(wait=False)
            session.wait_plugged(turn + 1, 30)
            time.sleep(0.4)
            push(pad, session)
            pad.unplug()
            session.wait_unplugged(turn + 1)
    assert seen_pushes(session, sticks_of(session)) == times
    remark(f"a pad that rests when it is opened, {case}: {times} times, its first push was seen")


class Alone:
    """A pad that is plugged in and out alone."""
    FIRST = 0
    FULL, REST, BYTE = 0, 128, 2  # values of its stick: forward, at rest; the stick's byte

    def __enter__(self):
        self.pad = UhidPad("plain")
        return self

    def __exit__(self, *_):
        pass

    def plug(self):
        self.pad.plug(wait=False)

    def unplug(self):
        self.pad.unplug(wait=False)


class BehindAReceiver:
    """A controller of an adapter that stays plugged in: a byte of its reports says whether it is there. Until the first
    report each of its four plugs may have one, so they are plugged in and out once more."""
    FIRST = 4
    FULL, REST, BYTE = 128 + 100, 128, 5

    def __enter__(self):
        self.pad = UhidPad("gamecube_adapter")
        self.pad.plug(wait=False)
        return self

    def __exit__(self, *_):
        self.pad.unplug(wait=False)

    def plug(self):
        self.pad.set(type=FULL_PLUG)

    def unplug(self):
        self.pad.set(type=EMPTY_PLUG)


def tap(source, session):
    """Moves the stick to the rim and back; the rim is held until the recording has it, a few ticks later."""
    way, before = source.FULL - source.REST, len(session.lines("E:"))
    for share in (0, 1 / 3, 2 / 3, 1):
        source.pad.set(ly=source.REST + round(share * way))
    wait_rim(session, before, source.BYTE, source.FULL)
    for share in (2 / 3, 1 / 3, 0):
        source.pad.set(ly=source.REST + round(share * way))


def held(session):
    """The program's numbers of (open files, threads)."""
    return session.handles(), len(os.listdir(f"/proc/{session.process.pid}/task"))


@pytest.mark.timeout(1200 if LONG else 120)
@pytest.mark.parametrize("source", [Alone, BehindAReceiver])
def test_every_tap_is_seen_at_full_speed(source):
    waits_s = []
    with source() as source, Session("--driver", "hidraw", "--no-rumble", name="full-speed", awaited=0) as session:
        if source.FIRST:
            session.wait_plugged(source.FIRST)
            source.unplug()
            session.wait_unplugged(source.FIRST)
        began = time.monotonic()
        for cycle in range(source.FIRST, source.FIRST + CYCLES):
            start = time.monotonic()
            source.plug()
            session.wait_plugged(cycle + 1)
            waits_s.append(time.monotonic() - start)
            tap(source, session)
            source.unplug()
            session.wait_unplugged(cycle + 1)
            if cycle == source.FIRST:
                first = held(session)
        took_s = time.monotonic() - began
        wait_for(lambda: held(session) <= first, 10, f"{first} files and threads as after the first cycle, not {held(session)}")
    assert session.summary["plugged"] == session.summary["unplugged"] == source.FIRST + CYCLES, session.summary
    sticks = sticks_of(session)
    seen = seen_pushes(session, sticks)
    assert seen == CYCLES, f"{seen} of {CYCLES} taps were seen"
    assert sticks[-1] == 0.0, "stuck"
    remark(f"plugging in at full speed, {type(source).__name__}: {CYCLES} times in {took_s:.0f} s, each tap was seen; in the session "
           f"after {statistics.median(waits_s):.3f} s (median), {max(waits_s):.2f} s at most; {first[0]} files and {first[1]} threads "
           "as after the first")
