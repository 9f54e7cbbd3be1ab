"""Which cells of a table of pads and drivers a run tests: every kind on one of its drivers, and every driver with at
least one kind. GAITPAD_SLICE chooses (tests/support/slices.py); the others run with GAITPAD_ALL=1, --long, or when
--only names them.

    @pytest.mark.parametrize("case", cells({"generic": ("hidraw", "usb"), "xbox360": ("usb", "evdev")}))
"""
import random

import pytest

from support import slices


def chosen(drivers_of, number):
    """The driver of each kind in that slice: drawn at random until every driver occurs."""
    every, chance = {driver for drivers in drivers_of.values() for driver in drivers}, random.Random(number)
    while True:
        row = {kind: chance.choice(drivers) for kind, drivers in drivers_of.items()}
        if set(row.values()) == every:
            return row


def cells(drivers_of):
    row = chosen(drivers_of, slices.NUMBER)
    return [case(f"{kind}-{driver}", row[kind] == driver) for kind, drivers in drivers_of.items() for driver in drivers]


def case(name, is_chosen):
    return name if is_chosen else pytest.param(name, marks=pytest.mark.other_slice)


def some(names, parts):
    """The entries of the list that run in this slice: one in `parts`."""
    return [case(name, slices.is_chosen(name, parts)) for name in names]
