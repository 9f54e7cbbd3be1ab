"""Tables of more kinds of pads: their ids, the encoding of their controls, and the controls' names.

    with plug(MORE["extreme3d"]) as pad: pad.set(lx=0)

Kinds that need answers or a vendor class are in pad_kinds.c; the others are plain HID pads, stated here: layouts of the
real models, the descriptors in our own words. `axes` is field -> (decoded axis, raw value at the middle, raw span to each
side, sign); `buttons` field -> SDL's name by position, `button_N` where SDL's data base has none.
"""
import dataclasses
import os
import tempfile

from pads import Pad, settle, wait_for
from support import traces

_STICKS8 = {"lx": ("left_x", 127.5, 127.5, 1), "ly": ("left_y", 127.5, 127.5, -1),
            "rx": ("right_x", 127.5, 127.5, 1), "ry": ("right_y", 127.5, 127.5, -1)}
_TRIGGERS8 = {"lt": ("left_trigger", 0, 255, 1), "rt": ("right_trigger", 0, 255, 1)}
_WORDS = {"lx": ("left_x", -0.5, 32767.5, 1), "ly": ("left_y", -0.5, 32767.5, 1), "rx": ("right_x", -0.5, 32767.5, 1),
          "ry": ("right_y", -0.5, 32767.5, 1)}
_XBOX = {name: name for name in ("a", "b", "x", "y", "leftshoulder", "rightshoulder", "back", "start", "leftstick",
                                 "rightstick")}
_DPAD = {name: name for name in ("dpup", "dpright", "dpdown", "dpleft")}


@dataclasses.dataclass
class Kind:
    name: str
    ids: str
    source: str        # of the layout
    drivers: tuple     # that can serve it
    axes: dict
    buttons: dict
    gadget: str = ""   # in pad_kinds.c; else a plain HID pad:
    descriptor: bytes = b""
    neutral: bytes = b""
    bits: dict = dataclasses.field(default_factory=dict)  # field -> (first bit, width)
    has_hat: bool = False
    still: tuple = ()  # decoded axes that no control of this pad moves
    stream_rate_hz: int = 0      # reports are sent all the time
    has_event_node: bool = True  # False: all of its report is a vendor's


class PlainPad(Pad):
    """A pad of a table, with a report made here."""

    def __init__(self, kind, index=0, plug=True):
        file = tempfile.NamedTemporaryFile("w", suffix=".hid", delete=False)
        with file:
            file.write(traces.device(kind.descriptor, kind.name, ids=f"3 {kind.ids.replace(':', ' ')}"))
            file.write(traces.report(0, kind.neutral))
        self.table, self.state = kind, bytearray(kind.neutral)
        super().__init__("trace", index, trace=file.name, plug=plug)

    def __enter__(self):
        super().__enter__()
        if self.table.stream_rate_hz:
            self.command(f"stream {self.table.stream_rate_hz}")
        return self

    def __exit__(self, *arguments):
        super().__exit__(*arguments)
        os.unlink(self._command[-1])

    def wait_ready(self, seconds=20.0):
        if self.table.has_event_node:
            super().wait_ready(seconds)
        else:
            wait_for(lambda: self.hidraws, seconds, "a hidraw node")
            settle()

    def set(self, **fields):
        for name, value in fields.items():
            bit, width = self.table.bits[name]
            mask = (1 << width) - 1
            whole = int.from_bytes(self.state, "little") & ~(mask << bit) | (int(value) & mask) << bit
            self.state[:] = whole.to_bytes(len(self.state), "little")
        self.report(self.state)


def plug(kind, index=0):
    return Pad(kind.gadget, index) if kind.gadget else PlainPad(kind, index)


# ---- descriptors -------------------------------------------------------------------------------
def _item(tag, value, size):
    return bytes([tag | {1: 1, 2: 2, 4: 3}[size]]) + value.to_bytes(size, "little")


def _fields(count, bits, high, flags=2):
    return _item(0x14, 0, 1) + _item(0x24, high, 4) + _item(0x74, bits, 1) + _item(0x94, count, 1) + bytes([0x81, flags])


def _usages(page, *usages):
    return bytes([0x05, page]) + b"".join(bytes([0x09, usage]) for usage in usages)


