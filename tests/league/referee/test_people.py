"""What people do at a match: end halts, bring on stages, carry the ball."""

from __future__ import annotations

import logging
from dataclasses import replace
from typing import Any

import pytest

from robobt.league.referee.people import People, waits_for
from robobt.league.wire.messages import Command, Referee
from robobt.match.referee.settings import RefereeSettings
from robobt.world.field import DIVISION_B
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team, TeamStatus
from robobt.world.state import BallState, Frame, RobotState

FIRST, HALF_TIME = Stage.NORMAL_FIRST_HALF, Stage.NORMAL_HALF_TIME
HALT = GameState(RefereeCommand.HALT, FIRST, may_touch=False)
FREE_KICK = GameState(
    RefereeCommand.STOP,
    FIRST,
    restart=Restart.FREE_KICK,
    restart_team=Team.BLUE,
    may_touch=False,
    placement=(1.0, 1.0),
    upcoming=RefereeCommand.DIRECT_FREE_BLUE,
    stage_time=100.0,
)
KICKOFF = replace(
    FREE_KICK,
    restart=Restart.KICKOFF,
    placement=(0.0, 0.0),
    upcoming=RefereeCommand.PREPARE_KICKOFF_BLUE,
)
PENALTY = replace(
    FREE_KICK,
    restart=Restart.PENALTY,
    placement=(-1.5, 0.0),
    upcoming=RefereeCommand.PREPARE_PENALTY_BLUE,
)


class Field:
    def __init__(self, **settings: Any) -> None:
        self.people = People(DIVISION_B, RefereeSettings(**{"half_length": 300.0, **settings}))

    def clicks(self, game: GameState, *times: float) -> list[str]:
        """What is clicked at the last of these times."""
        for time in times:
            clicked = self.people.clicks(Frame(time, DIVISION_B, BallState(1.0, 1.0)), game)
        return [told(change) for change in clicked]

    def puts(self, game: GameState, ball: BallState, *times: float, robot: float = 3.0) -> object:
        """Where the ball is put at the last of these times, with a robot at (robot, 0)."""
        own = (RobotState(1, robot, 0.0),)
        return [self.people.puts_ball(Frame(time, DIVISION_B, ball, own), game) for time in times][-1]


def told(change: Any) -> str:
    if change.HasField("set_ball_placement_pos_change"):
        spot = change.set_ball_placement_pos_change.pos
        return f"ball to {spot.x:g}, {spot.y:g}"
    if change.HasField("change_stage_change"):
        return Referee.Stage.Name(change.change_stage_change.new_stage)
    command = change.new_command_change.command
    return Command.Type.Name(command.type) + {0: "", 1: " YELLOW", 2: " BLUE"}[command.for_team]


def test_a_halt_ends_when_robots_have_had_time_to_stand() -> None:
    assert Field().clicks(HALT, 5.0, 6.9) == []
    assert Field().clicks(HALT, 5.0, 7.0) == ["STOP"]


def test_a_substitution_ends_before_it_would_count_as_another() -> None:
    halt = replace(HALT, yellow=TeamStatus(substituting=True))
    assert Field().clicks(halt, 5.0, 19.9) == []
    assert Field().clicks(halt, 5.0, 20.0) == ["STOP"]


def test_a_time_out_ends() -> None:
    assert Field().clicks(replace(HALT, command=RefereeCommand.TIMEOUT_BLUE), 0.0, 10.0) == ["STOP"]


@pytest.mark.parametrize("wait", [0.0, 30.0])
def test_the_break_lasts_as_long_as_the_settings_say(wait: float) -> None:
    field, game = Field(half_time=wait), replace(HALT, stage=HALF_TIME)
    lasts = max(2.0, wait)
    assert field.clicks(game, 100.0, 100.0 + lasts - 0.1) == []
    assert field.clicks(game, 100.0 + lasts) == ["NORMAL_SECOND_HALF_PRE"]


def test_a_half_whose_time_is_over_ends_with_the_next_stop() -> None:
    over = replace(FREE_KICK, stage_time=-0.1)
    assert Field().clicks(over, 0.0) == ["NORMAL_HALF_TIME"]
    assert Field().clicks(replace(over, stage=Stage.NORMAL_SECOND_HALF), 0.0) == ["POST_GAME"]
    running = replace(over, command=RefereeCommand.DIRECT_FREE_BLUE)
    assert Field().clicks(running, 0.0) == []
    assert Field().clicks(FREE_KICK, 0.0) == []


def test_a_draw_goes_on_to_overtime_and_a_shoot_out_where_there_are_some() -> None:
    over = replace(FREE_KICK, stage=Stage.NORMAL_SECOND_HALF, stage_time=-0.1)
    assert Field(extra_length=150.0).clicks(over, 0.0) == ["EXTRA_TIME_BREAK"]
    assert Field(shoot_out=True).clicks(over, 0.0) == ["PENALTY_SHOOTOUT_BREAK"]
    won = replace(over, blue_score=1)
    assert Field(extra_length=150.0, shoot_out=True).clicks(won, 0.0) == ["POST_GAME"]


