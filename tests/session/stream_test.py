"""`play --stream`: what other programs receive, as VMC messages by liblo's own receiver and as JSON, is the walk that
the session's recording replays to; the loop does not notice."""
import json
import shutil
import statistics
import time

import numpy as np
import pytest

from support.bvh import angle_between
from support.program import has_sanitizers
from support.streams import ExportedBones, OscDump, Receiver, free_ports, rotation_of, world_rotations
from support.traces import write_trace

NEAR_DEG, NEAR_M = 0.01, 1e-5
SECONDS = 4
MANY = 60 * SECONDS / 3  # a third of the frames, because a busy machine misses some
MIRROR = np.diag([-1.0, 1.0, 1.0])  # Unity's x grows to the right

needs_oscdump = pytest.mark.skipif(not shutil.which("oscdump"), reason="there is no oscdump (package liblo-tools)")


@pytest.fixture(scope="module")
def trace(tmp_path_factory):
    return write_trace(tmp_path_factory.mktemp("trace") / "walk.hid", [(0.3, 0.4, 0.9), (2.5, -0.3, 0.8)], (), 9)


@pytest.fixture(scope="module")
def played(run, trace, tmp_path_factory):
    """Plays a session that streams there, with these options; returns (summary, folder of its recording's replay)."""
    def play(address, *options):
        folder = tmp_path_factory.mktemp("played")
        done = run("play", trace, "--no-window", "--no-rumble", "--record", folder / "session.hid", "--json", "--seconds",
                   SECONDS, "--stream", address, *options)
        run("replay", folder / "session.hid", "--out", folder, "--gltf",
            *(o for o in options if not str(o).startswith("--stream") and not str(o).isdigit()))
        return json.loads(done.stdout), folder
    return play


@pytest.fixture(scope="module")
def json_stream(played):
    """The stream as (datagrams, bones of the replay, summary)."""
    with Receiver() as receiver:
        summary, folder = played(f"json://127.0.0.1:{receiver.port}")
    return receiver.frames(), ExportedBones(folder / "pose.glb"), summary


def test_bones_turn_as_the_exported_walk_does(json_stream):
    frames, exported, _ = json_stream
    assert len(frames) > MANY
    worst = 0.0
    for frame in frames:
        streamed = world_rotations(frame["bones"], frame["root"])
        expected = exported.rotations(frame["tick"])
        assert streamed.keys() == expected.keys()
        worst = max(worst, *(float(angle_between(streamed[bone], expected[bone])) for bone in expected))
    assert worst < NEAR_DEG, worst
    moved = [world_rotations(f["bones"], f["root"])["LeftUpperLeg"] for f in frames]
    assert max(float(angle_between(moved[0], turn)) for turn in moved) > 15, "nothing walks"


def test_hips_are_where_the_exported_walk_has_them(json_stream):
    frames, exported, _ = json_stream
    hips = exported.index["Hips"]
    for frame in frames:
        place_m = np.array(frame["root"][:3]) + rotation_of(frame["root"]) @ frame["bones"]["Hips"][:3]
        assert np.abs(place_m - exported.place_m[frame["tick"], hips]).max() < NEAR_M
        assert frame["root"][1] == 0.0 and np.abs(frame["bones"]["Hips"][:3:2]).max() < 1e-6, "the root is below the hips"
    assert np.linalg.norm(np.subtract(frames[-1]["root"][:3], frames[0]["root"][:3])) > 1.0, "nothing walks"


def test_a_frame_says_whose_and_when_it_is(json_stream):
    frames, _, summary = json_stream
    assert {frame["source"] for frame in frames} == {1}
    ticks = [frame["tick"] for frame in frames]
    assert ticks == sorted(ticks) and ticks[-1] > 240
    assert all(frame["time_s"] == pytest.approx(frame["tick"] / 240, abs=1e-6) for frame in frames)
    assert summary["streamed"] == len(frames)
    assert 3.5 < statistics.median(np.diff(ticks)) < 13, "60 poses of 240 ticks; a busy machine misses some"


