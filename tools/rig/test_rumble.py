"""A beat at each heel strike, stronger for a faster walk, and the stop after it, from the packets that the pad
receives."""
import time

import pytest

from cells import cells
from pads import Pad
from session import IDS, Session, remark
from test_matrix import DRIVERS, VALUES

# First bytes of the packets, and places of the strengths (strong, weak) in them.
PACKETS = {"ds4": (b"\x05", 5, 4), "dualsense": (b"\x02", 4, 3), "xbox360": (b"\x00\x08", 3, 4), "xboxone": (b"\x09", 8, 9)}


def beats(pad, since_ns):
    """The runs of the motors as [(time in ns, strong, end in ns)]."""
    start, strong, weak = PACKETS[pad.kind]
    runs = []
    for packet in pad.out_packets(since_ns):
        if not packet.data.startswith(start):
            continue
        level = packet.data[strong]
        if level and (not runs or runs[-1][2] is not None):
            runs.append([packet.ns, level, None])
        elif not level and not packet.data[weak] and runs and runs[-1][2] is None:
            runs[-1][2] = packet.ns
    return runs


@pytest.mark.timeout(120)
@pytest.mark.parametrize("case", cells({kind: DRIVERS[kind] for kind in PACKETS}))
def test_heel_strikes_are_felt(case):
    kind, driver = case.split("-")
    rest, full = VALUES[kind]["rest"], VALUES[kind]["forward"]
    half = rest + (full - rest) * 6 // 10
    with Pad(kind) as pad, Session(IDS[kind], "--driver", driver, name=f"rumble-{case}") as session:
        pad.set(ly=rest)
        time.sleep(0.3)
        walked_ns = time.monotonic_ns()
        pad.set(ly=half)
        time.sleep(3.0)
        middle_ns = time.monotonic_ns()
        pad.set(ly=full)
        time.sleep(3.0)
        pad.set(ly=rest)
        time.sleep(2.5)
        runs = beats(pad, walked_ns)
    frames = session.frames()
    strikes = sum(a["stage"] == "flight" and b["stage"] == "roll" for a, b in zip(frames, frames[1:]))
    assert strikes >= 6, f"{strikes} heel strikes"
    assert abs(len(runs) - strikes) <= 1, f"{len(runs)} beats for {strikes} heel strikes"
    assert all(end is not None for _, _, end in runs), runs
    lengths_s = sorted((end - start) / 1e9 for start, _, end in runs)
    # On a busy host a single beat may begin or end late.
    assert 0.02 < lengths_s[1] and lengths_s[len(lengths_s) // 2] < 0.18 and lengths_s[-1] < 1.0, runs
    slow = [level for start, level, _ in runs if walked_ns + 1.5e9 < start < middle_ns]
    fast = [level for start, level, _ in runs if middle_ns + 1.5e9 < start < middle_ns + 3e9]
    assert slow and fast and max(slow) < min(fast), (slow, fast)
    remark(f"rumble, {case}: {len(runs)} beats for {strikes} heel strikes, strength {slow[-1]} slow, {fast[-1]} fast")


def test_no_rumble_is_quiet():
    with Pad("dualsense") as pad, Session(IDS["dualsense"], "--driver", "hidraw", "--no-rumble", name="quiet"):
        since = time.monotonic_ns()
        pad.set(ly=128)
        time.sleep(0.2)
        pad.set(ly=0)
        time.sleep(2.0)
        assert not beats(pad, since)
