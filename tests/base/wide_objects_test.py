"""Objects for wider registers must not define functions that other objects also define: the linker keeps one of them,
and an old processor would crash at its first wide instruction. """
import shutil
import subprocess

import pytest

from support.program import ROOT, has_sanitizers

# The ticks of one walk and of the blocks that fill these registers; their parts are inlined or of this object alone.
OWN = ("gaitpad::advance(gaitpad::Tables const&, gaitpad::Block<", "gaitpad::advance_by_avx")


def test_wide_objects_hold_their_own_functions_alone(program):
    if not shutil.which("nm"):
        pytest.skip("nm is not installed")
    if has_sanitizers(program):
        pytest.skip("with sanitizers a compiler leaves small functions as they are; such a program runs where it is built")
    sources = sorted((ROOT / "src").rglob("*_avx*.cpp"))
    assert sources
    for source in sources:
        path = program.parent / f"CMakeFiles/gaitpad_core.dir/{source.relative_to(ROOT)}.o"
        lines = subprocess.run(["nm", "-C", "--defined-only", path], capture_output=True, text=True, check=True).stdout
        functions = [line.split(" ", 2)[2] for line in lines.splitlines() if line[17] in "TW"]
        assert len(functions) == 2 and all(f.startswith(OWN) for f in functions), f"{path.name} holds {functions}"
