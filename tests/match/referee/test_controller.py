"""What the controller decides, given what happened; robots and ball are put where they matter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from robobt.match.referee.controller import Controller
from robobt.match.referee.events import Detail, EventKind, RefereeEvent
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.verdicts import FOULS
from robobt.world import (
    DIVISION_A,
    DIVISION_B,
    BallState,
    FieldGeometry,
    Frame,
    GameState,
    RefereeCommand,
    Restart,
    RobotId,
    RobotState,
    Stage,
    Team,
)

PERIOD = 0.05
K, C = EventKind, RefereeCommand
BLUE, YELLOW = Team.BLUE, Team.YELLOW


class Match:
    """A controller in open play, told what happens; coordinates are the world's."""

    def __init__(self, field: FieldGeometry = DIVISION_B, **settings: object) -> None:
        given = {"opening": "force_start", **settings}
        self.field = field
        self.controller = Controller(
            field,
            RefereeSettings(**given),  # type: ignore[arg-type]
            np.random.default_rng(1),
        )
        self.time = 0.0
        self.ball = BallState(0.0, 0.0)
        self.robots: dict[RobotId, RobotState] = {}
        self.happening: list[RefereeEvent] = []
        self.events: list[RefereeEvent] = []
        self.commands: list[RefereeCommand] = []
        self.tick()

    @property
    def game(self) -> GameState:
        return self.controller.game

    @property
    def kinds(self) -> list[EventKind]:
        return [event.kind for event in self.events]

    def put(self, team: Team, number: int, x: float, y: float) -> Match:
        self.robots[RobotId(team, number)] = RobotState(number, x, y)
        return self

    def lie(self, x: float, y: float) -> Match:
        self.ball = BallState(x, y)
        return self

    def happens(
        self, kind: EventKind, team: Team | None, x: float = 0.0, y: float = 0.0, **more: Detail
    ) -> Match:
        """It happens in the next frame."""
        self.happening.append(RefereeEvent(self.time, kind, team, None, x, y, more))
        return self.tick()

    def goal(self, team: Team, **more: Detail) -> Match:
        return self.happens(K.POSSIBLE_GOAL, team, 4.5 if team is BLUE else -4.5, 0.0, **more)

    def tick(self) -> Match:
        own, opponents = (
            tuple(robot for identity, robot in self.robots.items() if identity.team is team) for team in Team
        )
        frame = Frame(self.time, self.field, self.ball, own, opponents, period=PERIOD)
        decision = self.controller.update(frame, self.happening)
        self.happening = []
        self.events += decision.events
        if decision.place_ball is not None:
            self.ball = BallState(*decision.place_ball)
        if not self.commands or self.commands[-1] is not self.game.command:
            self.commands.append(self.game.command)
        self.time += PERIOD
        return self

    def wait(self, seconds: float) -> Match:
        for _ in range(round(seconds / PERIOD)):
            self.tick()
        return self

    def until(self, command: RefereeCommand, longest: float = 60.0) -> Match:
        for _ in range(round(longest / PERIOD)):
            if self.game.command is command:
                return self
            self.tick()
        raise AssertionError(f"{command.name} did not come within {longest} s; {self.game}")


def score(match: Match) -> tuple[int, int]:
    return match.game.blue_score, match.game.yellow_score


# Goals.


@pytest.mark.parametrize(
    ("told", "counts"),
    [
        ({}, True),
        ({"num_robots_by_team": 6}, True),
        ({"num_robots_by_team": 7}, False),
        ({"max_ball_height": 0.15}, True),
        ({"max_ball_height": 0.16}, False),
    ],
)
def test_a_goal_counts_with_a_low_ball_and_not_too_many_robots(told: dict[str, Detail], counts: bool) -> None:
    match = Match().goal(BLUE, **told)
    assert match.kinds == [K.POSSIBLE_GOAL, K.GOAL if counts else K.INVALID_GOAL]
    assert score(match) == ((1, 0) if counts else (0, 0))
    restart = (Restart.KICKOFF, YELLOW, (0.0, 0.0)) if counts else (Restart.FREE_KICK, YELLOW, (3.5, 2.8))
    assert (match.game.restart, match.game.restart_team, match.game.placement) == restart


@pytest.mark.parametrize("kind", [K.BOT_CRASH_UNIQUE, K.BOT_KICKED_BALL_TOO_FAST, K.BOT_CRASH_DRAWN])
@pytest.mark.parametrize(("wait", "counts"), [(1.85, False), (2.1, True)])
def test_a_foul_without_a_stop_annuls_the_goals_of_two_seconds(
    kind: EventKind, wait: float, counts: bool
) -> None:
    match = Match().happens(kind, None if kind is K.BOT_CRASH_DRAWN else BLUE).wait(wait).goal(BLUE)
    assert score(match) == ((1, 0) if counts else (0, 0))


