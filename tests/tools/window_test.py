"""gaitpad play and replay --view: the real program on a display (Xvfb, Mesa), its pictures looked at.

The pictures stay in build/pictures. Skipped where Xvfb, numpy or matplotlib is not there.
"""
import functools
import json
import os
import shutil
import signal
import subprocess
import sys
import time

import pytest

np = pytest.importorskip("numpy")
colors = pytest.importorskip("matplotlib.colors")
from support.pictures import pixels  # noqa: E402
from support.program import ROUND, end_by, has_sanitizers, wait_until, wait_until_recorded, wait_until_works  # noqa: E402
from support.traces import raw_stick, write_trace  # noqa: E402

pytestmark = pytest.mark.skipif(shutil.which("Xvfb") is None, reason="there is no Xvfb (package xvfb)")

FOUR = [word for style in ("even", "stiff_hip", "stiff_knee", "limp_left") for word in ("--style", style)]
# The characters' colours of the dark theme (Okabe and Ito's), by hue.
HUES = {"even": 0x56B4E9, "stiff_hip": 0xE69F00, "stiff_knee": 0x009E73, "limp_left": 0xCC79A7}
EARLY, LATE = 40, 60  # frames of a walk that begins at 0.1 s


class Display:
    """An X server of its own."""

    def __init__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "2600x1500x24", "-nolisten", "tcp"],
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as file:
            self.name = ":" + file.readline().strip()

    def end(self, number=signal.SIGTERM):
        self.server.send_signal(number)
        self.server.wait(timeout=20)


def environment(display=None):
    result = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")}
    return {**result, "DISPLAY": display.name, "SDL_VIDEODRIVER": "x11"} if display else result


class Window:
    """The program on the tests' own display."""

    def __init__(self, program, run, started, folder):
        self._run, self._started, self._taken = run, started, {}
        self.display, self.pictures = Display(), program.parent / "pictures"
        self.pictures.mkdir(exist_ok=True)
        # Ahead from 0.1 s on, in a slight curve.
        self.trace = write_trace(folder / "walk.hid", [(0.0, 0.0, 0.0), (0.1, *raw_stick(0.15, 0.8))], end_s=8)

    def run(self, *arguments, display=None, **options):
        return self._run(*arguments, timeout=180, env=environment(display), **options)

    def started(self, *arguments, display=None):
        return self._started(*arguments, env=environment(display or self.display))

    def picture(self, name, *options, frames=EARLY):
        """Draws each picture once: the same options give the same picture."""
        if name not in self._taken:
            path = self.pictures / f"{name}.png"
            self.run("play", self.trace, "--frames", frames, "--screenshot", path, *options, display=self.display)
            self._taken[name] = pixels(path)
        return self._taken[name]


@pytest.fixture(scope="module")
def window(program, run, started, tmp_path_factory):
    window = Window(program, run, started, tmp_path_factory.mktemp("window"))
    yield window
    window.display.end()


SCENE_ROWS = slice(46, 628)  # rows between the bars, at scale 1


@functools.cache
def hsv_of(data, shape):
    return colors.rgb_to_hsv(np.frombuffer(data, np.uint8).reshape(shape) / 255.0)


def hsv_of_scene(picture):
    scene = picture[SCENE_ROWS].astype(np.uint8)
    return hsv_of(scene.tobytes(), scene.shape)


def coloured(picture, colour):
    """Pixels of a character in the scene: its hue within 10 degrees under any light; shoes are pale."""
    hsv = hsv_of_scene(picture)
    rgb = np.array([(colour >> 16) & 255, (colour >> 8) & 255, colour & 255]) / 255.0
    hue = colors.rgb_to_hsv(rgb)[0]
    away = np.abs((hsv[:, :, 0] - hue + 0.5) % 1.0 - 0.5)
    return (away < 10 / 360) & (hsv[:, :, 1] > 0.2) & (hsv[:, :, 2] > 0.2)


BARE = ("--panels", "none", "--hide", "trails,source,names,grid,shadows")


def test_every_characters_pixels_move_between_two_frames(window):
    early, late = window.picture("bare_early", *BARE), window.picture("bare_late", *BARE, frames=LATE)
    for name, colour in HUES.items():
        before, after = coloured(early, colour), coloured(late, colour)
        assert before.sum() > 1500, name
        changed = (before != after).sum() / before.sum()
        assert changed > 0.08, name
        # Legs swing more than the trunk sways; the camera follows it.
        rows = np.nonzero(before.any(axis=1))[0]
        hip = int((rows[0] + rows[-1]) / 2)
        legs = (before[hip:] != after[hip:]).sum() / before[hip:].sum()
        trunk = (before[:hip] != after[:hip]).sum() / before[:hip].sum()
        assert legs > trunk, name


