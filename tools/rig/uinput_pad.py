"""A pad with only an evdev node, over /dev/uinput: `with UinputPad() as pad: pad.set(X=100, A=1)`."""
import fcntl
import glob
import os
import select
import struct
import threading
import time

from nodes import ABS, EV_ABS, EV_FF, EV_KEY, EV_SYN, FF_RUMBLE, ioctl_number
from pads import Nodes, Packet, settle, wait_for

KEYS = {"A": 0x130, "B": 0x131, "X_KEY": 0x133, "Y_KEY": 0x134, "TL": 0x136, "TR": 0x137, "SELECT": 0x13a,
        "START": 0x13b, "MODE": 0x13c, "THUMBL": 0x13d, "THUMBR": 0x13e}
EV_UINPUT, UI_FF_UPLOAD, UI_FF_ERASE = 0x0101, 1, 2
BUS_VIRTUAL = 6


class UinputPad(Nodes):
    """axes: name of ABS -> (minimum, maximum, flat). `rumbles`: (strong, weak) as they were uploaded."""

    def __init__(self, name="Rig uinput pad", ids=(0x1209, 0x0003), axes=None, bus=BUS_VIRTUAL):
        stick, trigger, hat = (-32768, 32767, 128), (0, 255, 0), (-1, 1, 0)
        self.axes = axes or {"X": stick, "Y": stick, "RX": stick, "RY": stick, "Z": trigger, "RZ": trigger,
                             "HAT0X": hat, "HAT0Y": hat}
        self.name, self.ids, self.bus = name, ids, bus
        self.rumbles, self.plays = [], []
        super().__init__("/nowhere")

    def __enter__(self):
        self._fd = os.open("/dev/uinput", os.O_RDWR | os.O_CLOEXEC | os.O_NONBLOCK)
        for kind in (EV_KEY, EV_ABS, EV_FF):
            self._set_bit(100, kind)
        for code in KEYS.values():
            self._set_bit(101, code)
        for name in self.axes:
            self._set_bit(103, ABS[name])
        self._set_bit(107, FF_RUMBLE)
        setup = struct.pack("=HHHH80sI", self.bus, *self.ids, 1, self.name.encode(), 4)
        fcntl.ioctl(self._fd, ioctl_number(1, "U", 3, len(setup)), setup)
        for name, (low, high, flat) in self.axes.items():
            axis = struct.pack("=H2x6i", ABS[name], (low + high + 1) // 2 if low < 0 else low, low, high, 0, flat, 0)
            fcntl.ioctl(self._fd, ioctl_number(1, "U", 4, len(axis)), axis)
        fcntl.ioctl(self._fd, ioctl_number(0, "U", 1, 0))
        buffer = fcntl.ioctl(self._fd, ioctl_number(2, "U", 44, 64), bytes(64))
        self.sysfs = "/sys/devices/virtual/input/" + buffer.split(b"\0")[0].decode()
        wait_for(lambda: self.events, 10, "the event node")
        settle()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()
        os.close(self._fd)
        wait_for(lambda: not glob.glob(self.sysfs), 10, "the unplugging")

    def _set_bit(self, number, value):
        fcntl.ioctl(self._fd, ioctl_number(1, "U", number, 4), value)

    def _serve(self):
        while not self._stop.is_set():
            if not select.select([self._fd], [], [], 0.05)[0]:
                continue
            for _, _, kind, code, value in struct.iter_unpack("llHHi", os.read(self._fd, 24 * 16)):
                if kind == EV_UINPUT:
                    self._acknowledge(code, value)
                elif kind == EV_FF:
                    self.plays.append(Packet(time.monotonic_ns(), (code, value)))

    def _acknowledge(self, code, value):
        """Acknowledges that an effect was uploaded or erased: the host's call waits for this."""
        size, number = (104, 200) if code == UI_FF_UPLOAD else (12, 202)
        request = bytearray(struct.pack("=I", value).ljust(size, b"\0"))
        fcntl.ioctl(self._fd, ioctl_number(3, "U", number, size), request, True)
        if code == UI_FF_UPLOAD:
            self.rumbles.append(struct.unpack_from("=HH", request, 8 + 16))
        struct.pack_into("=i", request, 4, 0)
        fcntl.ioctl(self._fd, ioctl_number(1, "U", number + 1, size), bytes(request))

    def set(self, **values):
        """Sets axes and keys by the names of ABS and KEYS; one SYN_REPORT follows them all."""
        events = [(EV_ABS, ABS[name], value) if name in ABS else (EV_KEY, KEYS[name], value)
                  for name, value in values.items()] + [(EV_SYN, 0, 0)]
        os.write(self._fd, b"".join(struct.pack("llHHi", 0, 0, *event) for event in events))
