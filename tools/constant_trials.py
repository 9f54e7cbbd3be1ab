#!/usr/bin/python3
"""Tries what changes when a constant of the walk is doubled or halved, one constant at a time.

  constant_trials.py FOLDER [--only NAME,...]      tries them; writes tools/constant_trials.tsv, which constants.py shows
  constant_trials.py FOLDER --tests --only NAME,... [--together]
                                                   prints the walk's tests that fail, doubled and halved

FOLDER gets a copy of the sources in which every number of src/walk that has a name is multiplied by a factor that an
environment variable gives, so one build serves all trials. A trial runs core_hash (148 lines of poses) and counts the
lines that differ. A constant whose doubling and halving changes none of them may be one that nothing needs: ask the
tests, which take a minute for each factor. With --together the constants are changed all at once.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys

import constants

ROOT = constants.ROOT
RESULTS = ROOT / "tools" / "constant_trials.tsv"
FACTOR = """\
#pragma once
#include <cstdlib>
#include <cstring>
namespace gaitpad {
// The factor of a constant in GAITPAD_TRIAL="file:name=factor,...", 1 if it is not there.
inline double trial_factor(const char* constant) {
  const std::size_t length = std::strlen(constant);
  for (const char* at = std::getenv("GAITPAD_TRIAL"); at; at = std::strchr(at, ',')) {
    at += *at == ',';
    if (std::strncmp(at, constant, length) == 0 && at[length] == '=') return std::atof(at + length + 1);
  }
  return 1.0;
}
}  // namespace gaitpad
"""
# Constants that types or tables need while they are compiled.
FIXED = {"kOver"}
DECLARED = re.compile(r"(?m)^([ \t]*)((?:inline |static )*)constexpr (float|double) (?=k[A-Z])")


def variable(text, file):
    """The text of a source with its constants multiplied by factors, and their names."""
    out, at, names = [], 0, []
    for found in DECLARED.finditer(text):
        end = constants.end_of(text, found.end())
        declared, parts = re.sub(r"//[^\n]*", "", text[found.end():end]), []
        if FIXED & set(re.findall(r"\w+", declared)):
            continue
        for part in constants.parts_of(declared):
            match = re.match(r"\s*(k[A-Z]\w*)\s*=\s*(.+)", part, re.S)
            if match and not match[2].lstrip().startswith("{"):
                names.append(match[1])
                part = f"{match[1]} = static_cast<{found[3]}>(({match[2]}) * trial_factor(\"{file}:{match[1]}\"))"
            parts.append(part.strip())
        # A constant of a function is set once, one of a file before main().
        kind = found[2] if not found[1] else "static "
        out += [text[at:found.start()], f"{found[1]}{kind}const {found[3]} ", ", ".join(parts)]
        at = end
    text = "".join([*out, text[at:]])
    if names:
        after = text.index("#pragma once\n") + len("#pragma once\n") if "#pragma once" in text else 0
        text = text[:after] + '#include "walk/trial_factor.h"\n' + text[after:]
    return text, names


def copied(folder):
    """Copies the tracked sources to `folder` and makes the walk's constants variable. Returns (file, name) of each."""
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout.decode()
    tried = []
    for name in filter(None, tracked.split("\0")):
        data = (ROOT / name).read_bytes()
        if re.fullmatch(r"src/walk/\w+\.(h|cpp)", name):
            text, names = variable(data.decode(), pathlib.Path(name).name)
            data = text.encode()
            tried += [(pathlib.Path(name).name, constant) for constant in names]
        to = folder / name
        to.parent.mkdir(parents=True, exist_ok=True)
        if not to.exists() or to.read_bytes() != data:
            to.write_bytes(data)
            to.chmod((ROOT / name).stat().st_mode)
    (folder / "src/walk/trial_factor.h").write_text(FACTOR)
    return list(dict.fromkeys(tried))


def run(command, trial="", **more):
    return subprocess.run(command, env={**os.environ, "GAITPAD_TRIAL": trial}, capture_output=True, text=True, **more)


def hashes(folder, trial=""):
    """The lines of core_hash; none if it does not end."""
    try:
        done = run([folder / "build/tests/core_hash"], trial, timeout=60)
    except subprocess.TimeoutExpired:
        return None
    return done.stdout.splitlines() if done.returncode == 0 else None


def failing_tests(folder, trial=""):
    done = run([folder / "build/tests/test_walk", "--gtest_brief=1"], trial, cwd=folder / "build")
    return sorted(set(re.findall(r"(?m)^\[  FAILED  \] ([\w/.]+)", done.stdout)))


def changed(before, after):
    return "does not end" if after is None else sum(a != b for a, b in zip(before, after))


def try_tests(folder, keys):
    usual = failing_tests(folder)
    for trial in keys:
        for factor in (2, 0.5):
            failing = failing_tests(folder, ",".join(f"{key}={factor}" for key in trial))
            print(*trial, f"x {factor}:", *[test for test in failing if test not in usual] or ["none fails"], flush=True)


def try_poses(folder, keys):
    before = hashes(folder)
    values = {f"{path.name}:{name}": value for path in (ROOT / "src/walk").glob("*.[hc]*")
              for _, name, value, _, _ in constants.constants_of(path)}
    rows = dict(line.split("\t", 1) for line in RESULTS.read_text().splitlines()) if RESULTS.exists() else {}
    for key in keys:
        counts = [changed(before, hashes(folder, f"{key}={factor}")) for factor in (2, 0.5)]
        rows[key] = "\t".join(map(str, (values.get(key, "-"), *counts)))
        print(key, rows[key], sep="\t", flush=True)
        RESULTS.write_text("".join(f"{k}\t{v}\n" for k, v in sorted(rows.items())))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="for the changed copy of the sources and its build")
    parser.add_argument("--only", help="names of constants, separated by commas")
    parser.add_argument("--tests", action="store_true", help="run the walk's tests instead of core_hash")
    parser.add_argument("--together", action="store_true", help="change the constants all at once")
    options = parser.parse_args()
    folder = options.folder.resolve()
    keys = [f"{file}:{name}" for file, name in copied(folder) if not options.only or name in options.only.split(",")]
    target = "test_walk" if options.tests else "core_hash"
    subprocess.run(["bash", "tools/build.sh", "build", target], cwd=folder, check=True)
    if options.tests:
        try_tests(folder, [keys] if options.together else [[key] for key in keys])
    else:
        try_poses(folder, keys)
    return 0


if __name__ == "__main__":
    sys.exit(main())
