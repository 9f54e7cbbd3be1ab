"""Run by Blender: prints the joints' places at some times, in the file's unit, z up, one line of JSON per file.

Usage: blender -b --factory-startup -P blender_joints.py -- FILE...

Debian 12's Blender 3.4 needs parts that numpy and Python have removed (`numpy.bool`, open mode "U"), so they are
restored. """
import builtins
import json
import sys

import numpy

numpy.bool = bool
open_file = builtins.open
builtins.open = lambda path, mode="r", *more, **named: open_file(path, mode.replace("U", ""), *more, **named)

import bpy

TIMES_S = [0.0, 0.5, 1.25, 2.0, 2.5, 3.75]


def joints(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    first = 0  # a BVH file begins at Blender's frame 1
    if path.endswith(".glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    else:
        bpy.ops.import_anim.bvh(filepath=path, update_scene_fps=True)
        first = 1
    scene = bpy.context.scene
    armature = next(o for o in bpy.data.objects if o.type == "ARMATURE")
    places = []
    for time_s in TIMES_S:
        frame = first + time_s * scene.render.fps / scene.render.fps_base
        scene.frame_set(int(frame), subframe=frame - int(frame))
        places.append({bone.name: list(armature.matrix_world @ bone.head) for bone in armature.pose.bones})
    return {"path": path, "times_s": TIMES_S, "joints": places}


for name in sys.argv[sys.argv.index("--") + 1:]:
    print(json.dumps(joints(name)))
