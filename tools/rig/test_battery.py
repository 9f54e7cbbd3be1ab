"""A pad's battery from the kernel's driver: 8 tenths and charging, of a DualSense (hid-playstation.c: 10 n + 5 %)."""
import json
import subprocess

import pytest

from pads import Pad, wait_for
from session import IDS, PROGRAM

BATTERY = {"percent": 85, "level": None, "status": "charging"}


@pytest.mark.timeout(120)
def test_pads_and_monitor_tell_the_battery():
    with Pad("dualsense") as pad:
        pad.set(lx=128)

        def told():
            rows = json.loads(subprocess.run([PROGRAM, "pads", "--json"], capture_output=True, text=True, check=True).stdout)
            return {row["path"]: row["battery"] for row in rows if row.get("product") == 0x0ce6}

        wait_for(lambda: told().get(pad.hidraw) == BATTERY, 10, f"the battery; told {told()}")
        assert told()[pad.joystick] == BATTERY
        shown = subprocess.run([PROGRAM, "monitor", IDS["dualsense"], "--json", "--seconds", "4"], capture_output=True,
                               text=True, check=True).stdout.splitlines()
        assert json.loads(shown[-1])["battery"] == BATTERY, shown[-1]
