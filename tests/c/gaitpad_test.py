"""gaitpad/gaitpad.h: the core for C. Its header, what the library shows, its examples, and what it refuses."""
import ctypes as c
import importlib.util
import math
import re
import sys

import pytest

from support.program import ROOT, call

EXAMPLES = ROOT / "tools/examples"
INCLUDE = ROOT / "src/include"
STRICT = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]


@pytest.fixture(scope="module")
def path(program):
    return program.parent / "libgaitpad-c.so"


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("walk_in_python", EXAMPLES / "walk_in_python.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def lib(path):
    lib = c.CDLL(str(path))
    lib.gaitpad_model_create.restype = lib.gaitpad_walker_create.restype = c.c_void_p
    lib.gaitpad_walker_advance.argtypes = [c.c_void_p] + 3 * [c.c_double]
    lib.gaitpad_walker_frame.argtypes = [c.c_void_p, c.c_void_p]
    lib.gaitpad_walker_set_style.argtypes = [c.c_void_p, c.c_char_p, c.c_double]
    return lib


def refusal(lib, definition):
    error = c.create_string_buffer(200)
    assert not lib.gaitpad_model_create(c.byref(definition), error, c.c_size_t(200))
    return error.value.decode()


@pytest.mark.parametrize("standard", ["c99", "c11"])
def test_the_header_is_strict_c(standard):
    call("gcc", f"-std={standard}", *STRICT, "-fsyntax-only", "-x", "c", INCLUDE / "gaitpad/gaitpad.h")


def test_the_library_shows_the_functions_of_the_header_and_no_other(path):
    shown = {line.split()[-1] for line in call("nm", "-D", "--defined-only", path).splitlines()}
    declared = set(re.findall(r"GAITPAD_API[^(]*?\b(gaitpad_\w+)\(", (INCLUDE / "gaitpad/gaitpad.h").read_text()))
    assert shown == declared and len(shown) > 10


@pytest.mark.parametrize("standard", ["c99", "c11"])
def test_the_example_in_c_keeps_planted_toes_in_place(path, tmp_path, standard):
    call("gcc", f"-std={standard}", "-D_DEFAULT_SOURCE", *STRICT, "-I", INCLUDE, EXAMPLES / "walk_in_c.c", path,
         f"-Wl,-rpath,{path.parent}", "-lm", "-o", tmp_path / "walk")
    lines = call(tmp_path / "walk").splitlines()
    sides = [line.split()[0] for line in lines[:-1]]
    assert len(sides) > 8 and all(a != b for a, b in zip(sides, sides[1:])), "feet land in turn"
    assert float(re.search(r"slide ([\d.]+) mm", lines[-1])[1]) < 0.1
    for line in lines[:-1]:
        x, y, _ = map(float, line.split()[-3:])
        assert y == pytest.approx(0.1 * math.sin(0.4 * x), abs=0.005), "heels land on the waves"


def test_the_example_in_python_walks(path):
    lines = call(sys.executable, EXAMPLES / "walk_in_python.py", path).splitlines()
    assert len(lines) > 5
    assert float(lines[-1].split()[-1]) > 5.0, "from z 2, five seconds at 0.8 lead more than three metres"


def test_what_is_wrong_with_a_model_is_said_in_one_sentence(lib, example):
    size = c.sizeof(example.ModelDef)
    assert "size" in refusal(lib, example.ModelDef())
    assert "outside" in refusal(lib, example.ModelDef(size=size, scale=-1.0))
    assert "outside" in refusal(lib, example.ModelDef(size=size, scale=math.nan))
    assert "bones is NULL" in refusal(lib, example.ModelDef(size=size, bone_count=3))
    assert "bone_count" in refusal(lib, example.ModelDef(size=size, bone_count=2**31))


def test_a_shorter_struct_of_an_older_program_is_taken(lib, example):
    model = lib.gaitpad_model_create(c.byref(example.ModelDef(size=8, scale=-1.0)), None, c.c_size_t(0))
    assert model, "fields beyond its size count as 0"
    walker = lib.gaitpad_walker_create(c.c_void_p(model), (c.c_double * 3)(), c.c_double(0.0), None, c.c_size_t(0))
    lib.gaitpad_model_destroy(c.c_void_p(model))  # before its walker
    frame = (c.c_int32 * 200)(*[-7] * 200)
    frame[0] = 16
    assert lib.gaitpad_walker_frame(walker, frame) == 0
    assert frame[3] == 0 and frame[4] == -7, "nothing is written beyond its size"
    frame[0] = 3
    assert lib.gaitpad_walker_frame(walker, frame) == -1
    for bad in (math.nan, math.inf):
        lib.gaitpad_walker_advance(walker, bad, 0.5, 1 / 60)
    frame[0] = 16
    lib.gaitpad_walker_frame(walker, frame)
    assert frame[3] == 2, "bad sticks are counted"
    assert lib.gaitpad_walker_set_style(walker, b"hip_sway", 2.0) == 0
    assert lib.gaitpad_walker_set_style(walker, b"hip_sway", math.nan) == -1
    assert lib.gaitpad_walker_set_style(walker, b"no_such", 1.0) == -1
    lib.gaitpad_walker_destroy(c.c_void_p(walker))
