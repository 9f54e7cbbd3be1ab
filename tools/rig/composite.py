"""USB devices of several interfaces in the guest: `with Composite("31e3:1312", ["ff5d01", "030101"]) as device: ...`.

A configfs gadget with one FunctionFS function on dummy_udc.INDEX, as pad_usb.c makes it for pads of one interface. Each
interface has an IN endpoint that stays silent; those of class 3 have a descriptor: keyboard, mouse or game pad.
"""
import glob
import os
import pathlib
import struct
import subprocess
import threading

from pads import Nodes, settle, wait_for
from support.usb_interfaces import KEYBOARD, MOUSE

_GADGET = pathlib.Path("/sys/kernel/config/usb_gadget/composite")
_MOUNT = "/run/rig/composite"
_SETUP = 4  # the event FUNCTIONFS_SETUP
_FULL_AND_HIGH_SPEED = 3
_DESCRIPTORS, _STRINGS = 3, 2  # magic numbers of FunctionFS
_KEYS = bytes.fromhex("05010906a1010507 19e029e715002501 7501950881020507 190029651500256575089506 8100c0")
_POINTER = bytes.fromhex("05010902a1010901 a1000509190129031500250175019503 8102750595018101"
                         "0501093009311581257f7508950281 06c0c0")
_PAD = bytes.fromhex("05010905a101 0930093109320935 150026ff007508950481 02 0509190129081500250175019508 8102c0")


def _descriptor(interface):
    return {KEYBOARD: _KEYS, MOUSE: _POINTER}.get(interface, _PAD) if interface.startswith("03") else b""


def _usb_descriptors(interfaces, interval):
    """The descriptors of the interfaces, and their number."""
    parts = []
    for number, interface in enumerate(interfaces):
        parts.append(struct.pack("9B", 9, 4, number, 0, 1, *bytes.fromhex(interface), 0))
        if _descriptor(interface):
            parts.append(struct.pack("<BBHBBBH", 9, 0x21, 0x111, 0, 1, 0x22, len(_descriptor(interface))))
        parts.append(struct.pack("<BBBBHB", 7, 5, 0x81 + number, 3, 64, interval))
    return b"".join(parts), len(parts)


def _drivers_of_models(on):
    """hid-playstation and similar drivers drop a device that does not answer; without them hid-generic serves it."""
    models = ["hid_playstation", "hid_sony", "hid_nintendo", "hid_steam", "hid_logitech_dj", "hid_logitech_hidpp"]
    file = pathlib.Path("/etc/modprobe.d/rig.conf")  # written to this folder, because udevd notices its changes
    if on:
        file.unlink()
    else:
        file.write_text("".join(f"blacklist {name}\n" for name in models))
        subprocess.run(["modprobe", "-r", *models], check=False, stderr=subprocess.DEVNULL)
    subprocess.run(["udevadm", "control", "--reload"], check=True)


class Composite(Nodes):
    def __init__(self, ids, interfaces, index=0):
        super().__init__(f"/sys/devices/platform/dummy_hcd.{index}")
        self.ids, self.interfaces, self._udc = ids, interfaces, f"dummy_udc.{index}"

    def __enter__(self):
        _drivers_of_models(on=False)
        vendor, product = self.ids.split(":")
        (_GADGET / "configs/c.1").mkdir(parents=True)
        (_GADGET / "idVendor").write_text("0x" + vendor)
        (_GADGET / "idProduct").write_text("0x" + product)
        (_GADGET / "functions/ffs.composite").mkdir()
        (_GADGET / "configs/c.1/it").symlink_to(_GADGET / "functions/ffs.composite")
        os.makedirs(_MOUNT, exist_ok=True)
        subprocess.run(["mount", "-t", "functionfs", "composite", _MOUNT], check=True)
        self._control = os.open(_MOUNT + "/ep0", os.O_RDWR)
        (full, count), (high, _) = _usb_descriptors(self.interfaces, 4), _usb_descriptors(self.interfaces, 6)
        os.write(self._control, struct.pack("<5I", _DESCRIPTORS, 20 + len(full + high), _FULL_AND_HIGH_SPEED, count, count)
                 + full + high)
        os.write(self._control, struct.pack("<4I", _STRINGS, 16, 0, 0))
        threading.Thread(target=self._answer, daemon=True).start()
        (_GADGET / "UDC").write_text(self._udc)
        hid = sum(interface.startswith("03") for interface in self.interfaces)
        wait_for(lambda: self.usb_path and len(self.hidraws) == hid, 30, f"{hid} hidraw nodes of {self.ids}: {self.hidraws}")
        settle()
        return self

    def __exit__(self, *_):
        (_GADGET / "UDC").write_text("\n")
        try:
            wait_for(lambda: not self.usb_path, 10, "the unplugging")
        finally:  # a device that stays would take the port from every later test
            subprocess.run(["umount", "-l", _MOUNT], check=True)
            (_GADGET / "configs/c.1/it").unlink()
            for folder in ("configs/c.1", "functions/ffs.composite", ""):
                (_GADGET / folder).rmdir()
            _drivers_of_models(on=True)

    def _answer(self):
        """Answers requests for report descriptors; stalls all other requests."""
        while True:
            event = os.read(self._control, 12)
            kind, request, value, index, length = struct.unpack("<BBHHH4x", event)
            if event[8] != _SETUP:
                continue
            data = _descriptor(self.interfaces[index & 0xff]) if (kind, request, value >> 8) == (0x81, 6, 0x22) else b""
            try:
                if data:
                    os.write(self._control, data[:length])
                elif kind & 0x80:
                    os.read(self._control, 0)  # a transfer against the direction stalls
                else:
                    os.read(self._control, length)
            except OSError:
                pass

    @property
    def usb_path(self):
        """The device's folder in /sys, as soon as it has interfaces."""
        found = glob.glob(self.sysfs + "/usb*/*-1/*-1:1.0")  # pathlib's glob raises when a folder vanishes
        return pathlib.Path(found[0]).parent if found else None

    def interface_of(self, node):
        """Class, subclass and protocol of the interface that the node belongs to."""
        folder = pathlib.Path(os.path.realpath(f"/sys/class/hidraw/{os.path.basename(node)}"))
        while not (folder / "bInterfaceClass").exists():
            folder = folder.parent
        return "".join((folder / name).read_text().strip() for name in
                       ("bInterfaceClass", "bInterfaceSubClass", "bInterfaceProtocol"))
