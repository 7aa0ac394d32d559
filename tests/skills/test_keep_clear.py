"""Driving without a touch, also past what moves."""

from __future__ import annotations

import pytest

from robobt.skills.keep_clear import KeepClear
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from tests.skills.fixed_world import Alone

TARGET = (2.0, 0.0)
PLACING = GameState(
    RefereeCommand.BALL_PLACEMENT_YELLOW,
    restart=Restart.BALL_PLACEMENT,
    restart_team=Team.YELLOW,
    placement=(1.0, 2.5),
)


def driven(*theirs: object, line: tuple[int, int] | None = None, game: GameState | None = None) -> float:
    """Return the speed along x of a robot at rest in the origin, with the target ahead."""
    alone = Alone(KeepClear(target=TARGET, line=line))
    me = robot(0.0, 0.0, number=0)
    view = frame(me, (1.0, -2.5), (), theirs, 0.0, *(() if game is None else (game,)))  # type: ignore[arg-type]
    assert alone.tick(view, 0) is Status.RUNNING
    return alone.store.command.vx


def test_it_drives_straight_over_free_ground() -> None:
    assert driven() > 0.5


def test_a_wall_of_robots_is_gone_round() -> None:
    wall = [robot(0.35, 0.17 * index, number=index) for index in range(-3, 4) if index >= 0]
    wall += [robot(0.35, -0.17 * index, number=10 + index) for index in range(1, 4)]
    assert driven(*wall) < 0.2


@pytest.mark.parametrize(("line", "drives"), [(None, True), ((2, 3), False)])
def test_a_line_between_two_opponents_is_an_obstacle_where_it_is_one(
    line: tuple[int, int] | None, drives: bool
) -> None:
    ends = robot(0.25, 1.5, number=2), robot(0.25, -1.5, number=3)
    assert (driven(*ends, line=line) > 0.5) is drives


def test_the_way_of_a_ball_that_the_opponents_place_is_an_obstacle() -> None:
    assert driven(game=PLACING) < 0.5


def test_it_is_there_within_the_tolerance_at_any_speed() -> None:
    alone = Alone(KeepClear(target=TARGET))
    view = frame(robot(1.97, 0.0, number=0), (1.0, -2.5), (), (), 0.0)
    assert alone.tick(view, 0) is Status.SUCCESS


def test_without_a_target_it_fails() -> None:
    view = frame(robot(0.0, 0.0, number=0), (1.0, -2.5), (), (), 0.0)
    assert Alone(KeepClear()).tick(view, 0) is Status.FAILURE
