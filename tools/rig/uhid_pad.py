"""Pads that are not USB, over /dev/uhid: `with UhidPad("dualsense_bt") as pad: pad.set(lx=200)`."""
import glob
import os
import select
import struct
import threading
import time
import zlib

from pads import Nodes, Packet, Sent, settle, wait_for
from support import traces

# linux/uhid.h
DESTROY, OUTPUT, GET_REPORT, GET_REPORT_REPLY, CREATE2, INPUT2, SET_REPORT, SET_REPORT_REPLY = 1, 6, 9, 10, 11, 12, 13, 14
BUS_USB, BUS_BLUETOOTH = 3, 5


def with_checksum(seed, report):
    """The report with its last four bytes replaced: CRC-32 over the seed and all before them."""
    return report[:-4] + struct.pack("<I", zlib.crc32(bytes([seed]) + report[:-4]))


def _item(tag, value, size):
    return bytes([tag | {1: 1, 2: 2, 4: 3}[size]]) + value.to_bytes(size, "little")


def _fields(count, bits, usages=b"", low=0, high=None, tag=0x80, flags=2):
    high = (1 << bits) - 1 if high is None else high
    return (usages + _item(0x14, low, 1) + _item(0x24, high, 4) + _item(0x74, bits, 1) + _item(0x94, count, 1)
            + bytes([tag | 1, flags]))


def _usages(page, *usages):
    return bytes([0x05, page]) + b"".join(bytes([0x09, usage]) for usage in usages)


def _vendor(report, count, tag):
    return bytes([0x85, report, 0x06, 0, 0xff, 0x09, report]) + _fields(count, 8, tag=tag)


_STICKS = _usages(1, 0x30, 0x31, 0x32, 0x35)
_HAT = _usages(1, 0x39) + bytes([0x35, 0, 0x46, 0x3b, 1, 0x65, 0x14]) + _fields(1, 4, high=7, flags=0x42) + bytes(
    [0x65, 0, 0x45, 0])
_GAMEPAD = bytes([0x05, 1, 0x09, 5, 0xa1, 1])


def _buttons(count):
    return bytes([0x05, 9, 0x19, 1, 0x29, count]) + _fields(count, 1)


# Report 1 is the short one that these pads send until a feature is read; then the full one.
_SONY_SHORT = (_GAMEPAD + bytes([0x85, 1]) + _fields(4, 8, _STICKS) + _HAT + _buttons(14) + _fields(1, 6, flags=3)
               + _fields(2, 8, _usages(1, 0x33, 0x34)))
_DUALSENSE_BT = (_SONY_SHORT + _vendor(0x31, 77, 0x80) + _vendor(0x31, 77, 0x90) + _vendor(0x05, 40, 0xb0)
                 + _vendor(0x09, 19, 0xb0) + _vendor(0x20, 63, 0xb0) + b"\xc0")
_DS4_BT = (_SONY_SHORT + _vendor(0x11, 77, 0x80) + _vendor(0x11, 77, 0x90) + _vendor(0x05, 40, 0xb0)
           + _vendor(0xa3, 48, 0xb0) + b"\xc0")
_XBOX_BT = (_GAMEPAD + bytes([0x85, 1]) + _fields(4, 16, _STICKS) + _fields(1, 10, _usages(2, 0xc5)) + _fields(1, 6, flags=3)
            + _fields(1, 10, _usages(2, 0xc4)) + _fields(1, 6, flags=3) + _usages(1, 0x39)
            + bytes([0x35, 0, 0x46, 0x3b, 1, 0x65, 0x14]) + _fields(1, 4, low=1, high=8, flags=0x42)
            + bytes([0x65, 0, 0x45, 0]) + _fields(1, 4, flags=3) + _buttons(15) + _fields(1, 1, flags=3)
            + bytes([0x05, 0x0c, 0x0a, 0xb2, 0]) + _fields(1, 1) + _fields(1, 7, flags=3)
            + bytes([0x05, 0x0f, 0x09, 0x21, 0x85, 3]) + _fields(8, 8, tag=0x90) + b"\xc0")


