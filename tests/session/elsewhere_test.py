"""The same recording gives the same poses elsewhere: under valgrind, on one core, in a locale with decimal commas, and
while somebody sets the clock. Other compilers and processors: determinism_test.py; numbers of threads: followers_test.cpp."""
import json
import os
import pathlib
import re
import shutil
import subprocess

import pytest

from support import slices
from support.program import ROOT, ROUND, has_sanitizers
from support.traces import beginning

# A wall clock that jumps an hour back and two hours ahead at each call; the monotonic clock is unchanged.
STEPPING_CLOCK = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>
static long hours(void) { static long looks; return 3600 * (++looks % 2 ? -looks : 2 * looks); }
int clock_gettime(clockid_t clock, struct timespec *at) {
  static int (*kernels)(clockid_t, struct timespec *);
  if (!kernels) kernels = dlsym(RTLD_NEXT, "clock_gettime");
  const int problem = kernels(clock, at);
  if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE) at->tv_sec += hours();
  return problem;
}
time_t time(time_t *at) { struct timespec now; clock_gettime(CLOCK_REALTIME, &now); if (at) *at = now.tv_sec; return now.tv_sec; }
int gettimeofday(struct timeval *at, void *zone) { at->tv_sec = time(0); at->tv_usec = 0; (void)zone; return 0; }
"""
OPTIONS = ("--terrain", "course", "--style", "tiring", "--crowd", "70")


@pytest.fixture(scope="module")
def short(tmp_path_factory):
    path = tmp_path_factory.mktemp("short") / "short.hid"
    path.write_text(beginning(ROUND, 2))
    return path


def hash_of(done):
    summary = json.loads(done.stdout)
    return summary["pose_hash"] if isinstance(summary, dict) else summary[0]["pose_hash"]


@pytest.fixture(scope="module")
def here(run, short):
    return hash_of(run("replay", short, "--json", *OPTIONS))


def test_under_valgrind_without_an_error(program, short, here):
    if has_sanitizers(program):
        pytest.skip("a program with sanitizers does not run under valgrind")
    slices.need("valgrind", "valgrind")
    done = subprocess.run(["valgrind", "-q", "--error-exitcode=9", program, "replay", short, "--json", *OPTIONS],
                          capture_output=True, text=True, timeout=580, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    assert hash_of(done) == here


def test_on_one_core(run, short, here):
    def alone():
        os.sched_setaffinity(0, [min(os.sched_getaffinity(0))])
    assert hash_of(run("replay", short, "--json", *OPTIONS, preexec_fn=alone)) == here


@pytest.mark.parametrize("name", ["tr_TR", "de_DE"])
def test_with_decimal_commas(run, short, here, tmp_path, name):
    slices.need(f"/usr/share/i18n/locales/{name}", "locales")
    subprocess.run(["localedef", "-i", name, "-f", "UTF-8", tmp_path / f"{name}.UTF-8"], check=True, capture_output=True)
    there = {**os.environ, "LOCPATH": str(tmp_path), "LC_ALL": f"{name}.UTF-8", "LANG": f"{name}.UTF-8"}
    files = []
    for number, environment in enumerate((os.environ, there)):
        out = tmp_path / f"out{number}"
        assert hash_of(run("replay", short, "--json", "--out", out, "--gltf", "--crowd-files", 0, *OPTIONS,
                           env=environment)) == here
        files.append({path.name: path.read_bytes() for path in out.iterdir()})
    assert files[0] == files[1]


def test_while_the_wall_clock_is_set(run, short, tmp_path):
    if not shutil.which("gcc"):
        pytest.skip("gcc is not installed")
    (tmp_path / "clock.c").write_text(STEPPING_CLOCK)
    subprocess.run(["gcc", "-shared", "-fPIC", "-o", tmp_path / "clock.so", tmp_path / "clock.c", "-ldl"], check=True)
    stepping = {**os.environ, "LD_PRELOAD": str(tmp_path / "clock.so")}
    recording = tmp_path / "session.hid"
    played = json.loads(run("play", short, "--no-window", "--seconds", 2, "--record", recording, "--json", env=stepping).stdout)
    assert played["standstills"] == 0 and played["reports"] > 10
    assert 240 < played["ticks"] + 240 * played["skipped_s"] < 240 * 3, "two seconds by the monotonic clock"
    assert hash_of(run("replay", recording, "--json", env=stepping)) == played["pose_hash"]


def test_the_wall_clock_only_names_new_files():
    """The adjustable clock is read only for dates: in the names of folders and in `measured_on`."""
    asks = re.compile(r"system_clock::now|CLOCK_REALTIME|gettimeofday|\btime\(nullptr\)")
    found = {str(path.relative_to(ROOT)) for folder in ("src", "drivers", "tools/gaitpad")
             for path in (ROOT / folder).rglob("*.[ch]*") if asks.search(path.read_text())}
    assert found == {"src/selftest/self_test.cpp", "src/view/window.cpp", "src/pads/guided_calibration.cpp"}