def test_the_others_foul_annuls_nothing() -> None:
    assert score(Match().happens(K.BOT_CRASH_UNIQUE, YELLOW).goal(BLUE)) == (1, 0)


# Stops.

AT = (1.0, 1.0)


@pytest.mark.parametrize(
    ("kind", "restart", "team", "spot"),
    [
        (K.BALL_LEFT_FIELD_TOUCH_LINE, Restart.FREE_KICK, YELLOW, AT),
        (K.ATTACKER_DOUBLE_TOUCHED_BALL, Restart.FREE_KICK, YELLOW, AT),
        (K.BOT_DRIBBLED_BALL_TOO_FAR, Restart.FREE_KICK, YELLOW, AT),
        (K.KEEPER_HELD_BALL, Restart.FREE_KICK, YELLOW, AT),
        (K.BOT_PUSHED_BOT, Restart.FREE_KICK, YELLOW, AT),
        (K.BOUNDARY_CROSSING, Restart.FREE_KICK, YELLOW, AT),
        (K.DEFENDER_IN_DEFENSE_AREA, Restart.PENALTY, YELLOW, (1.5, 0.0)),
        (K.NO_PROGRESS_IN_GAME, None, None, (0.0, 0.0)),
        (K.TOO_MANY_ROBOTS, None, None, (0.0, 0.0)),
    ],
)
def test_what_stops_play_leads_to_its_restart(
    kind: EventKind, restart: Restart | None, team: Team | None, spot: tuple[float, float]
) -> None:
    match = Match().happens(kind, BLUE, *AT)
    assert match.game.command is C.STOP
    assert (match.game.restart, match.game.restart_team) == (restart, team)
    assert match.game.placement == pytest.approx(spot)
    assert match.game.events == (kind.value,)


@pytest.mark.parametrize(
    "kind",
    [
        K.ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA,
        K.BOT_CRASH_UNIQUE,
        K.BOT_CRASH_DRAWN,
        K.BOT_KICKED_BALL_TOO_FAST,
    ],
)
def test_play_goes_on_after_these(kind: EventKind) -> None:
    match = Match().happens(kind, None if kind is K.BOT_CRASH_DRAWN else BLUE)
    assert match.game.in_play
    assert match.controller.state.records[BLUE].fouls == 1
    assert match.controller.state.records[YELLOW].fouls == (1 if kind is K.BOT_CRASH_DRAWN else 0)


def test_of_two_events_in_a_frame_the_first_that_stops_play_decides() -> None:
    match = Match()
    match.happening.append(RefereeEvent(match.time, K.BALL_LEFT_FIELD_TOUCH_LINE, BLUE, None, 1.0, 3.0))
    match.happens(K.KEEPER_HELD_BALL, YELLOW, -4.0, 0.0)
    assert (match.game.restart_team, match.game.placement) == (YELLOW, pytest.approx((1.0, 2.8)))
    assert len(match.kinds) == 2


def test_the_events_are_forgotten_when_play_goes_on() -> None:
    match = Match().happens(K.NO_PROGRESS_IN_GAME, None).until(C.FORCE_START)
    assert match.game.events == ()


# Waiting in STOP.


@pytest.mark.parametrize(("gap", "free"), [(0.539, False), (0.541, True)])
@pytest.mark.parametrize(("number", "team"), [(1, BLUE), (2, YELLOW)])
def test_nobody_is_near_the_ball_of_a_forced_start(team: Team, number: int, gap: float, free: bool) -> None:
    match = Match().put(team, number, gap, 0.0).happens(K.NO_PROGRESS_IN_GAME, None).wait(10.0)
    assert match.game.in_play is free


def test_only_opponents_keep_off_the_ball_of_a_free_kick() -> None:
    match = Match().put(YELLOW, 1, 0.3, 0.0).happens(K.KEEPER_HELD_BALL, BLUE)
    assert match.until(C.DIRECT_FREE_YELLOW, 2.1).game.may_touch
    match = Match().put(BLUE, 1, 0.3, 0.0).happens(K.KEEPER_HELD_BALL, BLUE).wait(10.0)
    assert match.game.stopped


def test_all_has_to_be_right_for_two_seconds() -> None:
    match = Match().happens(K.NO_PROGRESS_IN_GAME, None).wait(1.9).put(BLUE, 1, 0.3, 0.0).tick()
    match.put(BLUE, 1, 0.7, 0.0).wait(1.9)
    assert match.game.stopped
    assert match.wait(0.2).game.in_play


