"""Which robots count as on the field."""

from __future__ import annotations

import pytest

from robobt.world import DIVISION_B, BallState, Frame, RobotState, Team
from robobt.world.field import DIVISION_A
from robobt.world.game import GameState, RefereeCommand, TeamStatus
from robobt.world.presence import taken_off, without_absent

FIELD = DIVISION_B
OUTSIDE = FIELD.half_width + 0.15


def team(*places: tuple[float, float]) -> list[RobotState]:
    return [RobotState(number, x, y) for number, (x, y) in enumerate(places)]


@pytest.mark.parametrize("y", [OUTSIDE, -OUTSIDE])
def test_a_robot_too_many_is_off_once_it_stands_beside_the_half_way_line(y: float) -> None:
    robots = team((-4.0, 0.0), (0.9, y), (1.0, 1.0))
    assert taken_off(FIELD, robots, 2) == {1}
    assert taken_off(FIELD, robots, 3) == frozenset()
    assert taken_off(FIELD, robots, None) == frozenset()


@pytest.mark.parametrize(("x", "y"), [(1.01, OUTSIDE), (0.0, FIELD.half_width - 0.01)])
def test_a_robot_elsewhere_is_not_off(x: float, y: float) -> None:
    assert taken_off(FIELD, team((-4.0, 0.0), (x, y)), 1) == frozenset()


def test_no_more_robots_are_off_than_there_are_too_many() -> None:
    robots = team((-4.0, 0.0), (0.0, OUTSIDE), (0.5, -OUTSIDE), (1.0, 0.0))
    assert taken_off(FIELD, robots, 3) == {2}
    assert taken_off(FIELD, robots, 2) == {1, 2}
    assert taken_off(FIELD, robots, 1) == {1, 2}


BEHIND = DIVISION_A.half_length + 0.39


def test_in_division_a_a_robot_too_many_is_off_behind_its_own_goal_line_too() -> None:
    robots = team((-BEHIND, 2.0), (BEHIND, 2.0), (1.0, 1.0))
    assert taken_off(DIVISION_A, robots, 2) == {0}
    assert taken_off(DIVISION_A, robots, 2, side=1.0) == {1}
    assert taken_off(DIVISION_A, robots, 3) == frozenset()
    assert taken_off(DIVISION_A, team((0.01 - BEHIND, 2.0), (1.0, 1.0)), 1) == frozenset()
    assert taken_off(DIVISION_B, team((-FIELD.half_length - 0.2, 2.0), (1.0, 1.0)), 1) == frozenset()


def test_robots_in_their_goal_substitution_areas_are_not_in_the_frame_of_either_team() -> None:
    game = GameState(
        RefereeCommand.FORCE_START, blue=TeamStatus(max_robots=1), yellow=TeamStatus(max_robots=1)
    )
    own, theirs = team((-BEHIND, 2.0), (1.0, 1.0)), team((2.0, 2.0), (BEHIND, 2.0))
    frame = Frame(0.0, DIVISION_A, BallState(0.0, 0.0), tuple(own), tuple(theirs))
    seen = without_absent(frame, game)
    assert [robot.id for robot in seen.own] == [1]
    assert [robot.id for robot in seen.opponents] == [0]
    there = without_absent(frame.seen_by(Team.YELLOW), game)
    assert ([robot.id for robot in there.own], [robot.id for robot in there.opponents]) == ([0], [1])
