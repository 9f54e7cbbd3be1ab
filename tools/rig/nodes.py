"""Bare reads of device nodes, the reference for the program: EventNode and HidrawNode."""
import collections
import errno
import fcntl
import os
import select
import struct
import time

from pads import PATIENCE

EV_SYN, EV_KEY, EV_ABS, EV_FF = 0, 1, 3, 0x15
SYN_DROPPED = 3
FF_RUMBLE = 0x50
ABS = {"X": 0, "Y": 1, "Z": 2, "RX": 3, "RY": 4, "RZ": 5, "THROTTLE": 6, "RUDDER": 7, "GAS": 9, "BRAKE": 10, "HAT0X": 16, "HAT0Y": 17}

_EVENT = struct.Struct("llHHi")
_EFFECT = struct.Struct("=HhHHHHH2xHH28x")  # an ff_effect with ff_rumble_effect, 48 bytes

Event = collections.namedtuple("Event", "ns type code value")
AbsInfo = collections.namedtuple("AbsInfo", "value min max fuzz flat resolution")


def ioctl_number(direction, letter, number, size):
    """The number that the kernel's _IOC gives: direction 1 write, 2 read."""
    return direction << 30 | size << 16 | ord(letter) << 8 | number


class Node:
    """An open node; reads wait at most `seconds`."""

    def __init__(self, path, flags=os.O_RDWR):
        self.path = path
        self.fd = os.open(path, flags | os.O_NONBLOCK | os.O_CLOEXEC)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.close(self.fd)

    def read(self, seconds=2.0, size=4096):
        """The bytes of one read; empty after `seconds` without any. OSError when the pad is gone."""
        if not select.select([self.fd], [], [], seconds)[0]:
            return b""
        try:
            return os.read(self.fd, size)
        except OSError as error:
            if error.errno == errno.EAGAIN:
                return b""
            raise


class HidrawNode(Node):
    def descriptor(self):
        size = struct.unpack("i", fcntl.ioctl(self.fd, ioctl_number(2, "H", 1, 4), bytes(4)))[0]
        buffer = bytearray(struct.pack("I4096x", size))
        fcntl.ioctl(self.fd, ioctl_number(2, "H", 2, 4100), buffer, True)
        return bytes(buffer[4:4 + size])

    def until(self, condition, seconds=3.0):
        """Reads reports until `condition(report)`; the report, or AssertionError."""
        end = time.monotonic() + PATIENCE * seconds
        last = b""
        while time.monotonic() < end:
            last = self.read(0.2) or last
            if last and condition(last):
                return last
        raise AssertionError(f"{self.path}: the report did not come; the last one was {last.hex()}")


class EventNode(Node):
    """An event node whose events have stamps of CLOCK_MONOTONIC."""

    def __init__(self, path):
        super().__init__(path)
        fcntl.ioctl(self.fd, ioctl_number(1, "E", 0xa0, 4), struct.pack("i", 1))

    def events(self, seconds=2.0):
        data = self.read(seconds, 64 * _EVENT.size)
        return [Event(s * 1_000_000_000 + us * 1000, kind, code, value)
                for s, us, kind, code, value in _EVENT.iter_unpack(data)]

    def absolute(self, code):
        info = fcntl.ioctl(self.fd, ioctl_number(2, "E", 0x40 + code, 24), bytes(24))
        return AbsInfo(*struct.unpack("6i", info))

    def keys(self):
        """The codes of the pressed keys."""
        bits = int.from_bytes(fcntl.ioctl(self.fd, ioctl_number(2, "E", 0x18, 96), bytes(96)), "little")
        return {code for code in range(8 * 96) if bits >> code & 1}

    def name(self):
        return fcntl.ioctl(self.fd, ioctl_number(2, "E", 0x06, 256), bytes(256)).split(b"\0")[0].decode()

    def until_absolute(self, seconds=3.0, **values):
        """Waits until axes stand at values: until_absolute(X=200, Y=100)."""
        end = time.monotonic() + PATIENCE * seconds
        while True:
            now = {name: self.absolute(ABS[name]).value for name in values}
            if now == values:
                return
            assert time.monotonic() < end, f"{self.path}: axes at {now}, not {values}"
            self.events(0.05)

    def rumble(self, strong, weak, length_ms):
        """Uploads and plays FF_RUMBLE; returns the effect's number."""
        effect = _EFFECT.pack(FF_RUMBLE, -1, 0, 0, 0, length_ms, 0, strong, weak)
        effect = fcntl.ioctl(self.fd, ioctl_number(1, "E", 0x80, _EFFECT.size), effect)
        number = _EFFECT.unpack(effect)[1]
        os.write(self.fd, _EVENT.pack(0, 0, EV_FF, number, 1))
        return number