def test_a_team_with_too_many_robots_keeps_play_from_going_on() -> None:
    match = Match(max_robots=1).put(BLUE, 0, -4.0, 0.0).put(BLUE, 1, -2.0, 0.0)
    assert match.happens(K.NO_PROGRESS_IN_GAME, None).wait(10.0).game.stopped
    assert match.put(BLUE, 1, -0.5, 3.1).wait(2.2).game.in_play


# Placement by robots.


def placing(field: FieldGeometry = DIVISION_B, left: bool = True, **settings: object) -> Match:
    """Blue has put the ball out; yellow places it at (1, touch line - 0.2)."""
    match = Match(field, **settings).lie(-1.0, 0.0)
    kind = K.BALL_LEFT_FIELD_TOUCH_LINE if left else K.BOT_PUSHED_BOT
    return match.happens(kind, BLUE, 1.0, field.half_width)


def test_the_team_that_kicks_places_the_ball() -> None:
    match = placing().until(C.BALL_PLACEMENT_YELLOW, 0.1)
    game = match.game
    assert (game.restart, game.restart_team) == (Restart.BALL_PLACEMENT, YELLOW)
    assert (game.placement, game.upcoming, game.next_team) == (
        pytest.approx((1.0, 2.8)),
        C.DIRECT_FREE_YELLOW,
        YELLOW,
    )
    assert game.action_time == pytest.approx(30.0)


@pytest.mark.parametrize(("x", "y", "placed"), [(0.05, 2.8, True), (-0.05, 2.8, False), (1.0, 3.01, False)])
def test_a_ball_that_lies_near_enough_is_not_placed(x: float, y: float, placed: bool) -> None:
    match = Match().lie(x, y).happens(K.BALL_LEFT_FIELD_TOUCH_LINE, BLUE, 1.0, 3.0).wait(2.5)
    assert match.game.command is (C.DIRECT_FREE_YELLOW if placed else C.BALL_PLACEMENT_YELLOW)


@pytest.mark.parametrize(("x", "placed"), [(-2.79, True), (-2.81, False)])
def test_a_ball_near_a_defence_area_is_placed(x: float, placed: bool) -> None:
    match = Match().lie(x, 0.0).happens(K.KEEPER_HELD_BALL, BLUE, -2.4, 0.0).wait(2.5)
    assert match.game.command is (C.DIRECT_FREE_YELLOW if placed else C.BALL_PLACEMENT_YELLOW)


def test_after_a_success_the_kick_may_be_taken_at_once() -> None:
    match = placing().wait(3.0).lie(1.0, 2.8).happens(K.PLACEMENT_SUCCEEDED, YELLOW).tick()
    assert match.game.command is C.DIRECT_FREE_YELLOW
    assert match.game.may_touch


def test_where_the_other_team_has_placed_the_ball_the_kicker_gets_two_seconds() -> None:
    match = placing().until(C.BALL_PLACEMENT_BLUE, 31.0).lie(1.0, 2.8).happens(K.PLACEMENT_SUCCEEDED, BLUE)
    assert match.wait(1.9).game.command is C.STOP
    match.until(C.DIRECT_FREE_YELLOW, 0.3)


def test_a_team_that_fails_is_followed_by_the_other_and_by_a_hand() -> None:
    match = placing().wait(29.9)
    assert K.PLACEMENT_FAILED not in match.kinds
    match.until(C.BALL_PLACEMENT_BLUE, 0.3)
    failed = match.events[-1]
    assert (failed.kind, failed.team) == (K.PLACEMENT_FAILED, YELLOW)
    assert failed.details["remaining_distance"] == pytest.approx((2.0**2 + 2.8**2) ** 0.5)
    assert match.game.upcoming is C.DIRECT_FREE_YELLOW
    match.until(C.STOP).until(C.DIRECT_FREE_YELLOW, 2.3)
    assert match.ball.position == pytest.approx((1.0, 2.8))
    assert [record.failures for record in match.controller.state.records.values()] == [1, 1]


def test_in_division_a_a_failure_loses_the_kick_where_the_ball_had_left() -> None:
    match = placing(DIVISION_A).until(C.BALL_PLACEMENT_BLUE)
    assert match.game.upcoming is C.DIRECT_FREE_BLUE
    assert match.until(C.STOP).game.upcoming is C.DIRECT_FREE_YELLOW
    assert placing(DIVISION_A, left=False).until(C.BALL_PLACEMENT_BLUE).game.upcoming is C.DIRECT_FREE_YELLOW


