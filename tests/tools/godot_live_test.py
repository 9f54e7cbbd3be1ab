"""tools/examples/godot: in Debian's Godot, the example's skeleton has the streamed pose."""
import json
import math
import shutil
import socket
import subprocess

import numpy as np
import pytest

from support.bvh import angle_between, matrices_of
from support.program import ROOT
from support.streams import PARENTS, hostile, world_rotations

GODOT = shutil.which("godot3-server") or shutil.which("godot3")
PORT = 39540


def made_frames():
    """A stream without gaitpad: every bone turns about an axis of its own while the figure walks in a circle."""
    rng = np.random.default_rng(18)
    axes = {bone: v / np.linalg.norm(v) for bone, v in zip(PARENTS, rng.normal(size=(len(PARENTS), 3)))}

    def place(m, axis, angle_rad):
        return [*m, *(math.sin(angle_rad / 2) * np.asarray(axis)), math.cos(angle_rad / 2)]

    for tick in range(20):
        angle = 0.05 * tick
        bones = {bone: place([0, 0.92 + 0.01 * math.sin(angle), 0] if bone == "Hips" else [0, 0, 0], axes[bone], angle)
                 for bone in PARENTS}
        yield {"source": 1, "character": "made", "tick": tick, "time_s": tick / 60, "hips_m": 0.92,
               "root": place([math.cos(angle), 0, math.sin(angle)], [0, 1, 0], -angle), "bones": bones}


@pytest.mark.skipif(not GODOT, reason="there is no Godot 3 (package godot3-server)")
def test_the_skeleton_stands_as_the_stream_says(tmp_path):
    project = shutil.copytree(ROOT / "tools/examples/godot", tmp_path / "godot")
    # Godot keeps what it prints into a pipe, so stdbuf.
    godot = subprocess.Popen(["stdbuf", "-oL", "timeout", "120", GODOT, "--path", project, "-s", ROOT / "tests/tools/godot_live.gd"], text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env={"HOME": str(tmp_path), "PATH": "/usr/bin"})
    frames = list(made_frames())
    try:
        said = []
        for line in godot.stdout:
            said.append(line)
            if line.strip() == "ready" or "SCRIPT ERROR" in line:
                break
        assert said[-1:] == ["ready\n"], "".join(said)
        said.clear()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for frame in frames:  # each after the one before was processed, so a slow machine passes
                sender.sendto(json.dumps(frame).encode(), ("127.0.0.1", PORT))
                said.append(godot.stdout.readline())
            sender.sendto(json.dumps({**frames[0], "tick": -1}).encode(), ("127.0.0.1", PORT))
        rest = "".join(said) + godot.communicate(timeout=60)[0]
    finally:
        godot.terminate()  # `timeout` also ends Godot
    assert "ERROR" not in rest, rest
    rows = {row["tick"]: row["bones"] for row in (json.loads(line) for line in rest.splitlines() if line[:1] == "{")}
    assert len(rows) == len(frames), rest
    for frame in frames:
        bones = rows[frame["tick"]]
        expected = world_rotations(frame["bones"], frame["root"])
        for bone, turn in expected.items():
            if bone in bones:  # a figure may have no collar bones
                seen = matrices_of(np.roll(np.array(bones[bone][3:]), 1))
                assert float(angle_between(seen, turn)) < 0.05, (bone, frame["tick"])
        hips_m = np.array(frame["root"][:3]) + [0, frame["bones"]["Hips"][1], 0]
        assert np.abs(bones["Hips"][:3] - hips_m).max() < 1e-4
        thigh = np.array(bones["LeftLowerLeg"][:3]) - bones["LeftUpperLeg"][:3]
        assert np.abs(thigh - expected["LeftUpperLeg"] @ [0, -0.41, 0]).max() < 1e-4


@pytest.mark.skipif(not GODOT, reason="there is no Godot 3 (package godot3-server)")
def test_hundred_thousand_datagrams_end_no_link(tmp_path):
    """Godot reads hostile ones from a file as from its socket, then a sound one."""
    frame = list(made_frames())[3]
    rng = np.random.default_rng(35)
    project = shutil.copytree(ROOT / "tools/examples/godot", tmp_path / "godot")
    (project / "datagrams").write_bytes(b"".join(len(d).to_bytes(4, "little") + d
                                                 for d in (hostile(frame, rng) for _ in range(100_000))))
    (project / "frame.json").write_text(json.dumps(frame))
    done = subprocess.run(["timeout", "250", GODOT, "--path", project, "-s", ROOT / "tests/tools/godot_flood.gd"], text=True,
                          capture_output=True, check=False, env={"HOME": str(tmp_path), "PATH": "/usr/bin"})
    assert "SCRIPT ERROR" not in done.stdout + done.stderr, (done.stdout + done.stderr)[-3000:]
    row = json.loads(next(line for line in done.stdout.splitlines() if line.startswith("{")))
    assert row["looked_at"] == 100_000 and row["most_at_once"] == 64
    assert row["malformed"] > 50_000 and row["still_walks"] and row["is_finite"]
