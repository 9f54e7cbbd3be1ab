"""gaitpad in other projects: installed, found by CMake and pkg-config, or fetched as a subproject."""
import csv
import io
import os
import re
import shutil
import subprocess

import pytest

from support.program import ROOT, call

EXAMPLES = ROOT / "tools/examples"


@pytest.fixture(scope="module")
def installed(program, tmp_path_factory):
    prefix = tmp_path_factory.mktemp("prefix")
    call("cmake", "--install", program.parent, "--prefix", prefix)
    return prefix


@pytest.fixture(scope="module")
def examples(installed, tmp_path_factory):
    """The examples' own CMake project, built against the installed copy."""
    folder = tmp_path_factory.mktemp("examples")
    call("cmake", "-G", "Ninja", "-S", EXAMPLES, "-B", folder, f"-DCMAKE_PREFIX_PATH={installed}",
         "-DCMAKE_BUILD_TYPE=Release")
    call("cmake", "--build", folder)
    return folder


def test_core_needs_glm_and_the_standard_library_alone(installed):
    archive = next(installed.glob("lib/**/libgaitpad_core.a"))
    undefined = call("nm", "--undefined-only", "--demangle", archive)
    for foreign in ("toml::", "png_", "SDL_", "fmt::", "nlohmann::", "cairo_", "libevdev", "hid_", "libusb"):
        found = [line for line in undefined.splitlines() if foreign in line]
        assert not found, f"{foreign}: {found[:3]}"
    posix = {"statfs", "flock", "open", "open64", "read", "write", "mmap", "getrandom", "poll", "ioctl", "kill"}
    assert not posix & set(undefined.split()), "the core calls POSIX"


def test_installed_headers_include_nothing_internal(installed):
    headers = sorted((installed / "include/gaitpad").glob("*.h"))
    assert len(headers) > 20
    names = {header.name for header in headers}
    for header in headers:
        for include in re.findall(r'#include "([^"]+)"', header.read_text()):
            assert include.removeprefix("gaitpad/") in names, f"{header.name} includes {include}"
        assert not re.search(r"#include <(fmt|toml\+\+|nlohmann|png|SDL2|cairo)", header.read_text()), header.name


def test_each_installed_header_compiles_alone(installed, tmp_path):
    headers = sorted((installed / "include/gaitpad").glob("*.h"))
    lines = ["rule check", f"  command = g++ -std=c++20 -fsyntax-only -Wall -Werror -include $in -x c++ /dev/null -I {installed}/include"]
    lines += [f"build {header.stem}: check {header}" for header in headers]
    (tmp_path / "build.ninja").write_text("\n".join(lines) + "\n")
    call("ninja", "-C", tmp_path)


@pytest.mark.parametrize("define", ["GLM_FORCE_QUAT_DATA_WXYZ", "GLM_FORCE_CTOR_INIT"])
def test_a_program_that_sets_glm_up_otherwise_is_told_so(define):
    """With another set-up of GLM rotations would have their parts in another order, or not be plain data."""
    command = ["g++", "-std=c++20", "-fsyntax-only", f"-I{ROOT}/src/include", "-include", "gaitpad/math.h", "-x", "c++", "/dev/null"]
    assert subprocess.run(command, check=False).returncode == 0
    done = subprocess.run([*command, f"-D{define}"], capture_output=True, text=True, check=False)
    assert done.returncode != 0 and f"without {define}" in done.stderr


def test_minimal_walk_prints_a_row_a_tick(examples, program, tmp_path):
    walk = tmp_path / "walk"
    call(program, "replay", ROOT / "config/traces/round.hid", "--out", walk)
    rows = list(csv.DictReader(io.StringIO(call(examples / "minimal_walk", walk / "pose.bvh", "0.8"))))
    assert len(rows) == 2400
    assert float(rows[-1]["time_s"]) == pytest.approx(2399 / 240, abs=1e-6)
    assert float(rows[-1]["left_heel_z_m"]) > 8.0, "ten seconds at 0.8 lead more than eight metres ahead"


