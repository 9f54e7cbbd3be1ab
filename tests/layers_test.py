"""Enforces who may include whom: reads every #include line of src/, drivers/ and tools/.

A room includes its own headers, those of the rooms named here, the public headers of the libraries below its
own, and the vendor headers named here. A public header includes public headers, GLM and the standard library.
"""
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[1]

# The libraries, lowest first: a library includes its own headers and those of the libraries before it.
LIBRARIES = {
    "core": ["src/base", "src/motion", "src/strides", "src/control", "src/animation", "src/walk"],
    "c": ["src/c_api"],
    "system": ["src/system"],  # built as a part of gaitpad::files
    "pictures": ["src/draw"],
    "files": ["src/files"],
    "devices": ["src/hid", "src/stick", "src/pads", "drivers", "drivers/pads"],
    "session": ["src/session"],
    "program": ["src/stick_picture", "src/scene", "src/view", "src/paper", "src/check", "src/selftest", "src/bench", "src/terminal",
                "src/doctor", "src/pad_report"],
}
# room: (rooms of its own library that it may include, vendor headers)
ROOMS = {
    "src/base": ([], ["glm/"]),
    "src/motion": (["base"], ["glm/"]),
    "src/strides": (["base", "motion"], ["glm/"]),
    "src/control": (["base"], []),
    "src/animation": (["base", "motion", "control"], []),
    "src/walk": (["base", "motion", "control", "animation"], []),
    "src/c_api": ([], []),
    "src/system": ([], []),
    "src/files": ([], ["fmt/", "toml++/", "nlohmann/"]),
    "src/hid": ([], ["fmt/"]),
    "src/stick": (["hid"], ["fmt/"]),
    "drivers": (["hid", "drivers/pads"], ["fmt/"]),
    "drivers/pads": (["hid"], ["fmt/"]),
    "src/pads": (["hid", "stick", "drivers", "drivers/pads"], ["fmt/"]),
    "src/session": ([], ["fmt/", "nlohmann/", "tbb/"]),
    "src/draw": ([], ["fmt/", "cairo/"]),
    "src/stick_picture": ([], ["fmt/", "cairo/"]),
    # The scene knows no window: no SDL, no Dear ImGui.
    "src/scene": ([], ["fmt/", "epoxy/", "glm/"]),
    "src/view": (["scene", "stick_picture", "selftest"], ["fmt/", "SDL2/", "SDL", "imgui", "backends/imgui_impl", "epoxy/", "cairo/", "nlohmann/"]),
    "src/paper": ([], ["fmt/", "cairo/", "nlohmann/"]),
    "src/check": ([], ["fmt/", "nlohmann/"]),
    "src/selftest": ([], ["fmt/", "nlohmann/"]),
    "src/terminal": ([], ["fmt/"]),
    "src/doctor": ([], ["fmt/"]),
    "src/pad_report": (["terminal"], ["fmt/", "nlohmann/"]),
    "src/bench": ([], ["fmt/", "nlohmann/", "benchmark/"]),
}
# Rooms that include less than the libraries below theirs have. Drawing knows no pads and no sticks.
LESS = {"src/draw": ["src/base", "src/system"]}
# The public headers, src/include/gaitpad/NAME.h, by the room whose functions they declare.
PUBLIC = {
    "src/base": ["curve", "hash", "limbs", "math", "result"],
    "src/motion": ["anatomy", "flight", "gait_cycle", "motion", "skeleton", "stride_family"],
    "src/control": ["control", "gait_params", "stick", "style"],
    "src/animation": ["ik", "placement", "terrain"],
    "src/walk": ["crowd", "walk", "walk_model", "walk_output", "walk_state"],
    "src/files": ["bvh", "config_files", "gltf", "motion_file"],
    "src/strides": ["clean_strides"],
    "src/hid": ["decode", "descriptor", "driver", "pad_overrides", "report", "trace"],
    "src/stick": ["calibration", "untouched"],
    "drivers": ["driver_registry", "keyboard"],
    "src/pads": ["pad_configuration", "pad_stream", "pads"],
    "src/session": ["followers", "live", "replay", "session_frame", "session_spec", "simulation", "summary"],
}
# What further headers of a vendor single files may include, and nobody else.
DRIVER_VENDORS = {
    "src/files/height_picture.cpp": ["png.h"],
    "src/check/pose_track.cpp": ["zlib.h"],
    "src/strides/stride_solver.cpp": ["Eigen/"],
    "src/session/pose_stream.cpp": ["lo/"],
    "drivers/virtual_pad.cpp": ["linux/"],
    "drivers/effect_table.h": ["linux/"],
    "drivers/evdev_virtual_pad.cpp": ["libevdev", "linux/"],
    "drivers/uhid_device.cpp": ["linux/"],
    "drivers/hidraw_driver.cpp": ["hidapi", "linux/"],
    "drivers/usb_driver.cpp": ["libusb"],
    "drivers/usb_transfers.h": ["libusb"],
    "drivers/usb_reattach.cpp": ["linux/"],
    "drivers/evdev_driver.cpp": ["libevdev", "linux/"],
    "drivers/sdl_driver.cpp": ["SDL2/", "SDL", "dlfcn.h"],
    "drivers/system_nodes.cpp": ["libudev.h"],
    "tools/rig/latency.cpp": ["linux/"],
    "tools/rig/plain_sdl.cpp": ["SDL2/"],
    "tools/soak/soak.cpp": ["SDL2/", "malloc.h"],
    "src/bench/bench_work.cpp": ["malloc.h"],
    "tools/fuzz/fuzz_stream.cpp": ["lo/"],
    "tools/gaitpad/window_module.cpp": ["dlfcn.h"],
}
TOOL_VENDORS = ["fmt/", "nlohmann/", "CLI/"]
# POSIX is in src/system, which all rooms but the core may include, and in drivers/, for devices. poll.h is a part of
# the drivers' contract (gaitpad/driver.h): any file may wait for descriptors.
SYSTEM_HEADERS = ("sys/", "unistd.h", "fcntl.h", "dirent.h", "errno.h", "signal.h", "pthread.h", "sched.h", "spawn.h",
                  "termios.h", "time.h", "pwd.h", "grp.h", "netdb.h", "net/", "netinet/", "arpa/", "syslog.h", "glob.h",
                  "ftw.h", "semaphore.h", "mqueue.h", "strings.h", "wait.h")
