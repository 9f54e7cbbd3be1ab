"""tools/blender/gaitpad_live.py: it guesses bones by the program's rules, and in Debian's Blender it moves an armature
like the exported walk, pose by pose and as recorded key frames."""
import ast
import json
import math
import re
import shutil
import socket
import subprocess
import sys
import types
from unittest import mock

import numpy as np
import pytest

from support.program import DATA, ROOT
from support.streams import Receiver, hostile, world_rotations
from support.traces import write_trace

ADDON = ROOT / "tools/blender/gaitpad_live.py"
ANATOMY = (ROOT / "src/motion/anatomy.cpp").read_text()
CLIP = DATA / "mocap/cmu_006_01_iclone.bvh"
FRAMES = 30
NEAR_DEG = 0.01
DATAGRAMS = 100_000


@pytest.fixture(scope="module")
def addon():
    """Loads the add-on without Blender, with an empty user interface."""
    blender = types.SimpleNamespace(props=mock.MagicMock(), app=mock.MagicMock(),
                                    types=types.SimpleNamespace(PropertyGroup=object, Operator=object, Panel=object))
    modules = {"bpy": blender, "mathutils": mock.MagicMock()}
    with mock.patch.dict(sys.modules, modules):
        scope = {"__name__": "gaitpad_live"}
        exec(compile(ADDON.read_text(), str(ADDON), "exec"), scope)  # noqa: S102
    return types.SimpleNamespace(**scope)


# --- the rules of names ---------------------------------------------------------------------------------------------
def words_of(table):
    return set(" ".join(re.findall(r'"([\w ]+)"', re.search(rf"{table} =(.*?)[,;]", ANATOMY, re.S)[1])).split())


def test_the_words_are_those_of_the_program(addon):
    parts = {word: part for part, words in re.findall(r'\{NamedPart::(\w+), "([\w ]+)"\}', ANATOMY)
             for word in words.split()}
    assert len(parts) > 40 and addon.PART_WORDS == parts
    for ours, table in ((addon.NECK_WORDS, "kNeckWords"), (addon.HEAD_WORDS, "kHeadWords"),
                        (addon.HELPER_WORDS, "kHelperWords"), (addon.BESIDE_ARM_WORDS, "kBesideArmWords"),
                        (addon.BESIDE_LEG_WORDS, "kBesideLegWords")):
        assert ours == words_of(table), table


def test_names_mean_what_they_mean_to_the_program(addon):
    """The cases of the program's own test."""
    text = (ROOT / "tests/motion/anatomy_test.cpp").read_text()
    cases = re.findall(r'\{"([^"]+)", ([LRN]), NamedPart::(\w+)\}', text)
    assert len(cases) > 20
    for name, side, part in cases:
        said = addon.named_joint(name)
        if part == "none":
            assert said[1] is None, name
        else:
            assert said == ({"L": "Left", "R": "Right"}[side], part), name


class Bone:
    def __init__(self, name, parent):
        self.name, self.parent = name, parent

    @property
    def parent_recursive(self):
        return [] if self.parent is None else [self.parent, *self.parent.parent_recursive]


def bones_of(tree, parent=None):
    """The bones of nested dictionaries, parents first."""
    for name, below in tree.items():
        bone = Bone(name, parent)
        yield bone
        yield from bones_of(below, bone)


def test_bones_of_usual_armatures_are_found(addon):
    def leg(s):
        return {f"thigh.{s}": {f"shin.{s}": {f"foot.{s}": {f"toe.{s}": {}, f"heel.02.{s}": {}}}}}

    def arm(s):
        return {f"shoulder.{s}": {f"upper_arm.{s}": {f"forearm.{s}": {f"hand.{s}": {f"palm.01.{s}": {}}}}}}

    rigify = {"spine": {**leg("L"), **leg("R"), "spine.001": {"spine.002": {"spine.003": {
        **arm("L"), **arm("R"), "neck": {"head": {}}}}}}}
    found = addon.guessed_bones(list(bones_of(rigify)))
    assert found == {"Hips": "spine", "Spine": "spine.001", "Chest": "spine.002", "UpperChest": "spine.003", "Neck": "neck",
                     "Head": "head", "LeftUpperLeg": "thigh.L", "LeftLowerLeg": "shin.L", "LeftFoot": "foot.L",
                     "LeftToes": "toe.L", "RightUpperLeg": "thigh.R", "RightLowerLeg": "shin.R", "RightFoot": "foot.R",
                     "RightToes": "toe.R", "LeftShoulder": "shoulder.L", "LeftUpperArm": "upper_arm.L",
                     "LeftLowerArm": "forearm.L", "LeftHand": "hand.L", "RightShoulder": "shoulder.R",
                     "RightUpperArm": "upper_arm.R", "RightLowerArm": "forearm.R", "RightHand": "hand.R"}
    assert addon.guessed_bones(list(bones_of({"Root": {"Box": {}}}))) == {}


