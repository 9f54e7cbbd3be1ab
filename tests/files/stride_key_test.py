"""The key of cached strides (CMakeLists.txt) covers every file of this project that was compiled for them."""
import pathlib
import shutil
import subprocess

import pytest

from support.program import ROOT

SOLVER = ("src/strides/", "src/motion/", "src/base/")  # objects that solve strides and objects that they call


def test_what_the_compiler_read_for_the_strides_is_in_their_key(program):
    build = program.parent
    if not (build / "build.ninja").exists() or not shutil.which("ninja"):
        pytest.skip("this build folder is not ninja's")
    key = {pathlib.Path(line).resolve() for line in (build / "stride_key.txt").read_text().splitlines()}
    done = subprocess.run(["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True, check=True)
    objects, is_solver = {}, False
    for line in done.stdout.splitlines():
        if line and not line[0].isspace():
            name = line.partition(":")[0].partition("gaitpad_core.dir/")[2]
            is_solver = name.startswith(SOLVER)
            objects.update({name: set()} if is_solver else {})
        elif is_solver and line.strip():
            path = (build / line.strip()).resolve()
            if path.is_relative_to(ROOT):
                objects[name].add(path)
    assert any(name.startswith("src/strides/stride_solver") for name in objects), "nothing was compiled here"
    for name, files in objects.items():
        assert files and files <= key, (name, sorted(map(str, files - key)))