def test_from_the_side_they_walk_one_behind_the_other(window):
    def width(picture):
        columns = np.nonzero(np.any([coloured(picture, c).any(axis=0) for c in HUES.values()], axis=0))[0]
        return columns[-1] - columns[0]
    ahead = window.picture("bare_standing", *BARE, frames=2)
    aside = window.picture("bare_aside", *BARE, "--camera", "90,5", frames=2)
    assert width(aside) < 0.5 * width(ahead)


def test_a_crowd_is_seen_behind_them(window):
    """The camera is farther away, so the first character is a quarter as large; with twenty behind it there is more to
    see."""
    options = (*BARE, "--style", "even", "--camera", "0,20")
    empty, full = window.picture("alone", *options), window.picture("crowd", *options, "--crowd", "20")

    def bodies(picture):
        """Bright or coloured pixels: the floor and the sky are neither."""
        scene = hsv_of_scene(picture)
        return ((scene[:, :, 1] > 0.35) & (scene[:, :, 2] > 0.25)).sum()
    assert bodies(full) > 1.5 * bodies(empty) > 1000


def test_panels_keep_their_place_and_their_text(window):
    none = window.picture("bare_early", *BARE)
    height, width = none.shape[:2]
    panels = window.picture("panels", "--hide", BARE[-1], "--panels", "pad,control,style,graphs,solver,loop")
    assert panels.std() > 8.0 and len(np.unique(panels.reshape(-1, 3), axis=0)) > 300

    def plain_columns(first, last):
        """Columns in which only one colour is drawn: the edge of a panel, which no text crosses."""
        part = panels[60:height - 110, first:last]
        return [i for i in range(part.shape[1]) if (np.ptp(part[:, i], axis=0) <= 2).all()]
    assert plain_columns(60, 330) and plain_columns(960, width - 60)
    assert (np.abs(panels - none).sum(axis=2) > 24).mean() > 0.2


def test_light_is_lighter_and_scale_2_doubles_every_size(window):
    dark = window.picture("bare_early", *BARE)
    one, two = (window.picture(f"light_{scale}", *BARE, "--theme", "light", "--scale", scale) for scale in (1, 2))
    assert one.mean() - dark.mean() > 80.0
    # Text is dark on light, light on dark: the extreme is on the other side of the mean.
    assert np.percentile(one, 0.5) < 90 and np.percentile(dark, 99.5) > 150
    assert two.shape[:2] == (2 * one.shape[0], 2 * one.shape[1])
    halved = two.reshape(one.shape[0], 2, one.shape[1], 2, 3).mean(axis=(1, 3))
    assert np.abs(halved - one).mean() < 8.0, "the same picture but for the sharpness of type"


def test_clean_pictures_have_no_bars(window):
    bars, clean = window.picture("bare_early", *BARE), window.picture("clean", *BARE, "--clean")
    dark = [np.abs(p[:40] - np.array([0x16, 0x19, 0x1F])).max(axis=2) < 6 for p in (bars, clean)]  # the tool bar's colour
    assert dark[0].mean() > 0.5 and dark[1].mean() < 0.1
    assert np.ptp(clean[-40:], axis=(0, 1)).max() < 120  # there is no time line either


def test_a_signal_ends_it_in_good_order(window, tmp_path):
    record = tmp_path / "signal.hid"
    start = time.monotonic()
    with window.started("play", ROUND, "--record", record, "--json") as process:
        wait_until_recorded(record)
        out, _ = end_by(process, signal.SIGTERM)
    summary = json.loads(out)[0]
    assert summary["frames"] > 0
    assert 0 < summary["first_frame_s"] < time.monotonic() - start
    again = json.loads(window.run("replay", record, *FOUR, "--json").stdout)[0]
    assert again["pose_hash"] == summary["pose_hash"]


def test_it_outlives_its_x_server_long_enough_to_finish(window, tmp_path):
    display = Display()
    record = tmp_path / "lost.hid"
    with window.started("play", ROUND, "--record", record, display=display) as process:
        wait_until_recorded(record)
        display.end(signal.SIGKILL)
        _, errors = end_by(process, status=1)
    assert len([line for line in errors.splitlines() if "display" in line]) == 1, errors
    window.run("replay", record, *FOUR)


