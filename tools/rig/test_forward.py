"""A pad for other programs: forwarded with its calibration by `play --forward`, and played into the kernel from a
recording by `replay --to`. SDL, evdev and hidraw read what came out."""
import ctypes
import math
import subprocess
import time

import pytest

from nodes import EventNode, HidrawNode
from pads import PATIENCE, Nodes, Pad, wait_for
from session import IDS, PROGRAM, Session, remark
from support import traces

FULL = 32767
NAME = b"gaitpad calibrated pad"
# Centre a tenth beside the middle, as of a worn stick; round zone.
CALIBRATION = """name = "rig"
devices = ["054c:09cc"]

[left]
x = { min = -0.9, centre = 0.1, max = 0.9 }
y = { min = -1.0, centre = 0.0, max = 1.0 }
shape = "radial"
inner = 0.1
outer = 0.9
"""


def calibrated(lx, ly):
    """By config/README.md's words: each axis from its centre, then the round zone; y forward."""
    x, y = lx / 127.5 - 1 - 0.1, -(ly / 127.5 - 1)
    x = x / (0.9 - 0.1 if x > 0 else 0.1 + 0.9)
    length = math.hypot(x, y)
    reach = min(1.0, max(0.0, (length - 0.1) / (0.9 - 0.1)))
    return (x / length * reach, y / length * reach) if length else (0.0, 0.0)


class SdlPad:
    """SDL's game controller of that name."""
    AXES = {"left_x": 0, "left_y": 1, "right_x": 2, "right_y": 3, "left_trigger": 4, "right_trigger": 5}
    BUTTONS = ("a", "b", "x", "y")

    def __init__(self):
        self.sdl = ctypes.CDLL("libSDL2-2.0.so.0")
        self.sdl.SDL_GameControllerOpen.restype = ctypes.c_void_p
        self.sdl.SDL_JoystickNameForIndex.restype = ctypes.c_char_p
        self.sdl.SDL_GameControllerGetAxis.restype = ctypes.c_int16
        self.sdl.SDL_SetHint(b"SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS", b"1")
        self.sdl.SDL_SetHint(b"SDL_JOYSTICK_HIDAPI", b"0")
        assert self.sdl.SDL_Init(0x2000) == 0  # SDL_INIT_GAMECONTROLLER
        names = [self.sdl.SDL_JoystickNameForIndex(i) for i in range(self.sdl.SDL_NumJoysticks())]
        assert names.count(NAME) == 1, names
        index = names.index(NAME)
        assert self.sdl.SDL_IsGameController(index), "SDL knows it without a mapping"
        self.pad = ctypes.c_void_p(self.sdl.SDL_GameControllerOpen(index))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.sdl.SDL_GameControllerClose(self.pad)
        self.sdl.SDL_Quit()

    def axes(self):
        self.sdl.SDL_GameControllerUpdate()
        return {name: self.sdl.SDL_GameControllerGetAxis(self.pad, number) for name, number in self.AXES.items()}

    def left(self):
        axes = self.axes()
        return axes["left_x"], axes["left_y"]

    def pressed(self):
        self.sdl.SDL_GameControllerUpdate()
        return {name for number, name in enumerate(self.BUTTONS) if self.sdl.SDL_GameControllerGetButton(self.pad, number)}


def virtual_pad():
    """The event nodes of the pad that gaitpad makes."""
    return Nodes("/sys/devices/virtual/input").joystick


