"""Enforces who may include whom: reads every #include line of src/, drivers/ and tools/.

The table is the architecture's, in short: a room includes its own headers, those of the rooms below
it, and the vendor headers named here.
"""
import pathlib
import re

# room: (rooms it may include, the only headers of a room where not all are allowed, vendor headers)
ROOMS = {
    "src/base": ([], {}, ["glm/", "fmt/", "toml++/"]),
    "src/hid": (["base"], {}, ["fmt/"]),
    "src/stick": (["base", "hid"], {}, ["fmt/"]),
    "src/motion": (["base"], {}, ["fmt/"]),
    "src/control": (["base", "stick"], {"stick": ["stick/stick.h"]}, ["fmt/"]),
    "src/animation": (
        ["base", "motion", "control"],
        {"control": ["control/gait_params.h"]},
        ["fmt/"],
    ),
    "src/session": (
        ["base", "hid", "stick", "motion", "control", "animation", "drivers"],
        {},
        ["fmt/", "nlohmann/"],
    ),
    "src/view": (
        ["base", "hid", "stick", "motion", "control", "animation", "session", "drivers"],
        {"drivers": ["drivers/posix.h"]},
        ["fmt/", "SDL2/", "SDL", "imgui", "backends/imgui_impl", "epoxy/", "cairo/", "nlohmann/"],
    ),
    # The paper's figures and claims: whatever the program can do, drawn without a window.
    "src/paper": (
        ["base", "hid", "stick", "motion", "control", "animation", "session", "view"],
        {"view": ["view/drawing.h", "view/plot.h", "view/stick_plot.h"]},
        ["fmt/", "cairo/", "nlohmann/"],
    ),
    "drivers": (["base", "hid", "drivers/pads"], {}, ["fmt/"]),
    "drivers/pads": (["base", "hid"], {}, ["fmt/"]),
}
EVERY_ROOM = sorted(room.removeprefix("src/") for room in ROOMS)
# A driver's one file may include its own vendor's headers, and nobody else may.
DRIVER_VENDORS = {
    "src/animation/height_picture.cpp": ["png.h"],
    "drivers/hidraw_node.h": ["hidapi"],
    "drivers/hidraw_node.cpp": ["linux/"],
    "drivers/usb_transfers.h": ["libusb"],
    "drivers/usb_claim.h": ["libusb"],
    "drivers/usb_reattach.cpp": ["linux/"],
    "drivers/evdev_nodes.h": ["libevdev"],
    "drivers/evdev_nodes.cpp": ["linux/"],
    "drivers/evdev_driver.cpp": ["linux/"],
    "drivers/sdl_driver.cpp": ["SDL2/", "SDL"],
    "drivers/system_nodes.cpp": ["libudev.h"],
    "tools/rig/latency.cpp": ["linux/"],
    "tools/rig/plain_sdl.cpp": ["SDL2/"],
    "tools/soak/soak.cpp": ["SDL2/", "malloc.h"],
}
TOOL_VENDORS = ["fmt/", "nlohmann/", "CLI/", "benchmark/"]
SYSTEM_HEADERS = ("sys/", "unistd.h", "fcntl.h", "dirent.h", "errno.h", "poll.h", "signal.h",
                  "pthread.h", "sched.h", "spawn.h", "termios.h", "time.h", "pwd.h", "grp.h")
C_PROGRAM = "tools/rig/pad_"  # the virtual pads: a C program that includes nothing of ours
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^">]+)[">]')


def includes(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if found := INCLUDE.match(line):
            yield number, found[1] == '"', found[2]


def is_standard(header):
    return "/" not in header and "." not in header or header.startswith(SYSTEM_HEADERS)


def own_header_problem(root, room, target):
    """Why `room` may not include "target", or None."""
    if not (root / "src" / target).exists() and not (root / target).exists():
        return "is not a path from src/ or from the root"
    home = target.split("/")[0] if not target.startswith("drivers/pads/") else "drivers/pads"
    if home not in EVERY_ROOM:
        return None if room is None else "is in no room"
    if room is None or home == room.removeprefix("src/"):
        return None
    below, only, _ = ROOMS[room]
    if home not in below:
        return f"is not for {room}"
    if home in only and target not in only[home]:
        return f"is not for {room}: only {', '.join(only[home])} of {home}"
    return None


def problems(root):
    files = [p for top in ("src", "drivers", "tools") for p in sorted((root / top).rglob("*"))]
    for path in (p for p in files if p.suffix in (".h", ".cpp")):
        name = path.relative_to(root).as_posix()
        if name.startswith(C_PROGRAM):
            continue
        folder = path.parent.relative_to(root).as_posix()
        room = folder if folder in ROOMS else None
        if room is None and not name.startswith("tools/"):
            yield f"{name}: stands in no room"
            continue
        vendors = ROOMS[room][2] if room else TOOL_VENDORS
        vendors = vendors + DRIVER_VENDORS.get(name, [])
        for line, own, target in includes(path):
            if own:
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
