"""Run by Blender: the add-on receives hostile datagrams, then a valid one.

Usage: blender -b --factory-startup -P blender_flood.py -- ADDON FOLDER

FOLDER holds `datagrams` (length of 4 bytes, bytes) and the sound `frame.json`. Prints the result. The fake socket
returns them without waiting: an endless flood. """
import importlib.util
import json
import math
import pathlib
import sys

import bpy

addon_path, folder = sys.argv[sys.argv.index("--") + 1:]
folder = pathlib.Path(folder)
spec = importlib.util.spec_from_file_location("gaitpad_live", addon_path)
addon = importlib.util.module_from_spec(spec)
spec.loader.exec_module(addon)
addon.register()


def made():
    armature = bpy.data.objects.new("made", bpy.data.armatures.new("made"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for name, parent, height_m in (("Hips", None, 0.9), ("LeftUpperLeg", "Hips", 0.85), ("RightUpperLeg", "Hips", 0.85),
                                   ("LeftLowerLeg", "LeftUpperLeg", 0.45), ("RightLowerLeg", "RightUpperLeg", 0.45)):
        bone = armature.data.edit_bones.new(name)
        side_m = 0.1 if "Left" in name else -0.1 if "Right" in name else 0.0
        bone.head, bone.tail = (side_m, 0, height_m), (side_m, 0, height_m - 0.4)
        bone.parent = armature.data.edit_bones[parent] if parent else None
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


class Flood:
    def __init__(self, data):
        self.data, self.at, self.received = data, 0, 0

    def recv(self, _):
        if self.at >= len(self.data):
            raise BlockingIOError
        size = int.from_bytes(self.data[self.at:self.at + 4], "little")
        self.at += 4 + size
        self.received += 1
        return self.data[self.at - size:self.at]

    def close(self):
        pass


bpy.ops.wm.read_factory_settings(use_empty=True)
armature = made()
listener = addon.Listener(armature, {bone.name: bone.name for bone in armature.data.bones}, 0)
listener.socket.close()
flood = listener.socket = Flood((folder / "datagrams").read_bytes())
addon.LISTENERS[armature.name] = listener
most, taken = 0, 0
take = listener.take


def counted(scene):
    global taken
    count = take(scene)
    taken += count
    return count


listener.take = counted
while flood.at < len(flood.data):
    before = flood.received
    addon.take_all()
    most = max(most, flood.received - before)
numbers = [number for bone in armature.pose.bones for row in bone.matrix_basis for number in row]
frame = json.loads((folder / "frame.json").read_text())
frame["bones"]["Hips"][1] += 0.01
data = json.dumps(frame).encode()
listens = addon.LISTENERS.get(armature.name) is listener
malformed, flood.data, flood.at = listener.malformed, len(data).to_bytes(4, "little") + data, 0
print(json.dumps({"looked_at": flood.received, "most_at_once": most, "malformed": malformed, "taken": taken,
                  "listens": listens, "is_finite": all(map(math.isfinite, numbers)),
                  "still_walks": addon.take_all() is not None and listener.malformed == malformed}), flush=True)
