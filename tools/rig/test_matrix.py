"""Six pads on every driver that can serve them: found, decoded as sent, recorded, and replayed to the same poses."""
import json
import time

import pytest

from cells import cells
from pads import Pad
from session import IDS, Session, remark, run

DRIVERS = {"generic": ("hidraw", "usb", "evdev", "sdl"), "ds4": ("hidraw", "usb", "evdev", "sdl"),
           "dualsense": ("hidraw", "usb", "evdev", "sdl"), "switch": ("hidraw", "usb", "evdev", "sdl"),
           "xbox360": ("usb", "evdev", "sdl"), "xboxone": ("usb", "evdev", "sdl")}

BYTES = {"rest": 128, "low": 0, "high": 255, "some": (200, 100, 50, 25), "trigger": 255, "forward": 0}
WORDS = {"rest": 0, "low": -32768, "high": 32767, "some": (20000, 10000, -5000, -20000), "forward": 32767}
VALUES = {"generic": BYTES, "ds4": BYTES, "dualsense": BYTES,
          # within the sticks' reach by the flash: 2048 +- 1536
          "switch": {"rest": 2048, "low": 512, "high": 3584, "some": (3200, 1500, 1000, 2500), "trigger": 1,
                     "forward": 3584},
          "xbox360": {**WORDS, "trigger": 255}, "xboxone": {**WORDS, "trigger": 1023}}
STICKS = ("lx", "ly", "rx", "ry")
BUTTONS = ("a", "b", "x", "y")
MIDDLE = ("leftshoulder", "rightshoulder", "back", "start", "leftstick", "rightstick")
DPAD = ("dpup", "dpright", "dpdown", "dpleft")
# Every button of a kind, as its field of the report is called and as SDL names it by position. Nintendo prints b on the
# bottom one; the generic pad's first ones count a b - x y - on a pad with accelerator and brake.
NAMES_OF = {
    "generic": {"a": "a", "b": "b", "x": "button_3", "y": "x", "button5": "y", "button6": "button_6",
                "button7": "leftshoulder", "button8": "rightshoulder", "button11": "back", "button12": "start"},
    "ds4": {name: name for name in BUTTONS + MIDDLE + ("guide", "touchpad")},
    "dualsense": {name: name for name in BUTTONS + MIDDLE + ("guide", "touchpad", "misc1")},
    "switch": {"a": "b", "b": "a", "x": "y", "y": "x", **{name: name for name in MIDDLE + ("guide", "misc1")}},
    "xbox360": {name: name for name in BUTTONS + MIDDLE + ("guide",)},
    "xboxone": {name: name for name in BUTTONS + MIDDLE}}
# Buttons that are missing on the pad's event node: a click of the touchpad belongs to the touchpad's node, Mute is the
# driver's own switch, and SDL has no name for the generic pad's spare buttons.
KEPT = {("generic", "sdl"): {"x", "button6"}, ("ds4", "evdev"): {"touchpad"}, ("ds4", "sdl"): {"touchpad"},
        ("dualsense", "evdev"): {"touchpad", "misc1"}, ("dualsense", "sdl"): {"touchpad", "misc1"}}
# A user's line, without which SDL would guess: SDL counts the buttons of the node, and its axes X Y Z Rz Gas Brake.
LINE_OF_GENERIC = ("03000000091200000100000011010000,Rig Test Pad,a:b0,b:b1,x:b3,y:b4,leftshoulder:b6,rightshoulder:b7,back:b10,"
                   "start:b11,leftx:a0,lefty:a1,rightx:a2,righty:a3,righttrigger:a4,lefttrigger:a5,dpup:h0.1,dpright:h0.2,"
                   "dpdown:h0.4,dpleft:h0.8,platform:Linux,")
HAS_HAT = ("generic", "ds4", "dualsense")  # values 0 up, clockwise, 8 released; the other kinds have four bits
NAMES = {"lx": "left_x", "ly": "left_y", "rx": "right_x", "ry": "right_y", "lt": "left_trigger",
         "rt": "right_trigger"}


