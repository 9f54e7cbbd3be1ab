"""evemu recordings: evemu's library reads gaitpad's files, and gaitpad reads the library's. Without the library the
same forms are read in tests/hid/evemu_test.cpp."""
import ctypes
import json
import os

import pytest

from support.traces import FULL, write_trace

EV_KEY, EV_ABS = 1, 3


class InputEvent(ctypes.Structure):
    _fields_ = [("sec", ctypes.c_long), ("usec", ctypes.c_long), ("type", ctypes.c_ushort), ("code", ctypes.c_ushort),
                ("value", ctypes.c_int)]


class Evemu:
    """libevemu by its C interface (evemu.h)."""

    def __init__(self):
        self.library, self.c = ctypes.CDLL("libevemu.so.3"), ctypes.CDLL(None)
        self.c.fopen.restype = self.library.evemu_new.restype = ctypes.c_void_p
        self.library.evemu_get_name.restype = ctypes.c_char_p
        self.device = ctypes.c_void_p(self.library.evemu_new(b""))

    def call(self, name, *arguments):
        return getattr(self.library, f"evemu_{name}")(self.device, *arguments)

    def open(self, path, mode):
        return ctypes.c_void_p(self.c.fopen(str(path).encode(), mode.encode()))

    def read(self, path):
        """The events: (time_s, type, code, value)."""
        file, event, events = self.open(path, "r"), InputEvent(), []
        assert self.call("read", file) > 0, f"{path}: evemu does not read it"
        while self.library.evemu_read_event(file, ctypes.byref(event)) > 0:
            events.append((event.sec + event.usec * 1e-6, event.type, event.code, event.value))
        self.c.fclose(file)
        return events

    def write(self, path, events):
        file = self.open(path, "w")
        assert self.call("write", file) == 0
        for time_s, *event in events:
            whole, rest = divmod(round(time_s * 1e6), 10**6)
            assert self.library.evemu_write_event(file, ctypes.byref(InputEvent(whole, rest, *event))) > 0
        self.c.fclose(file)


@pytest.fixture
def evemu():
    try:
        return Evemu()
    except OSError:
        pytest.skip("there is no libevemu (package evemu-tools)")


@pytest.fixture
def trace(tmp_path):
    return write_trace(tmp_path / "walk.hid", [(0.1, 0.5, 1.0), (0.2, -1.0, -0.25)])


def test_evemus_own_library_reads_what_is_written(run, evemu, trace, tmp_path):
    assert run("replay", trace, "--to", tmp_path / "walk.evemu").stdout == f"{tmp_path / 'walk.evemu'}\n"
    events = evemu.read(tmp_path / "walk.evemu")
    assert evemu.call("get_name") == b"gaitpad test pad"
    ids = [evemu.call(f"get_id_{part}") for part in ("bustype", "vendor", "product", "version")]
    assert ids == [3, 0x1209, 0x0001, 0]
    assert [evemu.call(f"get_abs_{end}", 0) for end in ("minimum", "maximum")] == [-FULL, FULL]
    assert evemu.call("has_event", EV_KEY, 0x130) and not evemu.call("has_event", EV_KEY, 0x100)
    x = [(round(t, 6), value) for t, kind, code, value in events if (kind, code) == (EV_ABS, 0)]
    assert x == [(pytest.approx(0.1, abs=2e-6), round(FULL * 0.5)), (pytest.approx(0.2, abs=2e-6), -FULL)]
    assert sum(event[1:] == (0, 0, 0) for event in events) == 2, "one SYN_REPORT for each report that changes anything"


def test_what_evemus_own_library_writes_is_a_recording(run, evemu, tmp_path):
    """From gaitpad's own description of the device, since the library describes a device only from a kernel's node
    or from a file."""
    described = tmp_path / "described.evemu"
    run("replay", write_trace(tmp_path / "any.hid", []), "--to", described)
    evemu.read(described)
    path = tmp_path / "ds4.evemu"
    for part, value in (("vendor", 0x054c), ("product", 0x09cc), ("version", 0x8111)):
        evemu.call(f"set_id_{part}", value)
    evemu.write(path, [(0.000001, EV_ABS, 1, -FULL), (0.000001, 0, 0, 0), (0.5, EV_KEY, 0x130, 1), (0.5, 0, 0, 0)])
    assert "\nI: 0003 054c 09cc 8111\n" in path.read_text()
    rows = [json.loads(line) for line in run("decode", path, "--json").stdout.splitlines()]
    device, reports = rows[0], rows[1:]
    assert (device["device"]["vendor"], device["device"]["product"], device["pad"]) == (0x054c, 0x09cc, True)
    assert [row["axes"]["left_y"] for row in reports] == [1.0, 1.0]
    assert [row["buttons"] for row in reports] == [[], ["a"]]
    assert json.loads(run("replay", path, "--json").stdout)["reports"] == 2


@pytest.mark.parametrize("target", ["uinput", "uhid"])
def test_without_the_kernels_node_it_is_one_sentence(refuse, trace, target):
    if os.path.exists(f"/dev/{target}"):
        pytest.skip(f"there is a /dev/{target} here; tools/rig proves it")
    refuse("replay", trace, "--to", target, says=[f"/dev/{target}", "modprobe"])
    if target == "uinput":
        refuse("play", trace, "--no-window", "--forward", says=["/dev/uinput", "modprobe"])


def test_other_targets_are_wrong_usage(run, trace):
    run("replay", trace, "--to", "evdev", status=2)
    run("replay", trace, "--to", "uhid", "--json", status=2)
    run("replay", trace, "--delay", 1, status=2)


