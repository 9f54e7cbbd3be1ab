"""gaitpad calibrate with recordings: what it finds, the file it keeps, what it refuses."""
import contextlib
import json
import math
import os
import pathlib
import re
import resource
import shutil
import subprocess
import tomllib

import pytest

from support.pictures import pixels
from support.program import ROUND
from support.sticks import Stick, thumb, trace_text
from support.traces import lines

SERIAL = "AA:BB:01"


class Turning(Stick):
    """A stick that is turned along its rim all the time."""

    def position(self, time, place, side):
        return math.cos(9 * time), math.sin(9 * time)


class User:
    """A user with a folder, recordings of a pad and calibrations."""

    def __init__(self, run, folder):
        self._run, self.folder, self.own = run, folder, folder / "config/gaitpad/calibration"

    def run(self, *arguments, environment=None, **options):
        own = {"XDG_CONFIG_HOME": str(self.folder / "config")} if environment is None else environment
        kept = {k: v for k, v in os.environ.items() if k not in ("XDG_CONFIG_HOME", "HOME")}
        return self._run(*arguments, env={**kept, **own}, cwd=self.folder, **options)

    def trace(self, left=None, right=None, steps=None, file="made", **options):
        path = self.folder / f"{file}.hid"
        path.write_text(trace_text(left or Stick(), right or Stick(seed=2), steps or thumb(), **options))
        return path

    def calibrated(self, *arguments, status=0):
        return json.loads(self.run("calibrate", "--json", *arguments, status=status).stdout)

    def written(self):
        files = list(self.own.glob("*.toml"))
        assert len(files) == 1
        return files[0]

    def table(self):
        return tomllib.loads(self.written().read_text())

    def refused(self, *arguments, says, **options):
        done = self.run("calibrate", *arguments, status=1, **options)
        assert says in done.stderr.strip().splitlines()[-1]
        return done


@pytest.fixture
def user(run, tmp_path):
    return User(run, tmp_path)


def test_finds_what_the_sticks_are(user):
    left = Stick(centre=(0.06, -0.04), reach=(0.85, 0.8), sigma=0.004, hysteresis=0.05)
    told = user.calibrated("--trace", user.trace(left, serial=SERIAL))["sticks"]
    found = told["left"]
    assert found["centre_x"] == pytest.approx(0.06, abs=0.05 / 4)
    assert found["centre_y"] == pytest.approx(-0.04, abs=0.05 / 4)
    for key, truth in (("min_x", 0.06 - 0.85), ("max_x", 0.06 + 0.85), ("min_y", -0.84), ("max_y", 0.76)):
        assert found[key] == pytest.approx(truth, abs=max(0.01 * abs(truth), 0.008)), key
    for key in ("sigma_x", "sigma_y"):
        assert found[key] == pytest.approx(0.004, abs=0.15 * 0.004)
    assert found["hysteresis"] == pytest.approx(0.05, abs=0.01)
    assert found["drift_per_s"] == 0
    assert found["rate_hz"] == pytest.approx(250, abs=2)
    assert found["inner_zone"] == pytest.approx(max(0.05, 3 * 0.004 + 0.05), abs=0.01)
    perfect = told["right"]
    assert perfect["verdict"] == "good"
    assert perfect["circularity_error"] < 0.5
    assert perfect["inner_zone"] == 0.05


def test_says_null_for_what_a_recording_cannot_tell(user):
    still = [(i / 250, (0, 0), (0, 0)) for i in range(500)]
    found = user.calibrated("--trace", user.trace(steps=still), status=1)["sticks"]["left"]
    assert found["centre_x"] == pytest.approx(0, abs=1e-4)
    for key in ("hysteresis", "min_x", "max_y", "circularity_error", "outer_zone"):
        assert found[key] is None, key
    assert found["verdict"] == "unknown"


def test_what_was_not_seen_is_neither_printed_nor_stored(user):
    """Half a turn of the left stick, and a right one that rests: both are unknown."""
    half = [(i / 250, (0, 0), (0, 0)) for i in range(500)]
    half += [(2 + i / 250, (math.cos(i / 250), math.sin(i / 250)), (0, 0)) for i in range(700)]
    trace = user.trace(Stick(reach=(0.8, 0.8)), Stick(reach=(0, 0)), steps=half, serial=SERIAL)
    done = user.run("calibrate", "--trace", trace, status=1)
    printed = done.stdout
    assert re.search(r"outer zone +not known", printed), printed
    assert len(done.stderr.strip().splitlines()) == 1
    for part in ("left: its rim was not seen to the", "right: it was never turned", "nothing is written"):
        assert part in done.stderr
    assert not user.own.exists() or not list(user.own.iterdir())
    user.refused("--trace", trace, "--out", user.folder / "out.toml", says="nothing is written")
    assert user.refused("--trace", trace, "--out", "-", says="nothing is written").stdout == ""
    assert not (user.folder / "out.toml").exists()
    # Columns: two blanks at least between a label, its numbers and what they are from.
    for row in (line for line in printed.splitlines() if line.startswith("  ") and "reports" in line):
        assert re.fullmatch(r"  [a-z][a-z(), ]+?  .*\S  +\S.*", row), row


