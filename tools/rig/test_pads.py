"""The rig itself: each virtual pad binds its kernel driver, and bare reads of its nodes see what it sends.

Values by the drivers' formulas: hid-nintendo scales by the calibration in flash and turns y round, xpad turns y
round (~y), the others hand the byte on.
"""
import contextlib

import pytest

from nodes import EventNode, HidrawNode
from pads import KINDS, NODES, Pad, wait_for
from support import traces
from uhid_pad import BUS_BLUETOOTH, KINDS as UHID_KINDS, UhidPad, with_checksum
from uinput_pad import UinputPad

EIGHT_BITS = {"lx": 200, "ly": 100, "rx": 50, "ry": 25}
SENT = {"generic": EIGHT_BITS, "ds4": EIGHT_BITS, "dualsense": EIGHT_BITS,
        "switch": {"lx": 3200, "ly": 3200, "rx": 1000, "ry": 1000},
        "xbox360": {"lx": 20000, "ly": 10000, "rx": -5000, "ry": -20000},
        "xboxone": {"lx": 20000, "ly": 10000, "rx": -5000, "ry": -20000}}
BYTES_SEEN = {"X": 200, "Y": 100, "Z": 50, "RZ": 25}
STICKS_SEEN = {"X": 200, "Y": 100, "RX": 50, "RY": 25}
XBOX_SEEN = {"X": 20000, "Y": ~10000, "RX": -5000, "RY": ~-20000}
SWITCH_UP, SWITCH_DOWN = (3200 - 2048) * 32767 // 1536, -((2048 - 1000) * 32767 // 1536)
SEEN = {"generic": BYTES_SEEN, "ds4": STICKS_SEEN, "dualsense": STICKS_SEEN,
        "switch": {"X": SWITCH_UP, "Y": -SWITCH_UP, "RX": SWITCH_DOWN, "RY": -SWITCH_DOWN},
        "xbox360": XBOX_SEEN, "xboxone": XBOX_SEEN}

LX_BYTE = {"generic": 0, "ds4": 1, "dualsense": 1, "switch": 6}

# The packet of strong 0xc000, weak 0x4000: its first bytes, and the place and value of the strengths.
RUMBLE = {"ds4": (b"\x05", {4: 0x40, 5: 0xc0}), "dualsense": (b"\x02", {3: 0x40, 4: 0xc0}),
          "xbox360": (b"\x00\x08", {3: 0xc0, 4: 0x40}), "xboxone": (b"\x09", {8: 0x60, 9: 0x20})}


@pytest.mark.parametrize("kind", KINDS)
def test_binds_and_hands_on_what_it_sends(kind):
    with Pad(kind) as pad:
        assert (len(pad.hidraws), len(pad.events)) == NODES[kind]
        assert pad.usb and pad.joystick
        with EventNode(pad.joystick) as node:
            print(node.name(), [node.absolute(code) for code in range(6)])
            pad.set(**SENT[kind])
            node.until_absolute(**SEEN[kind])
        if pad.hidraw:
            with HidrawNode(pad.hidraw) as node:
                pad.set(lx=77)
                report = node.until(lambda report: report[LX_BYTE[kind]] == 77)
                wait_for(lambda: report in {sent.data for sent in pad.sent()}, 5, "the report in the log")
        pad.unplug()
        pad.plug()
        with EventNode(pad.joystick) as node:
            pad.set(**SENT[kind])
            node.until_absolute(**SEEN[kind])


@pytest.mark.parametrize("kind", RUMBLE)
def test_logs_the_rumble_that_the_kernel_sends(kind):
    start, strengths = RUMBLE[kind]

    def strong(packet):
        return packet.data.startswith(start) and all(packet.data[place] == value for place, value in strengths.items())

    def stopped(packet):
        return packet.data.startswith(start) and all(packet.data[place] == 0 for place in strengths)

    with Pad(kind) as pad, EventNode(pad.joystick) as node:
        node.rumble(0xc000, 0x4000, 300)
        first = wait_for(lambda: next(filter(strong, pad.out_packets()), None), 5, "the rumble packet")
        last = wait_for(lambda: next(filter(stopped, pad.out_packets(first.ns)), None), 5, "the stop packet")
        assert 0.2 < (last.ns - first.ns) / 1e9 < 1.5, (last.ns - first.ns) / 1e9  # a busy machine is late, never early