def test_minimal_walk_refuses_a_missing_motion_in_one_sentence(examples):
    done = subprocess.run([examples / "minimal_walk", "missing.bvh", "0.8"], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 1
    assert done.stderr.count("\n") == 1 and "missing.bvh" in done.stderr


def flags_of(installed, module):
    folder = next(installed.glob("lib/**/pkgconfig"))
    return call("pkg-config", "--cflags", "--libs", module, env={**os.environ, "PKG_CONFIG_PATH": str(folder)}).split()


@pytest.mark.parametrize("standard", ["c++20", "c++2b"])
@pytest.mark.parametrize("compiler", ["g++", "clang++"])
def test_own_ground_keeps_planted_feet_in_place(installed, tmp_path, compiler, standard):
    """A stranger's program of at most sixty lines, without a warning in it or in the headers, by every compiler."""
    source, program = EXAMPLES / "own_ground.cpp", tmp_path / "own_ground"
    assert len(source.read_text().splitlines()) <= 60
    assert not call(compiler, f"-std={standard}", "-O1", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror", source,
                    *flags_of(installed, "gaitpad-core"), "-o", program)
    words = call(program).split()
    assert float(words[2]) < 0.1 and float(words[5]) < 0.1, words  # mm of slide and off the ground
    assert words[10] == "0", words  # number of poses that are not finite


def test_solve_leg_reaches_its_goal_with_stiff_and_free_hips(examples):
    lines = call(examples / "solve_leg").splitlines()
    assert len(lines) == 2
    for line in lines:
        assert float(re.search(r"([\d.]+) m from the goal", line)[1]) < 1e-6


def test_own_pad_turns_reports_into_sticks(examples):
    done = subprocess.run([examples / "own_pad"], capture_output=True, text=True, check=True)
    rows = [line.split(",") for line in done.stdout.splitlines()[1:]]
    sticks = [tuple(map(float, row[:2])) for row in rows]
    assert sticks[0] == (0, 0), "the default dead zone holds the middle"
    assert sticks[1] == pytest.approx((0, 1), abs=0.01), "y 0 is forward"
    assert sticks[2] == pytest.approx((1, 0), abs=0.03)
    assert [len(row[2].split()) for row in rows] == [0, 1, 0, 1], "buttons that are pressed"
    assert "1 of 5 reports were refused" in done.stderr


def test_sdl_game_walks_its_character(examples, tmp_path):
    game = examples / "sdl_game"
    if not game.exists():
        pytest.skip("SDL2 is not installed")
    picture = tmp_path / "game.bmp"
    text = call(game, "--frames", "300", "--stick", "0,0.8", "--picture", picture,
                env={**os.environ, "SDL_VIDEODRIVER": "dummy"})
    assert float(re.search(r"z ([\d.-]+) m", text)[1]) > 3.0
    assert len(set(picture.read_bytes()[54:])) > 3, "the picture shows a character"


@pytest.mark.parametrize("module, example", [("gaitpad-core", "solve_leg"), ("gaitpad", "own_pad")])
def test_pkg_config_finds_headers_and_libraries_under_the_prefix(installed, tmp_path, module, example):
    call("g++", "-std=c++20", EXAMPLES / f"{example}.cpp", *flags_of(installed, module), "-o", tmp_path / example)
    assert call(tmp_path / example)


def test_fetch_content_builds_the_core_as_a_subproject(tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(f"""
cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
include(FetchContent)
set(GAITPAD_CORE_ONLY ON)
FetchContent_Declare(gaitpad SOURCE_DIR {ROOT})
FetchContent_MakeAvailable(gaitpad)
add_executable(consumer {EXAMPLES}/solve_leg.cpp)
target_link_libraries(consumer PRIVATE gaitpad::core)
""")
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    call("cmake", "-G", "Ninja", "-S", tmp_path, "-B", tmp_path / "build", "-DCMAKE_BUILD_TYPE=Release", *launcher)
    call("cmake", "--build", tmp_path / "build", "--target", "consumer",
         env={**os.environ, "CCACHE_BASEDIR": str(ROOT), "CCACHE_NOHASHDIR": "1"})
    assert "m from the goal" in call(tmp_path / "build/consumer")