def test_a_team_that_cannot_place_is_not_asked() -> None:
    assert placing(yellow_can_place=False).until(C.BALL_PLACEMENT_BLUE, 0.2).game.status(BLUE).can_place_ball
    match = placing(yellow_can_place=False, blue_can_place=False).until(C.DIRECT_FREE_YELLOW, 2.3)
    assert not match.game.status(BLUE).can_place_ball


def test_in_division_a_every_team_is_asked() -> None:
    assert placing(DIVISION_A, yellow_can_place=False).until(C.BALL_PLACEMENT_YELLOW, 0.2)


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B], ids=["a", "b"])
def test_where_a_team_is_not_asked_any_more_the_other_places_and_the_kick_stays(field: FieldGeometry) -> None:
    match = Match(field).lie(-1.0, 0.0)
    match.controller.state.records[YELLOW].failures = 5
    match.happens(K.BALL_LEFT_FIELD_TOUCH_LINE, BLUE, 1.0, field.half_width)
    assert match.until(C.BALL_PLACEMENT_BLUE, 0.2).game.upcoming is C.DIRECT_FREE_YELLOW


def test_after_five_failures_a_team_is_not_asked_any_more() -> None:
    match = Match(placement_time=1.0, blue_can_place=False)
    for failures in range(1, 6):
        match.lie(-1.0, 0.0).happens(K.BALL_LEFT_FIELD_TOUCH_LINE, BLUE, 1.0, 3.0)
        match.until(C.BALL_PLACEMENT_YELLOW).until(C.DIRECT_FREE_YELLOW)
        assert match.controller.state.records[YELLOW].failures == failures
        match.lie(0.0, 0.0).tick()
    match.lie(-1.0, 0.0).happens(K.BALL_LEFT_FIELD_TOUCH_LINE, BLUE, 1.0, 3.0).wait(2.5)
    assert match.commands[-2:] == [C.STOP, C.DIRECT_FREE_YELLOW]
    assert not match.game.status(YELLOW).can_place_ball


def test_a_success_makes_up_for_a_failure() -> None:
    match = placing(placement_time=1.0, blue_can_place=False).until(C.DIRECT_FREE_YELLOW).lie(0.0, 0.0).tick()
    match.lie(-1.0, 0.0).happens(K.BALL_LEFT_FIELD_TOUCH_LINE, BLUE, 1.0, 3.0).tick()
    match.lie(1.0, 2.8).happens(K.PLACEMENT_SUCCEEDED, YELLOW)
    assert match.controller.state.records[YELLOW].failures == 0


def test_interference_gives_more_time_and_counts_once() -> None:
    match = (
        placing().tick().happens(K.BOT_INTERFERED_PLACEMENT, BLUE).happens(K.BOT_INTERFERED_PLACEMENT, BLUE)
    )
    assert match.controller.state.records[BLUE].fouls == 1
    assert match.game.action_time == pytest.approx(50.0, abs=0.3)
    assert match.wait(49.0).game.command is C.BALL_PLACEMENT_YELLOW


def test_for_a_forced_start_the_team_is_drawn_by_lot() -> None:
    placers = set()
    for seed in range(20):
        match = Match()
        match.controller = Controller(
            DIVISION_B, RefereeSettings(opening="force_start"), np.random.default_rng(seed)
        )
        match.lie(-3.9, 0.0).tick().happens(K.NO_PROGRESS_IN_GAME, None).tick()
        placers.add(match.game.restart_team)
    assert placers == set(Team)


def test_kick_offs_and_penalties_are_placed_by_hand() -> None:
    match = Match().lie(4.6, 0.0).goal(BLUE).until(C.PREPARE_KICKOFF_YELLOW, 3.0)
    assert match.ball.position == (0.0, 0.0)
    match = (
        Match().lie(-4.0, 0.0).happens(K.DEFENDER_IN_DEFENSE_AREA, BLUE).until(C.PREPARE_PENALTY_YELLOW, 3.0)
    )
    assert match.ball.position == pytest.approx((1.5, 0.0))


# Fouls and cards.


def fouls(match: Match, team: Team, count: int) -> Match:
    for _ in range(count):
        match.happens(K.BOT_CRASH_UNIQUE, team)
    return match


@pytest.mark.parametrize("kind", sorted(FOULS - {K.BOT_CRASH_DRAWN}))
def test_every_foul_counts(kind: EventKind) -> None:
    assert Match().happens(kind, BLUE).controller.state.records[BLUE].fouls == 1


