"""A worn virtual pad is calibrated at a terminal, unplugged in the middle; its file is then used by record and play."""
import os
import random
import re
import signal
import tempfile
import time
import tomllib

import pytest

from cells import cells
from pads import Pad, wait_for
from session import IDS, PROGRAM, Session, Terminal, record, remark
from support.hands import Hand

RATE_HZ = 100
COUNT = 1 / 127.5  # a count of an 8-bit axis, raw
FIRST_BYTE = {"generic": 0, "dualsense": 1}  # first byte of lx ly rx ry lt rt

# In counts: where the sticks rest, how far they go; the noise is one count to either side.
CENTRES = {"left": (138, 120), "right": (121, 134)}
REACHES = {"left": 108, "right": 100}
# From the hand's (right, forward) to counts (y grows towards the player).
AS_IT_SHOULD_BE = lambda x, y: (x, -y)
TURNED = lambda x, y: (-y, -x)  # a quarter turn to the left: right becomes forward, forward becomes left


class PadHand(Hand):
    """A hand at a virtual pad."""

    rate_hz = RATE_HZ
    release_s, turn_s, after_turns_s, push_s, trigger_s = (0.15, 0.8), 1.2, 0.3, (0.5, 0.4), (0.5, 0.4)

    def __init__(self, pad, mounted):
        super().__init__()
        self.pad, self.mounted = pad, mounted
        self.random = random.Random(1)
        pad.set(a=0)  # sends a report of the pad at rest
        self.base = bytearray(wait_for(pad.sent, 5, "the pad's report")[-1].data)

    def counts(self, stick):
        x, y = self.mounted[stick](*self.place)
        return [max(0, min(255, round(centre + offset * REACHES[stick] + self.random.choice((-1, 0, 0, 1)))))
                for centre, offset in zip(CENTRES[stick], (x, y))]

    def data(self):
        at = FIRST_BYTE[self.pad.kind]
        self.base[at:at + 6] = bytes(self.counts("left") + self.counts("right") + [255 * self.is_pulled] * 2)
        return self.base

    def do(self):
        """The pad plays the movement."""
        path = tempfile.mktemp(suffix=".hid")
        with open(path, "w") as file:
            file.writelines(self.lines)
        self.lines = []
        self.pad.play(path)
        self.pad.wait_play(60)


def calibrate(kind, driver):
    return Terminal(PROGRAM, "calibrate", IDS[kind], "--driver", driver)


def guide_through(pad, driver, mounted):
    """Does all steps, with an unplugging after three releases."""
    with calibrate(pad.kind, driver) as terminal:
        terminal.wait_for("Step 1 of 7: rest", 30)
        if driver == "evdev":
            terminal.wait_for("through evdev the kernel may filter", 5)
        hand = PadHand(pad, mounted)
        hand.hold(0.5)
        hand.releases(0, 3)
        hand.do()
        terminal.wait_for("3 of 10 releases", 10)  # the left stick rests so far off that more releases are asked for
        pad.unplug()
        terminal.wait_for("UNPLUGGED", 10)
        pad.plug()
        at = len(terminal.text)
        hand.hold(0.5)
        hand.releases(3, 8)
        hand.hold(2.2)
        hand.do()
        at = terminal.wait_for("Step 2 of 7: turning", 10, at).end()
        assert not re.search(r"\b0 of \d+ releases", terminal.text[terminal.text.index("UNPLUGGED"):]), "what was seen is lost"
        hand.turns(3)
        hand.pushes()
        hand.triggers()
        hand.do()
        for name in ("push forward", "push right", "push back", "push left", "triggers"):
            at = terminal.wait_for(f"Step [3-7] of 7: {name}", 10, at).end()
        terminal.wait_for("Enter writes", 30, at)
        assert files() == {}, "written before the question was answered"
        time.sleep(0.3)
        terminal.press("\n")
        assert terminal.wait_end() == 0, terminal.text[-2000:]
        assert terminal.is_as_before()
        print(terminal.text[terminal.text.rindex("\033[J"):])


def folder():
    return os.path.join(os.environ["XDG_CONFIG_HOME"], "gaitpad/calibration")