def test_switch_rumble_is_encoded_and_stops():
    with Pad("switch") as pad, EventNode(pad.joystick) as node:
        quiet = bytes.fromhex("0001404000014040")
        node.rumble(0xc000, 0x4000, 300)
        loud = wait_for(lambda: [p for p in pad.out_packets() if p.data[0] == 0x10 and p.data[2:10] != quiet], 5, "rumble")
        wait_for(lambda: [p for p in pad.out_packets(loud[-1].ns + 1) if p.data[2:10] == quiet], 5, "the stop")


@pytest.mark.timeout(90)
def test_six_pads_at_once():
    with contextlib.ExitStack() as stack:
        pads = [stack.enter_context(Pad(kind, index)) for index, kind in enumerate(KINDS)]
        nodes = [stack.enter_context(EventNode(pad.joystick)) for pad in pads]
        for pad, node in zip(pads, nodes):
            pad.set(**SENT[pad.kind])
        for pad, node in zip(pads, nodes):
            node.until_absolute(**SEEN[pad.kind])


def test_two_equal_pads_differ():
    with Pad("dualsense", 0) as first, Pad("dualsense", 1) as second:
        assert first.joystick != second.joystick and first.usb != second.usb
        with EventNode(first.joystick) as one, EventNode(second.joystick) as two:
            first.set(lx=10)
            second.set(lx=240)
            one.until_absolute(X=10)
            two.until_absolute(X=240)


def test_a_burst_numbers_its_reports():
    with Pad("generic") as pad, HidrawNode(pad.hidraw) as node:
        pad.burst(500, 1, at=8)
        numbers = []
        while len(numbers) < 500:
            report = node.read(2.0)
            assert report, f"silent after {len(numbers)}"
            numbers.append(int.from_bytes(report[8:12], "little"))
        assert numbers == list(range(500))
        assert pad.wait_burst()[0] == 500


def test_plays_a_recording_at_its_own_times():
    path = "/tmp/rig-trace.hid"
    descriptor = bytes.fromhex("05 01 09 04 a1 01 09 30 09 31 09 32 15 00 26 ff 00 75 08 95 03 81 02 c0")
    with open(path, "w") as file:
        file.write(traces.device(descriptor, "Traced Pad", ids="3 1234 5678"))
        file.writelines(traces.report(number * 0.04, [number, 0x80, 0xff]) for number in range(50))
    with Pad("trace", trace=path) as pad, HidrawNode(pad.hidraw) as node:
        assert len(node.descriptor()) == 24
        pad.play()
        for number in range(50):
            assert node.read(2.0) == bytes([number, 0x80, 0xff])
        late_s = sorted(sent.ns / 1e9 - 0.04 * sent.data[0] for sent in pad.sent())
        assert late_s[len(late_s) // 2] - late_s[0] < 0.25  # behind the most punctual one: at double speed it would be half a second


def test_faults_of_the_pad():
    with Pad("dualsense") as pad, HidrawNode(pad.hidraw) as node:
        pad.silence()
        while node.read(0.3):
            pass
        pad.silence(False)
        assert node.read(1.0)
        pad.stall()
        wait_for(lambda: pad.lines("stalled"), 5, "the stall")
        pad.set(lx=33)
        node.until(lambda report: report[1] == 33, 5)  # usbhid clears the halt
    with Pad("dualsense", plug=False) as pad:
        pad.command("features 0")
        pad.plug(wait=False)
        wait_for(lambda: any(line[2] == "stalled" for line in pad.lines("setup")), 10, "a refused feature")


@pytest.mark.parametrize("kind", [name for name, kind in UHID_KINDS.items() if kind.bus == BUS_BLUETOOTH])
def test_pads_of_bluetooth(kind):
    with UhidPad(kind) as pad:
        wide = kind == "xbox_bt"
        sent = {"lx": 50000, "ly": 1000, "rx": 40000, "ry": 30000} if wide else EIGHT_BITS
        seen = {"X": 50000, "Y": 1000, "Z": 40000, "RZ": 30000} if wide else STICKS_SEEN
        with EventNode(pad.joystick) as node:
            print(node.name(), pad.events, pad.hidraws)
            pad.set(**sent)
            node.until_absolute(**seen)
        with HidrawNode(pad.hidraw) as node:
            pad.set(lx=77)
            report = node.until(lambda report: report[0] == pad.state[0])
            if pad.kind.seed:
                assert report == with_checksum(0xa1, report)


def test_a_pad_of_uinput():
    with UinputPad() as pad, EventNode(pad.joystick) as node:
        pad.set(X=1234, RY=-4321, A=1)
        node.until_absolute(X=1234, RY=-4321)
        node.rumble(0xc000, 0x4000, 100)
        wait_for(lambda: pad.rumbles and pad.plays, 5, "the effect")
        assert pad.rumbles == [(0xc000, 0x4000)]
