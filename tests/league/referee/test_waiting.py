"""What the controller waits for is said, as it would say it at its screen."""

from __future__ import annotations

import logging
from dataclasses import replace

import pytest

from robobt.league.referee.people import People
from robobt.league.referee.waiting import waits_for
from robobt.match.referee.settings import RefereeSettings
from robobt.world.field import DIVISION_B
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team, TeamStatus
from robobt.world.state import BallState, Frame, RobotState

STOP = GameState(
    RefereeCommand.STOP,
    Stage.NORMAL_FIRST_HALF,
    restart=Restart.FREE_KICK,
    restart_team=Team.BLUE,
    may_touch=False,
    placement=(1.0, 1.0),
    upcoming=RefereeCommand.DIRECT_FREE_BLUE,
)
PLACED = BallState(1.0, 1.0)


def waits(
    game: GameState, ball: BallState, own: tuple[float, float], their: tuple[float, float]
) -> list[str]:
    robots = (RobotState(3, *own),), (RobotState(4, *their),)
    return waits_for(DIVISION_B, Frame(0.0, DIVISION_B, ball, *robots), game)


def test_nothing_is_waited_for_when_all_is_ready() -> None:
    assert waits(STOP, PLACED, (1.2, 1.0), (2.0, 2.0)) == []


@pytest.mark.parametrize(
    ("ball", "reasons"),
    [
        (BallState(1.0, -0.1), ["the ball is 1.10 m from its place"]),
        (BallState(1.0, 1.0, 0.3), ["the ball rolls"]),
        (BallState(1.5, 3.1), ["the ball is 2.16 m from its place", "the ball is out of the field"]),
    ],
)
def test_the_ball_has_to_lie_still_in_its_place(ball: BallState, reasons: list[str]) -> None:
    assert waits(STOP, ball, (-3.0, -2.0), (3.0, -2.0)) == reasons


def test_opponents_keep_their_distance_and_all_do_before_a_kick_off() -> None:
    assert waits(STOP, PLACED, (1.3, 1.0), (1.0, 1.53)) == ["yellow 4 is 0.53 m from the ball"]
    assert waits(STOP, PLACED, (1.3, 1.0), (1.0, 1.55)) == []
    kickoff = replace(STOP, restart=Restart.KICKOFF)
    assert waits(kickoff, PLACED, (1.3, 1.0), (3.0, 2.0)) == ["blue 3 is 0.30 m from the ball"]


def test_too_many_robots_are_named() -> None:
    game = replace(STOP, yellow=TeamStatus(max_robots=0))
    assert waits(game, PLACED, (-3.0, 0.0), (3.0, 0.0)) == ["yellow has 1 robot and may have 0"]
    # One that was taken off at the half-way line is not counted.
    assert waits(game, PLACED, (-3.0, 0.0), (0.2, 3.15)) == []


def test_before_a_kick_off_the_kicker_too_is_in_its_own_half() -> None:
    game = replace(STOP, command=RefereeCommand.PREPARE_KICKOFF_BLUE, restart=Restart.KICKOFF)
    assert waits(game, PLACED, (-0.08, 0.0), (1.0, 0.0)) == ["blue 3 is not in its own half"]
    assert waits(game, PLACED, (-0.1, 0.0), (0.1, 0.0)) == []


PREPARE_PENALTY = replace(
    STOP,
    command=RefereeCommand.PREPARE_PENALTY_BLUE,
    restart=Restart.PENALTY,
    placement=(-1.5, 0.0),
    upcoming=RefereeCommand.NORMAL_START,
    yellow=TeamStatus(keeper=4),
)
MARK = BallState(-1.5, 0.0)


@pytest.mark.parametrize(
    ("ball", "keeper", "reasons"),
    [
        (MARK, (4.45, 0.1), []),
        (BallState(-1.3, 0.0), (4.45, 0.0), ["the ball is 0.20 m from the mark"]),
        (MARK, (4.3, 0.0), ["yellow 4 is not on its goal line"]),
        (MARK, (4.5, 0.6), ["yellow 4 is not on its goal line"]),
    ],
)
def test_before_a_penalty_kick_the_goalkeeper_is_on_its_line(
    ball: BallState, keeper: tuple[float, float], reasons: list[str]
) -> None:
    assert waits(PREPARE_PENALTY, ball, (-1.8, 0.0), keeper) == reasons


def test_before_a_penalty_kick_all_but_one_kicker_are_behind_the_ball() -> None:
    own = RobotState(3, -1.8, 0.0), RobotState(5, -2.4, 1.0)
    their = RobotState(4, 4.45, 0.0), RobotState(2, -2.45, -1.0)
    frame = Frame(0.0, DIVISION_B, MARK, own, their)
    assert waits_for(DIVISION_B, frame, PREPARE_PENALTY) == [
        "yellow 2 is not 1 m behind the ball",
        "blue 5 is not 1 m behind the ball",
    ]


def test_a_goalkeeper_that_is_not_there_is_waited_for() -> None:
    game = replace(PREPARE_PENALTY, yellow=TeamStatus(keeper=9))
    said = waits(game, MARK, (-1.8, 0.0), (-2.6, 0.0))
    assert said == ["yellow has no goalkeeper, its number is 9"]


def test_a_stop_that_does_not_end_is_told_once(caplog: pytest.LogCaptureFixture) -> None:
    people = People(DIVISION_B, RefereeSettings())
    robots = (RobotState(3, -3.0, 0.0),), (RobotState(4, 1.0, 1.3),)
    with caplog.at_level(logging.WARNING, "robobt"):
        for time in range(100):
            people.clicks(Frame(float(time), DIVISION_B, PLACED, *robots), STOP)
    assert [record.message for record in caplog.records] == [
        "STOP lasts for 61 s: yellow 4 is 0.30 m from the ball"
    ]
