"""gaitpad pads: a list that a script can read, with or without devices."""
import json

import pytest

KEYS = {"driver": str, "path": str, "bus": str, "vendor": int, "product": int, "name": str, "unique_id": str,
        "port": str, "kernel_driver": str, "usages": list, "poll_rate_hz": (float, int, type(None)),
        "battery": (dict, type(None)), "usable": bool,
        "problem": str, "chosen": bool}


@pytest.fixture(scope="module")
def pads(run):
    return json.loads(run("pads", "--json").stdout)


def test_every_row_has_the_keys_of_the_contract(pads):
    for row in pads:
        if set(row) == {"driver", "problem"}:  # the driver was built without its library
            assert "built without" in row["problem"]
            continue
        assert list(row) == list(KEYS)
        for key, kind in KEYS.items():
            assert isinstance(row[key], kind), key
        assert row["usable"] == (row["problem"] == "")


def test_at_most_one_is_chosen_and_it_is_usable(pads):
    rows = [row for row in pads if "chosen" in row]
    chosen = [row for row in rows if row["chosen"]]
    assert len(chosen) == (1 if any(row["usable"] for row in rows) else 0)
    assert all(row["usable"] for row in chosen)
    assert rows[:len(chosen)] == chosen


def test_text_says_something_in_any_case(run):
    assert run("pads").stdout.strip() != ""


@pytest.mark.parametrize("driver", ["hidraw", "evdev", "usb", "sdl"])
def test_one_driver_alone(run, driver):
    rows = json.loads(run("pads", "--driver", driver, "--json").stdout)
    assert {row["driver"] for row in rows} <= {driver}


def test_an_unknown_driver_is_wrong_usage(run):
    run("pads", "--driver", "magic", status=2)
