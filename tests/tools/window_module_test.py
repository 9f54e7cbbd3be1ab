"""The drawing code is a module that is loaded only to draw: a replay without a picture maps none of its libraries."""
import json
import os
import pathlib
import re
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODULE = "gaitpad-window.so"
WINDOW = re.compile(r"lib(SDL2|GL|EGL|epoxy|cairo|freetype|imgui|stb|X11|wayland)[-.]")
TRACE = ROOT / "config/traces/walk.hid"


def run(program, *arguments, **environment):
    return subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, check=False,
                          env={**os.environ, **environment})


@pytest.fixture
def alone(program, tmp_path):
    """The program without its module."""
    (tmp_path / "bin").mkdir()
    return pathlib.Path(shutil.copy(program, tmp_path / "bin/gaitpad"))


def loaded_libraries(program, *arguments):
    done = run(program, *arguments, LD_DEBUG="files")
    assert done.returncode == 0, done.stderr[-500:]
    return set(re.findall(r"file=(\S+) \[0\];  generating link map", done.stderr))


def test_a_replay_maps_no_library_of_the_window(program, tmp_path):
    for out in ([], ["--out", tmp_path]):
        libraries = loaded_libraries(program, "replay", TRACE, *out)
        assert any("libstdc++" in name for name in libraries)
        assert not [name for name in libraries if WINDOW.search(name) or name.endswith(MODULE)]


def test_what_draws_maps_them(program, tmp_path):
    libraries = loaded_libraries(program, "calibrate", "--trace", ROOT / "config/traces/worn.hid", "--out", tmp_path / "a.toml",
                                 "--plot", tmp_path / "a.png")
    assert any(name.endswith(MODULE) for name in libraries)
    assert any(WINDOW.search(name) for name in libraries)


def test_without_the_module_a_replay_is_the_same(alone, program):
    hashes = [json.loads(run(p, "replay", TRACE, "--json", GAITPAD_CONFIG=str(ROOT / "config")).stdout)["pose_hash"]
              for p in (alone, program)]
    assert hashes[0] == hashes[1]


def test_without_the_module_drawing_fails_in_one_sentence(alone, tmp_path):
    for arguments in (["play", TRACE, "--frames", "1"], ["replay", TRACE, "--view"], ["figures", "--out", tmp_path / "f"]):
        done = run(alone, *arguments, GAITPAD_CONFIG=str(ROOT / "config"))
        assert done.returncode == 1
        assert re.fullmatch(rf"gaitpad \w+: the window cannot be loaded: .*{re.escape(MODULE)}.*\n", done.stderr), done.stderr


def test_another_versions_module_is_refused(alone, tmp_path):
    source = tmp_path / "other.c"
    source.write_text('struct { const char *version; } gaitpad_window_module = {"0.0.1"};\n')
    module = alone.parent / MODULE
    made = subprocess.run(["gcc", "-shared", "-fPIC", "-o", str(module), str(source)], capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    done = run(alone, "play", TRACE, "--frames", "1", GAITPAD_CONFIG=str(ROOT / "config"))
    assert done.returncode == 1
    assert re.fullmatch(r"gaitpad play: \S+gaitpad-window.so: is not the window of gaitpad \S+\n", done.stderr), done.stderr
