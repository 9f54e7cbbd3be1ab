"""Whose pace a motion walks at: stick 0.8 is a clip's own gait, `--pace adult` an adult's; a recording keeps it."""
import csv
import json

import pytest

from support import judge
from support.traces import EXACT_CALIBRATION, write_trace
from support.walk import Walk

OWN = 0.01  # allowed relative error of speed, steps and time, because stages last whole ticks
ADULT_STEP_M, ADULT_SPEED_M_S, ADULT_LEG_M = 0.7225, 1.5, 0.84  # an adult's values at full stick


class Paces:
    """A clip with unequal steps, made by a limping character, and walks of it."""

    def __init__(self, run, folder):
        self._run, self.folder, self.number = run, folder, 0
        (folder / "exact.toml").write_text(EXACT_CALIBRATION)
        write_trace(folder / "made.hid", [(0.5, 0, 0.7)], (), 12)
        run("replay", folder / "made.hid", "--out", folder, "--style", "limp_left")
        self.clip = folder / "pose.bvh"
        self.gait = json.loads(run("motion", self.clip, "--json").stdout)["gait"]

    def described(self, text):
        self.number += 1
        path = self.folder / f"described-{self.number}.toml"
        path.write_text(f'file = "{self.clip.name}"\n{text}\n')
        return path

    def out(self, trace, *options, motion=None):
        """Makes a replay and returns its folder."""
        self.number += 1
        folder = self.folder / f"out-{self.number}"
        self._run("replay", trace, "--out", folder, "--calibration", self.folder / "exact.toml",
                  "--motion", motion or self.clip, *options)
        return folder

    def walk(self, stick, *options, motion=None):
        """The last row of frames.csv and the summary of a straight walk."""
        trace = self.folder / "straight.hid"
        write_trace(trace, [(0.5, 0, stick)], (), 8)
        folder = self.out(trace, *options, motion=motion)
        with open(folder / "frames.csv", newline="") as file:
            *_, row = csv.DictReader(file)
        names = ("stride_left_m", "stride_right_m", "speed_m_s")
        return [float(row[n]) for n in names], json.loads((folder / "summary.json").read_text())


@pytest.fixture(scope="module")
def paces(run, tmp_path_factory):
    return Paces(run, tmp_path_factory.mktemp("paces"))


@pytest.mark.parametrize("stick, legs", [(0.8, 1.0), (0.4, 1.0), (1.0, 1.0), (0.8, 0.6)])
def test_stick_08_is_the_clips_own_gait(paces, stick, legs):
    """Speed is proportional to the stick, steps to its root; lengths scale with the legs, times with their 4th root."""
    gait, share = paces.gait, stick / 0.8
    assert gait["own_stick"] == 0.8 and gait["step_left_m"] < 0.7 * gait["step_right_m"], "the clip limps"
    (paces.folder / "legs.toml").write_text(f"leg_ratio = {legs}\n")
    numbers, summary = paces.walk(stick, "--character", paces.folder / "legs.toml")
    assert numbers == pytest.approx([legs * share ** 0.5 * gait["step_left_m"], legs * share ** 0.5 * gait["step_right_m"],
                                     legs ** 0.75 * share * gait["speed_m_s"]], rel=OWN)
    assert summary["pace"] == "own"


def test_the_feet_land_at_the_clips_own_steps(paces):
    write_trace(paces.folder / "long.hid", [(0.5, 0, 0.8)], (), 20)
    walk = Walk(paces.out(paces.folder / "long.hid"))
    for side, name in enumerate(("step_left_m", "step_right_m")):
        steps = [m for k, m in judge.realised_steps(walk, side) if walk.steady[k]]
        assert steps == pytest.approx([paces.gait[name]] * len(steps), rel=OWN) and len(steps) > 5


