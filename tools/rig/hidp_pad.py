"""Pads behind the kernel's real Bluetooth stack: `with bluetooth(pads=1), HidpPad("dualsense_bt") as pad: ...`.

btvirt makes virtual controllers, two for each pad: the even ones are the PC's, the odd ones the pads'. A controller of
btvirt 5.66 has one link only: it hands packets on with the sender's number of the link. hidp_link connects a pad's two
L2CAP channels to the PC and hands them to the kernel's HIDP, as bluetoothd does after pairing. There is no radio.
"""
import contextlib
import os
import subprocess

from pads import ROOT, wait_for
from uhid_pad import KINDS as UHID_KINDS, BUS_BLUETOOTH, HidPad, Kind, _neutral

LINK = os.path.join(ROOT, "build/rig/hidp_link")
MODULES = ("hci_vhci", "hidp", "af_alg", "algif_skcipher", "algif_hash", "cmac", "ecb")
GET_REPORT, SET_REPORT, DATA_FEATURE, DATA_INPUT, DATA_OUTPUT, DONE, REFUSED = 0x40, 0x50, 0xa3, 0xa1, 0xa2, 0x00, 0x02


@contextlib.contextmanager
def bluetooth(pads=1):
    """Makes virtual controllers for the PC and this number of pads."""
    subprocess.run(["modprobe", "-a", *MODULES], check=True)
    with subprocess.Popen(["btvirt", f"-l{2 * pads}"], stdout=subprocess.DEVNULL) as virtual:
        try:
            wait_for(lambda: all(os.path.isdir(f"/sys/class/bluetooth/hci{n}") for n in range(2 * pads)), 10,
                     "the controllers")
            yield
        finally:
            virtual.terminate()


# ---- pads of the Switch: dekuNukem, Nintendo_Switch_Reverse_Engineering (bluetooth_hid_notes.md, spi_flash_notes.md)
_VENDOR_INPUTS = b"".join(bytes([0x85, report, 0x09, report, 0x75, 0x08, 0x95, 0x30, 0x81, 0x02]) for report in (0x21, 0x30))
_VENDOR_OUTPUTS = b"".join(bytes([0x85, report, 0x09, report, 0x75, 0x08, 0x95, 0x30, 0x91, 0x02])
                           for report in (0x01, 0x10, 0x11, 0x12))
_SWITCH = (bytes([0x05, 1, 0x09, 5, 0xa1, 1, 0x06, 1, 0xff, 0x15, 0, 0x26, 0xff, 0]) + _VENDOR_INPUTS
           + bytes([0x85, 0x3f, 0x05, 9, 0x19, 1, 0x29, 0x10, 0x15, 0, 0x25, 1, 0x75, 1, 0x95, 0x10, 0x81, 2])
           + bytes([0x05, 1, 0x09, 0x39, 0x15, 0, 0x25, 7, 0x75, 4, 0x95, 1, 0x81, 0x42, 0x75, 4, 0x95, 1, 0x81, 1])
           + bytes([0x09, 0x30, 0x09, 0x31, 0x09, 0x33, 0x09, 0x34, 0x16, 0, 0, 0x27, 0xff, 0xff, 0, 0, 0x75, 16, 0x95, 4,
                    0x81, 2, 0x06, 1, 0xff, 0x15, 0, 0x26, 0xff, 0]) + _VENDOR_OUTPUTS + b"\xc0")
# Centre 2048, 1536 to each side: left up, centre, down; right centre, down, up.
_STICKS_OF_FLASH = bytes.fromhex("000660 000880 000660 000880 000660 000660")
_SENSORS_OF_FLASH = bytes.fromhex("000000000000 004000400040 000000000000 3b343b343b34")


def _flash(address, size):
    data = bytearray(b"\xff" * size)
    for begin, known in ((0x603d, _STICKS_OF_FLASH), (0x6020, _SENSORS_OF_FLASH)):
        for i in range(size):
            if begin <= address + i < begin + len(known):
                data[i] = known[address + i - begin]
    return bytes(data)


