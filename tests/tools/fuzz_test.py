"""The fuzz targets of tools/fuzz, which only tools/fuzz.sh builds, keep up with the sources."""
import concurrent.futures
import os
import shutil
import subprocess

import pytest

from support.program import ROOT


@pytest.mark.skipif(not shutil.which("clang++"), reason="clang++ is not installed")
def test_every_target_compiles():
    def errors_of(source):
        flags = ["-std=c++20", "-fsyntax-only", "-Wno-psabi", f"-I{ROOT}/src/include", f"-I{ROOT}/src", f"-I{ROOT}",
                 f"-DGAITPAD_CONFIG_DIR=\"{ROOT}/config\"", "-I/usr/include/eigen3"]
        return subprocess.run(["clang++", *flags, source], capture_output=True, text=True, check=False).stderr

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        sources = sorted((ROOT / "tools/fuzz").glob("fuzz_*.cpp"))
        assert sources
        errors = "".join(pool.map(errors_of, sources))
    assert not errors, errors