# --- in Blender -----------------------------------------------------------------------------------------------------
# Directions of limbs in a T pose: x to the left, y up, z forward.
LIMBS = {"LeftUpperLeg": (0, -1, 0), "RightLowerLeg": (0, -1, 0), "LeftLowerLeg": (0, -1, 0), "LeftUpperArm": (1, 0, 0),
         "RightUpperArm": (-1, 0, 0), "RightLowerArm": (-1, 0, 0)}

# Another body, an injury and, if captures are present, a skeleton of a hundred joints.
OPTIONS = ("--style", "limp_left", "--character", "child", *(("--motion", CLIP) if CLIP.exists() else ()))


def streamed(run, folder, *options):
    """The datagrams of a session, and the export of its recording's replay."""
    trace = write_trace(folder / "walk.hid", [(0.2, 0.4, 0.9)], (), 9)
    with Receiver() as receiver:
        run("play", trace, "--no-window", "--record", folder / "session.hid", "--seconds", 2.5, *options,
            "--stream", f"json://127.0.0.1:{receiver.port}")
    run("replay", folder / "session.hid", "--out", folder, "--gltf", *options)
    return receiver.datagrams[-FRAMES:]


@pytest.mark.skipif(not shutil.which("blender"), reason="there is no blender (package blender)")
def test_blender_walks_as_the_exported_walk_does(run, tmp_path):
    datagrams = streamed(run, tmp_path, *OPTIONS)
    assert len(datagrams) == FRAMES
    command = ["blender", "-b", "--factory-startup", "-P", ROOT / "tests/tools/blender_live.py", "--", ADDON,
               tmp_path / "pose.glb", str(FRAMES), "240"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as blender:
        said = []
        for line in blender.stdout:
            said.append(line)
            if line.startswith('{"port"'):
                break
        assert said and said[-1].startswith('{"port"'), "".join(said)
        start = json.loads(said[-1])
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for datagram in datagrams:  # each after the one before was processed, so a slow machine passes
                sender.sendto(datagram, ("127.0.0.1", start["port"]))
                said.append(next(blender.stdout))
        rest = "".join(said) + blender.communicate(timeout=120)[0]
    rows = [json.loads(line) for line in rest.splitlines() if line.startswith("{")]
    posed, recorded = [r for r in rows if "tick" in r], [r for r in rows if "recorded" in r]
    assert len(posed) == len(recorded) == FRAMES, rest[-3000:]
    assert len(start["bones"]) >= 19 and {"Hips", "Spine", "Head", "LeftFoot", "RightHand"} <= start["bones"].keys()
    assert max(max(row["degrees"].values()) for row in posed) < NEAR_DEG
    assert max(max(row["degrees"].values()) for row in recorded) < NEAR_DEG
    assert max(row["hips_gap_m"] for row in posed) < 5e-4  # Blender computes in single precision
    assert rows[-1] == {"stored": True}, "the map of the bones, in a .blend file"
    frames = [json.loads(datagram) for datagram in datagrams]
    assert [row["tick"] for row in posed] == [frame["tick"] for frame in frames]
    for row, frame in zip(posed, frames):
        turns = world_rotations(frame["bones"], frame["root"])
        assert set(LIMBS) <= row["made"].keys()
        for bone, aim in LIMBS.items():
            aside = math.degrees(np.linalg.norm(np.cross(turns[bone] @ aim, row["made"][bone])))
            assert aside < NEAR_DEG and (turns[bone] @ aim) @ row["made"][bone] > 0, (bone, aside)


@pytest.mark.skipif(not shutil.which("blender"), reason="there is no blender (package blender)")
def test_blender_takes_what_is_sound_of_hundred_thousand_datagrams(run, tmp_path):
    """Each read of the stream is bounded, and malformed datagrams are skipped."""
    frame = json.loads(streamed(run, tmp_path)[-1])
    rng = np.random.default_rng(34)
    (tmp_path / "datagrams").write_bytes(b"".join(len(d).to_bytes(4, "little") + d
                                                  for d in (hostile(frame, rng) for _ in range(DATAGRAMS))))
    (tmp_path / "frame.json").write_text(json.dumps(frame))
    done = subprocess.run(["blender", "-b", "--factory-startup", "-P", ROOT / "tests/tools/blender_flood.py", "--", ADDON, tmp_path],
                          capture_output=True, text=True, timeout=280, check=False)
    said = [line for line in done.stdout.splitlines() if line.startswith("{")]
    assert said, done.stdout[-3000:] + done.stderr
    row = json.loads(said[-1])
    assert row["looked_at"] == DATAGRAMS and row["most_at_once"] == 256
    assert row["malformed"] + row["taken"] == DATAGRAMS and row["malformed"] > DATAGRAMS / 2
    assert row["listens"] and row["still_walks"] and row["is_finite"]


def test_the_addon_is_one_file_of_python_3_10():
    """Blender 3.4 has Python 3.10 or Debian's 3.11."""
    ast.parse(ADDON.read_text(), feature_version=(3, 10))
