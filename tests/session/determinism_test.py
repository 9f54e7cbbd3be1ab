#!/usr/bin/python3
"""One walk, one hash: builds the core with two compilers at three levels and compares every tick.

Runs pose_hash_main twice in each build. Where two builds differ, says at which tick they begin to.
Usage: determinism_test.py PROGRAM (the builds stand in `determinism` beside it and are kept up to date)
"""
import hashlib
import itertools
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMPILERS = ["g++", "clang++"]
LEVELS = {"O0": "-O0", "O2": "-O2", "O3native": "-O3 -march=native"}
ROOMS = ["base", "hid", "stick", "motion", "control", "animation", "session"]
# What reads and writes files and cannot reach a pose comes from the ordinary build's libraries.
NO_POSE = re.compile(
    r"toml_file|trace|_file|_files|^style\.|style_store|body_keys|character|bvh_writer|gltf|frames_csv|replay|setup|walk_export"
    r"|motion_source|pad_|live|recording|realtime|summary|guided|tick_reports|playback|user_files")
MAIN = ROOT / "tests/session/pose_hash_main.cpp"
FLAGS = f"-std=c++20 -ffp-contract=off -fno-tree-slp-vectorize -w -I {ROOT}/src -I {ROOT}"

RULES = f"""
rule compile
  command = $cxx {FLAGS} $level -MD -MF $out.d -c $in -o $out
  depfile = $out.d
rule link
  command = $cxx $in -o $out -Wl,--start-group $libraries -Wl,--end-group -lfmt -ltomlplusplus -lpng
"""


def clashing(unit, sources):
    """The sources that cannot stand in one translation unit with those before them."""
    unit.write_text("".join(f'#include "{source}"\n' for source in sources))
    command = ["g++", *FLAGS.split(), "-fsyntax-only", unit]
    done = subprocess.run(command, capture_output=True, text=True)
    named = {line.split(":")[0] for line in done.stderr.splitlines() if ": error:" in line}
    return [source for source in sources[1:] if str(source) in named], done.returncode == 0


def room_units(folder, room):
    """A room's sources in as few translation units as their unnamed namespaces allow: a third of the
    time of a unit a file. Tried once for each state of the sources."""
    sources = [s for s in sorted((ROOT / "src" / room).glob("*.cpp")) if not NO_POSE.search(s.name)]
    digest = hashlib.sha256(b"".join(s.read_bytes() for s in sources)).hexdigest()
    stamp = folder / f"{room}.stamp"
    units = sorted(folder.glob(f"{room}_*.cpp"))
    if stamp.exists() and stamp.read_text() == digest:
        return units
    for unit in units:
        unit.unlink()
    units, rest = [], sources
    while rest:
        unit = folder / f"{room}_{len(units)}.cpp"
        together, later = rest, []
        while True:
            bad, fits = clashing(unit, together)
            if fits or not bad:
                break
            later += bad
            together = [s for s in together if s not in bad]
        if not fits:  # an error of its own: the build will say which
            later += together[1:]
            clashing(unit, together[:1])
        units.append(unit)
        rest = sorted(later)
    stamp.write_text(digest)
    return units


def build(folder):
    libraries = " ".join(str(library) for library in sorted(folder.parent.glob("libgaitpad_*.a")))
    units = [unit for room in ROOMS for unit in room_units(folder, room)] + [MAIN]
    lines, binaries = [RULES], {}
    for compiler, (name, level) in itertools.product(COMPILERS, LEVELS.items()):
        variant = f"{compiler}-{name}"
        objects = [f"{variant}/{unit.stem}.o" for unit in units]
        for unit, target in zip(units, objects):
            lines.append(f"build {target}: compile {unit}\n  cxx = {compiler}\n  level = {level}")
        lines.append(f"build {variant}/walk: link {' '.join(objects)} | {libraries}\n"
                     f"  cxx = {compiler}\n  libraries = {libraries}")
        binaries[variant] = folder / variant / "walk"
    (folder / "build.ninja").write_text("\n".join(lines) + "\n")
    done = subprocess.run(["ninja", "-j", "2", "-C", folder], capture_output=True, text=True)
    return binaries if done.returncode == 0 else done.stdout + done.stderr


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
    binaries = build(folder)
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