def test_both_sticks_of_a_pad_report_at_one_rate(user):
    """A pad reports only changes, every 8 ms; the right stick rests while the left one moves."""
    sticks = user.calibrated("--trace", ROUND, status=1)["sticks"]  # its left stick is not turned
    assert sticks["left"]["rate_hz"] == pytest.approx(125, abs=1)
    for key in ("rate_hz", "jitter_ms", "gaps"):
        assert sticks["left"][key] == sticks["right"][key], key


def test_several_recordings_of_a_pad_count_together(user):
    rest = [(i / 250, (0, 0), (0, 0)) for i in range(500)]
    turn = thumb(releases=0, pushes=())
    both = user.calibrated("--trace", user.trace(steps=rest, file="rest"), "--trace", user.trace(steps=turn, file="turn"))
    assert both["sticks"]["left"]["circularity_error"] is not None
    other = user.trace(product=3, file="other")
    user.refused("--trace", user.folder / "rest.hid", "--trace", other, says="is not the pad of")


def test_writes_the_devices_own_file_and_keeps_the_old_one(user):
    user.calibrated("--trace", user.trace(Stick(centre=(0.1, 0)), serial=SERIAL))
    own = user.table()
    assert own["unique_id"] == SERIAL
    assert own["left"]["x"]["centre"] == pytest.approx(0.1, abs=0.001)
    assert "measured" in own["left"]
    first = user.written().read_text()
    user.calibrated("--trace", user.trace(Stick(centre=(-0.1, 0)), serial=SERIAL))
    assert user.table()["left"]["x"]["centre"] == pytest.approx(-0.1, abs=0.001)
    assert pathlib.Path(f"{user.written()}.old").read_text() == first


def test_a_stick_that_was_not_seen_keeps_its_calibration(user):
    user.calibrated("--trace", user.trace(Stick(centre=(0.1, 0), reach=(0.8, 0.8)), serial=SERIAL))
    before = user.table()["left"]
    for left, centre in ((Turning(), 0.1), (Stick(reach=(0, 0)), -0.1)):  # it rests nowhere; it only rests
        trace = user.trace(left, Stick(centre=(0, centre)), serial=SERIAL)
        done = user.run("calibrate", "--trace", trace)
        assert "the left stick is unknown: its calibration is kept" in done.stderr
        after = user.table()
        assert after["right"]["y"]["centre"] == pytest.approx(centre, abs=0.001)
        assert after["left"] == before  # `measured` stays as well


def test_play_and_record_use_it_and_the_recording_carries_it(user):
    trace = user.trace(Stick(centre=(0.3, 0.3), reach=(0.6, 0.6)), serial=SERIAL)
    user.calibrated("--trace", trace)
    out = user.folder / "played.hid"
    done = user.run("play", trace, "--no-window", "--record", out, "--json")
    embedded = "\n".join(rest for _, rest in lines(out, "K"))
    assert tomllib.loads(embedded)["left"]["x"]["centre"] == pytest.approx(0.3, abs=0.002)
    # Nothing else is needed: another user's replay gives the same poses.
    replayed = user.run("replay", out, "--json", environment={"XDG_CONFIG_HOME": "/nonexistent"})
    assert json.loads(replayed.stdout)["pose_hash"] == json.loads(done.stdout)["pose_hash"]
    # A replay does not depend on a user's folder.
    own = user.run("replay", trace, "--json").stdout
    assert own == user.run("replay", trace, "--json", environment={"XDG_CONFIG_HOME": "/nonexistent"}).stdout


@pytest.mark.parametrize("right, forward, swap", [("x", "-y", lambda x, y: (x, -y)), ("-y", "x", lambda x, y: (y, -x))])
def test_learns_swapped_and_inverted_axes_from_pushes(user, right, forward, swap):
    trace = user.trace(Stick(centre=(0.05, -0.1), sigma=0.003), serial=SERIAL, swap=swap)
    told = user.calibrated("--trace", trace, "--pushes", "forward,right,back,left")["sticks"]["left"]
    left = user.table()["left"]
    assert (left.get("right", "x"), left.get("forward", "y")) == (right, forward)
    assert told["centre_x"] == pytest.approx(0.05, abs=0.003)
    assert told["centre_y"] == pytest.approx(-0.1, abs=0.003)


