"""`gaitpad selftest` from its first prompt to its folder: a virtual pad and a scripted person at a terminal."""
import functools
import glob
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time

import pytest

from pads import PATIENCE, ROOT, Pad, wait_for
from session import IDS, PROGRAM, Terminal, remark, run
from support import tested_pad
from test_calibrate import AS_IT_SHOULD_BE, CENTRES, REACHES, PadHand

STRAIGHT = {"left": AS_IT_SHOULD_BE, "right": AS_IT_SHOULD_BE}
# Words that identify a prompt, and the pad's field that it asks for.
BUTTONS = {"bottom one": "a", "right one of": "b", "left one of": "x", "top one": "y", "left of the middle": "back",
           "in the middle": "guide", "right of the middle": "start", "left stick in": "leftstick",
           "right stick in": "rightstick", "left shoulder": "leftshoulder", "right shoulder": "rightshoulder",
           "touchpad in": "touchpad"}
HATS = {"D-pad) up": 0, "to the right": 2, "D-pad) down": 4, "to the left": 6}
PUSHES = {"to the right": (1, 0), "to the left": (-1, 0), "forward": (0, 1), "back": (0, -1)}


class Person:
    """A scripted person that follows the terminal's prompts."""

    def __init__(self, pad, terminal):
        self.pad, self.terminal, self.at = pad, terminal, 0
        self.hand = PadHand(pad, STRAIGHT)

    def next_request(self, seconds=40):
        """The next prompt as (part, request)."""
        found = self.terminal.wait_for(r"\d of 6, ([a-z ]+): ([^\[]+?)\s*\[", seconds, self.at)
        self.at = found.end()
        return found[1], " ".join(found[2].replace("\x1b", "").split())

    def wait_change(self, request, again=lambda: None, seconds=40):
        """Waits for the next prompt that asks for something else. If the same one stays for five seconds, does the
        movement `again`."""
        end = time.monotonic() + PATIENCE * seconds
        due = time.monotonic() + PATIENCE * 5
        while (new := self.next_request(seconds))[1] == request:
            now = time.monotonic()
            assert now < end, f"it still asks: {request}"
            if now > due:
                due = now + PATIENCE * 5
                again()
        return new

    def place(self, stick, x, y):
        (centre_x, centre_y), reach = CENTRES[stick], REACHES[stick]
        names = ("lx", "ly") if stick == "left" else ("rx", "ry")
        self.pad.set(**dict(zip(names, (round(centre_x + x * reach), round(centre_y - y * reach)))))

    def press(self, **fields):
        rest = {name: 8 if name == "hat" else 0 for name in fields}
        self.pad.set(**fields)
        time.sleep(0.15)
        self.pad.set(**rest)

    def turn(self):
        self.hand.hold(0.3)
        self.hand.turns(2)
        self.hand.do()

    def do_control(self, request):
        if "Push the" in request:
            stick = "left" if "the left stick" in request else "right"
            words = request.split("stick ", 1)[1]
            x, y = next(place for word, place in PUSHES.items() if word in words)
            self.place(stick, x, y)
            time.sleep(0.2)
            self.place(stick, 0, 0)
        elif "trigger" in request and "Pull" in request:
            self.press(**{"lt" if "left trigger" in request else "rt": 255})
        elif "calls misc1" in request:
            self.terminal.press("\n")  # the person does not find the mute button
        elif "D-pad" in request:
            self.press(hat=next(value for word, value in HATS.items() if word in request))
        else:
            self.press(**{next(name for word, name in BUTTONS.items() if word in request): 1})

    def calibrate(self):
        self.hand.hold(0.5)
        self.hand.releases(0, 11)  # the left stick rests so far off that ten releases are asked for
        self.hand.hold(2.6)
        self.hand.turns(3)
        self.hand.pushes()
        self.hand.triggers()
        self.hand.do()


def lead_through(pad, terminal):
    """Answers every prompt; returns the requests of each part."""
    person, asked = Person(pad, terminal), {}
    part, request = person.next_request()
    is_calibrated = False
    while True:
        asked.setdefault(part, []).append(request)
        print(f"{part}: {request}", flush=True)
        again = lambda: None
        if "Unplug the pad" in request:
            pad.unplug()
        elif "Plug it in again" in request:
            pad.plug()
        elif part == "drivers" and "turn the left stick" in request:
            again = person.turn
        elif part in ("controls", "unplugging"):
            again = functools.partial(person.do_control, request)
        elif part == "rumble":
            motor = 4 if "strong" in request else 3
            since = time.monotonic_ns() - 10**9
            wait_for(lambda: any(packet.data[motor] for packet in pad.out_packets(since)), 6, request)
            terminal.press("y")
        elif part == "calibration" and not is_calibrated:
            is_calibrated = True
            person.calibrate()
        elif part == "straight walk":
            person.place("left", 0, 1)
            return asked
        again()
        part, request = person.wait_change(request, again)


