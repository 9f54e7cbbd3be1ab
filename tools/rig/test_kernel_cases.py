"""The pads and the cases of Linux's own HID tests, test_gamepad.py and test_sony.py of tools/testing/selftests/hid/tests:
for each state the kernel's event node says what those tests expect, and the hidraw driver decodes the same.

Of Sony's pads, which test_matrix.py and test_bluetooth.py also have, one in four runs (cells.py).
"""
import time

import pytest

from cells import some
from more_kinds import MORE
from nodes import ABS, EventNode
from pads import PATIENCE, Pad
from session import IDS, Session, remark
from test_matrix import STICKS, directions
from uhid_pad import KINDS, UhidPad

TOLERANCE = 1e-3
HATS = {0: (0, -1), 2: (1, 0), 4: (0, 1), 6: (-1, 0)}  # values of HAT0X, HAT0Y
NAMES = {"lx": "left_x", "ly": "left_y", "rx": "right_x", "ry": "right_y", "lt": "left_trigger", "rt": "right_trigger"}

# Each field's code in linux/input-event-codes.h. A button's name is the program's, by position, or the trigger that it
# pulls; None: it has none.
JOYSTICK, GAMEPAD, KEY_BACK, KEY_HOMEPAGE = 0x120, 0x130, 158, 172
SONY_AXES = {"lx": "X", "ly": "Y", "rx": "RX", "ry": "RY", "lt": "Z", "rt": "RZ"}
SONY = {"a": (0x130, "a"), "b": (0x131, "b"), "y": (0x133, "y"), "x": (0x134, "x"), "leftshoulder": (0x136, "leftshoulder"),
        "rightshoulder": (0x137, "rightshoulder"), "back": (0x13a, "back"), "start": (0x13b, "start"),
        "guide": (0x13c, "guide"), "leftstick": (0x13d, "leftstick"), "rightstick": (0x13e, "rightstick")}
SWITCHES = {"l2": (0x138, None), "r2": (0x139, None)}  # keys of the triggers


def numbered(first, names):
    return {f"button {number}": (first + number - 1, name) for number, name in names.items()}


PADS = {  # kind: (axes, buttons)
    "saitek": ({"lx": "X", "ly": "Y", "rx": "RUDDER", "ry": "THROTTLE"},
               numbered(JOYSTICK, dict(enumerate(("x", "y", "a", "b", "leftshoulder", "rightshoulder", "left_trigger",
                                                  "right_trigger", "leftstick", "rightstick", "start", "back"), 1)))),
    "asus": ({"lx": "X", "ly": "Y", "rx": "Z", "ry": "RZ", "lt": "BRAKE", "rt": "GAS"},
             numbered(GAMEPAD, {1: "a", 2: "b", 4: "x", 5: "y", 7: "leftshoulder", 8: "rightshoulder", 14: "leftstick",
                                15: "rightstick", 13: "guide"})
             | {"back": (KEY_BACK, "back"), "home": (KEY_HOMEPAGE, "start")}),
    "ds4": (SONY_AXES, SONY), "dualsense": (SONY_AXES, SONY),
    "ds3": (SONY_AXES, SONY | {name: (0x220 + i, name) for i, name in enumerate(("dpup", "dpdown", "dpleft", "dpright"))}),
    "ds4_bt": (SONY_AXES, SONY | SWITCHES), "dualsense_bt": (SONY_AXES, SONY | SWITCHES),
}


def plug(kind):
    return UhidPad(kind) if kind in KINDS else Pad(kind)


def states(kind):
    axes, buttons = PADS[kind]
    hats = () if "dpup" in buttons else HATS
    rest = {field: 127 if field in STICKS else 0 for field in axes} | dict.fromkeys(buttons, 0) | ({"hat": 8} if hats else {})
    first, second = list(buttons)[:2]
    for button in buttons:
        yield {**rest, button: 1}
        yield rest
    yield {**rest, first: 1, second: 1}
    yield {**rest, second: 1}
    yield rest
    for axis in axes:
        for value in (63, 0, 191, 255):
            yield {**rest, axis: value}
    for hat in hats:
        yield {**rest, "hat": hat}
    yield rest


def expected_of_node(kind, state):
    axes, buttons = PADS[kind]
    return ({code: state[field] for field, code in axes.items()} | dict(zip(("HAT0X", "HAT0Y"), HATS.get(state.get("hat"), (0, 0)))),
            {code for field, (code, _) in buttons.items() if state[field]})


def expected_of_program(kind, state):
    axes, buttons = PADS[kind]
    values = {NAMES[field]: state[field] / 255 if field not in STICKS else
              (state[field] / 127.5 - 1) * (-1 if field.endswith("y") else 1) for field in axes}
    down = {name for field, (_, name) in buttons.items() if state[field] and name}
    triggers = down & {"left_trigger", "right_trigger"}
    values |= dict.fromkeys(triggers, 1.0)
    return values, (down - triggers) | (directions(state["hat"]) if state.get("hat") in HATS else set())


def check_node(node, kind, state):
    """Checks that the node follows a report at once; on a busy host the program may need longer."""
    axes, keys = expected_of_node(kind, state)
    end = time.monotonic() + 3 * PATIENCE
    while (found := ({name: node.absolute(ABS[name]).value for name in axes}, node.keys())) != (axes, keys):
        assert time.monotonic() < end, f"{state}: the event node is at {found}, not {(axes, keys)}"
        time.sleep(0.01)


def is_decoded(row, axes, buttons):
    return set(row["buttons"]) == buttons and all(abs(value - axes.get(name, 0.0)) < TOLERANCE
                                                  for name, value in row["axes"].items())


@pytest.mark.timeout(120)
@pytest.mark.parametrize("kind", ["saitek", "asus", *some(list(PADS)[2:], 4)])
def test_event_node_and_hidraw_agree(kind):
    ids = "%04x:%04x" % KINDS[kind].ids if kind in KINDS else IDS.get(kind) or MORE[kind].ids
    sent = list(states(kind))
    with plug(kind) as pad, EventNode(pad.joystick) as node:
        with Session(ids, "--driver", "hidraw", name=f"kernel-{kind}") as session:
            for state in sent:
                session.show("hidraw", pad, 0.03, **state)
                check_node(node, kind, state)
            time.sleep(0.3)
    rows, position = session.decoded(), 0
    for number, state in enumerate(sent):
        axes, buttons = expected_of_program(kind, state)
        found = next((i for i in range(position, len(rows)) if is_decoded(rows[i], axes, buttons)), None)
        assert found is not None, (f"state {number} {state} was not decoded: {axes} {buttons}; from there on came "
                                   f"{[(row['axes'], row['buttons']) for row in rows[position:position + 6]]}")
        position = found
    assert session.replayed["bad_reports"] == 0
    remark(f"kernel's cases, {kind}: {len(sent)} states, each as the event node says")
