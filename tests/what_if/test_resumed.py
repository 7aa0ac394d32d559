"""The referee of a branch goes on where the log's was."""

from __future__ import annotations

from dataclasses import replace

from robobt.match.referee.settings import RefereeSettings
from robobt.what_if.resumed import ResumedReferee
from robobt.world import DIVISION_B, BallState, Frame, GameState, RobotState, Team
from robobt.world.game import RefereeCommand, Restart, TeamStatus

PERIOD = 1 / 60
FREE_KICK = GameState(
    RefereeCommand.DIRECT_FREE_BLUE,
    blue_score=2,
    yellow_score=1,
    restart=Restart.FREE_KICK,
    restart_team=Team.BLUE,
    placement=(1.0, 0.0),
    yellow=TeamStatus(keeper=0, max_robots=5, yellow_cards=1),
)
KICKER = RobotState(1, 0.9, 0.0, 0.0)


def frame(number: int, ball: BallState, game: GameState, own: tuple[RobotState, ...] = (KICKER,)) -> Frame:
    return Frame(40.0 + number * PERIOD, DIVISION_B, ball, own, (RobotState(0, 4.2, 0.0, 3.1),), game=game)


def resumed(game: GameState, ball: BallState) -> ResumedReferee:
    referee = ResumedReferee(DIVISION_B, RefereeSettings())
    for number in range(5):
        referee.watch(frame(number, ball, game))
    return referee


def test_command_restart_score_and_cards_are_taken_over() -> None:
    ball = BallState(1.0, 0.0)
    game = resumed(FREE_KICK, ball).begin(frame(5, ball, FREE_KICK))
    assert (game.command, game.restart, game.restart_team) == (
        RefereeCommand.DIRECT_FREE_BLUE,
        Restart.FREE_KICK,
        Team.BLUE,
    )
    assert game.may_touch
    assert (game.blue_score, game.yellow_score) == (2, 1)
    assert game.status(Team.YELLOW).yellow_cards == 1


def test_a_restart_is_taken_and_the_ball_is_in_play() -> None:
    ball = BallState(1.0, 0.0)
    referee = resumed(FREE_KICK, ball)
    referee.begin(frame(5, ball, FREE_KICK))
    moved = BallState(1.1, 0.0, 3.0, 0.0)
    assert referee.update(frame(6, moved, FREE_KICK)).game.in_play


def test_a_goal_counts_on_top_of_the_score() -> None:
    play = replace(FREE_KICK, command=RefereeCommand.NORMAL_START, restart=None, restart_team=None)
    rolling = BallState(4.3, 0.2, 6.0, 0.0)
    referee = resumed(play, rolling)
    referee.begin(frame(5, rolling, play))
    decision = referee.update(frame(6, BallState(4.6, 0.2, 6.0, 0.0), play))
    assert decision.game.blue_score == 3
    assert decision.game.command is RefereeCommand.STOP
