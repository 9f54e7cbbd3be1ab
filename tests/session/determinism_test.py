"""One walk, one hash: two compilers at three levels walk the same sessions, and every tick is compared. Of the five other
builds two are made, for each takes a minute: clang++ -O3 -march=native always, and one that the commit chooses
(support/slices.py). GAITPAD_ALL=1 makes them all, and those for other processors: aarch64 in an emulator, and i386 with
the arithmetic of SSE2.

The program `pose_hash` of the ordinary build is the reference, as users run it; it also says which sources
a walk needs. The other builds stand in `determinism` beside it, and ninja keeps them up to date. Where two
builds differ, the test names the first tick that does.
"""
import collections
import itertools
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess

import pytest

from support import slices

ORDINARY = "ordinary"  # the build that is tested everywhere else: g++ -O2
LEVELS = {"O0": "-O0", "O2": "-O2", "O3native": "-O3 -march=native"}
OTHERS = {f"{compiler}-{name}": (compiler, level) for compiler in ("g++", "clang++") for name, level in LEVELS.items()
          if (compiler, name) != ("g++", "O2")}
if not slices.ALL:
    FIRST, *REST = sorted(OTHERS, key=lambda name: name != "clang++-O3native")
    OTHERS = {name: OTHERS[name] for name in (FIRST, REST[slices.NUMBER % len(REST)])}
# Other processors: compiler and its package; emulator and its package. The x87's registers are wider than a double, so
# i386 is tested only with SSE2.
FOREIGN = {"aarch64": (("aarch64-linux-gnu-g++", "g++-aarch64-linux-gnu"), ("qemu-aarch64-static", "qemu-user-static"), "-O2"),
           "i386": (("i686-linux-gnu-g++", "g++-i686-linux-gnu"), None, "-O2 -msse2 -mfpmath=sse -mstackrealign")}
if slices.ALL:  # these builds take minutes
    OTHERS |= {variant: (compiler[0], level) for variant, (compiler, _, level) in FOREIGN.items()}
# The extension of each compiler's precompiled headers.
PRECOMPILED = collections.defaultdict(lambda: "gch", {"clang++": "pch"})

RULES = """
rule header
  command = $cxx $flags $level -x c++-header $in -MD -MF $out.d -o $out
  depfile = $out.d
rule compile
  command = $cxx $flags $level $own -MD -MF $out.d -c $in -o $out
  depfile = $out.d
rule link
  command = $cxx $in $libraries -o $out
"""


def output_of(*command, folder, **options):
    done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


# clang 14 crashes now and then in a pass of its own ("Two-Address instruction pass") where it compiles for AVX-512: one file
# of six or so, not the same one again, in functions that have not changed. That says nothing of the walk.
COMPILER_CRASHED, TRIES = "PLEASE submit a bug report", 8


def build(target, folder):
    for _ in range(TRIES):
        done = subprocess.run(["ninja", target], cwd=folder, capture_output=True, text=True)
        if COMPILER_CRASHED not in done.stdout:
            break
    assert done.returncode == 0, done.stdout + done.stderr


def parts_of_ordinary(build):
    """(rows, flags, libraries) of pose_hash: the objects that its linker takes with their sources, how its main
    file is compiled, and the shared libraries."""
    link = shlex.split(output_of("ninja", "-t", "commands", "pose_hash", folder=build).splitlines()[-1])
    link = [word for word in link if word not in (":", "&&")]
    link[link.index("-o") + 1] = "/dev/null"
    taken = output_of(*link, "-Wl,--trace,--trace", folder=build).splitlines()  # twice, for members of archives
    rows = {row["output"]: row for row in json.loads(output_of("ninja", "-t", "compdb", folder=build))
            if row["output"].endswith(".o")}
    found, main = [], None
    for name in taken:
        member = re.fullmatch(r"\(.*?lib(\w+)\.a\)(.*\.o)", name)
        if name in rows:
            main = rows[name]
            found.append(main)
        elif member:
            folder, file = f"/{member[1]}.dir/", f"/{member[2]}"
            found += [row for output, row in rows.items() if folder in f"/{output}" and output.endswith(file)]
    command = re.sub(r"^.*?\+\+ | -(M[TF]|o|c) \S+| -MD| -O\S*| -W\S*", "", main["command"])
    # A source may include headers that its main file does not, such as Eigen.
    folders = {folder for row in found for folder in re.findall(r"-isystem \S+", row["command"])}
    command += "".join(f" {folder}" for folder in sorted(folders) if folder not in command)
    libraries = [word for word in link if re.search(r"\.so(\.[\d.]+)?$", word)]
    return found, command + " -w", " ".join(libraries)


def system_headers(build, rows):
    """Include lines of the system's headers, of all our headers and of sources where several include one:
    precompiled, they are read once a variant."""
    deps = output_of("ninja", "-t", "deps", *(row["output"] for row in rows), folder=build).splitlines()
    own = {line.strip() for line in deps if line.startswith("    ") and line.endswith(".h") and "/usr/" not in line}
    included = re.compile(r"^#include <.*>$", re.MULTILINE)
    counts = collections.Counter(line for row in rows for line in included.findall(pathlib.Path(row["file"]).read_text()))
    return sorted({line for header in own for line in included.findall((build / header).read_text())} |
                  {line for line, count in counts.items() if count > 2})


