"""A dozen more kinds of pads, by the tables of more_kinds.py: every control decoded as its maker meant it, and no other.

One driver of each in every run (cells.py).
"""
import time

import pytest

from cells import cells
from more_kinds import MORE, plug
from session import Session, remark
from test_matrix import DPAD, directions

TOLERANCE = 0.01  # counts of a stick, and the rounding of the kernel's driver
# What SDL 2.26 calls otherwise: it has no name for Share, and takes the kernel's north of an unknown pad for x.
NAMES_OF_SDL = {"xboxseries": {"misc1": None}, "edge": {"x": "y", "y": "x"}}


def at_rest(kind):
    rest = {field: round(middle + 0.5) if "trigger" not in axis else 0 for field, (axis, middle, _, _) in kind.axes.items()}
    rest |= dict.fromkeys(kind.buttons, 0)
    return rest | ({"hat": 8} if kind.has_hat else {})


def states(kind, names):
    rest = at_rest(kind)
    for field, (axis, middle, span, _) in kind.axes.items():
        yield {**rest, field: round(middle + span)}
        if "trigger" not in axis:
            yield {**rest, field: round(middle - span)}
    for field in names:
        yield {**rest, field: 1}
    for eighth in range(8 if kind.has_hat else 0):
        yield {**rest, "hat": eighth}
    for field in ("twist", "throttle"):
        if field in kind.bits:
            yield {**rest, field: 255}
            yield {**rest, field: 0}
    yield rest


def expected(kind, names, state):
    axes = {axis: max(-1.0, min(1.0, sign * (state[field] - middle) / span))
            for field, (axis, middle, span, sign) in kind.axes.items()}
    buttons = {name for field, name in names.items() if state[field]}
    if kind.has_hat and state["hat"] < 8:
        buttons |= directions(state["hat"])
    return axes | dict.fromkeys(kind.still, 0.0), buttons


def is_as_sent(row, axes, buttons, names):
    return all(abs(row["axes"][axis] - value) < TOLERANCE for axis, value in axes.items()) and \
        {button for button in row["buttons"] if button in names} == buttons


@pytest.mark.timeout(120)
@pytest.mark.parametrize("cell", cells({name: kind.drivers for name, kind in MORE.items()}))
def test_every_control_is_decoded_as_meant(cell):
    name, driver = cell.split("-")
    kind = MORE[name]
    names = kind.buttons | (NAMES_OF_SDL.get(name, {}) if driver == "sdl" else {})
    names = {field: known for field, known in names.items() if known}
    seen = set(names.values()) | set(DPAD)
    with plug(kind) as pad:
        with Session(kind.ids, "--driver", driver, name=f"more-{cell}") as session:
            pad.set(**at_rest(kind))
            time.sleep(0.3)
            sent = list(states(kind, names))
            for state in sent:
                session.show(driver, pad, 0.04, **state)
            pad.set(**{**at_rest(kind), "ly": forward(kind)})
            time.sleep(1.5)
            pad.set(**at_rest(kind))
            time.sleep(0.2)
        rows, position = session.decoded(), 0
        for number, state in enumerate(sent):
            axes, buttons = expected(kind, names, state)
            found = next((i for i in range(position, len(rows)) if is_as_sent(rows[i], axes, buttons, seen)), None)
            assert found is not None, (f"state {number} {state} was not decoded: {axes} {buttons}; from there on came "
                                       f"{[(row['axes'], row['buttons']) for row in rows[position:position + 8]]}")
            position = found
    steps = session.replayed["steps_left"] + session.replayed["steps_right"]
    assert steps >= 2, f"{steps} steps"
    assert session.replayed["bad_reports"] == 0
    remark(f"{name}-{driver}: {session.replayed['reports']} reports, pose hash {session.replayed['pose_hash']} twice")


def forward(kind):
    _, middle, span, sign = kind.axes["ly"]
    return round(middle + sign * span)
