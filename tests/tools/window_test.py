#!/usr/bin/python3
"""gaitpad play and replay --view: the real program on a display (Xvfb, Mesa), its pictures looked at.

The pictures stay in build/pictures. Skipped (77) where Xvfb, numpy or matplotlib is not there.
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = str(pathlib.Path(sys.argv[1]).resolve()) if len(sys.argv) > 1 else "gaitpad"
PICTURES = pathlib.Path(PROGRAM).parent / "pictures"
ROUND = str(ROOT / "config/traces/round.hid")
sys.path.insert(0, str(ROOT / "tests/session"))

if shutil.which("Xvfb") is None:
    print("skipped: there is no Xvfb (package xvfb)")
    sys.exit(77)
try:
    import matplotlib.colors
    import matplotlib.image
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

PANELS = ["pad", "control", "style", "graphs", "solver", "loop"]
FOUR = [word for style in ("even", "stiff_hip", "stiff_knee", "limp_left") for word in ("--style", style)]
# The characters' colours of the dark theme (Okabe and Ito's), by hue.
HUES = {"even": 0x56B4E9, "stiff_hip": 0xE69F00, "stiff_knee": 0x009E73, "limp_left": 0xCC79A7}
EARLY, LATE = 100, 130  # frames of a walk that begins at 0.1 s: 1.6 s and 2.1 s


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


def environment(display=None, **more):
    result = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")}
    if display:
        result.update(DISPLAY=display.name, SDL_VIDEODRIVER="x11")
    return {**result, **more}


def run(*arguments, display=None, env=None, **options):
    """Under AddressSanitizer the search for leaks itself crashes once in a thousand runs, among Mesa's threads that
    are just ending ("Tracer caught signal 11"). It found nothing then: it is made again."""
    for _ in range(2):
        done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False, timeout=180,
                              stdin=subprocess.DEVNULL, env=env or environment(display), **options)
        if "LeakSanitizer has encountered a fatal error" not in done.stderr:
            break
    return done


def walk_trace(path):
    """Ahead from 0.1 s on, in a slight curve."""
    subprocess.run([sys.executable, str(ROOT / "tests/session/make_trace.py"), str(path), "--stick", "0:0,0",
                    "--stick", "0.1:0.15,0.8", "--end", "8"], check=True)


def image(path):
    picture = matplotlib.image.imread(path)
    return np.round(picture[:, :, :3] * 255).astype(int)


class WindowCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.display = Display()
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.scratch.name)
        cls.trace = cls.folder / "walk.hid"
        walk_trace(cls.trace)
        PICTURES.mkdir(exist_ok=True)
        cls.taken = {}

    @classmethod
    def tearDownClass(cls):
        cls.display.end()
        cls.scratch.cleanup()

    def picture(self, name, *options, frames=EARLY):
        """Once each: the same options give the same picture."""
        if name not in self.taken:
            path = PICTURES / f"{name}.png"
            done = run("play", str(self.trace), "--frames", str(frames), "--screenshot", str(path), *options,
                       display=self.display)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.taken[name] = image(path)
        return self.taken[name]


SCENE_ROWS = slice(46, 628)  # between the bars, at scale 1


def coloured(picture, colour):
    """Pixels of a character in the scene: its hue, within 10 degrees, however lit; shoes are pale."""
    picture = picture[SCENE_ROWS]
    hsv = matplotlib.colors.rgb_to_hsv(picture / 255.0)
    rgb = np.array([(colour >> 16) & 255, (colour >> 8) & 255, colour & 255]) / 255.0
    hue = matplotlib.colors.rgb_to_hsv(rgb)[0]
    away = np.abs((hsv[:, :, 0] - hue + 0.5) % 1.0 - 0.5)
    return (away < 10 / 360) & (hsv[:, :, 1] > 0.2) & (hsv[:, :, 2] > 0.2)


BARE = ("--panels", "none", "--hide", "trails,source,names,grid,shadows")


class Scene(WindowCase):
    def test_every_characters_pixels_move_between_two_frames(self):
        early, late = self.picture("bare_early", *BARE), self.picture("bare_late", *BARE, frames=LATE)
        for name, colour in HUES.items():
            before, after = coloured(early, colour), coloured(late, colour)
            self.assertGreater(before.sum(), 1500, name)
            changed = (before != after).sum() / before.sum()
            self.assertGreater(changed, 0.08, name)
            # Legs swing more than the trunk sways; the camera follows it.
            rows = np.nonzero(before.any(axis=1))[0]
            hip = int((rows[0] + rows[-1]) / 2)
            legs = (before[hip:] != after[hip:]).sum() / before[hip:].sum()
            trunk = (before[:hip] != after[:hip]).sum() / before[:hip].sum()
            self.assertGreater(legs, trunk, name)

    def test_trails_grow(self):
        grown = []
        for name, frames in (("early", EARLY), ("late", LATE)):
            bare = self.picture(f"bare_{name}", *BARE, frames=frames)
            trails = self.picture(f"trails_{name}", "--panels", "none", "--hide", "source,names,grid,shadows",
                                  frames=frames)
            grown.append((np.abs(bare - trails).sum(axis=2) > 24).sum())
        self.assertGreater(grown[0], 100)
        self.assertGreater(grown[1], 1.2 * grown[0])

    def test_nothing_of_a_character_is_below_its_feet(self):
        standing = self.picture("bare_standing", *BARE, frames=2)
        lowest, heights = {}, {}
        for name, colour in HUES.items():
            rows, columns = np.nonzero(coloured(standing, colour))
            lowest[name] = (np.median(columns), np.percentile(rows, 99.9))
            heights[name] = rows.max() - rows.min()
        # They stand side by side: their feet lie on one line across the floor.
        x, y = np.array(list(lowest.values())).T
        slope, offset = np.polyfit(x, y, 1)
        self.assertLess(np.abs(slope * x + offset - y).max(), 4.0)
        # Walking, the foot ahead of a step is 0.35 of the height nearer at the most; the camera looks down on it by
        # 0.2 rad, which shows a fifth of that.
        walking = self.picture("bare_late", *BARE, frames=LATE)
        for name, colour in HUES.items():
            rows, columns = np.nonzero(coloured(walking, colour))
            line = slope * np.median(columns) + offset
            self.assertLess(rows.max() - line, 0.2 * heights[name], name)

    def test_a_picture_is_the_same_each_time(self):
        first = self.picture("again_1", frames=40)
        second = self.picture("again_2", frames=40)
        self.assertEqual(np.abs(first - second).max(), 0)


def plain_columns(picture, x_range, y_range):
    """Columns along which nothing is drawn but one colour."""
    part = picture[y_range[0]:y_range[1], x_range[0]:x_range[1]]
    return [x_range[0] + i for i in range(part.shape[1]) if (np.ptp(part[:, i], axis=0) <= 2).all()]


class Panels(WindowCase):
    def assert_sound(self, picture, name):
        self.assertGreater(picture.std(), 8.0, name)
        self.assertGreater(len(np.unique(picture.reshape(-1, 3), axis=0)), 300, name)

    def test_each_panel_is_drawn_and_keeps_its_text(self):
        none = self.picture("panel_none", "--panels", "none", frames=40)
        height, width = none.shape[:2]
        for panel in PANELS:
            picture = self.picture(f"panel_{panel}", "--panels", panel, frames=60 if panel == "graphs" else 40)
            self.assert_sound(picture, panel)
            # A column stands at the left or at the right; its edge to the scene is one line that no text crosses.
            left = (60, 330), (960, width - 60)
            edges = [plain_columns(picture, x_range, (60, height - 110)) for x_range in left]
            self.assertTrue(edges[0] or edges[1], f"{panel}: no edge of a panel")
            # What differs from the bare scene lies in the panel, but for the scene that moves aside.
            self.assertGreater((np.abs(picture - none).sum(axis=2) > 24).mean(), 0.05, panel)

    def test_light_is_lighter_than_dark(self):
        dark = self.picture("theme_dark", "--theme", "dark", frames=40)
        light = self.picture("theme_light", "--theme", "light", frames=40)
        self.assert_sound(light, "light")
        self.assertGreater(light.mean() - dark.mean(), 80.0)
        # Text is dark on light, light on dark: the extreme is on the other side of the mean.
        self.assertLess(np.percentile(light, 0.5), 90)
        self.assertGreater(np.percentile(dark, 99.5), 170)

    def test_scale_2_doubles_every_size(self):
        one = self.picture("theme_dark", "--theme", "dark", frames=40)
        two = self.picture("scale_2", "--theme", "dark", "--scale", "2", frames=40)
        self.assertEqual(two.shape[:2], (2 * one.shape[0], 2 * one.shape[1]))
        halved = two.reshape(one.shape[0], 2, one.shape[1], 2, 3).mean(axis=(1, 3))
        # The same picture but for the sharpness of type; the bars and panels lie where they lay.
        self.assertLess(np.abs(halved - one).mean(), 8.0)


class Program(WindowCase):
    def started(self, *arguments, display):
        process = subprocess.Popen([PROGRAM, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, env=environment(display))
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def recorded(self, record):
        """Waits until something was recorded."""
        part = pathlib.Path(str(record) + ".part")
        for _ in range(600):
            if part.exists() and part.stat().st_size > 2000:
                return
            time.sleep(0.05)
        self.fail("nothing is recorded")

    def test_a_signal_ends_it_in_good_order(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            record = self.folder / f"signal{number}.hid"
            process = self.started("play", ROUND, "--record", str(record), "--json", display=self.display)
            self.recorded(record)
            process.send_signal(number)
            out, errors = process.communicate(timeout=30)
            self.assertEqual(process.returncode, 0, errors)
            summary = json.loads(out)[0]
            self.assertGreater(summary["frames"], 0)
            again = run("replay", str(record), *FOUR, "--json")
            self.assertEqual(json.loads(again.stdout)[0]["pose_hash"], summary["pose_hash"])

    def test_it_outlives_its_x_server_long_enough_to_finish(self):
        display = Display()
        record = self.folder / "lost.hid"
        process = self.started("play", ROUND, "--record", str(record), display=display)
        self.recorded(record)
        display.end(signal.SIGKILL)
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 1, errors)
        told = [line for line in errors.splitlines() if "display" in line]
        self.assertEqual(len(told), 1, errors)
        self.assertEqual(run("replay", str(record), *FOUR).returncode, 0)

    def test_a_video_has_as_many_frames_as_were_asked_for(self):
        if shutil.which("ffmpeg") is None or shutil.which("ffprobe") is None:
            self.skipTest("there is no ffmpeg")
        video = PICTURES / "walk.mp4"
        done = run("replay", str(self.trace), "--view", "--frames", "20", "--video", str(video))
        self.assertEqual(done.returncode, 0, done.stderr)
        probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                "stream=nb_read_frames,width,height,r_frame_rate", "-of", "json", str(video)],
                               capture_output=True, text=True, check=True)
        stream = json.loads(probe.stdout)["streams"][0]
        self.assertEqual((stream["nb_read_frames"], stream["width"], stream["height"], stream["r_frame_rate"]),
                         ("20", 1280, 720, "60/1"))

    def test_without_a_display_pictures_are_made_and_a_window_is_one_sentence(self):
        path = self.folder / "hidden.png"
        done = run("play", str(self.trace), "--frames", "5", "--screenshot", str(path))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(image(path).shape, (720, 1280, 3))
        done = run("play", str(self.trace))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn("display", done.stderr)

    def test_replay_view_writes_its_files_too(self):
        out = self.folder / "out"
        done = run("replay", str(self.trace), "--view", "--frames", "3", "--screenshot", str(self.folder / "x.png"),
                   "--out", str(out), "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["pose_hash"],
                         json.loads((out / "summary.json").read_text())["pose_hash"])

    def test_wrong_usage_is_2(self):
        for arguments in (["play", "--no-window", "--frames", "3"], ["play", "--frames", "0"],
                          ["play", "--screenshot", "x.jpg"], ["play", "--video", "x.avi"],
                          ["play", "--theme", "grey"], ["play", "--panels", "pad,kitchen"], ["play", "--scale", "9"],
                          ["play", "--hide", "feet"], ["replay", ROUND, "--frames", "3"],
                          ["play", ROUND, "--screenshot", "x.png", "--record", "x.hid"]):
            done = run(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertEqual(done.stdout, "", arguments)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
