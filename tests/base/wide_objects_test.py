"""Objects for wider registers must not define functions that other objects also define: the linker keeps one of them,
and an old processor would crash at its first wide instruction. """
import shutil
import subprocess

import pytest

from support.program import ROOT, has_sanitizers

BODIES = ("gaitpad::solve_legs<", "gaitpad::close_legs<", "gaitpad::advance_lanes<", "gaitpad::blend_rows<",
          "gaitpad::fade_rows<", "gaitpad::sum_rows<", "gaitpad::sum_group<")


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
        # Functions on wide registers have the register type in their name.
        own = [name for name in functions if "double __vector(" in name or any(body in name for body in BODIES)]
        assert own, f"{path.name} holds none of {BODIES}"
        assert functions == own, f"{path.name} holds {set(functions) - set(own)}"
