#!/usr/bin/env python3
"""walk_in_python.py LIBRARY: the built-in adult walks ten seconds, from Python by ctypes. Prints the way and the steps."""
import ctypes
import sys
from ctypes import POINTER, c_char_p, c_double, c_float, c_int32, c_size_t, c_void_p


class Options(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("bones", c_void_p), ("bone_count", c_int32), ("root_height_m", c_double),
                ("scale", c_double), ("leg_ratio", c_double), ("ground", c_void_p), ("game", c_void_p)]


class Frame(ctypes.Structure):
    _fields_ = [("size", c_size_t), ("stage", c_int32), ("swing", c_int32), ("heading_rad", c_double),
                ("speed_m_s", c_double), ("root_m", c_double * 3), ("root_moved_m", c_double * 3),
                ("root_turned_rad", c_double), ("heel_m", c_double * 3 * 2), ("toe_m", c_double * 3 * 2),
                ("heel_planted", c_int32 * 2), ("toe_planted", c_int32 * 2), ("landings", c_int32 * 2),
                ("heel_struck", c_int32 * 2), ("toe_off", c_int32 * 2), ("bad_inputs", c_int32)]


library = ctypes.CDLL(sys.argv[1])
library.gaitpad_model_create.restype = library.gaitpad_walk_create.restype = c_void_p
library.gaitpad_model_create.argtypes = [POINTER(Options), c_char_p, c_size_t]
library.gaitpad_walk_create.argtypes = [c_void_p, c_double * 3, c_double, c_char_p, c_size_t]
library.gaitpad_walk_step.argtypes = [c_void_p, c_double, c_double, c_double]
library.gaitpad_walk_frame.argtypes = [c_void_p, POINTER(Frame)]
library.gaitpad_pose_local.argtypes = [c_void_p, POINTER(c_float), c_int32, POINTER(c_float)]
library.gaitpad_joint_count.argtypes = library.gaitpad_model_destroy.argtypes = [c_void_p]
library.gaitpad_walk_destroy.argtypes = [c_void_p]

error = ctypes.create_string_buffer(256)
options = Options()
library.gaitpad_model_defaults(ctypes.byref(options))
model = library.gaitpad_model_create(options, error, len(error))
walk = model and library.gaitpad_walk_create(model, (c_double * 3)(), 0.0, error, len(error))
if not walk:
    sys.exit(error.value.decode())
for _ in range(600):
    library.gaitpad_walk_step(walk, 0.0, 0.8, 1 / 60)
frame = Frame(size=ctypes.sizeof(Frame))
library.gaitpad_walk_frame(walk, frame)
joints = library.gaitpad_joint_count(model)
rotations, root_m = (c_float * (4 * joints))(), (c_float * 3)()
library.gaitpad_pose_local(walk, rotations, joints, root_m)
print(f"{frame.root_m[2]:.2f} m ahead in {sum(frame.landings)} steps; hips {root_m[1]:.2f} m above the floor; "
      f"{joints} joints turned")
library.gaitpad_walk_destroy(walk)
library.gaitpad_model_destroy(model)
