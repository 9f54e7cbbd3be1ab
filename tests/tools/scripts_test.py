"""tools/folders.sh and tools/build.sh: their folders and their messages."""
import os
import subprocess

import pytest

from support.program import ROOT
from support.terminal import Terminal

NOBODY = 65534


def folders(root, command=(), **environment):
    """The settings (build, out, remarks) of tools/folders.sh."""
    script = f'set -eu; root={root}; source {ROOT}/tools/folders.sh; echo "$build"; echo "$out"'
    done = subprocess.run([*command, "bash", "-c", script], capture_output=True, text=True, check=True,
                          env={"PATH": os.environ["PATH"], "HOME": "/home/me", **environment})
    return (*done.stdout.splitlines(), done.stderr)


def test_it_builds_in_the_repository(tmp_path):
    assert folders(tmp_path) == (f"{tmp_path}/build", f"{tmp_path}/out", "")


def test_another_folder_can_be_named(tmp_path):
    assert folders(tmp_path, GAITPAD_BUILD=tmp_path / "other") == (f"{tmp_path}/other", f"{tmp_path}/other/out", "")


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can ask as another user")
def test_a_repository_that_cannot_be_written_is_built_in_the_cache_which_is_said():
    as_nobody = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"]
    build, out, remarks = folders("/usr", as_nobody, XDG_CACHE_HOME="/tmp/cache")
    assert build.startswith("/tmp/cache/gaitpad/build-") and out == build + "/out"
    assert "/usr cannot be written" in remarks and build in remarks
    assert folders("/usr", as_nobody)[0].startswith("/home/me/.cache/gaitpad/build-")
    assert folders("/etc", as_nobody)[0] != folders("/usr", as_nobody)[0]


@pytest.fixture
def pretended(tmp_path):
    """A function that takes the lines of a cmake that only pretends, and gives the folder that it builds into and the
    environment that finds it."""
    def cmake(*lines):
        tools, build = tmp_path / "bin", tmp_path / "build"
        tools.mkdir()
        build.mkdir()
        (tools / "cmake").write_text("\n".join(("#!/bin/sh", *lines)) + "\n")
        (tools / "cmake").chmod(0o755)
        (build / "build.ninja").write_text("")
        return build, {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"}
    return cmake


def test_a_build_says_on_a_terminal_how_far_it_is(pretended):
    build, env = pretended('for i in 1 2 3 4 5 6 7 8; do echo "[$i/8] Building x"; sleep 0.6; done')
    with Terminal("bash", ROOT / "tools/build.sh", build, "all", env=env) as terminal:
        terminal.wait_for(r"Building: \d+ %, \d+ s left", seconds=20)
        assert terminal.wait_end() == 0
    assert "[8/8]" in (build / "build.log").read_text()


def test_a_failed_build_shows_its_errors(pretended):
    build, env = pretended("echo '[1/2] Building x'", "echo 'x.cpp:1: error: no'", "exit 1")
    done = subprocess.run(["bash", ROOT / "tools/build.sh", build, "all"], capture_output=True, text=True, check=False,
                          env=env)
    assert done.returncode == 1 and done.stderr.strip() == "x.cpp:1: error: no"


def test_every_fuzz_target_keeps_few_inputs_in_two_megabytes_together():
    fuzz = ROOT / "tools/fuzz"
    kept = {path.name.removesuffix(".tar.xz"): path.stat().st_size for path in (fuzz / "corpus").glob("*.tar.xz")}
    assert sorted(kept) == sorted(path.stem for path in fuzz.glob("fuzz_*.cpp"))
    assert sum(kept.values()) <= 2 << 20, kept
