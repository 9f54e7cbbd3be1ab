"""config/udev: the rules are read in time, jump to labels that follow, and open pads, no other hardware."""
import fnmatch
import re

import pytest

from support.program import ROOT
from support.usb_interfaces import KEYBOARD, KEYBOARDS, PADS, PLAIN, STEAM

RULES = ROOT / "config/udev/60-gaitpad.rules"
LINES = [line for line in RULES.read_text().splitlines() if line and not line.startswith("#")]
# They make keyboards, mice, phones and more: pads are listed one by one.
MIXED_VENDORS = {"045e", "046d", "054c", "057e", "0738", "0955", "0b05", "0e6f", "0f0d", "145f", "1532", "18d1",
                 "1949", "28de", "2dc8"}
# Under Apple's vendor number, which a maker of pads took: no rule opens anything of Apple's.
LEFT_OUT = {"05ac:055b"}


def values(line, key):
    return [v for found in re.findall(re.escape(key) + r'=="([^"]*)"', line) for v in found.split("|")]


def hidraw_ids():
    """The vendor:product of each hidraw line; the product is * if the line opens all."""
    ids = set()
    for line in LINES:
        if line.startswith('SUBSYSTEM=="hidraw", KERNELS'):
            vendor = re.search(r"\*:([0-9A-F]{4}):\*", line)[1]
            products = re.findall(r"\*:([0-9A-F]{4})\.\*", line) or ["*"]
            ids |= {f"{vendor}:{product}".lower() for product in products}
    return ids


def usb_ids():
    ids = set()
    for line in LINES:
        for vendor in values(line, "ATTR{idVendor}"):
            ids |= {f"{vendor}:{product}" for product in values(line, "ATTR{idProduct}") or ["*"]}
    return ids


def config_ids():
    """The ids that config/pads names: `vendor` with `products`, and `ids`."""
    ids = set()
    for file in (ROOT / "config/pads").glob("*.toml"):
        for entry in file.read_text().split("[[pad]]"):
            vendor = re.search(r"^vendor = 0x([0-9a-f]{4})$", entry, re.M)
            products = re.search(r"^products = \[([^]]*)\]", entry, re.M)
            if vendor and products:
                ids |= {f"{vendor[1]}:{p}" for p in re.findall(r"0x([0-9a-f]{4})", products[1])}
            listed = re.search(r"^ids = \[([^]]*)\]", entry, re.M)
            ids |= set(re.findall(r"[0-9a-f]{4}:[0-9a-f]{4}", listed[1])) if listed else set()
    return ids


def test_the_number_is_below_that_of_the_seat_rules():
    assert int(RULES.name[:2]) < 73  # 73-seat-late.rules acts on the tag uaccess


def test_jumps_lead_to_labels_that_follow():
    for number, line in enumerate(LINES):
        for label in values(line.replace('GOTO="', 'GOTO=="'), "GOTO"):
            assert f'LABEL="{label}"' in LINES[number + 1:], line


def test_every_line_is_key_operator_value():
    term = re.compile(r'^[A-Z]+(\{\w+\})?(==|!=|=|\+=)"[^"]*"$')
    for line in LINES:
        for part in re.split(r",\s*(?=[A-Z])", line):
            assert re.search(term, part)


def test_one_line_gives_access_by_group_and_by_seat():
    given = [line for line in LINES if "MODE=" in line]
    assert given == ['MODE="0660", GROUP="input", TAG+="uaccess"']


def test_hidraw_and_usb_name_the_same_pads():
    assert len(hidraw_ids()) > 100
    assert hidraw_ids() == usb_ids()


def test_no_vendor_of_other_things_is_opened_as_a_whole():
    whole = {i.split(":")[0] for i in hidraw_ids() if i.endswith("*")}
    assert whole & MIXED_VENDORS == set()


def test_every_pad_of_config_is_opened():
    missing = {i for i in config_ids() - hidraw_ids() - LEFT_OUT if f"{i[:4]}:*" not in hidraw_ids()}
    assert missing == set()


def test_event_nodes_are_asked_what_they_are_and_keyboards_are_not_opened():
    asks = next(n for n, line in enumerate(LINES) if 'IMPORT{builtin}="input_id"' in line)
    opens = next(n for n, line in enumerate(LINES) if 'ENV{ID_INPUT_JOYSTICK}=="1"' in line)
    assert asks < opens
    assert 'ENV{ID_INPUT_KEYBOARD}!="1"' in LINES[opens]