# Names by which a program knows that a sanitizer runs it, or hooks into one: tests alone have them.
SANITIZERS = re.compile(r"__(?:asan|lsan|tsan|ubsan|msan)_|__SANITIZE_|GAITPAD_SANITIZED|__has_feature|sanitizer/")
C_HEADER = "src/include/gaitpad.h"  # of libgaitpad.so: tests/c_api/c_api_test.py compiles it as C
C_PROGRAM = "tools/rig/pad_"  # the virtual pads: a C program that includes nothing of ours
EXAMPLES = "tools/examples/"  # programs of other people: they include what is installed
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]')


def includes(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if found := INCLUDE.match(line):
            yield number, found[1] == '"', found[2]


def is_standard(header):
    return "/" not in header and "." not in header or header == "poll.h"


def may_include_system(name):
    return name.startswith(("src/system/", "drivers/", "tools/")) and not name.startswith("tools/gaitpad/")


def library_of(room):
    return next(number for number, rooms in enumerate(LIBRARIES.values()) if room in rooms)


def home_of(target):
    """The room of an included header; None if it belongs to no room."""
    if target == "gaitpad.h":
        return "src/c_api"
    if target.startswith("gaitpad/"):
        name = target.removeprefix("gaitpad/").removesuffix(".h")
        return next((room for room, names in PUBLIC.items() if name in names), None)
    folder = target.rpartition("/")[0]
    return folder if folder.startswith("drivers") else f"src/{folder}"


def own_header_problem(root, room, target):
    """The reason why `room` (None: a tool) may not include "target"; None if it may."""
    if not any((root / top / target).exists() for top in ("src", "src/include", ".")):
        return "is not a path from src/, src/include/ or the root"
    home = home_of(target)
    if home not in ROOMS:
        return None if room is None else "is in no room"
    if home != room and home not in LESS.get(room, [home]):
        return f"is more than {room} may know"
    if room is None or home == room or library_of(home) < library_of(room):
        return None
    if library_of(home) == library_of(room) and home.removeprefix("src/") in ROOMS[room][0]:
        return None
    return f"is not for {room}"


def problems(root):
    files = [p for top in ("src", "drivers", "tools") for p in sorted((root / top).rglob("*"))]
    for path in (p for p in files if p.suffix in (".h", ".cpp")):
        name = path.relative_to(root).as_posix()
        if name.startswith((C_HEADER, C_PROGRAM, EXAMPLES)):
            continue
        folder = path.parent.relative_to(root).as_posix()
        is_public = folder == "src/include/gaitpad"
        room = home_of(f"gaitpad/{path.name}") if is_public else folder if folder in ROOMS else None
        if room is None and not name.startswith("tools/"):
            yield f"{name}: stands in no room"
            continue
        vendors = ["glm/"] if is_public else ROOMS[room][1] if room else TOOL_VENDORS
        vendors = vendors + DRIVER_VENDORS.get(name, [])
        for line, own, target in includes(path):
            if is_public and own and not target.startswith("gaitpad/"):
                problem = "is not public"
            elif own:
                problem = own_header_problem(root, room, target)
            elif is_standard(target) or target.startswith(tuple(vendors)):
                problem = None
            elif target.startswith(SYSTEM_HEADERS):
                problem = None if may_include_system(name) else "is POSIX, which is for src/system and drivers"
            else:
                problem = f"is a vendor header that {room or 'tools'} may not include"
            if problem:
                yield f"{name}:{line}: {target} {problem}"


# What the standard libraries of Emscripten 3 and of LLVM 14 lack, and system calls. tools/portable.sh compiles with both.
NOT_IN_THE_CORE = re.compile(r"std::(ranges|views|bit_cast|async|jthread|format)\b|<(sys/|unistd|fcntl|ranges>|future>|format>)")
NOT_IN_FILES = re.compile(r"std::(ranges|views|async|jthread|format)\b")  # LLVM 14's alone: Emscripten builds no files


def unportable(root, text_of=pathlib.Path.read_text):
    public = [root / f"src/include/gaitpad/{name}.h" for room in LIBRARIES["core"] for name in PUBLIC.get(room, [])]
    files = public + [p for room in LIBRARIES["core"] for p in sorted((root / room).glob("*.[ch]*"))]
    files = [(path, NOT_IN_THE_CORE) for path in files]
    files += [(path, NOT_IN_FILES) for room in ("src/system", "src/files") for path in sorted((root / room).glob("*.[ch]*"))]
    for path, missing in files:
        code = re.sub(r"//.*", "", text_of(path))
        yield from (f"{path.relative_to(root)}: {found[0]}" for found in missing.finditer(code))


def test_the_core_and_files_keep_to_what_every_standard_library_has():
    root = pathlib.Path(__file__).resolve().parents[1]
    assert not list(unportable(root))
    found = list(unportable(root, lambda path: path.read_text().replace("std::sort(", "std::ranges::sort(")))
    assert any("src/strides/" in line for line in found) and any("src/files/bvh.cpp" in line for line in found), found


def test_sanitizer_hooks_are_in_tests_alone():
    sources = [p for top in ("src", "drivers", "tools/gaitpad") for p in (ROOT / top).rglob("*") if p.suffix in (".h", ".cpp")]
    assert len(sources) > 300
    found = [f"{p.relative_to(ROOT)}: {hit.group()}" for p in sources if (hit := SANITIZERS.search(p.read_text()))]
    assert not found, "\n".join(found)


# What a source would say, and what the test must say of it.
SABOTAGES = [
    ("src/draw/plot.cpp", '#include "gaitpad/stick.h"', "more than src/draw may know"),
    ("src/draw/plot.cpp", '#include "gaitpad/calibration.h"', "more than src/draw may know"),
    ("src/draw/picture.h", '#include "gaitpad/pads.h"', "more than src/draw may know"),
    ("src/draw/theme.cpp", '#include "stick_picture/stick_picture.h"', "more than src/draw may know"),
    ("src/walk/walk.cpp", "#include <unistd.h>", "is POSIX"),
    ("src/pads/pads.cpp", "#include <sys/stat.h>", "is POSIX"),
    ("src/include/gaitpad/pads.h", "#include <fcntl.h>", "is POSIX"),
    ("src/view/window.cpp", "#include <time.h>", "is POSIX"),
    ("src/session/recording.cpp", "#include <sys/file.h>", "is POSIX"),
    ("src/terminal/terminal.h", "#include <termios.h>", "is POSIX"),
    ("src/bench/measured.h", "#include <sched.h>", "is POSIX"),
    ("src/base/text.cpp", '#include "system/whole_file.h"', "is not for src/base"),
    ("src/system/whole_file.cpp", '#include "files/input_files.h"', "is not for src/system"),
    ("tools/gaitpad/list.cpp", "#include <signal.h>", "is POSIX"),
    ("src/session/replay.cpp", "#include <cairo/cairo.h>", "is a vendor header"),
    ("src/hid/decode.cpp", '#include "session/show.h"', "is not for src/hid"),
]


@pytest.mark.parametrize("name, line, said", SABOTAGES, ids=[f"{name} {line}" for name, line, _ in SABOTAGES])
def test_a_wrong_include_is_found(tmp_path, name, line, said):
    for folder in ("src", "drivers", "tools"):
        (tmp_path / folder).mkdir()
    for top in ("src", "drivers"):  # the headers, to be found
        for header in (ROOT / top).rglob("*.h"):
            copy = tmp_path / header.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text("")
    source = tmp_path / name
    source.parent.mkdir(parents=True, exist_ok=True)
    source.write_text(line + "\n")
    assert [said in problem for problem in problems(tmp_path)] == [True]


def test_every_include_keeps_to_its_layer():
    found = list(problems(pathlib.Path(__file__).resolve().parents[1]))
    assert not found, "\n".join(found)


def test_no_two_sources_of_a_library_share_a_name():
    """An archive tells its members by their names alone; tests/session/determinism_test.py would compile one of two twice."""
    for library, rooms in LIBRARIES.items():
        names = sorted(path.name for room in rooms for path in (ROOT / room).glob("*.cpp"))
        assert len(set(names)) == len(names), (library, [name for name in names if names.count(name) > 1])
