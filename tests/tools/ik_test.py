"""gaitpad ik: the CSV of a solve, and what is refused."""
import csv
import math

import pytest

GOAL = (0.1, -0.6, 0.2)
CHAIN = """goal_m = [0.1, -0.6, 0.2]
tolerance_m = 1e-6
[[dof]]
axis = [1, 0, 0]
angle_rad = 0.1
weight = 0.5
[[dof]]
axis = [0, 0, 1]
link_m = [0, -0.4, 0]
angle_rad = 0.2
[[dof]]
axis = [1, 0, 0]
link_m = [0, -0.4, 0]
angle_rad = 0.6
"""


def end_of(angles):
    """The end of the chain Rx(a) Rz(b) link Rx(c) link."""
    a, b, c = angles
    turn_x = lambda v, t: (v[0], v[1] * math.cos(t) - v[2] * math.sin(t), v[1] * math.sin(t) + v[2] * math.cos(t))
    turn_z = lambda v, t: (v[0] * math.cos(t) - v[1] * math.sin(t), v[0] * math.sin(t) + v[1] * math.cos(t), v[2])
    below = turn_x((0, -0.4, 0), c)
    return turn_x(turn_z((below[0], below[1] - 0.4, below[2]), b), a)


@pytest.fixture
def chain(tmp_path):
    """Writes a chain with this text and returns its path."""
    def write(text=CHAIN):
        (tmp_path / "chain.toml").write_text(text)
        return tmp_path / "chain.toml"
    return write


@pytest.fixture(params=["paper", "robust"])
def rows(request, run, chain):
    lines = list(csv.reader(run("ik", chain(), "--mode", request.param).stdout.splitlines()))
    assert lines[0] == ["iteration", "angle_0_rad", "angle_1_rad", "angle_2_rad", "error_m"]
    return [[float(x) for x in line] for line in lines[1:]]


def test_rows_begin_at_the_start_and_end_at_the_goal(rows):
    assert [r[0] for r in rows] == list(range(len(rows)))
    assert rows[0][1:4] == [0.1, 0.2, 0.6]
    assert math.dist(end_of(rows[-1][1:4]), GOAL) < 2e-6


def test_each_rows_error_is_its_poses_distance_from_the_goal(rows):
    for row in rows:
        assert row[4] == pytest.approx(math.dist(end_of(row[1:4]), GOAL), abs=1e-7)  # nine digits of each angle


@pytest.mark.parametrize("text, says", [(CHAIN + "speed = 1\n", ":15: unknown key"), (CHAIN.replace("0.5", "1.5"), ":6: "),
                                        ("goal_m = [0, 0]\n", ":1: ")], ids=["unknown key", "weight", "goal"])
def test_refuses_with_one_sentence_that_names_the_line(refuse, chain, text, says):
    refuse("ik", chain(text), says="chain.toml" + says)


def test_no_file_is_a_failure_and_no_mode_a_usage_error(run, chain):
    run("ik", "/none.toml", status=1)
    run("ik", chain(), "--mode", "fast", status=2)


def test_the_papers_mode_says_which_step_sent_an_angle_out_of_the_circle(run, chain):
    wild = chain(CHAIN.replace("weight = 0.5", "weight = 0.2").replace("tolerance_m = 1e-6\n", ""))
    done = run("ik", wild, "--mode", "paper")
    rows = [[float(x) for x in line] for line in list(csv.reader(done.stdout.splitlines()))[1:]]
    steps = [(abs(b[j] - a[j]), int(b[0]), j - 1, b[j] - a[j]) for a, b in zip(rows, rows[1:]) for j in (1, 2, 3)]
    size, iteration, joint, turn = max(steps)
    assert size > 1000, "the chain is tame"
    assert f"iteration {iteration} turns angle_{joint} by {turn:.4g} rad" in done.stderr
    assert "singular" in done.stderr and "--mode robust" in done.stderr
    assert run("ik", wild, "--mode", "robust").stderr == ""
