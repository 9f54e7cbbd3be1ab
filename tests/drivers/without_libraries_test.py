"""Without any driver the program still builds, replays and names what is missing. SDL2 is never linked: its driver
loads it.

The repository is configured without the drivers' libraries, in `without_libraries` beside the program. One source alone knows
which drivers there are: it is compiled there and linked before the program's own objects, so that the linker takes no driver.
"""
import json
import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEVICES = "libgaitpad_devices.a"  # the archive of the target gaitpad_devices, which holds the drivers
REGISTRY = "CMakeFiles/gaitpad_devices.dir/drivers/driver_registry.cpp.o"
LIBRARIES = {"hidraw": "libhidapi-hidraw", "evdev": "libevdev", "sdl": "libSDL2", "usb": "libusb-1.0"}


def run(*command, folder=None):
    return subprocess.run([str(c) for c in command], cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def without(program):
    """The program without drivers."""
    folder = program.parent / "without_libraries"
    off = [f"-DGAITPAD_{driver.upper()}=OFF" for driver in LIBRARIES]
    for command in (["cmake", "-G", "Ninja", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", *off],
                    ["ninja", "-C", folder, REGISTRY]):
        done = run(*command)
        assert done.returncode == 0, done.stdout + done.stderr
    link = run("ninja", "-t", "commands", program.name, folder=program.parent).stdout.splitlines()[-1]
    assert f" {DEVICES} " in link
    link = link.replace(f" {DEVICES} ", f" {folder / REGISTRY} {DEVICES} ", 1).replace(" -o gaitpad ", f" -o {folder / 'gaitpad'} ")
    for library in set(LIBRARIES.values()) - {"libSDL2"}:
        assert f"/{library}.so" in link
        link = re.sub(rf" \S*/{library}\.so\S*", "", link)
    linked = run("bash", "-c", link, folder=program.parent)
    assert linked.returncode == 0, linked.stderr
    return folder / "gaitpad"


def test_no_driver_is_compiled(without):
    sources = [row["file"] for row in json.loads(run("ninja", "-t", "compdb", folder=without.parent).stdout)]
    assert any(source.endswith("drivers/trace_driver.cpp") for source in sources)
    for driver in LIBRARIES:
        assert not any(source.endswith(f"drivers/{driver}_driver.cpp") for source in sources)


def test_nothing_else_knows_which_drivers_there_are():
    sources = [path for pattern in ("*.cpp", "*.h") for room in ("src", "tools", "drivers")
               for path in (ROOT / room).rglob(pattern) if re.search(r"GAITPAD_HAS_(HIDRAW|USB|EVDEV|SDL)\b", path.read_text())]
    assert [path.parent.name for path in sources] == ["drivers"]


def test_needs_none_of_them(without):
    needed = run("ldd", without).stdout
    assert "libc.so" in needed
    for library in ("hidapi", "usb-1.0", "evdev"):
        assert library not in needed


def test_replays_to_the_same_hash(without, program):
    command = ["replay", ROOT / "config/traces/round.hid", "--json"]
    hashes = [json.loads(run(p, *command).stdout)["pose_hash"] for p in (without, program)]
    assert hashes[0] == hashes[1]


def test_pads_names_the_missing_drivers_and_their_libraries(without):
    text = run(without, "pads").stdout
    for driver, library in LIBRARIES.items():
        assert re.search(rf"{driver}.*built without {library}", text)
    listed = json.loads(run(without, "pads", "--json").stdout)
    missing = {row["driver"]: row["problem"] for row in listed}
    for driver, library in LIBRARIES.items():
        assert library in missing[driver]


def test_asking_for_one_is_one_sentence(without):
    done = run(without, "play", "--no-window", "--driver", "usb", "--seconds", "1")
    assert done.returncode == 1
    assert "libusb-1.0" in done.stderr
