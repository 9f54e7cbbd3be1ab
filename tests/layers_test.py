"""Enforces who may include whom: reads every #include line of src/, drivers/ and tools/.

A room includes its own headers, those of the rooms named here, the public headers of the libraries below its
own, and the vendor headers named here. A public header includes public headers, GLM and the standard library.
"""
import pathlib
import re

# The libraries, lowest first: a library includes its own headers and those of the libraries before it.
LIBRARIES = {
    "core": ["src/base", "src/motion", "src/strides", "src/control", "src/animation", "src/walk"],
    "c": ["src/c_api"],
    "pictures": ["src/draw"],
    "files": ["src/files"],
    "devices": ["src/hid", "src/stick", "src/pads", "drivers", "drivers/pads"],
    "session": ["src/session"],
    "program": ["src/stick_picture", "src/scene", "src/view", "src/paper", "src/check", "src/selftest", "src/bench", "src/terminal",
                "src/doctor"],
}
# room: (rooms of its own library that it may include, vendor headers)
ROOMS = {
    "src/base": ([], ["glm/"]),
    "src/motion": (["base"], ["glm/"]),
    "src/strides": (["base", "motion"], ["glm/"]),
    "src/control": (["base"], []),
    "src/animation": (["base", "motion", "control"], []),
    # Replaces the walk of src/animation; until then both are there.
    "src/walk": (["base", "motion", "animation"], []),
    "src/c_api": ([], []),
    "src/files": ([], ["fmt/", "toml++/", "nlohmann/"]),
    "src/hid": ([], ["fmt/"]),
    "src/stick": (["hid"], ["fmt/"]),
    "drivers": (["hid", "drivers/pads"], ["fmt/"]),
    "drivers/pads": (["hid"], ["fmt/"]),
    "src/pads": (["hid", "stick", "drivers", "drivers/pads"], ["fmt/"]),
    "src/session": ([], ["fmt/", "nlohmann/", "tbb/"]),
    # Drawing needs cairo alone and knows no pads; the paper's figures are drawn without a window.
    "src/draw": ([], ["fmt/", "cairo/"]),
    "src/stick_picture": ([], ["fmt/", "cairo/"]),
    # The scene knows no window: no SDL, no Dear ImGui.
    "src/scene": ([], ["fmt/", "epoxy/", "glm/"]),
    "src/view": (["scene", "stick_picture", "selftest"], ["fmt/", "SDL2/", "SDL", "imgui", "backends/imgui_impl", "epoxy/", "cairo/", "nlohmann/"]),
    "src/paper": ([], ["fmt/", "cairo/", "nlohmann/"]),
    "src/check": ([], ["fmt/"]),
    "src/selftest": ([], ["fmt/", "nlohmann/"]),
    "src/terminal": ([], ["fmt/"]),
    "src/doctor": ([], ["fmt/"]),
    "src/bench": ([], ["fmt/", "nlohmann/", "benchmark/"]),
}
# The public headers, src/include/gaitpad/NAME.h, by the room whose functions they declare.
PUBLIC = {
    "src/base": ["curve", "hash", "limbs", "math", "result"],
    "src/motion": ["anatomy", "flight", "gait_cycle", "motion", "skeleton", "stride_family"],
    "src/control": ["control", "gait_params", "stick", "style"],
    "src/animation": ["crowd", "ik", "terrain", "walk", "walk_model", "walk_output"],
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
SYSTEM_HEADERS = ("sys/", "unistd.h", "fcntl.h", "dirent.h", "errno.h", "poll.h", "signal.h",
                  "pthread.h", "sched.h", "spawn.h", "termios.h", "time.h", "pwd.h", "grp.h", "netdb.h")
C_HEADER = "src/include/gaitpad.h"  # of libgaitpad.so: tests/c_api/c_api_test.py compiles it as C
C_PROGRAM = "tools/rig/pad_"  # the virtual pads: a C program that includes nothing of ours
EXAMPLES = "tools/examples/"  # programs of other people: they include what is installed
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]')


def includes(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if found := INCLUDE.match(line):
            yield number, found[1] == '"', found[2]


def is_standard(header):
    return "/" not in header and "." not in header or header.startswith(SYSTEM_HEADERS)


def library_of(room):
    return next(number for number, rooms in enumerate(LIBRARIES.values()) if room in rooms)


def home_of(target):
    """The room of an included header, or None where it is none of a room's."""
    if target == "gaitpad.h":
        return "src/c_api"
    if target.startswith("gaitpad/"):
        name = target.removeprefix("gaitpad/").removesuffix(".h")
        return next((room for room, names in PUBLIC.items() if name in names), None)
    folder = target.rpartition("/")[0]
    return folder if folder.startswith("drivers") else f"src/{folder}"


def own_header_problem(root, room, target):
    """Why `room` (None: a tool) may not include "target", or None."""
    if not any((root / top / target).exists() for top in ("src", "src/include", ".")):
        return "is not a path from src/, src/include/ or the root"
    home = home_of(target)
    if home not in ROOMS:
        return None if room is None else "is in no room"
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
            else:
                problem = f"is a vendor header that {room or 'tools'} may not include"
            if problem:
                yield f"{name}:{line}: {target} {problem}"


def test_every_include_keeps_to_its_layer():
    found = list(problems(pathlib.Path(__file__).resolve().parents[1]))
    assert not found, "\n".join(found)
