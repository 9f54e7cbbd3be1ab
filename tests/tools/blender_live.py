"""Run by Blender: the add-on moves an armature by a stream, which is compared with the same walk as an imported
animation.

Usage: blender -b --factory-startup -P blender_live.py -- ADDON pose.glb FRAMES TICKS_PER_S

Prints {"port": N} once it listens; then a line for each pose that came: its tick, by bone the degrees between the
armature and the animation at that tick, and where the limbs of a made armature point; then the degrees of the key
frames that were recorded, and whether the map of the bones was there again after saving. It ends after FRAMES.
"""
import importlib.util
import json
import math
import socket
import sys
import time

import numpy

numpy.bool = bool  # Debian 12's Blender 3.4 needs it, but numpy has removed it

import bpy
import mathutils

addon_path, glb, count, rate_hz = sys.argv[sys.argv.index("--") + 1:]
rate_hz = float(rate_hz)


def imported():
    bpy.ops.import_scene.gltf(filepath=glb)
    return next(o for o in bpy.context.selected_objects if o.type == "ARMATURE")


# A stranger of half the size: other names, arms hanging at 45 degrees, one knee bent, facing along +x + y.
FACING = math.radians(135)  # counted about z from -y, as imported figures face
MADE = {"root": (None, (0, 0, 0), (0, 0, 0.1)), "pelvis": ("root", (0, 0, 0.5), (0, 0, 0.55)),
        "abdomen": ("pelvis", (0, 0, 0.55), (0, 0, 0.7)), "head": ("abdomen", (0, 0, 0.8), (0, 0, 0.9))}
for side, sign in (("L", 1), ("R", -1)):
    knee = (sign * 0.05, -0.1 if side == "L" else 0, 0.28)
    MADE.update({f"Thigh_{side}": ("pelvis", (sign * 0.05, 0, 0.48), knee), f"Calf_{side}": (f"Thigh_{side}", knee, (sign * 0.05, 0, 0.05)),
                 f"Foot_{side}": (f"Calf_{side}", (sign * 0.05, 0, 0.05), (sign * 0.09, -0.08, 0)),
                 f"Toe_{side}": (f"Foot_{side}", (sign * 0.09, -0.08, 0), (sign * 0.1, -0.12, 0)),
                 f"UpperArm_{side}": ("abdomen", (sign * 0.1, 0, 0.7), (sign * 0.2, 0, 0.6)),
                 f"LowerArm_{side}": (f"UpperArm_{side}", (sign * 0.2, 0, 0.6), (sign * 0.3, -0.02, 0.5))})


def made():
    armature = bpy.data.objects.new("made", bpy.data.armatures.new("made"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    turn = mathutils.Matrix.Rotation(FACING, 3, "Z")
    for name, (parent, head, tail) in MADE.items():
        bone = armature.data.edit_bones.new(name)
        bone.head, bone.tail = turn @ mathutils.Vector(head), turn @ mathutils.Vector(tail)
        bone.parent = armature.data.edit_bones[parent] if parent else None
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def directions(puppet):
    """The directions of its limbs in the armature's frame: x to its left, y up, z forward."""
    bpy.context.view_layer.update()
    back = mathutils.Matrix.Rotation(-FACING, 3, "Z")
    found = {}
    for name, bone in puppet.bones.items():
        posed = puppet.armature.pose.bones[bone]
        x, y, z = back @ (posed.tail - posed.head).normalized()
        found[name] = [x, z, -y]
    return found


def rotations(armature, names):
    bpy.context.view_layer.update()
    return {name: armature.pose.bones[name].matrix.to_quaternion() for name in names}


def degrees_between(one, other):
    """Degrees between bones, from the sine of the half angle, which is also exact for small angles."""
    turn = {name: one[name].rotation_difference(other[name]) for name in one}
    return {name: math.degrees(2 * math.asin(min(1.0, math.hypot(*q[1:])))) for name, q in turn.items()}


def show(frame):
    bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))


bpy.ops.wm.read_factory_settings(use_empty=True)
spec = importlib.util.spec_from_file_location("gaitpad_live", addon_path)
addon = importlib.util.module_from_spec(spec)
spec.loader.exec_module(addon)
addon.register()
scene = bpy.context.scene
fps = scene.render.fps / scene.render.fps_base
animated, live = imported(), imported()
live.animation_data_clear()
bpy.context.view_layer.objects.active = live
assert bpy.ops.gaitpad.guess_bones() == {"FINISHED"}
bones = addon.bone_map(live)
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_port:
    any_port.bind(("127.0.0.1", 0))
    live.gaitpad.port = any_port.getsockname()[1]
scene.frame_set(0)
assert not bpy.ops.gaitpad.record.poll(), "nothing listens yet"
assert bpy.ops.gaitpad.start() == bpy.ops.gaitpad.record() == {"FINISHED"}
listener = addon.LISTENERS[live.name]
stranger = made()
puppet = addon.Puppet(stranger, addon.guessed_bones(list(stranger.data.bones)))
print(json.dumps({"port": listener.port, "bones": bones}), flush=True)

ticks, end = [], time.monotonic() + 300
waiting = listener.waiting
while len(ticks) < int(count) and time.monotonic() < end:
    frames = waiting()
    for frame in frames:
        listener.waiting = lambda one=frame: [one]  # one at a time, so that each is compared
        assert listener.take(scene) == 1
        posed = rotations(live, bones.values())
        live_hips = live.pose.bones[bones["Hips"]].matrix.translation.copy()
        action, live.animation_data.action = live.animation_data.action, None
        show(frame["tick"] / rate_hz * fps)
        live.animation_data.action = action
        gap_m = (live_hips - animated.pose.bones[bones["Hips"]].matrix.translation).length
        puppet.put(frame)
        print(json.dumps({"tick": frame["tick"], "hips_gap_m": gap_m, "made": directions(puppet),
                          "degrees": degrees_between(posed, rotations(animated, bones.values()))}), flush=True)
        ticks.append((frame["tick"], frame["time_s"]))
    time.sleep(0.002)

listener.waiting = waiting
bpy.context.view_layer.objects.active = live
assert bpy.ops.gaitpad.start() == {"FINISHED"} and not addon.LISTENERS, "the second press stops"
for tick, time_s in ticks:  # the key frames: each at its time, counted from the first
    show((time_s - ticks[0][1]) * fps)
    recorded = rotations(live, bones.values())
    show(tick / rate_hz * fps)
    print(json.dumps({"recorded": tick, "degrees": degrees_between(recorded, rotations(animated, bones.values()))}), flush=True)

name = live.name  # loading a file invalidates all objects of Blender
bpy.ops.wm.save_as_mainfile(filepath=glb + ".blend")
bpy.ops.wm.open_mainfile(filepath=glb + ".blend")
print(json.dumps({"stored": addon.bone_map(bpy.data.objects[name]) == bones}), flush=True)
