"""Frames, views and the referee's state."""

from __future__ import annotations

from dataclasses import fields
from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from robobt.world import (
    DIVISION_A,
    DIVISION_B,
    BallState,
    FieldGeometry,
    Frame,
    GameState,
    KickTrigger,
    RefereeCommand,
    Restart,
    RobotCommand,
    RobotId,
    RobotLimits,
    RobotState,
    Team,
)
from robobt.world.rules import in_own_defense_area, in_their_defense_area

number = st.floats(-4, 4)


@given(number, number, st.floats(-3.14, 3.14), number, number)
def test_mirroring_twice_gives_the_frame_back(
    x: float, y: float, heading: float, vx: float, vy: float
) -> None:
    frame = Frame(
        1.5,
        DIVISION_B,
        BallState(x, y, vx, vy, 0.3, -1.5),
        (RobotState(1, x, y, heading, vx, vy, 2.0, True),),
        (RobotState(0, y, x, 0.3),),
        last_touch=RobotId(Team.BLUE, 1),
    )
    once, twice = frame.mirrored(), frame.mirrored().mirrored()
    assert once.team is Team.YELLOW
    assert once.opponents[0].x == -x
    assert -pi <= once.opponents[0].heading <= pi
    assert once.opponents[0].omega == 2.0
    assert once.last_touch == frame.last_touch
    assert twice.own[0].heading == pytest.approx(heading, abs=1e-12)
    twice.own[0].heading = heading
    twice.opponents[0].heading = 0.3
    assert twice == frame


def test_a_view_of_the_own_side_is_the_frame_itself() -> None:
    frame = Frame(0.0, DIVISION_B, BallState(1, 2))
    assert frame.seen_by(Team.BLUE) is frame
    assert frame.seen_by(Team.YELLOW).ball.position == (-1, -2)


def test_robots_are_found_by_number() -> None:
    frame = Frame(
        0.0, DIVISION_B, BallState(0, 0), (RobotState(2, 0, 0), RobotState(5, 1, 1)), (RobotState(2, 3, 0),)
    )
    assert frame.robot(5).position == (1, 1)
    assert frame.robot(0) is None
    assert [robot.position for robot in frame.others(2)] == [(1, 1), (3, 0)]
    assert [robot.id for robot in frame.teammates(2)] == [5]


def test_the_placement_is_turned_with_the_view() -> None:
    game = GameState(RefereeCommand.BALL_PLACEMENT_BLUE, restart=Restart.FREE_KICK, placement=(1.0, -2.0))
    assert game.mirrored().placement == (-1.0, 2.0)
    assert not game.in_play


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B])
def test_areas_are_where_the_rules_put_them(field: FieldGeometry) -> None:
    x, y = field.half_length, field.defense_width / 2
    assert in_their_defense_area(field, x - 0.01, y - 0.01)
    assert not in_their_defense_area(field, x - field.defense_depth - 0.01, 0)
    assert in_their_defense_area(field, x - field.defense_depth - 0.01, 0, tolerance=0.02)
    assert in_own_defense_area(field, -x + 0.5, 0)
    assert not in_own_defense_area(field, x - 0.5, 0)
    assert field.contains(x, field.half_width)
    assert not field.contains(x + 0.01, 0)
    assert field.contains(x + 0.01, 0, tolerance=0.02)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"length": -1}, "length"),
        ({"goal_width": 7}, "goal_width"),
        ({"defense_depth": 5}, "defense_depth"),
        ({"goal_depth": 0.5}, "goal_depth"),
        ({"width": float("nan")}, "width"),
        ({"colour": "green"}, "colour"),
    ],
)
def test_an_impossible_field_is_refused_by_name(change: dict[str, object], word: str) -> None:
    with pytest.raises(ValidationError, match=word):
        FieldGeometry.model_validate(DIVISION_B.model_dump() | change)


def test_limits_scale_speed_and_turning_only() -> None:
    half = RobotLimits(max_speed=2, acceleration=3, max_turn=8).scaled(0.5)
    assert (half.max_speed, half.max_turn, half.acceleration) == (1, 4, 3)


def test_a_command_knows_whether_it_is_finite() -> None:
    assert RobotCommand(1, 2, 3, 4).finite()
    assert not RobotCommand(vy=float("inf")).finite()
    assert not RobotCommand(kick_speed=float("nan")).finite()
    assert not RobotCommand(kick_angle=float("nan")).finite()


def test_a_frame_is_packed_with_the_balls_height_only_where_it_flies() -> None:
    ground, air = (Frame(0.0, DIVISION_B, BallState(1.0, 2.0, z=z)).packed() for z in (0.0, 0.5))
    assert (len(ground), len(air)) == (8 * 7, 8 * 9)
    assert air.startswith(ground)


def test_a_mirrored_ball_is_as_high() -> None:
    ball = Frame(0.0, DIVISION_B, BallState(1.0, 2.0, 3.0, 4.0, 0.5, -0.5)).mirrored().ball
    assert (ball.x, ball.vx, ball.z, ball.vz) == (-1.0, -3.0, 0.5, -0.5)


def restart(command: RefereeCommand, kind: Restart, may_touch: bool = True) -> GameState:
    return GameState(command, restart=kind, restart_team=Team.BLUE, may_touch=may_touch)


@pytest.mark.parametrize(
    ("game", "blue", "yellow"),
    [
        (GameState(), 0, 0),
        (GameState(RefereeCommand.DIRECT_FREE_BLUE), 0, 0),
        (restart(RefereeCommand.DIRECT_FREE_BLUE, Restart.FREE_KICK), 1, -1),
        (restart(RefereeCommand.STOP, Restart.FREE_KICK, may_touch=False), -1, -1),
        (restart(RefereeCommand.BALL_PLACEMENT_BLUE, Restart.BALL_PLACEMENT), -1, -1),
        (GameState(RefereeCommand.HALT), -1, -1),
    ],
)
def test_whose_ball_it_is(game: GameState, blue: int, yellow: int) -> None:
    assert (game.ball_for(Team.BLUE), game.ball_for(Team.YELLOW)) == (blue, yellow)


def test_a_copy_of_a_command_has_all_of_its_entries() -> None:
    # Each other than by default, so that one which is left out is seen.
    command = RobotCommand(1.0, 2.0, 3.0, 4.0, KickTrigger.NOW, True, 0.5)
    default = RobotCommand()
    assert all(getattr(command, entry.name) != getattr(default, entry.name) for entry in fields(command))
    assert command.copy() == command
    assert command.copy() is not command