def _pad_bits(count):
    return bytes([0x75, count, 0x95, 1, 0x81, 3])


_HAT = _usages(1, 0x39) + bytes([0x35, 0, 0x46, 0x3b, 1, 0x65, 0x14]) + _fields(1, 4, 7, 0x42) + bytes([0x65, 0, 0x45, 0])


def _buttons(first, last):
    return bytes([0x05, 9, 0x19, first, 0x29, last]) + _fields(last - first + 1, 1, 1)


def _pad(usage, *parts, report_id=None):
    start = bytes([0x05, 1, 0x09, usage, 0xa1, 1]) + (bytes([0x85, report_id]) if report_id else b"")
    return start + b"".join(parts) + b"\xc0"


def _places(first_bit, *names, width=1):
    """Consecutive fields; None leaves one out."""
    return {name: (first_bit + i * width, width) for i, name in enumerate(names) if name}


# hid-pl drives the two motors by an output report for each port: one field of four 16-bit values.
_PORT_OF_TWIN = (_usages(1, 0x32, 0x35, 0x30, 0x31) + _fields(4, 8, 255) + _HAT + _buttons(1, 12)
                 + bytes([0x06, 0, 0xff, 0x09, 1]) + _fields(8, 1, 1) + bytes([0x09, 2, 0x75, 16, 0x95, 4, 0x91, 2]))
X_Y_Z_RZ = _usages(1, 0x30, 0x31, 0x32, 0x35) + _fields(4, 8, 255)
BRAKE_GAS = _usages(2, 0xc5, 0xc4) + _fields(2, 8, 255)

# ---- the kinds ---------------------------------------------------------------------------------
HID = ("hidraw", "evdev", "usb")