@needs_oscdump
def test_liblo_receives_the_same_walk_as_vmc_messages(played):
    port = free_ports(1)
    with OscDump(port) as receiver:
        time.sleep(0.5)
        _, folder = played(f"osc://127.0.0.1:{port}")
        messages = receiver.messages()
    exported = ExportedBones(folder / "pose.glb")
    assert {path for path, _, _ in messages} == {"/VMC/Ext/OK", "/VMC/Ext/T", "/VMC/Ext/Root/Pos", "/VMC/Ext/Bone/Pos"}
    frames, worst = 0, 0.0
    for i, (path, types, values) in enumerate(messages):
        if path == "/VMC/Ext/OK":
            assert (types, values) == ("i", [1])
        if path != "/VMC/Ext/T" or i + 2 + len(exported.index) > len(messages):
            continue
        assert types == "f"
        tick = round(values[0] * 240)
        root, *bones = messages[i + 1:i + 2 + len(exported.index)]
        assert root[:2] == ("/VMC/Ext/Root/Pos", "sfffffff") and root[2][0] == "root"
        places = {bone[2][0]: bone[2][1:] for bone in bones}
        assert places.keys() == exported.index.keys() and {bone[1] for bone in bones} == {"sfffffff"}
        received, expected = world_rotations(places, root[2][1:]), exported.rotations(tick)
        worst = max(worst, *(float(angle_between(received[b], MIRROR @ expected[b] @ MIRROR)) for b in expected))
        hips_m = exported.place_m[tick, exported.index["Hips"]]
        assert root[2][1] == pytest.approx(-hips_m[0], abs=NEAR_M) and root[2][3] == pytest.approx(hips_m[2], abs=NEAR_M)
        frames += 1
    assert frames > MANY and worst < NEAR_DEG, (frames, worst)


def test_each_character_has_a_port(played):
    first = free_ports(2)
    with Receiver(first) as one, Receiver(first + 1) as two:
        played(f"json://:{first}", "--character", "adult", "--character", "child", "--stream-fps", 30)
    assert {(f["source"], f["character"]) for f in one.frames()} == {(1, "adult")}
    assert {(f["source"], f["character"]) for f in two.frames()} == {(2, "child")}
    assert two.frames()[0]["hips_m"] < one.frames()[0]["hips_m"]
    assert MANY / 2 < len(one.datagrams) <= 30 * SECONDS + 1


def test_another_address_is_taken_when_it_is_given(run, trace):
    with Receiver(address="::1") as receiver:
        run("play", trace, "--no-window", "--seconds", 1, "--stream", f"json://[::1]:{receiver.port}")
    assert receiver.datagrams


@pytest.mark.parametrize("address, says", [
    ("udp://127.0.0.1:1", "is no stream"), ("json", None), ("osc://:70000", "1 .. 65535"), ("json://[::1", "has no ]"),
    ("json://no-such-host.invalid:39540", "no-such-host.invalid"), ("json://127.0.0.1:65535", "2 characters")])
def test_an_address_that_is_none_is_one_sentence(refuse, run, trace, address, says):
    options = ("play", trace, "--no-window", "--seconds", 1, "--stream", address, "--style", "even", "--style", "tired")
    if says is None:
        run(*options)
    else:
        refuse(*options, says=says)


def test_a_rate_without_a_stream_is_wrong_usage(run, trace):
    run("play", trace, "--no-window", "--stream-fps", 30, status=2)


def test_a_tick_does_not_notice(run, program, trace):
    """Alternates runs with and without a stream at a high rate, so that other load affects both. Ticks copy their poses
    and never wait: their time grows by a few microseconds at most."""
    if has_sanitizers(program):
        pytest.skip("times under a sanitizer say nothing about the program")
    took_us = {"": [], "json": []}
    with Receiver() as receiver:
        for _ in range(4):
            for name in took_us:
                stream = ["--stream", f"json://127.0.0.1:{receiver.port}", "--stream-fps", 240] if name else []
                done = run("play", trace, "--no-window", "--no-rumble", "--json", "--seconds", 1, *stream)
                took_us[name].append(json.loads(done.stdout)["tick_us_median"])
    assert len(receiver.datagrams) > 100
    assert min(took_us["json"]) < 1.5 * min(took_us[""]) + 10, took_us
