"""What is measured in a match, from hand-made frames."""

from __future__ import annotations

import pytest

from robobt.match.results.measures import Measures, Trace
from robobt.world import (
    DIVISION_B,
    OPEN_PLAY,
    BallState,
    Frame,
    GameState,
    RefereeCommand,
    RobotCommand,
    RobotId,
    RobotState,
    Team,
)

PERIOD = 0.02
ME, MATE, IT = RobotId(Team.BLUE, 0), RobotId(Team.BLUE, 1), RobotId(Team.YELLOW, 0)
KICK = {ME: RobotCommand(kick_speed=5.0)}
MOUTH = 0.1


class Watched:
    """Measures of three robots that see frame after frame."""

    def __init__(self) -> None:
        self.measures = Measures(dict.fromkeys((ME, MATE, IT)))
        self.ticks = 0

    def see(
        self,
        ahead: float = MOUTH,
        speed: float = 0.0,
        commands: dict[RobotId, RobotCommand] | None = None,
        *,
        contact: bool = False,
        last_touch: RobotId | None = None,
        game: GameState = OPEN_PLAY,
    ) -> Watched:
        """Take in a frame: the ball so far ahead of the robot at the origin, rolling off at ``speed``."""
        own = (RobotState(0, 0.0, 0.0, ball_contact=contact), RobotState(1, -2.0, 1.0))
        ball = BallState(ahead, 0.0, speed, 0.0)
        time = self.ticks * PERIOD
        frame = Frame(time, DIVISION_B, ball, own, (RobotState(0, 3.0, 1.0),), period=PERIOD)
        frame.last_touch = last_touch
        self.measures.update(frame, game, commands or {})
        self.ticks += 1
        return self

    @property
    def kicks(self) -> tuple[int, int]:
        """Kicks of the robot and of all."""
        return self.measures.robots[ME].kicks, self.measures.kicks


def test_one_kick_is_counted_once_however_long_it_is_commanded() -> None:
    watched = Watched().see(contact=True)
    watched.see(MOUTH, 5.0, KICK)
    assert watched.measures.kicked == [ME]
    assert watched.kicks == (1, 1)
    # The ball is still near, leaves as fast and the command stands.
    watched.see(MOUTH + 0.1, 5.0, KICK).see(MOUTH + 0.2, 4.9, KICK)
    assert watched.measures.kicked == []
    assert watched.kicks == (1, 1)


def test_a_kick_is_counted_again_once_the_ball_has_come_back() -> None:
    watched = Watched().see(contact=True).see(MOUTH, 5.0, KICK).see(contact=True).see(MOUTH, 5.0, KICK)
    assert watched.kicks == (2, 2)


def test_a_kick_belongs_to_the_robot_that_was_commanded_and_is_near() -> None:
    watched = Watched().see()
    watched.see(MOUTH, 5.0, {MATE: RobotCommand(kick_speed=5.0), IT: RobotCommand(kick_speed=5.0)})
    assert watched.kicks == (0, 0)


@pytest.mark.parametrize(
    ("commanded", "away", "kicks"), [(5.0, 1.01, 1), (5.0, 0.99, 0), (2.0, 0.51, 1), (2.0, 0.49, 0)]
)
def test_a_ball_that_hardly_leaves_was_not_kicked(commanded: float, away: float, kicks: int) -> None:
    watched = Watched().see(contact=True).see(MOUTH, away, {ME: RobotCommand(kick_speed=commanded)})
    assert watched.measures.kicks == kicks


def test_a_ball_that_leaves_without_a_command_was_not_kicked() -> None:
    assert Watched().see(contact=True).see(MOUTH, 5.0, {ME: RobotCommand()}).kicks == (0, 0)


def test_a_ball_that_somebody_else_touched_last_was_not_kicked() -> None:
    assert Watched().see().see(MOUTH, 5.0, KICK, last_touch=IT).kicks == (0, 0)
    assert Watched().see().see(MOUTH, 5.0, KICK, last_touch=ME).kicks == (1, 1)


def test_times_run_from_the_start_to_the_ball_and_from_there_to_the_first_kick() -> None:
    watched = Watched().see().see().see(contact=True).see(contact=True)
    watched.see(MOUTH, 5.0, KICK)
    figures = watched.measures.robots[ME]
    assert figures.go_to_ball == pytest.approx(2 * PERIOD)
    assert figures.shoot == pytest.approx(2 * PERIOD)
    watched.see(contact=True).see(MOUTH, 5.0, KICK)
    assert (figures.kicks, figures.shoot) == (2, pytest.approx(2 * PERIOD))


def test_a_ball_kicked_between_two_frames_was_reached_then() -> None:
    figures = Watched().see().see(MOUTH, 5.0, KICK).measures.robots[ME]
    assert figures.go_to_ball == pytest.approx(PERIOD)
    assert figures.shoot == 0.0


def test_the_ball_is_in_play_where_the_game_says_so_and_it_lies_in_the_field() -> None:
    stop = GameState(RefereeCommand.STOP)
    watched = Watched().see().see(game=stop).see(DIVISION_B.half_length + 0.1).see()
    assert (watched.measures.ticks, watched.measures.in_play) == (4, 2)


def test_a_trace_tells_matches_apart_by_their_states_and_events() -> None:
    def trace(x: float = 0.0, event: str = "", score: int = 0) -> str:
        made = Trace()
        made.update(Frame(0.0, DIVISION_B, BallState(x, 0.0)).packed(), GameState(blue_score=score))
        if event:
            made.event(event)
        return made.hexdigest()

    assert trace() == trace()
    assert len({trace(), trace(x=1e-16), trace(event="goal"), trace(score=1)}) == 4


def test_kicks_that_the_world_saw_are_those_that_count() -> None:
    watched = Watched().see().see(contact=True)
    frame = Frame(0.5, DIVISION_B, BallState(1.0, 0.0, 5.0), (RobotState(0, 0.0, 0.0),), period=PERIOD)
    watched.measures.update(frame, OPEN_PLAY, {}, [(ME, 0.45)])
    figures = watched.measures.robots[ME]
    assert (figures.kicks, figures.go_to_ball) == (1, PERIOD)
    assert figures.shoot == pytest.approx(0.45 - PERIOD)
    assert watched.measures.kicked == [ME]
    watched.measures.update(frame, OPEN_PLAY, KICK, [])
    assert watched.kicks == (1, 1)
    assert watched.measures.kicked == []


def test_robots_that_do_not_play_are_left_out() -> None:
    measures = Measures({ME: None})
    stranger = RobotState(9, 0.0, 0.0, ball_contact=True)
    frame = Frame(0.0, DIVISION_B, BallState(0.1, 0.0), (stranger,), period=PERIOD)
    measures.update(frame, OPEN_PLAY, {}, [(RobotId(Team.BLUE, 9), 0.0)])
    assert list(measures.robots) == [ME]
    assert measures.kicks == 0
