#!/usr/bin/python3
"""One walk, one hash: builds the core with two compilers at three levels and compares every tick.

Runs pose_hash_main twice in each build. Where two builds differ, says at which tick they begin to.
Usage: determinism_test.py PROGRAM (the builds stand in `determinism` beside it and are kept up to date)
"""
import itertools
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMPILERS = ["g++", "clang++"]
LEVELS = {"O0": "-O0", "O2": "-O2", "O3native": "-O3 -march=native"}
ROOMS = ["src/base", "src/hid", "src/stick", "src/motion", "src/control", "src/animation",
         "src/session", "drivers"]
MAIN = ROOT / "tests/session/pose_hash_main.cpp"

RULES = f"""
rule compile
  command = $cxx -std=c++20 -ffp-contract=off -w $level -I {ROOT}/src -I {ROOT} -MD -MF $out.d -c $in -o $out
  depfile = $out.d
rule link
  command = $cxx $in -o $out -lfmt
"""


def units(folder, whole_rooms):
    """The translation units: a room each where whole_rooms, which takes a third of the time."""
    for room in ROOMS:
        sources = sorted((ROOT / room).glob("*.cpp"))
        if not whole_rooms:
            yield from sources
        elif sources:
            unit = folder / (room.replace("/", "_") + ".cpp")
            text = "".join(f'#include "{source}"\n' for source in sources)
            if not unit.exists() or unit.read_text() != text:
                unit.write_text(text)
            yield unit
    yield MAIN


def build(folder, whole_rooms):
    lines, binaries = [RULES], {}
    for compiler, (name, level) in itertools.product(COMPILERS, LEVELS.items()):
        variant = f"{compiler}-{name}"
        objects = []
        for unit in units(folder, whole_rooms):
            kind = "room" if whole_rooms else unit.parent.name
            objects.append(f"{variant}/{kind}_{unit.stem}.o")
            lines.append(f"build {objects[-1]}: compile {unit}\n  cxx = {compiler}\n  level = {level}")
        lines.append(f"build {variant}/walk: link {' '.join(objects)}\n  cxx = {compiler}")
        binaries[variant] = folder / variant / "walk"
    (folder / "build.ninja").write_text("\n".join(lines) + "\n")
    done = subprocess.run(["ninja", "-C", folder], capture_output=True, text=True)
    return binaries if done.returncode == 0 else done.stdout


def first_difference(a, b):
    for line_a, line_b in itertools.zip_longest(a, b, fillvalue="nothing"):
        if line_a != line_b:
            return f"{line_a} against {line_b}"
    return None


def main():
    for tool in COMPILERS + ["ninja"]:
        if not shutil.which(tool):
            print(f"skipped: {tool} is not installed")
            return 77
    folder = pathlib.Path(sys.argv[1]).resolve().parent / "determinism"
    folder.mkdir(exist_ok=True)
    # Two files of a room may use one name in their unnamed namespaces: then a unit a file.
    binaries = build(folder, True)
    if isinstance(binaries, str):
        binaries = build(folder, False)
    if isinstance(binaries, str):
        print(binaries)
        return 1

    reference, failed = None, False
    for variant, run in itertools.product(binaries, (1, 2)):
        done = subprocess.run([binaries[variant], folder], capture_output=True, text=True)
        if done.returncode != 0:
            print(f"{variant}: {done.stderr.strip() or done.returncode}")
            return 1
        ticks = done.stdout.splitlines()
        reference = reference or ticks
        difference = first_difference(reference, ticks)
        print(f"{variant} run {run}: {ticks[-1]}, {len(ticks)} ticks" +
              (f", DIFFERS from {next(iter(binaries))}: {difference}" if difference else ""))
        failed = failed or difference is not None
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