MORE = {
    "xboxseries": Kind("Xbox Series, wired", "045e:0b12", "Linux xpad.c (GIP, share in byte 22)", ("usb", "evdev", "sdl"),
                       _WORDS | {"lt": ("left_trigger", 0, 1023, 1), "rt": ("right_trigger", 0, 1023, 1)},
                       _XBOX | _DPAD | {"misc1": "misc1"}, gadget="xboxseries"),
    "powera": Kind("PowerA Xbox Series X EnWired", "20d6:2001", "Linux xpad.c (its table of ids; GIP)", ("evdev", "usb", "sdl"),
                   _WORDS | {"lt": ("left_trigger", 0, 1023, 1), "rt": ("right_trigger", 0, 1023, 1)}, _XBOX | _DPAD,
                   gadget="powera"),
    "f310x": Kind("Logitech F310, switch at X", "046d:c21d", "Linux xpad.c (its table of ids; the 360's packets)",
                  ("evdev", "usb", "sdl"), _WORDS | _TRIGGERS8, _XBOX | _DPAD | {"guide": "guide"}, gadget="f310x"),
    "edge": Kind("DualSense Edge", "054c:0df2", "Linux hid-playstation.c", ("hidraw", "evdev", "usb", "sdl"),
                 _STICKS8 | _TRIGGERS8, _XBOX | {"guide": "guide"}, gadget="edge", has_hat=True),
    "ds3": Kind("DualShock 3", "054c:0268", "Linux hid-sony.c", ("hidraw", "usb"), _STICKS8 | _TRIGGERS8,
                _XBOX | _DPAD | {"guide": "guide"}, gadget="ds3"),
    "gamecube": Kind("GameCube adapter, one controller", "057e:0337", "SDL SDL_hidapi_gamecube.c", ("hidraw",),
                     {"lx": ("left_x", 127.5, 127.5, 1), "ly": ("left_y", 127.5, 127.5, 1),
                      "rx": ("right_x", 127.5, 127.5, 1), "ry": ("right_y", 127.5, 127.5, 1)} | _TRIGGERS8,
                     {name: name for name in ("a", "b", "x", "y", "start", "rightshoulder")} | _DPAD, gadget="gamecube"),
    "f310d": Kind("Logitech F310, switch at D", "046d:c216", "SDL's gamecontrollerdb, Logitech Dual Action", HID,
                  _STICKS8,
                  dict(x="x", a="a", b="b", y="y", l1="leftshoulder", r1="rightshoulder", back="back", start="start",
                       l3="leftstick", r3="rightstick"),
                  descriptor=_pad(4, X_Y_Z_RZ, _HAT, _buttons(1, 12), bytes([0x06, 0, 0xff, 0x09, 1]), _fields(2, 8, 255)),
                  neutral=bytes([0x80] * 4 + [8, 0, 0, 0]),
                  bits=_places(0, "lx", "ly", "rx", "ry", width=8) | {"hat": (32, 4)} | _places(
                      36, "x", "a", "b", "y", "l1", "r1", None, None, "back", "start", "l3", "r3"), has_hat=True),
    "extreme3d": Kind("Logitech Extreme 3D Pro", "046d:c215", "linux-hardware.org's descriptor: 10-bit X and Y, hat, twist (Rz), "
                      "throttle (slider), 12 buttons", HID,
                      {"lx": ("left_x", 511.5, 511.5, 1), "ly": ("left_y", 511.5, 511.5, -1)}, {},
                      descriptor=_pad(4, _usages(1, 0x30, 0x31), _fields(2, 10, 1023), _HAT, _usages(1, 0x35), _fields(1, 8, 255),
                                      _buttons(1, 8), _usages(1, 0x36), _fields(1, 8, 255), _buttons(9, 12), _pad_bits(4)),
                      neutral=bytes.fromhex("00028880008000"),
                      bits=_places(0, "lx", "ly", width=10) | {"hat": (20, 4), "twist": (24, 8), "throttle": (40, 8)},
                      has_hat=True, still=("right_x", "right_y")),
    "t16000m": Kind("Thrustmaster T.16000M", "044f:b10a", "linux-hardware.org's descriptor: 16 buttons, hat, 14-bit X and Y, twist "
                    "(Rz), throttle (slider)", HID,
                    {"lx": ("left_x", 8191.5, 8191.5, 1), "ly": ("left_y", 8191.5, 8191.5, -1)}, {},
                    descriptor=_pad(4, _buttons(1, 16), _HAT, _pad_bits(4), _usages(1, 0x30, 0x31), _fields(2, 16, 16383),
                                    _usages(1, 0x35, 0x36), _fields(2, 8, 255)),
                    neutral=bytes.fromhex("0000080020002080 00"),
                    bits={"hat": (16, 4), "lx": (24, 16), "ly": (40, 16), "twist": (56, 8), "throttle": (64, 8)}, has_hat=True,
                    still=("right_x", "right_y")),
    "twin": Kind("Twin USB PS2 adapter", "0810:0001", "Linux hid-pl.c, SDL's gamecontrollerdb (two report ids, one a pad)",
                 ("hidraw",),
                 {"lx": ("left_x", 127.5, 127.5, 1), "ly": ("left_y", 127.5, 127.5, -1)},
                 dict(y="y", b="b", a="a", x="x", l1="leftshoulder", r1="rightshoulder", back="back", start="start",
                      l3="leftstick", r3="rightstick"),
                 descriptor=b"".join(_pad(4, _PORT_OF_TWIN, report_id=number) for number in (1, 2)),
                 neutral=bytes([1, 0x80, 0x80, 0x80, 0x80, 8, 0, 0]),
                 bits={"rx": (8, 8), "ry": (16, 8), "lx": (24, 8), "ly": (32, 8), "hat": (40, 4)} | _places(
                     44, "y", "b", "a", "x", None, None, "l1", "r1", "back", "start", "l3", "r3"), has_hat=True),
    "8bitdo": Kind("8BitDo SN30 Pro, DInput", "2dc8:6001", "SDL's gamecontrollerdb, 8BitDo SN30 Pro", HID,
                   _STICKS8 | {"lt": ("left_trigger", 0, 255, 1), "rt": ("right_trigger", 0, 255, 1)},
                   dict(b="b", a="a", y="y", x="x", l1="leftshoulder", r1="rightshoulder", back="back", start="start",
                        guide="guide", l3="leftstick", r3="rightstick"),
                   descriptor=_pad(5, _HAT, _pad_bits(4), X_Y_Z_RZ, BRAKE_GAS, _buttons(1, 16), report_id=3),
                   neutral=bytes([3, 8, 0x80, 0x80, 0x80, 0x80, 0, 0, 0, 0]),
                   bits={"hat": (8, 4)} | _places(16, "lx", "ly", "rx", "ry", "lt", "rt", width=8) | _places(
                       64, "b", "a", None, "y", "x", None, "l1", "r1", None, None, "back", "start", "guide", "l3", "r3"),
                   has_hat=True),
    "stadia": Kind("Stadia Controller", "18d1:9400", "the stadia-vigem project (bytes), Android's numbers of buttons", HID,
                   _STICKS8 | {"lt": ("left_trigger", 0, 255, 1), "rt": ("right_trigger", 0, 255, 1)},
                   dict(a="a", b="b", x="x", y="y", l1="leftshoulder", r1="rightshoulder", back="back", start="start",
                        guide="guide", l3="leftstick", r3="rightstick", capture="misc1", assistant="misc2"),
                   descriptor=_pad(5, _HAT, _pad_bits(4),
                                   _usages(9, 18, 17, 20, 19, 13, 12, 11, 15, 14, 8, 7, 5, 4, 2, 1), _fields(15, 1, 1), _pad_bits(1),
                                   X_Y_Z_RZ, BRAKE_GAS, report_id=3),
                   neutral=bytes([3, 8, 0, 0, 0x80, 0x80, 0x80, 0x80, 0, 0]),
                   bits={"hat": (8, 4)} | _places(16, "capture", "assistant", None, None, "guide", "start", "back", "r3", "l3", "r1",
                                                  "l1", "y", "x", "b", "a")
                   | _places(32, "lx", "ly", "rx", "ry", "lt", "rt", width=8), has_hat=True),
    "luna": Kind("Luna Controller", "1949:0419", "SDL's SDL_hidapi_luna.c (bytes)", HID, _STICKS8 | _TRIGGERS8,
                 dict(a="a", b="b", x="x", y="y", l1="leftshoulder", r1="rightshoulder", back="back", start="start",
                      guide="guide", microphone="misc1", l3="leftstick", r3="rightstick"),
                 descriptor=_pad(5, _buttons(1, 12), _pad_bits(4), _HAT, _pad_bits(4), X_Y_Z_RZ,
                                 _usages(1, 0x33, 0x34), _fields(2, 8, 255), report_id=1),
                 neutral=bytes([1, 0, 0, 8, 0x80, 0x80, 0x80, 0x80, 0, 0]),
                 bits=_places(8, "a", "b", "x", "y", "l1", "r1", "back", "start", "guide", "microphone", "l3", "r3")
                 | {"hat": (24, 4)} | _places(32, "lx", "ly", "rx", "ry", "lt", "rt", width=8), has_hat=True),
    # The numbers of its buttons are bits of a word of 64; 2 and 1 are the triggers' switches.
    "deck": Kind("Steam Deck", "28de:1205", "SDL's steam/controller_structs.h, Linux hid-steam.c", ("hidraw", "usb"),
                 _WORDS | {"lt": ("left_trigger", 0, 32767, 1), "rt": ("right_trigger", 0, 32767, 1)},
                 _XBOX | _DPAD | {name: name for name in ("guide", "misc1", "paddle1", "paddle2", "paddle3", "paddle4")},
                 descriptor=bytes([0x06, 0xff, 0xff, 0x09, 1, 0xa1, 1, 0x09, 2, 0x15, 0, 0x26, 0xff, 0, 0x75, 8, 0x95, 64, 0x81, 2,
                                   0x09, 3, 0x95, 64, 0xb1, 2, 0xc0]),
                 neutral=bytes([1, 0, 9, 60]) + bytes(60),
                 bits={name: (64 + bit, 1) for name, bit in (
                     ("rightshoulder", 2), ("leftshoulder", 3), ("y", 4), ("b", 5), ("x", 6), ("a", 7), ("dpup", 8), ("dpright", 9),
                     ("dpleft", 10), ("dpdown", 11), ("back", 12), ("guide", 13), ("start", 14), ("paddle4", 15), ("paddle3", 16),
                     ("leftstick", 22), ("rightstick", 26), ("paddle2", 41), ("paddle1", 42), ("misc1", 50))}
                 | _places(352, "lt", "rt", "lx", "ly", "rx", "ry", width=16),
                 stream_rate_hz=250, has_event_node=False),
}
