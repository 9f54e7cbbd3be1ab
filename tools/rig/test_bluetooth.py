"""Pads in their Bluetooth form, through uhid: full reports with their checksums, and rumble with its own."""
import time

import pytest

from cells import cells
from session import Session, remark
from test_matrix import check_sequence
from uhid_pad import UhidPad, with_checksum

EIGHT_BITS, SIXTEEN_BITS = 127.5, 32767.5
HALF = {"dualsense_bt": EIGHT_BITS, "ds4_bt": EIGHT_BITS, "xbox_bt": SIXTEEN_BITS}
STICKS = {"lx": "left_x", "ly": "left_y", "rx": "right_x", "ry": "right_y"}
# Id of the output report, and its bytes with the strengths (strong, weak). Its checksum begins with 0xa2.
OUTPUT = {"dualsense_bt": (0x31, 6, 5), "ds4_bt": (0x11, 7, 6)}


def expected(half, state):
    axes = {STICKS[name]: (state[name] / half - 1) * (-1 if name.endswith("y") else 1) for name in STICKS}
    return axes, {button for button in ("a", "b", "x", "y") if state.get(button)}


def states(half):
    rest = dict.fromkeys(STICKS, round(half + 0.5))
    yield {**rest, "lx": round(1.6 * half), "ly": round(0.4 * half), "rx": round(0.2 * half), "ry": round(1.9 * half)}
    for stick in STICKS:
        yield {**rest, stick: 0}
        yield {**rest, stick: round(2 * half)}
    for button in ("a", "b", "x", "y"):
        yield {**rest, button: 1}
    yield rest


@pytest.mark.timeout(90)
@pytest.mark.parametrize("case", cells(dict.fromkeys(HALF, ("hidraw", "evdev", "sdl"))))
def test_decoded_and_replayed(case):
    kind, driver = case.split("-")
    half = HALF[kind]
    with UhidPad(kind) as pad:
        ids = "%04x:%04x" % pad.kind.ids
        with Session(ids, "--driver", driver, name=case) as session:
            sent = list(states(half))
            for state in sent:
                session.show(driver, pad, 0.03, **{**dict.fromkeys(("a", "b", "x", "y"), 0), **state})
            pad.set(ly=0)
            time.sleep(1.5)
            pad.set(ly=round(half + 0.5))
            time.sleep(0.1)
        check_sequence(session.decoded(), [expected(half, state) for state in sent])
        assert session.replayed["steps_left"] + session.replayed["steps_right"] >= 2
        remark(f"{case}: {session.replayed['reports']} reports, pose hash {session.replayed['pose_hash']} twice")


@pytest.mark.timeout(60)
@pytest.mark.parametrize("kind", ["dualsense_bt", "ds4_bt"])
def test_a_wrong_checksum_moves_nothing(kind):
    """The kernel's own drivers also check it and drop a wrong report before hidraw."""
    with UhidPad(kind) as pad:
        with Session("%04x:%04x" % pad.kind.ids, "--driver", "hidraw", name=f"checksum-{kind}") as session:
            pad.set(lx=200)
            time.sleep(0.3)
            pad.good_checksum = False
            pad.set(lx=0)
            time.sleep(0.3)
            pad.set(lx=200)
            time.sleep(0.05)
            pad.good_checksum = True
            time.sleep(0.3)
    assert not [row for row in session.decoded() if row["axes"]["left_x"] < -0.5]
    assert session.replayed["reports"] > 50


@pytest.mark.timeout(60)
def test_rumble_keeps_the_rate_of_reports():
    """A DualShock 4's output report also sets how often it reports."""
    with UhidPad("ds4_bt") as pad:
        with Session("%04x:%04x" % pad.kind.ids, "--driver", "hidraw", name="rate-ds4_bt"):
            time.sleep(1.0)
            before_hz = pad.rate_hz
            since = time.monotonic_ns()
            pad.set(ly=0)
            time.sleep(3.0)
            beats = [p.data for p in pad.out_packets(since) if p.data[0] == 0x11 and p.data[6] + p.data[7] > 0]
            after_hz = pad.rate_hz
    assert beats, "no heel beat"
    assert after_hz == before_hz, f"{before_hz} reports a second, {after_hz} after the first beat"
    remark(f"ds4_bt: {before_hz:.0f} reports a second before and after {len(beats)} beats")


@pytest.mark.timeout(60)
@pytest.mark.parametrize("kind", ["dualsense_bt", "ds4_bt"])
def test_rumble_carries_its_checksum(kind):
    number, strong, weak = OUTPUT[kind]
    with UhidPad(kind) as pad:
        with Session("%04x:%04x" % pad.kind.ids, "--driver", "hidraw", name=f"rumble-{kind}"):
            time.sleep(0.3)
            since = time.monotonic_ns()
            pad.set(ly=0)
            time.sleep(3.0)
            packets = [p.data for p in pad.out_packets(since) if p.data[0] == number]
    assert packets and all(with_checksum(0xa2, data) == data for data in packets), packets[:3]
    levels = [data[strong] for data in packets]
    assert max(levels) > 100 and max(data[weak] for data in packets) > 0 and 0 in levels, levels