def test_adult_is_the_pace_of_an_adult(paces):
    for walked in (paces.walk(1.0, "--pace", "adult"), paces.walk(1.0, motion=paces.described('pace = "adult"'))):
        numbers, summary = walked
        legs = summary["leg_length_m"] / ADULT_LEG_M
        assert numbers == pytest.approx([legs * ADULT_STEP_M] * 2 + [legs ** 0.75 * ADULT_SPEED_M_S], rel=OWN)
        assert summary["pace"] == "adult"
    _, summary = paces.walk(0.8, "--pace", "own", motion=paces.described('pace = "adult"'))
    assert summary["pace"] == "own", "the option goes before the description"


def test_the_built_in_motion_has_the_adults_pace(paces):
    walks = [paces.walk(1.0, *options, motion="procedural") for options in ([], ["--pace", "own"], ["--pace", "adult"])]
    for numbers, summary in walks:
        assert numbers == pytest.approx([ADULT_STEP_M, ADULT_STEP_M, ADULT_SPEED_M_S], rel=OWN)
        assert (summary["pace"], summary["pose_hash"]) == ("adult", walks[0][1]["pose_hash"])


# --- recordings
def session_of(paces, option):
    """The straight walk as a recorded session: with ticks."""
    write_trace(paces.folder / "plain.hid", [(0.5, 0, 1.0)], (), 10)
    lines = (paces.folder / "plain.hid").read_text().splitlines(keepends=True)
    first = next(k for k, line in enumerate(lines) if line.startswith("E:"))
    ticks = []
    for line in lines[first:]:
        if line.startswith("E:"):
            ticks.append(f"T: {round(float(line.split()[1]) * 240)}\n")
        ticks.append(line)
    path = paces.folder / "session.hid"
    path.write_text("".join([lines[0], option, *lines[1:first], *ticks]))
    return path


def pace_of(folder):
    return json.loads((folder / "summary.json").read_text())["pace"]


@pytest.mark.parametrize("option, pace", [("", "adult"), ("O: pace own\n", "own"), ("O: pace adult\n", "adult"),
                                          ("O: colour red\n", "adult")], ids=repr)
def test_a_session_replays_at_its_pace_and_an_old_one_at_the_adults(paces, option, pace):
    session = session_of(paces, option)
    assert pace_of(paces.out(session)) == pace
    assert pace_of(paces.out(session, "--pace", "own")) == "own", "the option goes before the recording"


def test_a_made_trace_means_the_motions_pace(paces):
    write_trace(paces.folder / "plain.hid", [(0.5, 0, 1.0)], (), 2)
    assert pace_of(paces.out(paces.folder / "plain.hid")) == "own"


@pytest.mark.parametrize("options", [[], ["--pace", "adult"]], ids=" ".join)
def test_a_recorded_session_keeps_its_pace(run, paces, options):
    write_trace(paces.folder / "driven.hid", [(0.2, 0, 1.0)], (), 3)
    record = paces.folder / "recorded.hid"
    done = run("play", paces.folder / "driven.hid", "--no-window", "--json", "--seconds", "2", "--record", record,
               "--motion", paces.clip, *options)
    replayed = json.loads(run("replay", record, "--json", "--motion", paces.clip).stdout)
    assert f"O: pace {options[-1] if options else 'own'}\n" in record.read_text()
    assert replayed["pose_hash"] == json.loads(done.stdout)["pose_hash"]


def test_another_pace_is_wrong_usage_or_one_sentence(run, refuse, paces):
    write_trace(paces.folder / "plain.hid", [(0.5, 0, 1.0)], (), 2)
    run("replay", paces.folder / "plain.hid", "--pace", "brisk", status=2)
    refuse("replay", paces.folder / "plain.hid", "--motion", paces.described('pace = "brisk"'), says=('"brisk"', "own or adult"))
    (paces.folder / "bad.hid").write_text("O: pace brisk\n" + (paces.folder / "plain.hid").read_text())
    refuse("replay", paces.folder / "bad.hid", says='bad.hid:1: "brisk" is no pace')


def test_figures_take_it_too(run, tmp_path):
    run("figures", "--out", tmp_path, "--pace", "brisk", status=2)
