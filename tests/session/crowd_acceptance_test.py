"""The first 32 of 1,000 characters that walk behind a session's own, judged from their exported files alone: contacts, the
stages of Table I, the floor, and how smoothly legs turn, as single walkers are (acceptance.py)."""
import json

from support import judge
from support.judge import Check
from support.traces import write_trace
from support.walk import Walk

JUDGED = 32


def checks_of(walk):
    # Members follow their places in the crowd, so their sticks change all the time: legs as while a stick changes.
    legs = [check for check in judge.leg_checks(walk) if check.name.startswith("leg d2") and check.bound is not None]
    return judge.file_checks(walk) + judge.stage_checks(walk) + judge.contact_checks(walk) + \
        [Check("leg d2", max(check.value for check in legs), 1.0, unit="deg/tick2",
               note=max(legs, key=lambda check: check.value).note)]


def test_members_of_a_crowd_keep_the_bounds_of_single_walkers(run, pytestconfig, tmp_path):
    size = 64 if pytestconfig.getoption("--quick") else 1000
    trace = tmp_path / "trace.hid"
    write_trace(trace, [(0.5, 0.0, 0.8), (5.0, 0.3, 0.7), (7.0, 0.0, 0.5), (9.0, 0.0, 0.0)], (), 12.0, comment="crowd")
    run("replay", trace, "--crowd", size, "--out", tmp_path)
    assert json.loads((tmp_path / "summary.json").read_text())["crowd"] == size
    worst, broken = {}, []
    for index in range(2, 2 + JUDGED):
        walk = Walk(tmp_path, index=index)
        assert sum(walk.summary[f"steps_{side}"] for side in ("left", "right")) > 8
        for check in checks_of(walk):
            if check.bound is None:
                continue
            if check.name not in worst or check.value > worst[check.name].value:
                worst[check.name] = check
            if not check.ok:
                broken.append(f"member {index - 1}: {judge.table([check])}")
    print(judge.table(worst.values()))
    assert not broken, "\n".join(broken)