def test_a_shoot_out_ends_after_five_kicks_each_when_it_is_decided() -> None:
    field = Field(shoot_out=True)
    stop = replace(PENALTY, stage=Stage.PENALTY_SHOOTOUT, blue_score=1, stage_time=0.0)
    kick = replace(stop, command=RefereeCommand.NORMAL_START)
    for attempt in range(10):
        assert field.clicks(stop, 10.0 * attempt) == []
        field.clicks(kick, 10.0 * attempt + 5.0)
    assert field.clicks(replace(stop, yellow_score=1), 100.0) == []
    assert field.clicks(stop, 100.0) == ["POST_GAME"]


def test_a_ball_that_hands_place_is_carried_at_once() -> None:
    assert Field(placement="by_hand").puts(FREE_KICK, BallState(1.0, 3.1), 0.0, 0.1) == (1.0, 1.0)


def test_a_penalty_is_still_taken_at_the_end_of_a_half() -> None:
    assert Field().clicks(replace(PENALTY, stage_time=-1.0), 0.0, 4.9) == []
    assert Field().clicks(replace(PENALTY, stage_time=-1.0), 0.0, 5.0) == ["PENALTY BLUE"]


def test_a_ball_that_left_after_the_foul_does_not_move_the_penalty() -> None:
    # The controller takes a second to stop play, and then believes both.
    assert Field().clicks(replace(PENALTY, placement=(-4.3, 2.8)), 0.0) == ["ball to -1.5, 0"]
    assert Field().clicks(replace(PENALTY, placement=(-1.5, 0.0)), 0.0) == []
    assert Field().clicks(replace(KICKOFF, placement=(4.3, 2.8)), 0.0) == ["ball to 0, 0"]


@pytest.mark.parametrize(("score", "over"), [((10, 8), True), ((10, 9), False), ((9, 0), False)])
def test_ten_goals_with_a_lead_of_two_end_the_match(score: tuple[int, int], over: bool) -> None:
    game = replace(KICKOFF, blue_score=score[0], yellow_score=score[1])
    assert Field().clicks(game, 0.0) == (["POST_GAME"] if over else [])


def test_a_stop_after_which_nothing_follows_ends_with_a_force_start() -> None:
    nothing = replace(FREE_KICK, restart=None, restart_team=None, upcoming=None)
    assert Field().clicks(nothing, 0.0, 4.9) == []
    assert Field().clicks(nothing, 0.0, 5.0) == ["FORCE_START"]


def test_nothing_is_done_while_the_ball_is_in_play_or_the_match_over() -> None:
    assert Field().clicks(GameState(stage_time=-10.0), 0.0, 100.0) == []
    assert Field().clicks(replace(HALT, stage=Stage.POST_GAME), 0.0, 100.0) == []


def test_the_ball_is_carried_to_the_centre_for_a_kick_off() -> None:
    in_goal = BallState(4.6, 0.0)
    assert Field().puts(KICKOFF, in_goal, 0.0) == (0.0, 0.0)
    assert Field().puts(replace(KICKOFF, command=RefereeCommand.HALT), in_goal, 0.0) == (0.0, 0.0)
    assert Field().puts(KICKOFF, BallState(0.0, 0.01), 0.0) is None


@pytest.mark.parametrize(("team", "x"), [(Team.BLUE, -1.5), (Team.YELLOW, 1.5)])
def test_the_ball_is_carried_to_the_mark_for_a_penalty(team: Team, x: float) -> None:
    game = replace(PENALTY, restart_team=team)
    assert Field().puts(game, BallState(3.0, 1.0), 0.0) == (x, 0.0)
    # Once it may be taken nobody carries it any more.
    taken = replace(game, command=RefereeCommand.NORMAL_START, may_touch=True)
    assert Field().puts(taken, BallState(3.0, 1.0), 0.0, 10.0) is None


def test_a_robot_on_the_spot_is_given_time_to_leave() -> None:
    ball = BallState(4.6, 0.0)
    assert Field().puts(KICKOFF, ball, 0.0, 4.9, robot=0.1) is None
    assert Field().puts(KICKOFF, ball, 0.0, 5.1, robot=0.1) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("ball", "carried"),
    [
        (BallState(1.0, 1.9), False),
        (BallState(1.0, 2.1), True),
        (BallState(1.0, 3.1), True),
        (BallState(1.0, 3.1, 0.0, 0.3), False),
    ],
    ids=["near its spot", "far", "outside", "rolling"],
)
def test_a_ball_that_no_robot_may_place_is_carried(ball: BallState, carried: bool) -> None:
    assert Field().puts(FREE_KICK, ball, 0.0, 1.9) is None
    assert Field().puts(FREE_KICK, ball, 0.0, 2.1) == ((1.0, 1.0) if carried else None)


def test_a_ball_near_a_defence_area_is_carried_even_if_it_is_near_its_spot() -> None:
    game = replace(FREE_KICK, placement=(2.5, 0.5))
    assert Field().puts(game, BallState(2.9, 0.5), 0.0, 2.1) == (2.5, 0.5)


def test_a_ball_that_has_no_spot_is_carried_to_the_nearest_legal_one() -> None:
    game = replace(FREE_KICK, restart=None, placement=None)
    assert Field().puts(game, BallState(1.0, 3.1), 0.0, 2.1) == (1.0, 2.8)


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
