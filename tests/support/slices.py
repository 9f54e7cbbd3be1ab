"""The part of a long sweep that this run does. tools/ctest.sh and tools/rig.sh set GAITPAD_SLICE to a number that the
commit's hash chooses, so that a failure can be repeated; GAITPAD_ALL=1 runs everything.

    for walk in slices.chosen(walks, 6, name=lambda walk: walk.label): ...
"""
import os
import shutil
import zlib

ALL = os.environ.get("GAITPAD_ALL") == "1"
NUMBER = int(os.environ.get("GAITPAD_SLICE", "0"))


def is_chosen(name, parts):
    """True if the name is in this run's part of `parts`. A name stays in its part when others are added or removed."""
    return ALL or zlib.crc32(name.encode()) % parts == NUMBER % parts


def chosen(items, parts, name=str):
    return [item for item in items if is_chosen(name(item), parts)]


def text(parts):
    """How to repeat the run, for the test's output."""
    return "all (GAITPAD_ALL=1)" if ALL else f"part {NUMBER % parts + 1} of {parts} (GAITPAD_SLICE={NUMBER}; GAITPAD_ALL=1: all)"


def need(tool, package):
    """Skips the test where a program or a file is missing. A run of everything fails instead: it leaves nothing out."""
    import pytest  # scripts without tests also choose slices
    if not shutil.which(tool) and not os.path.exists(tool):
        (pytest.fail if ALL else pytest.skip)(f"{tool} is not here (package {package})")
