"""Pads over the kernel's own Bluetooth stack (HIDP over L2CAP between virtual controllers): decoding, rumble, loss and
return of the link. test_bluetooth.py has the same pads without a link, over uhid."""
import contextlib
import statistics
import time

import pytest

from cells import case, some
from hidp_pad import HidpPad, bluetooth
from pads import LONG, wait_for
from session import Session, remark
from support import slices
from test_bluetooth import HALF, OUTPUT, expected, states
from test_matrix import check_sequence, is_as_sent
from uhid_pad import with_checksum

KINDS = ("dualsense_bt", "ds4_bt", "xbox_bt")
ALL = [f"{kind}-{driver}" for kind in KINDS for driver in ("hidraw", "evdev", "sdl")]
CHOSEN = ALL[slices.NUMBER % len(ALL)]  # the pad that loses its link in this run
# Seconds until a lost link is noticed. On USB the kernel reports a loss at once; here it closes the L2CAP channels
# first.
MOST_LOST_S = 3.0


def ids(pad):
    return "%04x:%04x" % pad.kind.ids


def send(pad, state):
    pad.set(**{**dict.fromkeys(("a", "b", "x", "y"), 0), **state})
    time.sleep(0.04)


def lose_and_find(pad, session, forward, turns):
    """Loses the link while the stick is pushed forward, and restores it; returns the seconds until the session noticed
    it."""
    noticed = []
    for turn in range(turns):
        pad.set(**forward)
        time.sleep(0.5)
        start = time.monotonic()
        pad.unplug(wait=False)
        wait_for(lambda: session.unplugged() > turn, 20, "the lost link in the recording")
        noticed.append(time.monotonic() - start)
        pad.state[:] = pad.kind.neutral
        pad.plug()
        session.wait_plugged(session.awaited + turn + 1)
    return noticed


def check_noticed(case, noticed):
    remark(f"bluetooth, {case}: a lost link is noticed after {statistics.median(noticed):.2f} s, {max(noticed):.2f} s at most, "
           f"and the pad came back {len(noticed)} times")
    assert statistics.median_low(noticed) < MOST_LOST_S, noticed  # a busy host makes one of them late


@pytest.mark.timeout(120)
@pytest.mark.parametrize("cell", [case(name, name == CHOSEN) for name in ALL])
def test_decoded_felt_lost_and_found(cell):
    kind, driver = cell.split("-")
    half = HALF[kind]
    with bluetooth(), HidpPad(kind) as pad:
        with Session(ids(pad), "--driver", driver, name=f"hidp-{cell}") as session:
            sent = list(states(half))
            for state in sent:
                send(pad, state)
            since = time.monotonic_ns()
            pad.set(ly=0)
            time.sleep(2.5)
            pad.set(ly=round(half + 0.5))
            time.sleep(0.5)
            packets = [packet.data for packet in pad.out_packets(since)]
            noticed = lose_and_find(pad, session, {"ly": 0}, 5 if LONG else 2)
        check_sequence(session.decoded(), [expected(half, state) for state in sent])
    assert session.replayed["steps_left"] + session.replayed["steps_right"] >= 2
    if kind in OUTPUT:
        number, strong, weak = OUTPUT[kind]
        packets = [data for data in packets if data[0] == number]
        assert packets and all(with_checksum(0xa2, data) == data for data in packets), packets[:3]
        assert max(data[strong] for data in packets) > 100 and max(data[weak] for data in packets) > 0
    else:
        packets = [data for data in packets if data[0] == 3]
        assert any(any(data[2:6]) for data in packets), packets[:3]
    remark(f"bluetooth, {cell}: {session.replayed['reports']} reports, {len(packets)} output reports, pose hash twice")
    check_noticed(cell, noticed)


# A stick's count through a driver that leaves the calibration to the program (hidraw), and through hid-nintendo.
def switch_stick(driver, value):
    return value / 2047.5 - 1 if driver == "hidraw" else max(-1.0, min(1.0, (value - 2048) / 1536))


NINTENDO_NAMES = {"a": "b", "b": "a", "x": "y", "y": "x"}  # names printed on the pad: SDL's, by position


@pytest.mark.timeout(120)
@pytest.mark.parametrize("cell", some(["switch-hidraw", "switch-evdev", "switch-sdl"], 8))
def test_switch_pro(cell):
    driver = cell.removeprefix("switch-")
    with bluetooth(), HidpPad("switch_bt") as pad:
        with Session(ids(pad), "--driver", driver, name=f"hidp-switch-{driver}") as session:
            states_ = [{"lx": 3200, "ly": 1500, "rx": 1000, "ry": 2500}] + [{name: 1} for name in NINTENDO_NAMES] + [{}]
            for state in states_:
                pad.set(**{**dict.fromkeys(("lx", "ly", "rx", "ry"), 2048), **dict.fromkeys(NINTENDO_NAMES, 0), **state})
                time.sleep(0.1)
            since = time.monotonic_ns()
            pad.set(ly=3584)
            time.sleep(2.5)
            pad.set(ly=2048)
            time.sleep(0.5)
            packets = [packet.data for packet in pad.out_packets(since) if packet.data[0] == 0x10]
            noticed = lose_and_find(pad, session, {"ly": 3584}, 3)
        wanted = []
        for state in states_:
            axes = {f"{side}_{axis}": switch_stick(driver, state.get(side[0] + axis, 2048))
                    for side in ("left", "right") for axis in "xy"}
            wanted.append((axes, {NINTENDO_NAMES[name] for name in NINTENDO_NAMES if state.get(name)}))
        check_sequence(session.decoded(), wanted)
    assert any(data[2:10] != bytes.fromhex("0001404000014040") for data in packets), packets[:2]
    remark(f"bluetooth, switch-{driver}: {session.replayed['reports']} reports, {len(packets)} rumble packets")
    check_noticed(f"switch-{driver}", noticed)


@pytest.mark.timeout(120)
@pytest.mark.parametrize("cell", some(["joycons-hidraw"], 8))
def test_a_pair_of_joy_cons_is_one_pad(cell):
    with contextlib.ExitStack() as stack:
        stack.enter_context(bluetooth(2))
        left, right = (stack.enter_context(HidpPad(kind, index))
                       for index, kind in enumerate(("joycon_left", "joycon_right")))
        with Session("057e:2008", "--driver", "hidraw", name="hidp-joycons") as session:
            left.set(lx=3200, ly=1500)
            right.set(rx=1000, ry=2500, a=1)
            time.sleep(0.3)
            left.set(lx=2048, ly=3584)
            right.set(rx=2048, ry=2048, a=0)
            time.sleep(2.5)
            left.set(ly=2048)
            time.sleep(0.5)
            right.unplug(wait=False)
            wait_for(lambda: session.unplugged() >= 1, 20, "the half that is lost")
        axes = {"left_x": switch_stick("hidraw", 3200), "left_y": switch_stick("hidraw", 1500),
                "right_x": switch_stick("hidraw", 1000), "right_y": switch_stick("hidraw", 2500)}
        assert any(is_as_sent(row, axes, {"b"}) for row in session.decoded())
    assert session.replayed["steps_left"] + session.replayed["steps_right"] >= 2
    remark(f"bluetooth, joycons-hidraw: {session.replayed['reports']} reports as one pad")
