"""Every cell of the rig's tables is in some run (tools/rig/cells.py)."""
import collections
import sys
import warnings

import pytest

from support.program import ROOT

sys.path.append(str(ROOT / "tools" / "rig"))
with warnings.catch_warnings():
    warnings.simplefilter("ignore", pytest.PytestUnknownMarkWarning)  # marks are defined in the rig's own conftest.py
    from cells import chosen
    from more_kinds import MORE
    from test_bluetooth import HALF
    from test_calibrate import DRIVERS as CALIBRATED
    from test_matrix import DRIVERS
    from test_rumble import PACKETS

SLICES = 2520  # the numbers that tools/slice.sh can make of a commit's hash
TABLES = {"matrix": DRIVERS, "more_kinds": {name: kind.drivers for name, kind in MORE.items()},
          "rumble": {kind: DRIVERS[kind] for kind in PACKETS}, "bluetooth": dict.fromkeys(HALF, ("hidraw", "evdev", "sdl")),
          "calibrate": CALIBRATED}


@pytest.mark.parametrize("table", TABLES)
def test_every_slice_has_each_kind_and_each_driver(table):
    drivers_of = TABLES[table]
    every = {driver for drivers in drivers_of.values() for driver in drivers}
    for number in range(SLICES):
        row = chosen(drivers_of, number)
        assert row.keys() == drivers_of.keys() and set(row.values()) == every, (number, row)


@pytest.mark.parametrize("table", TABLES)
def test_every_cell_is_in_one_of_eight_slices_at_least(table):
    drivers_of = TABLES[table]
    times = collections.Counter(cell for number in range(SLICES) for cell in chosen(drivers_of, number).items())
    for kind, drivers in drivers_of.items():
        for driver in drivers:
            assert times[kind, driver] > SLICES / 8, (kind, driver, times[kind, driver] / SLICES)
