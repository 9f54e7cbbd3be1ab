#!/usr/bin/python3
"""gaitpad pads: a list that a script can read, with or without devices."""
import json
import sys
import unittest

from program import run

KEYS = {"driver": str, "path": str, "bus": str, "vendor": int, "product": int, "name": str, "unique_id": str,
        "port": str, "kernel_driver": str, "usages": list, "poll_rate_hz": (float, int, type(None)), "usable": bool,
        "problem": str, "chosen": bool}


class Pads(unittest.TestCase):
    def test_every_row_has_the_keys_of_the_contract(self):
        done = run("pads", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        for row in json.loads(done.stdout):
            if set(row) == {"driver", "problem"}:  # built without its library
                self.assertIn("built without", row["problem"])
                continue
            self.assertEqual(list(row), list(KEYS))
            for key, kind in KEYS.items():
                self.assertIsInstance(row[key], kind, key)
            self.assertEqual(row["usable"], row["problem"] == "")

    def test_at_most_one_is_chosen_and_it_is_usable(self):
        rows = [row for row in json.loads(run("pads", "--json").stdout) if "chosen" in row]
        chosen = [row for row in rows if row["chosen"]]
        self.assertEqual(len(chosen), 1 if any(row["usable"] for row in rows) else 0)
        self.assertTrue(all(row["usable"] for row in chosen))
        self.assertEqual(rows[:len(chosen)], chosen)

    def test_text_says_something_in_any_case(self):
        done = run("pads")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotEqual(done.stdout.strip(), "")

    def test_one_driver_alone(self):
        for driver in ("hidraw", "evdev", "usb", "sdl"):
            done = run("pads", "--driver", driver, "--json")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertLessEqual({row["driver"] for row in json.loads(done.stdout)}, {driver})
        self.assertEqual(run("pads", "--driver", "magic").returncode, 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
