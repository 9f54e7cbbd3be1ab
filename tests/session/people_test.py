"""The built-in walk beside people (people.py), where it is within what was measured of them; docs/measured.md has all rows."""
import pytest

from session import people
from session.transitions import Player

STICK = 0.8  # gives a walk of about 110 steps a minute


@pytest.fixture(scope="module")
def walk(program, tmp_path_factory):
    return Player(program, tmp_path_factory.mktemp("even")).walk((0.5, 0, STICK), end_s=10.0)


def within(value, bounds):
    return bounds[0] <= value <= bounds[1]


def test_a_walk_at_a_persons_cadence_bends_the_joints_as_people_do(walk):
    assert within(people.cadence(walk), people.CADENCE)
    for joint, off_deg in people.differences(walk).items():
        assert off_deg <= people.PEOPLE[joint][0], joint


def test_the_toe_clears_the_ground_as_far_as_peoples(walk):
    assert within(people.toe_clearance_mm(walk), people.TOE_MM)


def test_a_walk_backwards_is_not_that_of_people(program, tmp_path):
    back = Player(program, tmp_path).walk((0.5, 0, -STICK), end_s=10.0)
    for joint, off_deg in people.differences(back).items():
        assert off_deg > people.PEOPLE[joint][0], joint


def test_rows_tell_the_value_that_is_furthest_out():
    row = people.row("turn", [1.5, 2.5, 2.3, 1.0], (1.4, 2.2), "s")
    assert (row["worst"], row["failed"], row["runs"]) == (1.0, 3, 4)
