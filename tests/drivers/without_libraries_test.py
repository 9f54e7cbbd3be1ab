#!/usr/bin/python3
"""Without any driver the program still builds and replays, and says what is missing. SDL2 stays, the window's.

Usage: without_libraries_test.py PROGRAM (the build stands in `without_libraries` beside it)
"""
import json
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "build/gaitpad").resolve()
FOLDER = PROGRAM.parent / "without_libraries"
LIBRARIES = {"hidraw": "libhidapi-hidraw", "evdev": "libevdev", "sdl": "libSDL2", "usb": "libusb-1.0"}


def run(*command):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)


class WithoutLibraries(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        off = [f"-DGAITPAD_{driver.upper()}=OFF" for driver in LIBRARIES]
        built = run("bash", ROOT / "tools/build.sh", FOLDER, "gaitpad", "-DCMAKE_BUILD_TYPE=Release", *off)
        assert built.returncode == 0, built.stderr
        cls.program = FOLDER / "gaitpad"

    def test_needs_none_of_them(self):
        needed = run("ldd", self.program).stdout
        for library in ("hidapi", "usb-1.0", "evdev"):
            self.assertNotIn(library, needed)

    def test_replays_to_the_same_hash(self):
        command = ["replay", ROOT / "config/traces/round.hid", "--json"]
        hashes = [json.loads(run(p, *command).stdout)["pose_hash"] for p in (self.program, PROGRAM)]
        self.assertEqual(hashes[0], hashes[1])

    def test_pads_names_the_missing_drivers_and_their_libraries(self):
        text = run(self.program, "pads").stdout
        for driver, library in LIBRARIES.items():
            self.assertRegex(text, rf"{driver}.*built without {library}")
        listed = json.loads(run(self.program, "pads", "--json").stdout)
        missing = {row["driver"]: row["problem"] for row in listed}
        for driver, library in LIBRARIES.items():
            self.assertIn(library, missing[driver])

    def test_asking_for_one_is_one_sentence(self):
        done = run(self.program, "play", "--no-window", "--driver", "usb", "--seconds", "1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("libusb-1.0", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