# One vendor report with a type, two bytes of buttons, two sticks and two triggers for each of four plugs (SDL's
# SDL_hidapi_gamecube.c). The second byte is the first plug's type.
_GAMECUBE = (bytes([0x06, 0, 0xff, 0x09, 1, 0xa1, 1]) + _vendor(0x21, 36, 0x80) + _vendor(0x13, 1, 0x90)
             + _vendor(0x11, 4, 0x90) + b"\xc0")
EMPTY_PLUG, FULL_PLUG = 0x04, 0x14

# The pads of Linux's own test_gamepad.py (tools/testing/selftests/hid/tests): the order and width of their fields. The
# first has a field of no bits, a second report with effects; the second numbers its buttons with gaps, and states X
# before and a brake after a change of the usage page.
_SAITEK = (bytes([0x05, 1, 0x09, 4, 0xa1, 1, 0x09, 1, 0xa1, 0, 0x85, 1]) + _fields(1, 8, _usages(1, 0x30))
           + _fields(1, 8, _usages(1, 0x31)) + _fields(1, 8, _usages(2, 0xba)) + _fields(1, 8, _usages(2, 0xbb))
           + _buttons(12) + _fields(1, 0, flags=3) + _HAT + b"\xc0" + bytes([0x05, 0x0f, 0x09, 0x92, 0xa1, 2, 0x85, 2])
           + _fields(2, 1, _usages(0x0f, 0xa0, 0x9f)) + _fields(1, 6, flags=3) + _fields(1, 7, _usages(0x0f, 0x22))
           + _fields(1, 1, _usages(0x0f, 0x94)) + b"\xc0\xc0")
_ASUS_BUTTONS = (1, 2, 4, 5, 7, 8, 14, 15, 13)
_ASUS = (_GAMEPAD + bytes([0x85, 1])
         + _fields(11, 1, _usages(9, *_ASUS_BUTTONS) + bytes([0x05, 0x0c, 0x0a, 0x24, 2, 0x0a, 0x23, 2]))
         + _fields(1, 1, flags=3) + _HAT + bytes([0x09, 1, 0xa1, 0])
         + _fields(6, 8, _usages(1, 0x30, 0x31, 0x32, 0x35) + _usages(2, 0xc5, 0xc4)) + b"\xc0"
         + bytes([0x85, 2]) + _fields(4, 1, _usages(8, 1, 2, 3, 4), tag=0x90) + _fields(1, 4, tag=0x90, flags=3) + b"\xc0")


def _motion_calibration(report, size):
    values = (0, 0, 0, 8000, -8000, 8000, -8000, 8000, -8000, 500, 500) + 3 * (8192, -8192)
    return with_checksum(0xa3, (bytes([report]) + struct.pack("<17h", *values)).ljust(size, b"\0"))


def _dualsense_feature(report, mac):
    if report == 0x05:
        return _motion_calibration(report, 41)
    if report == 0x09:
        return with_checksum(0xa3, (b"\x09" + mac[::-1]).ljust(20, b"\0"))
    if report == 0x20:
        data = bytearray(64)
        data[0], data[24], data[28], data[44], data[45] = 0x20, 0x14, 0x01, 0x24, 0x02
        return with_checksum(0xa3, bytes(data))
    return None


def _ds4_feature(report, mac):
    if report == 0x05:
        return _motion_calibration(report, 41)
    if report == 0xa3:
        data = bytearray(49)
        data[0], data[36], data[41] = 0xa3, 0xa0, 0x0a
        return bytes(data)
    return None


def _ds4_interval(pad, report):
    """The interval in the lower six bits of an output report's second byte: milliseconds between reports; 0: as short
    as the link allows."""
    if report[0] == 0x11:
        pad.rate_hz = 1000 / max(1, report[1] & 0x3f)