@pytest.mark.timeout(120)
def test_sdl_reads_the_forwarded_pad_exactly(tmp_path):
    (tmp_path / "rig.toml").write_text(CALIBRATION)
    seen = {}
    with Pad("ds4") as pad, Session(IDS["ds4"], "--forward", "--calibration", tmp_path / "rig.toml", name="forward") as session:
        wait_for(virtual_pad, 10, "the virtual pad")
        time.sleep(0.5)
        with SdlPad() as sdl:
            # SDL tells no movement of an axis before its first one of more than an eightieth (SDL_joystick.c).
            for corner in (0, 255):
                pad.set(lx=corner, ly=corner)
                wait_for(lambda: min(map(abs, sdl.left())) > FULL / 2, 20, "both axes of the stick in SDL")
                time.sleep(0.05)
            for place in [(140, 128), (255, 128), (0, 128), (128, 0), (128, 255), (200, 60), (30, 220), (90, 128), (141, 128)]:
                pad.set(lx=place[0], ly=place[1])
                expected = tuple(round(v * FULL) for v in calibrated(*place))
                end = time.monotonic() + 20 * PATIENCE
                while max(abs(sdl.left()[0] - expected[0]), abs(sdl.left()[1] + expected[1])) > 1:
                    assert time.monotonic() < end, f"{expected} of {place}, SDL has {sdl.left()}"
                    time.sleep(0.01)
                seen[place] = sdl.left()
            pad.set(lx=140, ly=128, lt=255, a=1)
            wait_for(lambda: sdl.pressed() == {"a"} and sdl.axes()["left_trigger"] == FULL, 20, "a and the trigger")
            for button in ("b", "x", "y"):
                pad.set(**{"a": 0, "b": 0, "x": 0, "y": 0, button: 1})
                wait_for(lambda b=button: sdl.pressed() == {b}, 20, button)
            pad.set(lx=255, x=0, y=0, lt=0)
            wait_for(lambda: sdl.left()[0] == FULL, 20, "full stick")
            pad.unplug()
            wait_for(lambda: sdl.left() == (0, 0), 20, "a neutral stick after unplugging")
    assert seen[140, 128] == (0, 0), "the centre of the worn stick, 0.1 from its middle"
    sticks = {(round(float(row["stick_x"]) * FULL), round(-float(row["stick_y"]) * FULL)) for row in session.frames()}
    assert set(seen.values()) <= sticks, "exactly what the walk used"
    remark(f"forward: {len(seen)} stick positions and four buttons exact in SDL")


@pytest.mark.timeout(120)
def test_gaitpad_does_not_read_its_own_output():
    with Pad("generic"), Session(IDS["generic"], "--forward", name="own") as session:
        wait_for(virtual_pad, 10, "the virtual pad")
        time.sleep(2)
    assert session.plugged() == 1, session.lines("H:")


def play_into(target, trace, reader):
    """reader(wait) beside `replay --to`; its output."""
    player = subprocess.Popen([PROGRAM, "replay", trace, "--to", target, "--delay", "3"], stdout=subprocess.PIPE, text=True)
    try:
        result = reader()
        output, _ = player.communicate(timeout=60 * PATIENCE)
        assert player.returncode == 0
        print(output)
        return result
    finally:
        player.kill()


STICK = [(0.02 * i, 0.9 * math.sin(i / 9), 0.9 * math.cos(i / 7)) for i in range(1, 120)]


@pytest.mark.timeout(120)
def test_a_recording_comes_out_of_hidraw_as_it_was(tmp_path):
    trace = traces.write_trace(tmp_path / "walk.hid", STICK)
    recorded = traces.reports(trace)

    def read():
        node = wait_for(lambda: Nodes("/sys/devices/virtual/misc/uhid").hidraw, 20, "a hidraw node")
        with HidrawNode(node) as hidraw:
            assert hidraw.descriptor() == traces.DESCRIPTOR
            seen = []
            while len(seen) < len(recorded):
                data = hidraw.read(10)
                assert data, f"{len(seen)} of {len(recorded)} reports came"
                seen.append((time.monotonic(), data))
            return seen

    seen = play_into("uhid", trace, read)
    assert [data for _, data in seen] == [data for _, data in recorded]
    late_s = [t - sent for (t, _), (sent, _) in zip(seen, recorded)]
    late_ms = sorted((late - min(late_s)) * 1000 for late in late_s)  # behind the most punctual one
    assert late_ms[len(late_ms) // 2] < 20, late_ms
    remark(f"replay --to uhid: {len(seen)} reports exact, median {late_ms[len(late_ms) // 2]:.1f} ms behind their times")


@pytest.mark.timeout(120)
def test_a_recording_comes_out_of_uinput_calibrated(tmp_path):
    raw = traces.raw_stick(-0.5, 0.25)
    trace = traces.write_trace(tmp_path / "walk.hid", [(0.5, *raw)])

    def read():
        node = wait_for(virtual_pad, 20, "the virtual pad")
        with EventNode(node) as events:
            x, y = round(-0.5 * FULL), round(-0.25 * FULL)
            # 16 bits of the recording's stick are worth a count or two after its zones
            wait_for(lambda: events.events(0.05) is not None and abs(events.absolute(0).value - x) <= 2 and
                     abs(events.absolute(1).value - y) <= 2, 20, f"{x} {y}, not {events.absolute(0)} {events.absolute(1)}")

    play_into("uinput", trace, read)
