"""The program as its tests run it: the script's first argument, else the one in the path."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = str(pathlib.Path(sys.argv[1]).resolve()) if len(sys.argv) > 1 else "gaitpad"
ROUND = str(ROOT / "config/traces/round.hid")


def run(*arguments, **options):
    stdin = {} if "input" in options else {"stdin": subprocess.DEVNULL}
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False,
                          **{**stdin, "timeout": 300, **options})


class FolderCase(unittest.TestCase):
    """A folder of its own for each test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