def _neutral(size, start, **values):
    data = bytearray(size)
    data[:len(start)] = start
    for place, value in values.items():
        data[int(place[1:])] = value
    return data


class Kind:
    """fields: name -> (first bit, width) of the little-endian report.
    feature(report, mac) -> bytes or None; answer(pad, output report) -> an input report to send, or None."""

    def __init__(self, name, ids, descriptor, neutral, fields, rate_hz=0, seed=None, feature=None, answer=None,
                 bus=BUS_BLUETOOTH):
        self.name, self.ids, self.descriptor, self.neutral, self.fields = name, ids, descriptor, neutral, fields
        self.rate_hz, self.seed, self.feature, self.answer, self.bus = rate_hz, seed, feature, answer, bus


def _sony_fields(start, triggers, buttons):
    """Fields of Sony's pads. `start`: byte of the left stick's X."""
    axes = {name: (8 * (start + i), 8) for i, name in enumerate(("lx", "ly", "rx", "ry"))}
    first = 8 * buttons
    return axes | {"lt": (8 * triggers, 8), "rt": (8 * triggers + 8, 8), "hat": (first, 4), "buttons": (first + 4, 14)} | \
        _bits(first + 4, ("x", "a", "b", "y", "leftshoulder", "rightshoulder", "l2", "r2", "back", "start", "leftstick",
                          "rightstick", "guide"))


def _bits(first, names):
    return {name: (first + i, 1) for i, name in enumerate(names)}


def _numbered(*numbers):
    return [f"button {number}" for number in numbers]


KINDS = {
    "plain": Kind(
        "Rig plain pad", (0x1209, 0x0001), _GAMEPAD + bytes([0x85, 1]) + _fields(4, 8, _STICKS) + _buttons(8) + b"\xc0",
        _neutral(6, b"\x01\x80\x80\x80\x80"), {"lx": (8, 8), "ly": (16, 8), "buttons": (40, 8)}, bus=BUS_USB),
    "saitek": Kind(
        "Rig Saitek", (0x06a3, 0xff0d), _SAITEK, _neutral(7, b"\x01\x7f\x7f\x7f\x7f\0\xf0"),
        {"lx": (8, 8), "ly": (16, 8), "rx": (24, 8), "ry": (32, 8), "hat": (52, 4)} | _bits(40, _numbered(*range(1, 13))), bus=BUS_USB),
    "asus": Kind(
        "Rig Asus", (0x18d1, 0x2c40), _ASUS, _neutral(9, b"\x01\0\xf0\x7f\x7f\x7f\x7f"),
        {"lx": (24, 8), "ly": (32, 8), "rx": (40, 8), "ry": (48, 8), "lt": (56, 8), "rt": (64, 8), "hat": (20, 4)}
        | _bits(8, [*_numbered(*_ASUS_BUTTONS), "back", "home"]), bus=BUS_USB),
    "gamecube_adapter": Kind(
        "Rig adapter", (0x057e, 0x0337), _GAMECUBE,
        _neutral(37, b"\x21", **{f"b{1 + 9 * plug + byte}": value for plug in range(4)
                                 for byte, value in ((0, EMPTY_PLUG), (3, 0x80), (4, 0x80), (5, 0x80), (6, 0x80))}),
        {"type": (8, 8), "lx": (32, 8), "ly": (40, 8)}, bus=BUS_USB),
    "dualsense_bt": Kind(
        "DualSense Wireless Controller", (0x054c, 0x0ce6), _DUALSENSE_BT,
        _neutral(78, b"\x31\x01\x80\x80\x80\x80", b9=0x08, b34=0x80, b38=0x80, b54=0x18), _sony_fields(2, 6, 9),
        rate_hz=250, seed=0xa1, feature=_dualsense_feature),
    "ds4_bt": Kind(
        "Wireless Controller", (0x054c, 0x09cc), _DS4_BT,
        _neutral(78, b"\x11\xc0\x00\x80\x80\x80\x80\x08", b32=0x0b, b37=0x80, b41=0x80), _sony_fields(3, 10, 7),
        rate_hz=250, seed=0xa1, feature=_ds4_feature, answer=_ds4_interval),
    "xbox_bt": Kind(
        "Xbox Wireless Controller", (0x045e, 0x0b13), _XBOX_BT, _neutral(17, b"\x01" + b"\x00\x80" * 4),
        {"lx": (8, 16), "ly": (24, 16), "rx": (40, 16), "ry": (56, 16), "lt": (72, 10), "rt": (88, 10), "hat": (104, 4),
         "a": (112, 1), "b": (113, 1), "x": (115, 1), "y": (116, 1), "buttons": (112, 15)}),
}