def test_checks_todays_stick_against_its_file(user):
    user.calibrated("--trace", user.trace(Stick(sigma=0.003), serial=SERIAL))
    same = user.calibrated("--trace", user.trace(Stick(sigma=0.003, seed=9), serial=SERIAL), "--check", user.written())
    assert same["changes"] == []
    before = user.written().read_text()
    moved = user.trace(Stick(centre=(0.08, 0), sigma=0.012), serial=SERIAL)
    told = user.calibrated("--trace", moved, "--check", user.written())["changes"]
    assert any("left" in c and "centre" in c for c in told), told
    assert not any("right" in c for c in told), told
    # A recording of a resting pad is enough to see that a centre has moved.
    resting = [(i / 250, (0, 0), (0, 0)) for i in range(1000)]
    laid = user.trace(Stick(centre=(0.08, 0)), steps=resting, serial=SERIAL)
    assert any("left" in c and "centre" in c for c in user.calibrated("--trace", laid, "--check", user.written())["changes"])
    assert user.written().read_text() == before


def test_says_that_a_file_is_another_pads_or_that_nothing_could_be_compared(user):
    own = user.trace(serial=SERIAL)
    user.calibrated("--trace", own)
    same = user.run("calibrate", "--trace", own, "--check", user.written())
    assert same.stderr == ""
    assert "nothing that was seen has changed since" in same.stdout
    other = user.run("calibrate", "--trace", user.trace(product=3, file="other"), "--check", user.written())
    assert f"{user.written()}: is the file of " in other.stderr
    turning = [(t, (math.cos(9 * t), math.sin(9 * t)), (0, 0)) for t in (i / 250 for i in range(800))]
    unseen = user.refused("--trace", user.trace(steps=turning, serial=SERIAL), "--check", user.written(),
                          says="no stick was seen at rest")
    assert "has changed" not in unseen.stdout


def test_prints_and_writes_where_it_is_told(user):
    trace = user.trace(serial=SERIAL)
    done = user.run("calibrate", "--trace", trace, "--out", "-")
    assert tomllib.loads(done.stdout)["unique_id"] == SERIAL
    assert not user.own.exists()
    (user.folder / "-").write_text("left = nonsense\n")  # `--out -` must not touch a file of that name
    again = user.run("calibrate", "--trace", trace, "--out", "-")
    assert (again.stdout, again.stderr) == (done.stdout, "")
    out = user.folder / "mine.toml"
    done = user.run("calibrate", "--trace", trace, "--out", out, "--plot", user.folder / "sticks.png")
    assert "left stick: good." in done.stdout
    assert pixels(user.folder / "sticks.png").shape[1] > 800 and pixels(user.folder / "sticks.png").std() > 0.02 * 255
    user.run("replay", trace, "--calibration", out)
    assert not user.own.exists()


def test_imports_and_exports_other_tools_words(user):
    trace = user.trace(serial=SERIAL)
    line = user.run("calibrate", "--trace", trace, "--export-sdl").stdout
    assert "leftx:a0," in line
    (user.folder / "evemu").write_text(
        "# EVEMU 1.3\n" + "".join(f"A: 0{axis} 0 65535 0 4096 0\n" for axis in (0, 1)))
    user.run("calibrate", "--trace", trace, "--import", user.folder / "evemu")
    left = user.table()["left"]
    assert left["inner"] > 0.05
    # A mapping names controls and leaves the zones as they were.
    (user.folder / "sdl").write_text(line.replace("leftx:a0,", "leftx:a2,").replace("rightx:a2,", "rightx:a0,"))
    user.run("calibrate", "--trace", trace, "--import", user.folder / "sdl")
    own = user.table()
    assert own["left"] == left
    assert "measured_on" not in own
    assert "leftx:a2," in own["mapping"]
    (user.folder / "junk").write_text("hello\n")
    user.refused("--trace", trace, "--import", user.folder / "junk", says="junk")


def test_imports_a_whole_data_base_without_a_pad(user):
    guid = "0300000009120000{:02x}00000010010000,Pad {},a:b0,platform:{},\n"
    lines = [guid.format(n, n, "Linux" if n % 2 else "Windows") for n in range(10)]
    (user.folder / "gamecontrollerdb.txt").write_text("# SDL\n" + "".join(lines))
    done = user.run("calibrate", "--import", user.folder / "gamecontrollerdb.txt")
    assert "5 Linux mappings taken over; 5 are in" in done.stderr
    own = next(user.folder.rglob("gaitpad/gamecontrollerdb.txt"))
    assert own.read_text().count("platform:Linux") == 5
    (user.folder / "more.txt").write_text(guid.format(1, "new", "Linux") + guid.format(20, "more", "Linux"))
    user.run("calibrate", "--import", user.folder / "more.txt")
    assert own.read_text().count("platform:Linux") == 6
    assert "Pad new" in own.read_text() and "Pad 1," not in own.read_text()