@pytest.mark.timeout(200)
def test_a_scripted_person_proves_a_dualsense():
    folder = pathlib.Path("/results/selftest")
    shutil.rmtree(folder, ignore_errors=True)
    with Pad("dualsense") as pad:
        uevent, = glob.glob("/sys/bus/hid/devices/0003:054C:0CE6.*/uevent")
        unique = re.search("HID_UNIQ=(.*)", pathlib.Path(uevent).read_text())[1]
        command = [PROGRAM, "selftest", IDS["dualsense"], "--out", folder]
        with Terminal(*command, columns=200) as terminal:
            asked = lead_through(pad, terminal)
            status = terminal.wait_end(90)
            print(terminal.text[-1500:])
        assert status == 0
    report = json.loads((folder / "report.json").read_text())
    check_report(report, asked)
    check_folder(folder, unique)
    remark(f"selftest: {len(report['controls'])} controls, {len(report['drivers'])} drivers, "
           f"{sum(driver['opened'] for driver in report['drivers'])} opened, walk {report['walk']}")


def check_report(report, asked):
    assert report["failures"] == [], report["failures"]
    assert report["pad"]["vendor"] == 0x054c and report["pad"]["product"] == 0x0ce6
    assert {c["control"]: c["result"] for c in report["controls"] if c["result"] != "seen"} == {"misc1": "absent"}
    names = {c["control"] for c in report["controls"]}
    assert {"left_x+", "left_x-", "left_y+", "left_y-", "right_x+", "right_y-", "left_trigger", "a", "guide", "dpup",
            "touchpad", "misc1"} <= names and "paddle1" not in names, names  # only the Edge has paddles
    opened = {driver["driver"] for driver in report["drivers"] if driver["opened"]}
    assert opened == {"hidraw", "evdev", "sdl", "usb"}, report["drivers"]
    hidraw = next(driver for driver in report["drivers"] if driver["driver"] == "hidraw")
    assert 60 < hidraw["rate"]["rate_hz"] < 300, hidraw["rate"]  # the pad's own 250 Hz, and the hand's 100
    assert report["unplugging"]["is_back"] and report["rumble"] == {"strong": "felt", "weak": "felt"}
    assert {side: stick["verdict"] for side, stick in report["calibration"].items()}.keys() == {"left", "right"}
    assert report["walk"]["steps"] >= 4 and abs(report["walk"]["aside_m"]) < 0.02 * report["walk"]["forward_m"]
    assert report["system"]["kernel"].startswith("6.") and "udev_rule" in report["system"]
    assert "serial" not in json.dumps(report)
    assert len(asked["controls"]) == len(report["controls"])


def check_folder(folder, unique):
    """The recordings replay and decode; nothing tells which pad it was; the project can take it."""
    names = {path.name for path in folder.iterdir()}
    assert {"report.json", "descriptor.txt", "controls.hid", "calibration.toml", "walk.hid", "driver-hidraw.hid"} <= names
    bytes_of_id = bytes.fromhex(unique.replace(":", ""))
    for path in folder.iterdir():
        text = path.read_text()
        assert unique not in text.lower(), path
        for data in (bytes_of_id, bytes_of_id[::-1]):
            assert data.hex(" ") not in text, path
    assert list(tested_pad.problems(lambda *words: run("gaitpad", *words), folder)) == []
    walked = json.loads(run("gaitpad", "replay", folder / "walk.hid", "--json").stdout)
    assert walked["pose_hash"] == json.loads((folder / "report.json").read_text())["walk"]["pose_hash"]
    checkout = pathlib.Path("/tmp/checkout")
    (checkout / "docs").mkdir(parents=True)
    shutil.copy(f"{ROOT}/docs/tested-pads.md", checkout / "docs")
    done = subprocess.run([sys.executable, f"{ROOT}/tools/add_tested_pad.py", folder, "--root", checkout, "--program", PROGRAM],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "| 054c:0ce6, USB |" in (checkout / "docs/tested-pads.md").read_text()


@pytest.mark.timeout(90)
def test_who_gives_up_keeps_nothing():
    folder = pathlib.Path("/tmp/given-up")
    with Pad("generic"):
        with Terminal(PROGRAM, "selftest", IDS["generic"], "--out", folder) as terminal:
            terminal.wait_for("turn the left stick", 40)
            terminal.press("q")
            assert terminal.wait_end() == 1
            assert "nothing was kept" in terminal.text
            assert terminal.is_as_before()
        assert not folder.exists()
        folder.mkdir()
        done = subprocess.run([PROGRAM, "selftest", IDS["generic"], "--out", folder], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, check=False)
        assert done.returncode == 1 and "exists already" in done.stderr, done.stderr