def files():
    names = os.listdir(folder()) if os.path.isdir(folder()) else []
    return {name: open(os.path.join(folder(), name), "rb").read() for name in names}


def check_axis(axis, centre, reach, what):
    """Checks an axis; `centre` and `reach` are raw. The noise has a sigma of 0.71 counts and moves the rim by one
    count."""
    assert abs(axis["centre"] - centre) < COUNT, (what, axis, centre)
    assert abs(axis["min"] - (centre - reach)) < 1.5 * COUNT, (what, axis, centre - reach)
    assert abs(axis["max"] - (centre + reach)) < 1.5 * COUNT, (what, axis, centre + reach)


def check_file(mounted):
    (name, text), = files().items()
    assert name.endswith(".toml"), name
    told = tomllib.loads(text.decode())
    for stick, centre in CENTRES.items():
        raw = {"x": centre[0] * COUNT - 1, "y": 1 - centre[1] * COUNT}
        table = told[stick]
        is_turned = mounted[stick] is TURNED
        assert (table.get("right", "x"), table.get("forward", "y")) == (("y", "-x") if is_turned else ("x", "y")), table
        centre_x, centre_y = (raw["y"], -raw["x"]) if is_turned else (raw["x"], raw["y"])
        check_axis(table["x"], centre_x, REACHES[stick] * COUNT, (stick, "x"))
        check_axis(table["y"], centre_y, REACHES[stick] * COUNT, (stick, "y"))
        remark(f"calibrate: {stick} {table['x']} {table['y']} inner {table['inner']}")
    return name


def check_use(pad, driver):
    """record embeds it; play rests at rest and walks straight, at full stride, with the stick held forward."""
    lines = record(IDS[pad.kind], "--driver", driver)
    assert any(line.startswith("K:") for line in lines), "the recording has no calibration"
    (x, y), reach = CENTRES["left"], REACHES["left"]
    with Session(IDS[pad.kind], "--driver", driver, name=f"calibrated-{pad.kind}-{driver}") as session:
        pad.set(lx=x + 1, ly=y - 1)
        time.sleep(0.5)
        # The wait is long: if the last report before centring asked for a small step back, that step ends first.
        for offset in (0, 1, -1, 0) * 3:
            pad.set(lx=x + offset, ly=y - reach)
            time.sleep(0.5)
        pad.set(lx=x - 1, ly=y + 1)
        time.sleep(0.5)
    frames = session.frames()
    places = {(float(row["stick_x"]), float(row["stick_y"])) for row in frames}
    assert (0.0, 0.0) in places
    assert max(y for _, y in places) >= 0.99, max(places)
    assert {x for x, _ in places} == {0.0}, "it does not walk straight"
    assert float(frames[-1]["stick_y"]) == 0.0
    assert session.replayed["steps_left"] + session.replayed["steps_right"] >= 2


def check_giving_up(kind, driver):
    before = files()
    for give_up in (lambda terminal: terminal.press("\x03"), lambda terminal: terminal.send_signal(signal.SIGTERM),
                    lambda terminal: terminal.press("q")):
        with calibrate(kind, driver) as terminal:
            terminal.wait_for("Step 1 of 7: rest", 30)
            terminal.press("s")
            terminal.wait_for("Step 2 of 7", 10)
            give_up(terminal)
            assert terminal.wait_end() == 1
            assert terminal.is_as_before()
            assert "nothing written" in terminal.text
        assert files() == before


DRIVERS = {"generic": ("hidraw", "evdev"), "dualsense": ("hidraw", "evdev")}


@pytest.mark.timeout(180)
@pytest.mark.parametrize("case", cells(DRIVERS))
def test_a_worn_pad_is_calibrated_at_a_terminal(case):
    kind, driver = case.split("-")
    os.environ["XDG_CONFIG_HOME"] = tempfile.mkdtemp()
    mounted = {"left": AS_IT_SHOULD_BE, "right": TURNED if kind == "generic" else AS_IT_SHOULD_BE}
    with Pad(kind) as pad:
        guide_through(pad, driver, mounted)
        remark(f"calibrate: {case}: {check_file(mounted)}")
        check_use(pad, driver)
        check_giving_up(kind, driver)