@pytest.mark.parametrize(
    "kind",
    [K.DEFENDER_IN_DEFENSE_AREA, K.ATTACKER_DOUBLE_TOUCHED_BALL, K.NO_PROGRESS_IN_GAME, K.AIMLESS_KICK],
)
def test_these_are_no_fouls_that_count(kind: EventKind) -> None:
    assert Match().happens(kind, BLUE).controller.state.records[BLUE].fouls == 0


def test_each_third_foul_is_a_yellow_card_of_two_minutes_playing_time() -> None:
    match = fouls(Match(), BLUE, 2)
    assert match.game.status(BLUE).max_robots == 6
    fouls(match, BLUE, 1)
    assert match.kinds[-2:] == [K.BOT_CRASH_UNIQUE, K.MULTIPLE_FOULS]
    assert match.events[-1].details["caused_game_events"] == ", ".join(["bot_crash_unique"] * 3)
    assert (match.game.status(BLUE).max_robots, match.game.status(BLUE).yellow_cards) == (5, 1)
    assert match.game.in_play
    match.happens(K.KEEPER_HELD_BALL, YELLOW).put(YELLOW, 1, 0.3, 0.0).wait(60.0)
    assert match.game.stopped
    match.put(YELLOW, 1, 3.0, 0.0).until(C.DIRECT_FREE_BLUE).wait(118.0)
    assert match.game.status(BLUE).max_robots == 5
    match.wait(3.0)
    assert (match.game.status(BLUE).max_robots, match.game.status(BLUE).yellow_cards) == (6, 0)


def test_a_third_card_while_two_run_is_red_to_the_end() -> None:
    match = fouls(Match(), BLUE, 9)
    assert match.kinds[-3:] == [K.BOT_CRASH_UNIQUE, K.MULTIPLE_FOULS, K.MULTIPLE_CARDS]
    status = match.game.status(BLUE)
    assert (status.yellow_cards, status.red_cards, status.max_robots) == (2, 1, 3)
    status = match.wait(130.0).game.status(BLUE)
    assert (status.yellow_cards, status.red_cards, status.max_robots) == (0, 1, 5)


def test_the_other_team_may_want_play_to_go_on_for_its_advantage() -> None:
    match = Match()
    match.controller.requests.advantage(YELLOW, True)
    assert match.happens(K.TOO_MANY_ROBOTS, BLUE).game.in_play
    match.controller.requests.advantage(YELLOW, False)
    assert match.happens(K.TOO_MANY_ROBOTS, BLUE).game.stopped


# Too close to the defence area.


def test_too_close_in_stop_gives_the_others_the_free_kick_and_the_second_time_a_halt() -> None:
    match = Match().happens(K.BALL_LEFT_FIELD_TOUCH_LINE, YELLOW, 0.5, 3.0)
    match.lie(0.5, 2.8).happens(K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA, BLUE)
    assert (match.game.command, match.game.restart_team) == (C.STOP, YELLOW)
    assert match.game.placement == pytest.approx((0.5, 2.8))
    match.happens(K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA, BLUE)
    assert match.game.command is C.HALT
    assert match.controller.state.records[BLUE].fouls == 2
    match.until(C.STOP, 2.1).wait(9.0)
    assert match.game.stopped
    match.until(C.DIRECT_FREE_YELLOW, 3.2)


def test_one_of_each_team_is_no_halt() -> None:
    match = Match().happens(K.BALL_LEFT_FIELD_TOUCH_LINE, YELLOW, 0.5, 3.0)
    for team in Team:
        match.happens(K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA, team)
    assert (match.game.command, match.game.restart_team) == (C.STOP, BLUE)


def test_too_close_at_a_free_kick_stops_it() -> None:
    match = Match().happens(K.KEEPER_HELD_BALL, YELLOW).until(C.DIRECT_FREE_BLUE)
    match.happens(K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA, BLUE)
    assert (match.game.command, match.game.upcoming) == (C.STOP, C.DIRECT_FREE_YELLOW)


def test_a_kick_off_stays_a_kick_off() -> None:
    match = Match().goal(BLUE).happens(K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA, YELLOW)
    assert match.game.upcoming is C.PREPARE_KICKOFF_YELLOW


# Penalty kicks.


def penalty(**settings: object) -> Match:
    """Blue's penalty kick from (-1.5, 0) may be taken."""
    match = Match(opening="penalty", **settings).put(YELLOW, 0, 4.45, 0.0).put(BLUE, 1, -2.1, 0.0)
    match.until(C.PREPARE_PENALTY_BLUE, 5.0)
    assert match.game.penalty is BLUE
    return match.until(C.NORMAL_START, 2.2)