# ---- the rules as udev reads them ------------------------------------------------------------
class Node:
    """A device node beside the chain of its parents: (subsystem, kernel name, attributes) each, the nearest first."""

    def __init__(self, subsystem, kernel, parents=(), interfaces="", attributes=None, **env):
        self.own = {"SUBSYSTEM": subsystem, "KERNEL": kernel, "ACTION": "add"}
        self.parents = [(subsystem, kernel, attributes or {}), *parents]
        self.interfaces, self.env = interfaces, {"DEVTYPE": "", **env}


def hidraw_of(ids, interface, interfaces):
    """The hidraw node of one interface (class, subclass, protocol) of a USB device."""
    shape = dict(zip(("bInterfaceClass", "bInterfaceSubClass", "bInterfaceProtocol"), (interface[:2], interface[2:4], interface[4:])))
    return Node("hidraw", "hidraw0", [("hid", f"0003:{ids.upper()}.0001", {}), ("usb", "1-1:1.0", shape), ("usb", "1-1", {})],
                interfaces)


def usb_of(ids, interfaces):
    vendor, product = ids.split(":")
    return Node("usb", "1-1", interfaces=interfaces, attributes={"idVendor": vendor, "idProduct": product}, DEVTYPE="usb_device")


def fits(pattern, text):
    return any(fnmatch.fnmatchcase(text, part) for part in pattern.split("|"))


def terms_of(line):
    return re.findall(r'([A-Z]+)(?:\{(\w+)\})?(==|!=|\+=|=)"([^"]*)"', line)


def matches(line, node):
    """True if the line matches. udev: KERNELS, SUBSYSTEMS and ATTRS of a line must fit the same device of the chain."""
    above = []
    for key, name, operator, value in terms_of(line):
        if operator not in ("==", "!="):
            continue
        if key in ("KERNELS", "SUBSYSTEMS", "ATTRS"):
            above.append((key, name, value))
            continue
        attributes = node.parents[0][2]
        found = node.env.get(name, "") if key == "ENV" else attributes.get(name) if key == "ATTR" else node.own[key]
        if (found is not None and fits(value, found)) != (operator == "=="):
            return False
    def is_it(device, key, name, value):
        text = {"KERNELS": device[1], "SUBSYSTEMS": device[0], "ATTRS": device[2].get(name)}[key]
        return text is not None and fits(value, text)
    return any(all(is_it(device, *term) for term in above) for device in node.parents)


def is_opened(node):
    """True if the rules give the node to the user at the machine."""
    lines, waits_for, opened = list(LINES), None, False
    for line in lines:
        label = values(line.replace("LABEL=", "LABEL=="), "LABEL")
        if waits_for:
            waits_for = None if label == [waits_for] else waits_for
            continue
        if not matches(line, node):
            continue
        for key, name, operator, value in terms_of(line):
            if key == "IMPORT" and value == "usb_id":
                node.env["ID_USB_INTERFACES"] = node.interfaces
            if key == "MODE":
                opened = True
            if key == "GOTO":
                waits_for = value
    return opened


def listed(interfaces):
    return ":" + ":".join(interfaces) + ":"


@pytest.mark.parametrize("ids, interfaces", PADS + [STEAM])
def test_a_pad_is_opened_as_a_usb_device_and_by_its_hid_interfaces(ids, interfaces):
    assert is_opened(usb_of(ids, listed(interfaces)))
    for interface in interfaces:
        if interface == PLAIN and not ids.startswith("1209"):
            assert is_opened(hidraw_of(ids, interface, listed(interfaces)))


@pytest.mark.parametrize("ids, interfaces", KEYBOARDS)
def test_nothing_of_a_keyboard_is_opened(ids, interfaces):
    assert not is_opened(usb_of(ids, listed(interfaces)))
    for interface in interfaces:
        assert not is_opened(hidraw_of(ids, interface, listed(interfaces)))


def test_the_keyboard_of_a_pad_is_not_opened():
    assert not is_opened(hidraw_of(STEAM[0], KEYBOARD, listed(STEAM[1])))


def test_over_bluetooth_a_pad_is_opened_by_its_ids():
    assert is_opened(Node("hidraw", "hidraw0", [("hid", "0005:054C:09CC.0001", {})]))
    assert not is_opened(Node("hidraw", "hidraw0", [("hid", "0005:046D:B342.0001", {})]))
