"""Counting passes on frames written by hand."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from robobt.challenges.passes import PassCounter
from robobt.world.field import DIVISION_B
from robobt.world.game import GameState, RefereeCommand, Team
from robobt.world.state import BallState, Frame, RobotId, RobotState

PLAYING, STOPPED = GameState(RefereeCommand.NORMAL_START), GameState(RefereeCommand.STOP)
TOUCHING = 0.1
"""A ball this far from a robot's centre touches it, ahead of it and behind it [m]."""

Ball = tuple[float, float, float]
"""A ball: x, y [m] and its speed along x [m/s]."""


def count(
    balls: Sequence[Ball],
    blue: Sequence[tuple[float, float]],
    yellow: Sequence[tuple[float, float]] = (),
    game: GameState = PLAYING,
    touches: Sequence[RobotId | None] = (),
) -> tuple[int, int]:
    """Return both teams' passes after frames with robots that stand still and face +x."""
    counter = PassCounter()
    for index, (x, y, speed) in enumerate(balls):
        own, theirs = (
            tuple(RobotState(number, *place) for number, place in enumerate(team)) for team in (blue, yellow)
        )
        last = touches[index] if touches else None
        frame = Frame(index / 60, DIVISION_B, BallState(x, y, speed), own, theirs, last_touch=last)
        counter.see(frame, game)
    return counter.passes[Team.BLUE], counter.passes[Team.YELLOW]


def rolling(start: float, end: float, speed: float = 3.0) -> list[Ball]:
    """Return a ball that lies at the mouth at ``start``, rolls, and lies at ``end``."""
    middle = [start + share * (end - start) for share in (0.2, 0.4, 0.6, 0.8)]
    return [(start, 0.0, 0.0), *((x, 0.0, speed) for x in middle), (end, 0.0, 0.0)]


def test_a_pass_to_a_mate_counts() -> None:
    assert count(rolling(TOUCHING, 2.0 - TOUCHING), [(0.0, 0.0), (2.0, 0.0)]) == (1, 0)


@pytest.mark.parametrize(("way", "passes"), [(0.99, 0), (1.01, 1)])
def test_a_pass_is_at_least_a_metre_long(way: float, passes: int) -> None:
    there = TOUCHING + way
    assert count(rolling(TOUCHING, there), [(0.0, 0.0), (there + TOUCHING, 0.0)]) == (passes, 0)


@pytest.mark.parametrize(("speed", "passes"), [(6.4, 1), (6.6, 0)])
def test_a_ball_above_the_speed_limit_makes_no_pass(speed: float, passes: int) -> None:
    balls = rolling(TOUCHING, 2.0 - TOUCHING, speed)
    assert count(balls, [(0.0, 0.0), (2.0, 0.0)]) == (passes, 0)


def test_a_ball_that_an_opponent_takes_is_no_pass() -> None:
    assert count(rolling(TOUCHING, 2.0 - TOUCHING), [(0.0, 0.0)], [(2.0, 0.0)]) == (0, 0)


def test_a_robot_does_not_pass_to_itself() -> None:
    out = rolling(TOUCHING, 2.0)[:-1]
    assert count([*out, *out[::-1]], [(0.0, 0.0), (0.0, 2.0)]) == (0, 0)


def test_yellow_passes_too() -> None:
    assert count(rolling(TOUCHING, 2.0 - TOUCHING), [], [(0.0, 0.0), (2.0, 0.0)]) == (0, 1)


def test_a_pass_while_the_game_is_stopped_does_not_count() -> None:
    balls = rolling(TOUCHING, 2.0 - TOUCHING)
    assert count(balls, [(0.0, 0.0), (2.0, 0.0)], game=STOPPED) == (0, 0)


def test_the_length_is_taken_to_where_the_ball_stopped() -> None:
    stops_short = [*rolling(TOUCHING, TOUCHING + 0.8)[:-1], (0.9, 0.0, 0.0)]
    # A mate fetches it there, and stands so that it touches the ball only then.
    counter = PassCounter()
    for index, (x, y, speed) in enumerate([*stops_short, (0.9, 0.0, 0.0)]):
        mate = (0.9 + TOUCHING, 0.0) if index == len(stops_short) else (2.0, 0.0)
        own = (RobotState(0, 0.0, 0.0), RobotState(1, *mate))
        counter.see(Frame(index / 60, DIVISION_B, BallState(x, y, speed), own), PLAYING)
    assert counter.passes[Team.BLUE] == 0


def test_a_deflection_by_a_mate_between_two_frames_ends_the_pass() -> None:
    mate, last = RobotId(Team.BLUE, 1), RobotId(Team.BLUE, 0)
    balls = [(TOUCHING, 0.0, 0.0), (0.9, 0.0, 5.0), (1.8, 0.0, 5.0), (1.5, 0.0, -3.0), (1.2, 0.0, -3.0)]
    assert count(balls, [(0.0, 0.0), (2.0, 0.0)], touches=[last, last, last, mate, mate]) == (1, 0)


def test_a_pass_over_the_line_does_not_count() -> None:
    outside = 4.6
    balls = rolling(TOUCHING, outside)
    assert count(balls, [(0.0, 0.0), (outside + TOUCHING, 0.0)]) == (0, 0)