@pytest.mark.parametrize(
    ("team", "number", "x", "y", "fair"),
    [
        (YELLOW, 0, 4.45, 0.49, True),
        (YELLOW, 0, 4.45, 0.51, False),
        (YELLOW, 0, 4.42, 0.0, True),
        (YELLOW, 0, 4.40, 0.0, False),
        (YELLOW, 1, -2.51, 2.0, True),
        (YELLOW, 1, -2.49, 2.0, False),
        (BLUE, 2, -2.51, 2.0, True),
        (BLUE, 2, -2.49, 2.0, False),
    ],
)
def test_a_penalty_waits_for_the_keeper_on_its_line_and_all_others_behind(
    team: Team, number: int, x: float, y: float, fair: bool
) -> None:
    match = Match(opening="penalty").put(YELLOW, 0, 4.45, 0.0).put(BLUE, 1, -2.1, 0.0).put(team, number, x, y)
    match.until(C.PREPARE_PENALTY_BLUE, 5.0).wait(3.0)
    assert match.game.command is (C.NORMAL_START if fair else C.PREPARE_PENALTY_BLUE)


def test_in_a_penalty_the_ball_is_free_once_it_has_moved_and_it_goes_on() -> None:
    match = penalty().lie(-1.4, 0.0).tick()
    assert (match.game.restart, match.game.penalty, match.game.command) == (None, BLUE, C.NORMAL_START)
    match.goal(BLUE)
    assert (score(match), match.game.penalty, match.game.restart_team) == ((1, 0), None, YELLOW)


def test_a_penalty_ends_after_ten_seconds() -> None:
    match = penalty().lie(0.0, 0.0).wait(9.9)
    assert match.game.penalty is BLUE
    match.wait(0.2)
    assert match.kinds[-1] is K.PENALTY_KICK_FAILED
    assert (match.game.restart_team, match.game.placement) == (YELLOW, pytest.approx((3.5, 2.8)))


@pytest.mark.parametrize(
    ("kind", "team", "goals"),
    [
        (K.PENALTY_KICK_FAILED, BLUE, 0),
        (K.BOT_CRASH_UNIQUE, BLUE, 0),
        (K.BOT_CRASH_UNIQUE, YELLOW, 1),
        (K.BOT_DRIBBLED_BALL_TOO_FAR, BLUE, 0),
        (K.BOT_PUSHED_BOT, YELLOW, 1),
        (K.POSSIBLE_GOAL, YELLOW, 0),
    ],
)
def test_breaches_end_a_penalty(kind: EventKind, team: Team, goals: int) -> None:
    match = penalty().lie(1.0, 0.0).happens(kind, team, 4.0, 1.0)
    assert score(match) == (goals, 0)
    assert match.game.command is C.STOP
    assert match.game.restart is (Restart.KICKOFF if goals else Restart.FREE_KICK)
    assert match.game.restart_team is YELLOW


def test_a_penalty_goal_after_the_kickers_foul_does_not_count() -> None:
    match = penalty()
    match.controller.state.records[BLUE].last_foul = match.time
    match.goal(BLUE)
    assert match.kinds[-2:] == [K.POSSIBLE_GOAL, K.INVALID_GOAL]
    assert (score(match), match.game.restart, match.game.restart_team) == ((0, 0), Restart.FREE_KICK, YELLOW)


# Stages.


def halves(**settings: object) -> Match:
    return Match(half_length=20.0, half_time=3.0, no_progress_time=None, **settings)


def test_a_half_ends_at_the_first_stop_after_its_playing_time() -> None:
    match = halves().wait(25.0)
    assert match.game.in_play
    assert match.game.stage_time == pytest.approx(-5.0, abs=0.2)
    match.happens(K.NO_PROGRESS_IN_GAME, None).tick()
    assert (match.game.command, match.game.stage) == (C.HALT, Stage.NORMAL_HALF_TIME)
    match.until(C.STOP, 3.1)
    assert (match.game.stage, match.game.restart_team) == (Stage.NORMAL_SECOND_HALF_PRE, YELLOW)
    match.wait(9.9)
    assert match.game.stopped
    match.until(C.NORMAL_START, 3.0)
    assert match.game.stage is Stage.NORMAL_SECOND_HALF
    match.wait(25.0).happens(K.NO_PROGRESS_IN_GAME, None).tick()
    assert (match.game.command, match.game.stage) == (C.HALT, Stage.POST_GAME)
    assert match.wait(20.0).game.halted