def test_eight_imports_at_once_lose_nothing(user, started):
    """Eight imports read the user's file, add 92 pads each and write it: 736 in the end."""
    guid = "0300000009120000{:02x}{:02x}000010010000,Pad {},a:b0,platform:Linux,\n"
    for k in range(8):
        (user.folder / f"{k}.txt").write_text("".join(guid.format(n, k, n) for n in range(92)))
    environment = {**os.environ, "XDG_CONFIG_HOME": str(user.folder / "config")}
    with contextlib.ExitStack() as stack:
        importing = [stack.enter_context(started("calibrate", "--import", user.folder / f"{k}.txt", env=environment))
                     for k in range(8)]
        assert [process.wait(60) for process in importing] == [0] * 8
    own = next(user.folder.rglob("gaitpad/gamecontrollerdb.txt"))
    assert own.read_text().count("platform:Linux") == 8 * 92


def test_refusals_are_one_sentence_and_lose_nothing(user):
    good = user.trace(serial=SERIAL)
    user.calibrated("--trace", good)
    kept = user.written().read_text()
    damaged = user.folder / "damaged.hid"
    damaged.write_text(good.read_text().replace("E: 000001.000000 11", "E: 000001.000000 12", 1))
    user.refused("--trace", damaged, says="damaged.hid:")
    user.refused("--trace", user.folder / "none.hid", says="none.hid")
    user.refused("--trace", good, "--out", "/proc/mine.toml", says="/proc/mine.toml")
    user.refused("--trace", good, "--out", user.folder, says=str(user.folder))
    user.refused("--trace", good, "--plot", "/proc/mine.png", says="/proc/mine.png")
    user.refused("--trace", good, "--check", user.folder / "none.toml", says="none.toml")
    user.refused("--trace", good, environment={}, says="--out")
    full = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))
    user.refused("--trace", good, preexec_fn=full, says=user.written().name)
    assert user.written().read_text() == kept
    assert all(".toml" in p.name for p in user.own.iterdir())


@pytest.mark.parametrize("options", [
    "--trace a PAD", "--trace a --driver evdev", "--check a --out b", "--import a --check b", "--import a --json",
    "--export-sdl --import a", "--export-sdl --plot a.png", "--pushes forward,right", "--trace made.hid --pushes up",
    "--trace made.hid --plot a.jpg", "--trace made.hid --json --out -", "--compare a b --out c", "--compare a"])
def test_options_that_contradict_each_other_are_wrong_usage(user, options):
    user.trace()
    user.run("calibrate", *options.split(), status=2)


def test_a_damaged_file_of_its_own_is_told_and_replaced(user):
    trace = user.trace(serial=SERIAL)
    user.calibrated("--trace", trace)
    user.written().write_text("left = nonsense\n")
    done = user.run("calibrate", "--trace", trace)
    assert ".toml:1" in done.stderr
    assert "left" in user.table()


def test_compares_two_files_in_text_and_in_a_picture(user):
    before, after, picture = (user.folder / name for name in ("before.toml", "after.toml", "repair.png"))
    user.calibrated("--trace", user.trace(Stick(centre=(0.08, 0), sigma=0.012), serial=SERIAL), "--out", before)
    user.calibrated("--trace", user.trace(Stick(sigma=0.003), serial=SERIAL), "--out", after)
    told = user.run("calibrate", "--compare", before, after, "--plot", picture).stdout
    if shutil.which("file"):
        assert "PNG image data" in subprocess.run(["file", picture], capture_output=True, text=True, check=True).stdout
    left, right = told.split("\nright stick\n")
    centre = next(line.split() for line in left.splitlines() if "centre x" in line)
    assert float(centre[2]) == pytest.approx(0.08, abs=0.003)
    assert float(centre[3]) == pytest.approx(0.0, abs=0.003)
    assert centre[4] == "*"
    assert "left stick: the centre has moved" in right
    assert pixels(picture).std() > 0.02 * 255
    same = user.run("calibrate", "--compare", after, after).stdout
    assert "*" not in same and "what was measured for both files has not changed" in same
    user.refused("--compare", after, user.folder / "none.toml", says="none.toml")
