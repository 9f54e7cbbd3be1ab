"""Plugging in again and again: pads of all kinds in turn, each with one short push, every one of which is seen.

Four times each kind, a thousand times with --long, in sessions of fifty.
"""
import contextlib
import random
import statistics
import time

import pytest

from pads import KINDS, LONG, Pad, wait_for
from session import HAS_SANITIZERS, IDS, Session, remark
from test_matrix import VALUES

SESSIONS, TURNS = (20, 50) if LONG else (1, 12 if HAS_SANITIZERS else 24)
PUSH_S = 0.15  # a tap of the stick
MOST_S = 3.0  # from the node to the session, in the median


def push(pad, session):
    """From rest to the rim and back, as a thumb does. Back when the rim is in the recording: on a busy host both might
    come within a tick."""
    values, before = VALUES[pad.kind], len(session.lines("E:"))
    pad.move(ly=(values["rest"], values["forward"]))
    time.sleep(PUSH_S)
    wait_for(lambda: len(session.lines("E:")) > before + 2, 10, "the push in the recording")
    pad.move(ly=(values["forward"], values["rest"]))
    time.sleep(0.1)


def seen_pushes(session):
    """How many times the stick went from rest beyond 0.9 and back."""
    sticks = [float(frame["stick_y"]) for frame in session.frames()]
    return sum(a <= 0.9 < b for a, b in zip(sticks, sticks[1:]))


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
            seen = seen_pushes(session)
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
    """It has sent nothing since it was plugged in, so only asking it tells that its stick rests. An event node cannot be
    asked: its axes are 0 until the first report, which is an Xbox pad's middle and a HID pad's edge."""
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
    assert seen_pushes(session) == times
    remark(f"a pad that rests when it is opened, {case}: {times} times, its first push was seen")