def test_the_clock_stands_while_play_is_stopped() -> None:
    match = halves().wait(10.0).put(BLUE, 1, 0.3, 0.0).happens(K.NO_PROGRESS_IN_GAME, None).wait(30.0)
    assert match.game.stage_time == pytest.approx(10.0, abs=0.2)


def test_a_penalty_is_taken_though_the_half_is_over() -> None:
    match = halves().wait(25.0).put(BLUE, 0, -4.45, 0.0).happens(K.DEFENDER_IN_DEFENSE_AREA, BLUE)
    match.until(C.NORMAL_START).goal(YELLOW).tick()
    assert (score(match), match.game.stage) == ((0, 1), Stage.NORMAL_HALF_TIME)


def test_a_new_half_forgives_failures() -> None:
    match = halves()
    match.controller.state.records[BLUE].failures = 5
    match.wait(25.0).happens(K.NO_PROGRESS_IN_GAME, None).until(C.NORMAL_START)
    assert match.game.status(BLUE).can_place_ball


@pytest.mark.parametrize(
    ("blue", "yellow", "over"), [(10, 8, True), (10, 9, False), (9, 0, False), (11, 10, False)]
)
def test_ten_goals_and_a_lead_of_two_end_the_match(blue: int, yellow: int, over: bool) -> None:
    match = halves()
    match.controller.state.records[BLUE].score = blue - 1
    match.controller.state.records[YELLOW].score = yellow
    assert (match.goal(BLUE).tick().game.stage is Stage.POST_GAME) is over


def play_on(match: Match) -> Match:
    """Play the present stage to its end."""
    match.until(C.NORMAL_START) if match.game.command is not C.FORCE_START else None
    return match.wait(25.0).happens(K.NO_PROGRESS_IN_GAME, None).tick()


def test_a_draw_leads_to_overtime_and_a_shoot_out() -> None:
    match = halves(extra_length=10.0, shoot_out=True)
    stages = []
    for _ in range(4):
        stages.append(play_on(match).game.stage)
    assert stages == [
        Stage.NORMAL_HALF_TIME,
        Stage.EXTRA_TIME_BREAK,
        Stage.EXTRA_HALF_TIME,
        Stage.PENALTY_SHOOTOUT_BREAK,
    ]
    match.until(C.PREPARE_PENALTY_BLUE)
    assert match.game.stage is Stage.PENALTY_SHOOTOUT
    assert match.controller.state.records[BLUE].time_outs == 2


def test_without_a_draw_there_is_none() -> None:
    match = halves(extra_length=10.0, shoot_out=True).goal(BLUE)
    play_on(match)
    assert play_on(match).game.stage is Stage.POST_GAME


def shoot_out(blue: str, yellow: str) -> Match:
    """Play a shoot-out in which kicks score (x) or fail (-)."""
    match = Match(opening="shoot_out").put(YELLOW, 0, 4.45, 0.0).put(BLUE, 0, -4.45, 0.0)
    for first, second in zip(blue, yellow, strict=True):
        for team, kick in ((BLUE, first), (YELLOW, second)):
            match.until(C.NORMAL_START, 20.0)
            assert match.game.restart_team is team
            match.goal(team) if kick == "x" else match.happens(K.PENALTY_KICK_FAILED, team)
            match.tick()
    return match


def test_in_a_shoot_out_the_teams_kick_in_turn_five_times() -> None:
    match = shoot_out("xx--", "x---")
    assert (match.game.stage, score(match)) == (Stage.PENALTY_SHOOTOUT, (2, 1))
    match = shoot_out("xx---", "x----")
    assert (match.game.stage, score(match)) == (Stage.POST_GAME, (2, 1))


def test_a_drawn_shoot_out_goes_on_in_pairs() -> None:
    assert shoot_out("x----", "x----").game.stage is Stage.PENALTY_SHOOTOUT
    assert shoot_out("x----x", "x----x").game.stage is Stage.PENALTY_SHOOTOUT
    assert shoot_out("x----x", "x-----").game.stage is Stage.POST_GAME


# Requests.


def test_a_time_out_begins_at_the_next_stop_and_ends_when_told() -> None:
    match = Match()
    assert match.controller.requests.time_out(BLUE)
    assert match.wait(1.0).game.in_play
    match.happens(K.KEEPER_HELD_BALL, YELLOW).tick()
    assert match.game.command is C.TIMEOUT_BLUE
    assert match.wait(60.0).game.halted
    assert match.controller.requests.end_time_out(BLUE)
    match.until(C.STOP, 0.2).until(C.DIRECT_FREE_BLUE, 12.1)
    record = match.controller.state.records[BLUE]
    assert (record.time_outs, record.time_out_left) == (3, pytest.approx(240.0, abs=0.2))


