"""Tests config/udev with udev itself: `udevadm test` of each node of thirteen devices, four of them keyboards."""
import os
import pathlib
import re
import shutil
import subprocess

import pytest

from composite import Composite
from pads import ROOT
from session import remark
from support.usb_interfaces import KEYBOARD, KEYBOARDS, MOUSE, PADS, PLAIN, STEAM

TARGET = pathlib.Path("/etc/udev/rules.d/60-gaitpad.rules")


@pytest.fixture(autouse=True)
def rules():
    shutil.copy(os.path.join(ROOT, "config/udev/60-gaitpad.rules"), TARGET)
    subprocess.run(["udevadm", "control", "--reload"], check=True)
    yield
    TARGET.unlink()
    subprocess.run(["udevadm", "control", "--reload"], check=True)


def is_opened(path):
    """True if udev gives access. Its output shows mode, group and tag, which must agree."""
    told = subprocess.run(["udevadm", "test", "--action=add", str(path)], capture_output=True, text=True, check=True)
    text = told.stdout + told.stderr
    ours = {word: bool(re.search(rf"60-gaitpad\.rules:\d+ {word}", text)) for word in ("MODE 0660", "GROUP")}
    has_tag = bool(re.search(r"^TAGS=.*:uaccess:", text, re.M))
    assert len({*ours.values(), has_tag}) == 1, text
    return has_tag


def opened_of(device):
    """What the rules open: (the USB device, the interfaces whose hidraw nodes are opened, the number of event nodes).
    """
    hidraws = [device.interface_of(node) for node in device.hidraws
               if is_opened(f"/sys/class/hidraw/{os.path.basename(node)}")]
    events = [node for node in device.events if is_opened(f"/sys/class/input/{os.path.basename(node)}")]
    return is_opened(device.usb_path), hidraws, len(events)


@pytest.mark.timeout(240)
def test_keyboards_are_opened_to_nobody():
    for ids, interfaces in KEYBOARDS:
        with Composite(ids, interfaces) as device:
            usb, hidraws, _ = opened_of(device)  # each event node is judged by its own kind
            assert not usb and not hidraws, (ids, usb, hidraws)
    remark(f"{len(KEYBOARDS)} keyboards, three of them beside or by makers of pads: udev opens none")


@pytest.mark.timeout(360)
def test_pads_are_opened_but_not_their_keyboards():
    for ids, interfaces in [*PADS, STEAM]:
        with Composite(ids, interfaces) as device:
            usb, hidraws, events = opened_of(device)
            plain = [interface for interface in interfaces if interface == PLAIN]
            assert usb and hidraws == plain and events == len(plain), (ids, usb, hidraws, events)
            assert not {KEYBOARD, MOUSE} & set(hidraws)
    remark(f"{len(PADS) + 1} pads, one with a keyboard of its own: udev opens each, not that keyboard")
