"""libgaitpad.so as other languages use it: the header in C, the symbols, the examples."""
import os
import re
import subprocess
import sys

import pytest

from support.program import ROOT, call

HEADER = ROOT / "src/include/gaitpad.h"


@pytest.fixture
def library(program):
    path = program.parent / "libgaitpad.so"
    if "__asan_init" in call("nm", "-D", path) or "__tsan_init" in call("nm", "-D", path):
        pytest.skip("a library with sanitizers cannot be loaded by Python")
    return path


@pytest.mark.parametrize("compiler", ["gcc -std=c99", "gcc -std=c11", "clang -std=c99", "g++ -std=c++20 -x c++", "clang++ -std=c++20 -x c++"])
def test_the_header_compiles_without_a_warning(compiler):
    done = subprocess.run([*compiler.split(), "-fsyntax-only", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-pedantic", "-Werror", HEADER],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_it_shows_what_the_header_declares_and_nothing_else(library):
    declared = set(re.findall(r"GAITPAD_API[^;(]*?(gaitpad_\w+)\(", HEADER.read_text()))
    assert len(declared) > 10
    shown = {line.split()[-1] for line in call("nm", "-D", "--defined-only", library).splitlines()}
    assert shown == declared


def test_the_python_example_walks(library):
    text = call(sys.executable, ROOT / "tools/examples/walk_in_python.py", library)
    assert re.search(r"^1[01]\.\d\d m ahead in \d+ steps; hips 0\.\d\d m above the floor", text), text


def test_the_c_example_walks_over_waves(library, tmp_path):
    program = tmp_path / "walk_in_c"
    call("gcc", "-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror", f"-I{HEADER.parent}", ROOT / "tools/examples/walk_in_c.c",
         library, "-lm", "-o", program)
    lines = call(program, env={**os.environ, "LD_LIBRARY_PATH": str(library.parent)}).splitlines()
    sides = [line.split()[2] for line in lines[:-1]]
    assert len(sides) > 12 and all(a != b for a, b in zip(sides, sides[1:])), sides
    assert re.match(r"11 joints, the last one at 10\.\d\d m$", lines[-1]), lines[-1]