def read_trace(path):
    """The kind and the reports, (Kind, [(time_s, report)]), of a recording's first device."""
    name, ids, bus, descriptor, reports = "", (0, 0), BUS_USB, b"", []
    for letter, rest in traces.lines(path, "DNIRE"):
        words = rest.split()
        if letter == "D" and reports:
            break
        if letter == "N":
            name = rest.strip()
        elif letter == "I":
            bus, ids = int(words[0], 16), (int(words[1], 16), int(words[2], 16))
        elif letter == "R":
            descriptor = bytes.fromhex("".join(words[1:]))
        elif letter == "E":
            reports.append((float(words[0]), bytes.fromhex("".join(words[2:]))))
    features = {(0x054c, 0x0ce6): _dualsense_feature, (0x054c, 0x09cc): _ds4_feature}
    feature = features.get(ids) if bus == BUS_BLUETOOTH else None
    neutral = bytearray(reports[0][1] if reports else b"\0")
    return Kind(name, ids, descriptor, neutral, {}, feature=feature, bus=bus), reports


class HidPad(Nodes):
    """A HID pad whose reports Python makes; its transport is a subclass. Plugged in by entering the `with` block.

    A subclass has _open() and _close(), the file descriptor _inbox with what comes from the host, _take(inbox) that
    reads and answers it, and _deliver(report)."""

    def __init__(self, kind):
        super().__init__("/nowhere")
        self.kind = kind
        self.state = bytearray(kind.neutral)
        self.rate_hz = kind.rate_hz
        self.good_checksum = True  # False: every report has a wrong checksum
        self._thread = None
        self._outs, self._sents = [], []
        self._lock = threading.Lock()

    def __enter__(self):
        self.plug()
        return self

    def __exit__(self, *_):
        if self._thread is not None:
            self.unplug()

    def plug(self, wait=True):
        self._open()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()
        if wait:
            self.sysfs = wait_for(self._find_sysfs, 10, "the HID device")
            settle()  # a special driver replaces hid-generic as soon as udev has loaded it
            wait_for(lambda: self.events or self.hidraws, 20, "a node")
            if self.kind.fields:
                wait_for(lambda: self.joystick, 20, "the joystick node")

    def unplug(self, wait=True):
        self._stop.set()
        self._thread.join()
        self._thread = None
        self._close()
        if wait:
            wait_for(lambda: not os.path.isdir(self.sysfs), 10, "the unplugging")

    def _find_sysfs(self):
        for folder in glob.glob("/sys/bus/hid/devices/%04X:%04X:%04X.*" % (self.kind.bus, *self.kind.ids)):
            try:
                with open(folder + "/uevent") as file:
                    if f"HID_UNIQ={self.uniq}" in file.read():
                        return os.path.realpath(folder)
            except FileNotFoundError:
                pass
        return None

    # --- what happens by itself: replies, the stream

    def _serve(self):
        next_s = time.monotonic()
        while not self._stop.is_set():
            wait_s = 0.05
            if self.rate_hz > 0:
                now = time.monotonic()
                if now >= next_s:
                    self.send()
                    next_s = max(next_s + 1 / self.rate_hz, now)
                wait_s = min(wait_s, max(0.0, next_s - time.monotonic()))
            if select.select([self._inbox], [], [], wait_s)[0]:
                self._take()

    def _take_output(self, data):
        self._outs.append(Packet(time.monotonic_ns(), data))
        reply = self.kind.answer and self.kind.answer(self, data)
        if reply:
            self.send(reply)

    # --- what a test sends

    def send(self, report=None):
        """Sends this report unchanged once, or the state with its checksum."""
        with self._lock:
            if report is None:
                report = bytes(self.state)
                if self.kind.seed is not None:
                    report = with_checksum(self.kind.seed if self.good_checksum else 0, report)
            self._sents.append(Sent(time.monotonic_ns(), len(self._sents) + 1, bytes(report)))
            self._deliver(bytes(report))

    def set(self, **fields):
        with self._lock:
            for name, value in fields.items():
                bit, width = self.kind.fields[name]
                mask = (1 << width) - 1
                whole = int.from_bytes(self.state, "little") & ~(mask << bit) | (int(value) & mask) << bit
                self.state[:] = whole.to_bytes(len(self.state), "little")
        if not self.rate_hz:
            self.send()

    def sent(self):
        return list(self._sents)

    def out_packets(self, since_ns=0):
        """The output and feature reports that the host has written."""
        return [packet for packet in self._outs if packet.ns >= since_ns]