def directions(eighth):
    """Names of the D-pad buttons pressed at that eighth of a turn, clockwise from up."""
    names = {DPAD[eighth // 2]}
    return names | {DPAD[(eighth // 2 + 1) % 4]} if eighth % 2 else names


def at_rest(kind):
    rest = {**dict.fromkeys(STICKS, VALUES[kind]["rest"]), "lt": 0, "rt": 0, **dict.fromkeys(NAMES_OF[kind], 0)}
    return {**rest, "hat": 8} if kind in HAS_HAT else {**rest, **dict.fromkeys(DPAD, 0)}


def states(kind, driver):
    """The states to send, in order: sticks at both ends and between, triggers, each button, the D-pad in eight
    directions."""
    v, rest, kept = VALUES[kind], at_rest(kind), KEPT.get((kind, driver), ())
    yield {**rest, **dict(zip(STICKS, v["some"]))}
    for stick in STICKS:
        yield {**rest, stick: v["low"]}
        yield {**rest, stick: v["high"]}
    if kind != "switch":
        yield {**rest, "lt": v["trigger"] // 2, "rt": v["trigger"]}
    yield {**rest, "lt": v["trigger"]}
    yield {**rest, "rt": v["trigger"]}
    for button in NAMES_OF[kind]:
        if button not in kept:
            yield {**rest, button: 1}
    for eighth in range(8):
        yield {**rest, **({"hat": eighth} if kind in HAS_HAT else dict.fromkeys(directions(eighth), 1))}
    yield rest


def expected_stick(kind, driver, name, value):
    """The decoded value, +y forward. HID pads have y backwards, Switch and Xbox packets forward."""
    if kind == "switch":
        if driver in ("hidraw", "usb"):
            return value / 2047.5 - 1  # in the pad's own counts; the calibration comes later
        return max(-1.0, min(1.0, (value - 2048) / 1536))  # hid-nintendo applies the calibration
    if kind in ("xbox360", "xboxone"):
        return (value + 32768) / 32767.5 - 1
    return (value / 127.5 - 1) * (-1 if name.endswith("y") else 1)


def expected(kind, driver, state):
    """The expected axes, and every button that is pressed."""
    axes = {NAMES[name]: expected_stick(kind, driver, name, state[name]) for name in STICKS}
    for name in ("lt", "rt"):
        axes[NAMES[name]] = state[name] / VALUES[kind]["trigger"]
    pressed = {name for button, name in NAMES_OF[kind].items() if state[button]}
    if kind in HAS_HAT:
        return axes, pressed | (directions(state["hat"]) if state["hat"] < 8 else set())
    return axes, pressed | {name for name in DPAD if state[name]}


def is_as_sent(row, axes, buttons):
    """True if every axis has the sent value, and only these buttons are pressed."""
    return all(abs(row["axes"][name] - value) < 0.002 for name, value in axes.items()) and set(row["buttons"]) == buttons


def check_sequence(rows, wanted):
    """Checks that the wanted states occur in this order."""
    position = 0
    for number, (axes, buttons) in enumerate(wanted):
        found = next((i for i in range(position, len(rows)) if is_as_sent(rows[i], axes, buttons)), None)
        if found is None:
            near = [(row["axes"], row["buttons"]) for row in rows[position:position + 12]]
            raise AssertionError(f"state {number} was not decoded: {axes} {buttons}; from there on came {near}")
        position = found


@pytest.mark.timeout(90)
@pytest.mark.parametrize("case", cells(DRIVERS))
def test_found_decoded_recorded_and_replayed(case, monkeypatch):
    kind, driver = case.split("-")
    if (kind, driver) == ("generic", "sdl"):
        monkeypatch.setenv("SDL_GAMECONTROLLERCONFIG", LINE_OF_GENERIC)
    with Pad(kind) as pad:
        rows = json.loads(run("gaitpad", "pads", "--driver", driver, "--json").stdout)
        ids = IDS[kind].split(":")
        mine = [row for row in rows if row.get("vendor") == int(ids[0], 16) and row["product"] == int(ids[1], 16)]
        assert [row["usable"] for row in mine].count(True) == 1, mine
        with Session(IDS[kind], "--driver", driver, name=case) as session:
            sent = list(states(kind, driver))
            for state in sent:
                session.show(driver, pad, 0.02, **state)
            pad.set(ly=VALUES[kind]["forward"])
            time.sleep(1.5)
            pad.set(ly=VALUES[kind]["rest"])
            time.sleep(0.1)
            drivers = {line.split()[1] for line in session.lines("B:")}
        assert drivers == {driver}
        check_sequence(session.decoded(), [expected(kind, driver, state) for state in sent])
        steps = session.replayed["steps_left"] + session.replayed["steps_right"]
        assert steps >= 2, f"{steps} steps"
        assert session.replayed["bad_reports"] == 0, session.replayed
        remark(f"{case}: {session.replayed['reports']} reports, pose hash {session.replayed['pose_hash']} twice")


@pytest.mark.parametrize("kind", ["generic", "ds4", "dualsense", "switch", "xbox360", "xboxone"])
def test_without_a_choice_the_best_driver_serves_it(kind):
    with Pad(kind):
        rows = json.loads(run("gaitpad", "pads", "--json").stdout)
        chosen = [row["driver"] for row in rows if row.get("chosen")]
        assert chosen == [DRIVERS[kind][0] if kind[:4] != "xbox" else "evdev"], rows