needs_ffmpeg = pytest.mark.skipif(not (shutil.which("ffmpeg") and shutil.which("ffprobe")), reason="there is no ffmpeg")


@needs_ffmpeg
def test_a_video_has_as_many_frames_as_were_asked_for(window):
    video = window.pictures / "walk.mp4"
    window.run("replay", window.trace, "--view", "--frames", "20", "--video", video)
    probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                            "stream=nb_read_frames,width,height,r_frame_rate", "-of", "json", video],
                           capture_output=True, text=True, check=True)
    stream = json.loads(probe.stdout)["streams"][0]
    assert (stream["nb_read_frames"], stream["width"], stream["height"], stream["r_frame_rate"]) == ("20", 1280, 720, "60/1")


def test_without_a_display_pictures_are_made_and_a_window_is_one_sentence(window, tmp_path):
    path = tmp_path / "hidden.png"
    assert f"written to {path}" in window.run("play", window.trace, "--frames", "5", "--screenshot", path).stderr
    assert pixels(path).shape == (720, 1280, 3)
    for command in (["play"], ["replay", "--view"]):
        errors = window.run(*command, window.trace, status=1).stderr
        assert len(errors.strip().splitlines()) == 1 and "no display" in errors and "--screenshot" in errors, errors


def test_replay_view_writes_its_files_too(window, tmp_path):
    out = tmp_path / "out"
    done = window.run("replay", window.trace, "--view", "--frames", "3", "--screenshot", tmp_path / "x.png",
                      "--out", out, "--json")
    assert json.loads(done.stdout)["pose_hash"] == json.loads((out / "summary.json").read_text())["pose_hash"]


@pytest.mark.parametrize("arguments", [
    "play --no-window --frames 3", "play --frames 0", "play --screenshot x.jpg", "play --video x.avi", "play --theme grey",
    "play --panels pad,kitchen", "play --scale 9", "play --hide feet", "play --camera 90",
    "play --crowd -1", "play --crowd 100001", "play --crowd x", f"replay {ROUND} --frames 3",
    f"play {ROUND} --screenshot x.png --record x.hid"])
def test_wrong_usage_is_2(refuse, arguments):
    refuse(*arguments.split(), status=2, env=environment())


MOST_MIB = 250e6 / 2**20  # most memory of a program that makes pictures of any number of frames


def peak_mib(program, *arguments):
    """The kernel's own count of the program's greatest resident memory."""
    code = ("import resource, subprocess, sys\n"
            "subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)\n"
            "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)\n")
    done = subprocess.run([sys.executable, "-c", code, str(program), *map(str, arguments)], env=environment(),
                          capture_output=True, text=True, check=True, timeout=300)
    return float(done.stdout)


def test_a_still_needs_no_more_memory_for_more_frames(program, tmp_path):
    if has_sanitizers(program):
        pytest.skip("AddressSanitizer keeps freed memory")

    def peak(frames):
        return peak_mib(program, "play", ROUND, "--frames", frames, "--screenshot", tmp_path / "still.png", "--scale", "2", "--clean")
    few, many = peak(20), peak(600)
    print(f"{few:.0f} MiB after 20 frames, {many:.0f} MiB after 600")
    assert many < MOST_MIB and many < few + 20


def test_control_c_gives_a_still_up(started, tmp_path):
    picture = tmp_path / "still.png"
    picture.write_bytes(b"an earlier one")
    with started("play", ROUND, "--frames", "1000000", "--screenshot", picture, env=environment()) as process:
        wait_until_works(process)
        _, errors = end_by(process, signal.SIGINT, status=130)  # a million frames would take hours
    assert "no picture was written" in errors
    assert [p.name for p in tmp_path.iterdir()] == ["still.png"] and picture.read_bytes() == b"an earlier one"


@needs_ffmpeg
def test_control_c_gives_a_video_up(started, tmp_path):
    with started("play", ROUND, "--frames", "100000", "--video", tmp_path / "walk.mp4", env=environment()) as process:
        wait_until(lambda: any(p.name.startswith(".walk.mp4.") for p in tmp_path.iterdir()))
        end_by(process, signal.SIGTERM, status=143)
    assert list(tmp_path.iterdir()) == []


def test_a_missing_ffmpeg_is_named_before_the_work_begins(refuse, tmp_path):
    bare = {**environment(), "PATH": str(tmp_path)}
    refuse("play", tmp_path / "none.hid", "--frames", "5", "--video", tmp_path / "walk.mp4", env=bare,
           says=["ffmpeg is not installed", "sudo apt-get install ffmpeg"])