class UhidPad(HidPad):
    """One HID pad of a kind above, or "trace" with trace=FILE.hid."""

    def __init__(self, kind, index=0, trace=None):
        kind, self._trace = read_trace(trace) if kind == "trace" else (KINDS[kind], [])
        super().__init__(kind)
        self.mac = bytes([0x02, 0x55, 0x48, 0x49, kind.ids[1] & 0xff, index + 1])
        self.uniq = ":".join(f"{byte:02x}" for byte in self.mac)

    def _open(self):
        self._inbox = os.open("/dev/uhid", os.O_RDWR | os.O_CLOEXEC)
        text = [self.kind.name.encode(), b"rig/uhid", self.uniq.encode()]
        descriptor = self.kind.descriptor
        self._write(CREATE2, struct.pack("=128s64s64sHHIIII4096s", *text, len(descriptor), self.kind.bus, *self.kind.ids,
                                         0x0100, 0, descriptor))

    def _close(self):
        os.close(self._inbox)  # destroys the device

    def _write(self, kind, data):
        os.write(self._inbox, struct.pack("=I", kind) + data)

    def _deliver(self, report):
        self._write(INPUT2, struct.pack("=H", len(report)) + report)

    def _take(self):
        event = os.read(self._inbox, 4380)
        kind, data = struct.unpack_from("=I", event)[0], event[4:]
        if kind == OUTPUT:
            size, = struct.unpack_from("=H", data, 4096)
            self._take_output(data[:size])
        elif kind == GET_REPORT:
            number, report, _ = struct.unpack_from("=IBB", data)
            reply = self.kind.feature and self.kind.feature(report, self.mac)
            self._write(GET_REPORT_REPLY, struct.pack("=IHH4096s", number, 0 if reply else 5, len(reply or b""), reply or b""))
        elif kind == SET_REPORT:
            number, _, _, size = struct.unpack_from("=IBBH", data)
            self._outs.append(Packet(time.monotonic_ns(), data[8:8 + size]))
            self._write(SET_REPORT_REPLY, struct.pack("=IH", number, 0))

    def play(self):
        """Plays the trace at its own times; returns at its end."""
        start = time.monotonic() - (self._trace[0][0] if self._trace else 0)
        for at_s, report in self._trace:
            time.sleep(max(0.0, start + at_s - time.monotonic()))
            self.send(report)