def _switch_answer(number):
    """The answer of a Switch pad. number: 1 left Joy-Con, 2 right one, 3 Pro Controller."""
    def answer(pad, out):
        if out[0] != 0x01 or len(out) < 11:
            return None
        command, data = out[10], out[11:]
        reply = bytearray(49)
        reply[:3] = 0x21, 0, 0x8e
        reply[3:12] = pad.state[3:12]
        reply[13], reply[14] = 0x80, command
        if command == 0x02:
            reply[13] = 0x82
            reply[15:27] = bytes([0x03, 0x48, number, 0x02]) + pad.mac + b"\1\1"
        elif command == 0x03:
            pad.rate_hz = 60 if data[0] == 0x30 else 0
        elif command == 0x10:
            reply[13] = 0x90
            reply[15:20] = data[:5]
            reply[20:20 + data[4]] = _flash(int.from_bytes(data[:4], "little"), data[4])
        return bytes(reply[:49])
    return answer


_SWITCH_FIELDS = {"lx": (48, 12), "ly": (60, 12), "rx": (72, 12), "ry": (84, 12)}
_RIGHT_BUTTONS = {"y": 24, "x": 25, "b": 26, "a": 27, "rightshoulder": 30, "rt": 31, "start": 33, "rightstick": 34, "guide": 36}
_LEFT_BUTTONS = {"back": 32, "leftstick": 35, "misc1": 37, "dpdown": 40, "dpup": 41, "dpright": 42, "dpleft": 43,
                 "leftshoulder": 46, "lt": 47}


def _switch_kind(name, product, number, buttons, sticks):
    neutral = _neutral(49, b"\x30\x00\x8e")
    for stick, at in (("l", 6), ("r", 9)):
        if stick in sticks:
            neutral[at:at + 3] = b"\x00\x08\x80"
    fields = {key: place for key, place in _SWITCH_FIELDS.items() if key[0] in sticks}
    return Kind(name, (0x057e, product), _SWITCH, neutral, fields | {key: (bit, 1) for key, bit in buttons.items()},
                rate_hz=0, answer=_switch_answer(number))


KINDS = UHID_KINDS | {
    "switch_bt": _switch_kind("Pro Controller", 0x2009, 3, _LEFT_BUTTONS | _RIGHT_BUTTONS, "lr"),
    "joycon_left": _switch_kind("Joy-Con (L)", 0x2006, 1, _LEFT_BUTTONS, "l"),
    "joycon_right": _switch_kind("Joy-Con (R)", 0x2007, 2, _RIGHT_BUTTONS, "r"),
}


class HidpPad(HidPad):
    """The pad with that index, from 0, for which bluetooth() has made a controller."""

    def __init__(self, kind, index=0):
        super().__init__(KINDS[kind])
        self.index, self.mac, self.uniq, self._rest = index, bytes(6), "", b""
        assert self.kind.bus == BUS_BLUETOOTH

    def _open(self):
        version = 0x0001 if self.kind.ids[0] == 0x057e else 0x0100  # as Nintendo's and Sony's pads; SDL reads it
        ids = ["%04x" % number for number in (*self.kind.ids, version)]
        self._link = subprocess.Popen([LINK, str(2 * self.index), str(2 * self.index + 1), *ids, self.kind.name, self.kind.descriptor.hex()],
                                      stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        word, _, self.uniq = self._link.stdout.readline().decode().strip().partition(" ")
        if word != "ready":
            raise RuntimeError("hidp_link did not connect")
        self.mac = bytes.fromhex(self.uniq.replace(":", ""))
        self._inbox = self._link.stdout.fileno()
        self._rest = b""

    def _close(self):
        """Closes both channels, as when a pad is switched off."""
        self._link.stdin.close()
        self._link.wait(10)
        self._link.stdout.close()

    def _write(self, letter, packet):
        with contextlib.suppress(BrokenPipeError):  # the host has dropped the link
            self._link.stdin.write(f"{letter} {packet.hex()}\n".encode())

    def _deliver(self, report):
        self._write("i", bytes([DATA_INPUT]) + report)

    def _take(self):
        data = os.read(self._inbox, 65536)
        if not data:
            self._stop.set()
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            letter, packet = line[:1], bytes.fromhex(line[2:].decode())
            if letter == b"i" and packet[0] == DATA_OUTPUT:
                self._take_output(packet[1:])
            elif letter == b"c":
                self._take_control(packet)

    def _take_control(self, packet):
        kind = packet[0] & 0xf0
        if kind == GET_REPORT:
            reply = self.kind.feature and self.kind.feature(packet[1], self.mac)
            self._write("c", bytes([DATA_FEATURE]) + reply if reply else bytes([REFUSED]))
        elif kind == SET_REPORT:
            self._take_output(packet[1:])
            self._write("c", bytes([DONE]))
        else:
            self._write("c", bytes([DONE]))
