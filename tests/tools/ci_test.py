"""Runs the examples of docs/ci.md unchanged on a folder `walks` of four recordings."""
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET

import pytest

from support.program import ROOT
from support.traces import raw_stick, write_trace

PAGE = (ROOT / "docs/ci.md").read_text()


def block(language, word):
    """The code block of that language that contains the word."""
    return next(text for text in re.findall(rf"^```{language}\n(.*?)^```", PAGE, flags=re.S | re.M) if word in text)


@pytest.fixture(scope="module")
def prefix(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("prefix")
    done = subprocess.run(["cmake", "--install", program.parent, "--prefix", folder], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def expected(run, tmp_path_factory):
    """Makes recordings with expectations."""
    folder = tmp_path_factory.mktemp("expected")
    for i in range(4):
        write_trace(folder / f"walk{i}.hid", [(0.2, *raw_stick(0, 0.5 + 0.1 * i)), (0.6, 0, 0)], end_s=1)
    run("check", "--update", folder)
    return folder


@pytest.fixture
def walks(expected, tmp_path):
    """The folder that contains them as `walks`."""
    shutil.copytree(expected, tmp_path / "walks")
    return tmp_path


def plant(folder):
    write_trace(folder / "walks/walk2.hid", [(0.2, *raw_stick(0.2, 0.7)), (0.6, 0, 0)], end_s=1)


@pytest.fixture
def shell(program, walks):
    def shell(script, status=0, **variables):
        done = subprocess.run(["bash", "-e", "-c", script], cwd=walks, capture_output=True, text=True, check=False,
                              env={**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", **variables})
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout
    return shell


def cases(folder):
    return sorted(case.get("name") for file in folder.glob("results*.xml") for case in ET.parse(file).iter("testcase"))


EVERY = [f"walks/walk{i}.hid" for i in range(4)]


def test_the_hosted_workflow(shell, walks):
    """Runs each job's command with its variables; the service itself is not here."""
    text = block("yaml", "jobs:")
    shards = [n.strip() for n in re.search(r"shard: \[(.*)\]", text)[1].split(",")]
    total = re.search(r"GAITPAD_SHARD_TOTAL: (\d+)", text)[1]
    command = re.search(r"run: (gaitpad check .*)", text)[1]
    assert len(shards) == int(total)
    found = []
    for shard in shards:
        shell(command, GAITPAD_SHARD_INDEX=shard, GAITPAD_SHARD_TOTAL=total)
        found += cases(walks)
    assert sorted(found) == EVERY
    plant(walks)
    shell(command, status=1, GAITPAD_SHARD_INDEX="3", GAITPAD_SHARD_TOTAL=total)
    assert list((walks / "differences").rglob("*.png"))


def test_gnu_parallel(shell, walks):
    if not shutil.which("parallel"):
        pytest.skip("GNU parallel is not installed")
    shell(block("bash", "parallel --jobs"))
    assert cases(walks) == EVERY
    plant(walks)
    shell(block("bash", "parallel --jobs"), status=1)


def test_the_slurm_script(shell, walks):
    """The test sets the variables that sbatch sets for each task."""
    script = block("bash", "#SBATCH")
    first, last = map(int, re.search(r"--array=(\d+)-(\d+)", script).groups())
    count = {"SLURM_ARRAY_TASK_COUNT": str(last - first + 1),
             "SLURM_CPUS_PER_TASK": re.search(r"--cpus-per-task=(\d+)", script)[1]}
    for task in range(first, last + 1):
        shell(script, SLURM_ARRAY_TASK_ID=str(task), **count)
    assert cases(walks) == EVERY
    plant(walks)
    shell(script, status=1, SLURM_ARRAY_TASK_ID="3", **count)


def test_cmake_adds_a_test_for_each_recording(prefix, walks, tmp_path):
    (walks / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.25)\nproject(walks LANGUAGES CXX)\n"
                                          + block("cmake", "gaitpad_add_trace_tests"))
    configured = subprocess.run(["cmake", "-S", walks, "-B", tmp_path / "built", f"-DCMAKE_PREFIX_PATH={prefix}"],
                                capture_output=True, text=True, check=False)
    assert configured.returncode == 0, configured.stderr

    def tests(status):
        done = subprocess.run(["ctest", "--test-dir", tmp_path / "built"], capture_output=True, text=True, check=False)
        assert (done.returncode != 0) == status, done.stdout
        return dict(re.findall(r"Test +#\d+: (\S+) \.+\**\s*(Passed|Failed)", done.stdout))
    assert tests(False) == {f"gaitpad.walk{i}": "Passed" for i in range(4)}
    plant(walks)
    assert tests(True)["gaitpad.walk2"] == "Failed"