def write_build_file(folder, build):
    rows, flags, libraries = parts_of_ordinary(build)
    sources = [row["file"] for row in rows]
    # Sources for wider registers keep their own sets of instructions, which precompiled headers do not have.
    own = {row["file"]: " ".join(re.findall(r"(?<= )(?:-m\S+|-DGAITPAD_WIDE_LANES)", row["command"])) for row in rows}
    headers = system_headers(build, rows)
    lines = [f"flags = {flags}", f"libraries = {libraries}", RULES]
    for variant, (compiler, level) in OTHERS.items():
        header = folder / variant / "system.h"
        header.parent.mkdir(parents=True, exist_ok=True)
        text = "\n".join(headers) + "\n"
        if not header.exists() or header.read_text() != text:
            header.write_text(text)
        with_compiler = f"  cxx = {compiler}\n  level = {level}\n  variant = {variant}"
        is_foreign = variant in FOREIGN
        if is_foreign:  # without our libraries; wider numbers than its registers are computed in parts
            portable = re.sub(r" -D(FMT|TOML)_\S+| -I\S*/usr/\S+", "", flags)
            with_compiler += f"\n  flags = {portable} -DFMT_HEADER_ONLY -DTOML_HEADER_ONLY=1\n  libraries = -static"
        precompiled = f"{variant}/system.h.{PRECOMPILED[compiler]}"
        lines.append(f"build {precompiled}: header {variant}/system.h\n{with_compiler}")
        objects = [f"{variant}/{number}_{pathlib.Path(source).stem}.o" for number, source in enumerate(sources)]
        lines += [f"build {target}: compile {source} | {precompiled}\n{with_compiler}\n"
                  f"  own = {(not is_foreign and own[source]) or f'-include {variant}/system.h'}"
                  for source, target in zip(sources, objects)]
        lines.append(f"build {variant}/walk: link {' '.join(objects)}\n{with_compiler}")
    (folder / "build.ninja").write_text("\n".join(lines) + "\n")


@pytest.fixture(scope="module")
def folder(program):
    for tool in ("g++", "clang++", "ninja"):
        if not shutil.which(tool):
            pytest.skip(f"{tool} is not installed")
    folder = program.parent / "determinism"
    folder.mkdir(exist_ok=True)
    write_build_file(folder, program.parent)
    return folder


def walk(binary, folder, *emulator, **environment):
    """The pose hash of every tick, one in a line."""
    return output_of(*emulator, binary, folder, folder=folder, env={**os.environ, **environment}).splitlines()


@pytest.fixture(scope="module")
def ordinary(program, folder):
    return walk(program.parent / "tests/pose_hash", folder)


def first_difference(a, b):
    return next((f"{x} against {y}" for x, y in itertools.zip_longest(a, b, fillvalue="nothing") if x != y), None)


@pytest.mark.parametrize("variant", [ORDINARY, *OTHERS])
def test_every_tick_has_the_same_hash(variant, program, folder, ordinary):
    binary = program.parent / "tests/pose_hash" if variant == ORDINARY else folder / variant / "walk"
    emulator = []
    if variant in FOREIGN:
        compiler, runner, _ = FOREIGN[variant]
        for tool in filter(None, (compiler, runner)):
            slices.need(*tool)
        emulator = runner[:1] if runner else []
    if variant != ORDINARY:
        build(f"{variant}/walk", folder)
    assert len(ordinary) > 10000
    assert first_difference(ordinary, walk(binary, folder, *emulator)) is None
    print(f"{variant}: {ordinary[-1]}, {len(ordinary)} ticks")


@pytest.fixture(scope="module")
def locales(tmp_path_factory):
    """Locales with decimal commas; Turkish also has its own upper case of i."""
    folder = tmp_path_factory.mktemp("locales")
    slices.need("/usr/share/i18n/locales/tr_TR", "locales")
    for name in ("tr_TR", "de_DE"):
        subprocess.run(["localedef", "-i", name, "-f", "UTF-8", folder / f"{name}.UTF-8"], check=True, capture_output=True)
    return folder


@pytest.mark.parametrize("name", ["tr_TR.UTF-8", "de_DE.UTF-8"])
def test_a_hosts_locale_changes_no_bit(name, program, locales, tmp_path):
    """The program `pose_hash` sets its user's locale, as a host program may; it also writes and reads a motion."""
    binary = program.parent / "tests/pose_hash"
    plain = walk(binary, tmp_path, LC_ALL="C", GAITPAD_SAY_LOCALE="1")
    there = walk(binary, tmp_path, LC_ALL=name, LOCPATH=str(locales), GAITPAD_SAY_LOCALE="1")
    assert (plain[0], there[0]) == ("locale: 0.5", "locale: 0,5")
    assert first_difference(plain[1:], there[1:]) is None