def test_a_time_out_ends_with_its_time_and_none_is_left_then() -> None:
    match = Match()
    match.controller.requests.time_out(YELLOW)
    match.happens(K.KEEPER_HELD_BALL, YELLOW).wait(299.0)
    assert match.game.command is C.TIMEOUT_YELLOW
    match.until(C.STOP, 1.2)
    assert not match.controller.requests.time_out(YELLOW)


def test_a_wish_for_a_time_out_can_be_taken_back() -> None:
    match = Match()
    match.controller.requests.time_out(BLUE)
    assert match.controller.requests.end_time_out(BLUE)
    assert match.happens(K.KEEPER_HELD_BALL, YELLOW).game.command is C.STOP
    assert not match.controller.requests.end_time_out(BLUE)


def test_a_substitution_is_a_halt_of_twenty_seconds_at_the_next_stop() -> None:
    match = Match()
    match.controller.requests.substitution(BLUE)
    match.happens(K.KEEPER_HELD_BALL, YELLOW).tick()
    assert (match.game.command, match.kinds[-1]) == (C.HALT, K.BOT_SUBSTITUTION)
    assert (match.game.status(BLUE).substituting, match.game.status(YELLOW).substituting) == (True, False)
    match.until(C.STOP, 20.1)
    assert not match.game.status(BLUE).substituting
    assert match.until(C.DIRECT_FREE_BLUE, 12.1).controller.state.records[BLUE].substitutions == 4


def test_beyond_the_budget_it_is_a_foul_and_a_corner_for_the_others() -> None:
    match = Match()
    match.controller.state.records[BLUE].substitutions = 0
    match.controller.requests.substitution(BLUE)
    match.happens(K.KEEPER_HELD_BALL, YELLOW).tick()
    assert match.kinds[-2:] == [K.BOT_SUBSTITUTION, K.EXCESSIVE_BOT_SUBSTITUTION]
    assert match.controller.state.records[BLUE].fouls == 1
    match.until(C.STOP, 20.1)
    assert (match.game.upcoming, match.game.placement) == (C.DIRECT_FREE_YELLOW, pytest.approx((-4.3, 2.8)))


@pytest.mark.parametrize(("x", "allowed"), [(-1.0, False), (1.0, True)])
def test_the_keeper_changes_while_the_ball_is_away_or_out_of_play(x: float, allowed: bool) -> None:
    match = Match().lie(x, 0.0).tick()
    assert match.controller.requests.keeper(BLUE, 3) is allowed
    assert match.tick().game.status(BLUE).keeper == (3 if allowed else 0)
    match.happens(K.NO_PROGRESS_IN_GAME, None)
    assert match.controller.requests.keeper(BLUE, 4)
    assert match.tick().game.status(BLUE).keeper == 4


# Openings.


def test_a_placement_drill_begins_with_the_placement() -> None:
    match = Match(opening="ball_placement", opening_team="yellow", opening_spot=(1.0, 1.0))
    game = match.game
    assert (game.command, game.restart_team, game.placement) == (C.BALL_PLACEMENT_YELLOW, YELLOW, (1.0, 1.0))
    assert (game.may_touch, game.upcoming) == (True, C.DIRECT_FREE_YELLOW)


def test_a_free_kick_drill_begins_with_the_ball_at_its_spot() -> None:
    match = Match(opening="free_kick", opening_team="yellow", opening_spot=(-2.0, -1.0))
    match.until(C.DIRECT_FREE_YELLOW, 3.0)
    assert match.ball.position == (-2.0, -1.0)


def test_a_random_spot_is_a_legal_one_and_follows_from_the_generator() -> None:
    spots = []
    for seed in [*range(50), 0]:
        match = Match()
        match.controller = Controller(
            DIVISION_B,
            RefereeSettings(opening="ball_placement", opening_spot="random"),
            np.random.default_rng(seed),
        )
        spots.append(match.tick().game.placement)
    assert spots[0] == spots[-1]
    assert len(set(spots)) == 50
    assert all(spot is not None and abs(spot[0]) <= 4.3 and abs(spot[1]) <= 2.8 for spot in spots)


def test_the_second_team_may_kick_off_first() -> None:
    assert Match(opening="kickoff", opening_team="yellow").game.command is C.PREPARE_KICKOFF_YELLOW


def test_states_that_differ_only_in_their_times_are_equal() -> None:
    match = halves()
    before = match.game
    assert match.tick().game == replace(before, stage_time=0.0)
