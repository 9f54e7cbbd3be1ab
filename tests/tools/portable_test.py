"""The core walks to the same bits with LLVM's standard library, on aarch64, as WebAssembly, and without vector types; with
LLVM's library the readers of files do, too. Only a whole run (GAITPAD_ALL=1) compiles them.
tests/session/determinism_test.py compares compilers and levels."""
import subprocess

import pytest

from support import slices
from support.program import ROOT

# Programs or files that each needs, and their packages.
NEEDS = {"libc++": [("clang++", "clang"), ("/usr/include/c++/v1/vector", "libc++-dev"),
                    ("/usr/lib/x86_64-linux-gnu/libc++abi.so", "libc++abi-dev")],
         "aarch64": [("aarch64-linux-gnu-g++", "g++-aarch64-linux-gnu"), ("qemu-aarch64-static", "qemu-user-static")],
         "wasm": [("em++", "emscripten"), ("node", "nodejs")],
         "scalar": []}
pytestmark = pytest.mark.skipif(not slices.ALL, reason="it compiles the core again: only in a whole run (GAITPAD_ALL=1)")


def lines_of(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    return done.stdout.splitlines()


@pytest.fixture(scope="module")
def here(program):
    """The hashes of the ordinary build: also without the walk of a file, as where only the core is compiled."""
    lines = lines_of(program.parent / "tests/core_hash")
    return {"libc++": lines, "core": lines[:lines.index(next(li for li in lines if li.startswith("strides of a file")))]}


@pytest.mark.parametrize("kind", NEEDS)
def test_the_core_walks_to_the_same_bits(kind, program, here):
    for tool, package in NEEDS[kind]:
        slices.need(tool, package)
    there = lines_of("bash", ROOT / "tools/portable.sh", kind, program.parent / "portable" / kind)
    expected = here.get(kind, here["core"])
    assert len(expected) > 70
    for line, same in zip(there, expected):
        assert line == same
    assert len(there) == len(expected)
