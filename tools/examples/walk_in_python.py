#!/usr/bin/env python3
"""The built-in adult walks five seconds by ctypes: walk_in_python.py LIBGAITPAD-C.SO. Prints each heel strike."""
import ctypes as c
import sys


class ModelDef(c.Structure):
    _fields_ = [("size", c.c_uint32), ("bone_count", c.c_uint32), ("bones", c.c_void_p), ("scale", c.c_double),
                ("ground", c.c_void_p), ("game", c.c_void_p)]


class Event(c.Structure):
    _fields_ = [("kind", c.c_int32), ("side", c.c_int32), ("place_m", c.c_double * 3)]


def main():
    lib = c.CDLL(sys.argv[1])
    lib.gaitpad_model_create.restype = lib.gaitpad_walker_create.restype = c.c_void_p
    lib.gaitpad_walker_advance.argtypes = [c.c_void_p] + 3 * [c.c_double]
    error = c.create_string_buffer(200)
    model = lib.gaitpad_model_create(c.byref(ModelDef(size=c.sizeof(ModelDef), scale=0.9)), error, c.c_size_t(200))
    if not model:
        sys.exit(error.value.decode())
    place = (c.c_double * 3)(1.0, 0.0, 2.0)
    walker = lib.gaitpad_walker_create(c.c_void_p(model), place, c.c_double(0.0), error, c.c_size_t(200))
    if not walker:
        sys.exit(error.value.decode())
    events = (Event * 6)()
    for tick in range(300):
        lib.gaitpad_walker_advance(walker, 0.0, 0.8, 1.0 / 60.0)
        for event in events[:lib.gaitpad_walker_events(c.c_void_p(walker), events, 6)]:
            if event.kind == 2:  # GAITPAD_HEEL_STRIKE
                print(f"{tick / 60:.2f} s", ("left", "right")[event.side], *(f"{x:.3f}" for x in event.place_m))
    lib.gaitpad_walker_destroy(c.c_void_p(walker))
    lib.gaitpad_model_destroy(c.c_void_p(model))


if __name__ == "__main__":
    main()
