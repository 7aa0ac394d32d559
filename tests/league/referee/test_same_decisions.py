"""Our controller and the official one decide alike, event by event; where they do not, it is told why."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import product
from math import cos, sin
from pathlib import Path

import numpy as np
import pytest

from robobt.league.referee.lockstep import EPOCH, LockstepController
from robobt.league.referee.process import GameControllerProcess
from robobt.league.referee.setup import MatchSetup, command, game_event
from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.messages import Change
from robobt.match.referee.controller import Controller
from robobt.match.referee.events import Detail, EventKind, RefereeEvent
from robobt.match.referee.openings import opening_of
from robobt.match.referee.restarts import free_kick, kickoff, penalty
from robobt.match.referee.settings import RefereeSettings
from robobt.world import (
    DIVISION_A,
    DIVISION_B,
    BallState,
    FieldGeometry,
    Frame,
    GameState,
    RobotId,
    RobotState,
    Team,
)
from robobt.world.game import RefereeCommand
from robobt.world.geometry import Point
from robobt.world.rules import own_side

OFFICIAL = os.environ.get("ROBOBT_GAME_CONTROLLER", "")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not OFFICIAL, reason="ROBOBT_GAME_CONTROLLER does not name the official program"),
]

K = EventKind
GENERATOR = np.random.default_rng(1)
STATES = ("play", "free_kick", "kickoff", "penalty", "stop_free_kick", "stop_kickoff")
STOPPED = (RefereeCommand.STOP, RefereeCommand.HALT)
IN_STOP = (
    K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA,
    K.BOT_TOO_FAST_IN_STOP,
    K.BOT_CRASH_UNIQUE,
    K.BOT_CRASH_DRAWN,
)
REPORTED = sorted(
    set(EventKind)
    - {
        # The controller's own, or people's.
        K.GOAL,
        K.INVALID_GOAL,
        K.PLACEMENT_FAILED,
        K.PLACEMENT_SUCCEEDED,
        K.MULTIPLE_FOULS,
        K.MULTIPLE_CARDS,
        K.BOT_SUBSTITUTION,
        K.EXCESSIVE_BOT_SUBSTITUTION,
        K.CHALLENGE_FLAG,
        K.CHALLENGE_FLAG_HANDLED,
        K.EMERGENCY_STOP,
        K.UNSPORTING_BEHAVIOR_MINOR,
        K.UNSPORTING_BEHAVIOR_MAJOR,
    }
)


class Ours:
    """Our controller in a state, and what it makes of one event."""

    def __init__(self, field: FieldGeometry, state: str, team: Team) -> None:
        self.field = field
        self.controller = Controller(field, RefereeSettings(opening="force_start"), np.random.default_rng(1))
        self.update()
        match = self.controller.state
        if state == "play":
            return
        if state == "stop_free_kick":
            self.update(*before(field, state, team))
            return
        if state == "stop_kickoff":
            match.stop(kickoff(team))
            return
        kicks = {
            "free_kick": free_kick(field, team, 0.0, 0.0),
            "kickoff": kickoff(team),
            "penalty": penalty(field, team),
        }
        match.stop(kicks[state])
        match.resume()
        if state != "free_kick":
            match.allow(RefereeCommand.NORMAL_START)

    def update(self, *events: RefereeEvent) -> GameState:
        where = (events[0].x, events[0].y) if events else (0.0, 0.0)
        time = self.controller.state.time
        return self.controller.update(Frame(time, self.field, BallState(*where)), events).game


class Official:
    """The official controller, brought into the same states."""

    def __init__(self, controller: LockstepController, field: FieldGeometry) -> None:
        self.controller, self.field = controller, field
        self.follower = RefereeFollower()
        self.time = 0.0
        self.fouls: dict[Team, int] = {}

    def tick(self, seconds: float) -> None:
        self.time += seconds
        self.controller.ask(self.time)
        self.follow(self.controller.answer() + self.controller.rest())

    def change(self, *changes: Change) -> GameState:
        for change in changes:
            self.follow(self.controller.change([change]))
        return self.follower.game

    def follow(self, messages: list) -> None:  # type: ignore[type-arg]
        for message in messages:
            self.follower.follow(message)
            self.fouls = {
                Team.BLUE: message.blue.foul_counter,
                Team.YELLOW: message.yellow.foul_counter,
            }

    def report(self, event: RefereeEvent) -> GameState:
        return self.change(game_event(write_event(event, EPOCH, "UI")))

    def bring(self, state: str, team: Team) -> None:
        self.tick(3.0)
        self.change(command("STOP"), command("FORCE_START"))
        if state in ("stop_free_kick", "stop_kickoff"):
            for event in before(self.field, state, team):
                self.report(event)
            return
        kinds = {"free_kick": "DIRECT", "kickoff": "KICKOFF", "penalty": "PENALTY"}
        if state != "play":
            self.change(command("STOP"), command(kinds[state], team))
            if state != "free_kick":
                self.change(command("NORMAL_START"))


def before(field: FieldGeometry, state: str, team: Team) -> Iterator[RefereeEvent]:
    """What leads to a stop before our free kick or kick-off."""
    kind = K.BALL_LEFT_FIELD_TOUCH_LINE if state == "stop_free_kick" else K.GOAL
    yield RefereeEvent(0.0, kind, team.other, RobotId(team.other, 1), 1.0, field.half_width)


def happening(lot: np.random.Generator, field: FieldGeometry, kind: EventKind, team: Team) -> RefereeEvent:
    """An event somewhere on the field, or at the line where that is what it is about."""
    x, y = (
        float(share) * edge
        for share, edge in zip(
            lot.uniform(-0.95, 0.95, 2), (field.half_length, field.half_width), strict=True
        )
    )
    details: dict[str, Detail] = {}
    if kind is K.BALL_LEFT_FIELD_TOUCH_LINE:
        y = field.half_width + 0.0215 if y > 0.0 else -field.half_width - 0.0215
    if kind in (K.BALL_LEFT_FIELD_GOAL_LINE, K.POSSIBLE_GOAL, K.AIMLESS_KICK):
        x = field.half_length + 0.0215 if x > 0.0 else -field.half_length - 0.0215
    if kind in (K.POSSIBLE_GOAL, K.AIMLESS_KICK):
        x = abs(x) if team is Team.BLUE else -abs(x)
    if kind is K.POSSIBLE_GOAL:
        y *= 0.1
        details = {"kicking_team": team, "max_ball_height": 0.0, "num_robots_by_team": 0}
    if kind is K.AIMLESS_KICK:
        details = {"kick_location": (-0.5 * x, 0.5 * y)}
    if kind is K.BOT_DRIBBLED_BALL_TOO_FAR:
        details = {"start": (x, y), "end": (x + 1.1, y)}
    if kind is K.BOT_CRASH_DRAWN:
        return RefereeEvent(0.0, kind, None, None, x, y, {"bot_blue": 1, "bot_yellow": 2, "crash_speed": 2.0})
    if kind is K.BOT_CRASH_UNIQUE:
        details = {"victim": 2, "crash_speed": 2.0}
    if kind in (
        K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA,
        K.TOO_MANY_ROBOTS,
        K.BOT_TIPPED_OVER,
        K.BOT_DROPPED_PARTS,
    ):
        details = {"ball_location": (x, y)}
    if kind is K.NO_PROGRESS_IN_GAME:
        return RefereeEvent(0.0, kind, None, None, x, y, {"time": 10.0})
    return RefereeEvent(0.0, kind, team, RobotId(team, 1), x, y, details)


def told(kind: EventKind, game: GameState, goals: int) -> dict[str, object]:
    """What is compared of a state."""
    spot = None
    # Before a kick-off the official one names another spot where a robot is near the area; it means nothing.
    kickoff_follows = game.upcoming in (
        RefereeCommand.PREPARE_KICKOFF_BLUE,
        RefereeCommand.PREPARE_KICKOFF_YELLOW,
    )
    if game.command in STOPPED and game.placement is not None and not kickoff_follows:
        spot = tuple(round(part, 2) + 0.0 for part in game.placement)
    # The official one waits in a HALT for somebody who looks at the goal again; ours goes on to the STOP.
    command = None if kind is K.POSSIBLE_GOAL else game.command
    return {"command": command, "upcoming": game.upcoming, "spot": spot, "goals": goals}


def reported(state: str, kind: EventKind, team: Team, kicking: Team) -> bool:
    """Return whether an automatic referee reports this in the state."""
    if state.startswith("stop"):
        return kind in IN_STOP
    if kind is K.PENALTY_KICK_FAILED or (kind is K.POSSIBLE_GOAL and state == "penalty"):
        return state == "penalty" and team is kicking
    return True


@contextmanager
def begun(field: FieldGeometry, *, by_itself: bool) -> Iterator[Official]:
    """Start the official controller, which goes on by itself or waits for clicks."""
    # So many that cards never take all of them: with fewer than none no goal would count.
    setup = MatchSetup(field, RefereeSettings(), {Team.BLUE: 500, Team.YELLOW: 500})
    with GameControllerProcess(Path(OFFICIAL), setup.game_settings()) as process:
        controller = LockstepController(process.stream)
        config = setup.config()
        config.auto_continue = by_itself
        controller.ask(0.0)
        controller.answer()
        opening = opening_of(setup.settings, field, Frame(0.0, field, BallState(0.0, 0.0)), GENERATOR)
        controller.change(setup.changes(opening), config)
        controller.ask(0.0, None, write_geometry(field))
        controller.answer()
        yield Official(controller, field)


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B], ids=["a", "b"])
def test_both_decide_alike(field: FieldGeometry) -> None:
    lot = np.random.default_rng(1)
    differing: list[str] = []
    compared = 0
    with begun(field, by_itself=False) as official:
        for state, kind, team, kicking in product(STATES, REPORTED, Team, Team):
            if not reported(state, kind, team, kicking) or (kind is K.AIMLESS_KICK and field is DIVISION_A):
                continue
            event = happening(lot, field, kind, team)
            ours = Ours(field, state, kicking)
            records = ours.controller.state.records
            official.bring(state, kicking)
            scores = [
                game.blue_score + game.yellow_score for game in (ours.controller.game, official.follower.game)
            ]
            fouls = dict(official.fouls), {each: records[each].fouls for each in Team}
            mine, theirs = ours.update(event), official.report(event)
            one = told(kind, mine, mine.blue_score + mine.yellow_score - scores[0])
            other = told(kind, theirs, theirs.blue_score + theirs.yellow_score - scores[1])
            one["fouls"] = {each: records[each].fouls - fouls[1][each] for each in Team}
            other["fouls"] = {each: official.fouls[each] - fouls[0][each] for each in Team}
            compared += 1
            if one != other:
                parts = "; ".join(
                    f"{key}: {one[key]} / {other[key]}" for key in one if one[key] != other[key]
                )
                differing.append(f"{state} of {kicking}, {kind} by {event.team}: {parts}")
    assert compared > 350
    assert not differing, f"{len(differing)} of {compared}: " + "\n".join(differing)


Places = list[tuple[Team, int, float, float]]
WAITING = ("stop_free_kick", "stop_kickoff", "prepare_kickoff", "prepare_penalty")


def standing(
    lot: np.random.Generator, field: FieldGeometry, state: str, kicking: Team
) -> tuple[Point, Places]:
    """Put ball and robots where some of them, now and then, are a little out of place."""
    ahead = 1.0 if kicking is Team.BLUE else -1.0

    def near(limit: float, spread: float = 0.05) -> float:
        # Not at the limit itself: positions travel as single precision numbers.
        return limit + float(lot.choice((-1.0, 1.0, 1.0, 1.0))) * float(lot.uniform(0.002, spread))

    robots: Places = [(team, 9, own_side(team) * 2.0, 2.0) for team in Team]
    if state in ("stop_free_kick", "stop_kickoff"):
        spot = (1.0, field.half_width - 0.2) if state == "stop_free_kick" else (0.0, 0.0)
        off = near(0.9, 0.15) if state == "stop_free_kick" and lot.random() < 0.3 else 0.0
        ball = (spot[0] - off, spot[1])
        for team in Team:
            angle, gap = float(lot.uniform(3.3, 6.1)), near(0.54)
            robots.append((team, 1, ball[0] + gap * cos(angle), ball[1] + gap * sin(angle)))
        return ball, robots
    if state == "prepare_kickoff":
        for team in Team:
            robots.append((team, 1, own_side(team) * near(0.09), float(lot.uniform(-1.0, 1.0))))
        return (0.0, 0.0), robots
    mark = penalty(field, kicking).spot
    line, post = ahead * field.half_length, field.goal_width / 2
    robots = [
        (kicking.other, 0, line - ahead * near(0.0, 0.12), min(near(post - 0.05, 0.1), post + 0.04)),
        (kicking, 1, mark[0] - ahead * 0.3, 0.0),
        (kicking, 2, mark[0] - ahead * near(1.02, 0.1), 1.0),
        (kicking.other, 3, mark[0] - ahead * near(1.02, 0.1), -1.0),
    ]
    return mark, robots


def frames(field: FieldGeometry, ball: Point, robots: Places, begin: float) -> Iterator[Frame]:
    """Four seconds in which nobody moves."""
    own, opponents = (
        tuple(RobotState(number, x, y) for each, number, x, y in robots if each is team) for team in Team
    )
    for tick in range(1, 17):
        yield Frame(begin + 0.25 * tick, field, BallState(*ball), own, opponents)


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B], ids=["a", "b"])
def test_both_go_on_from_the_same_positions(field: FieldGeometry) -> None:
    lot = np.random.default_rng(2)
    differing, outcomes = [], set()
    with begun(field, by_itself=True) as official:
        # A match begins with a HALT, after which the first stop is longer.
        official.tick(12.0)
        for case in range(160):
            state, kicking = WAITING[case % 4], list(Team)[case // 4 % 2]
            ball, robots = standing(lot, field, state, kicking)
            ours = Ours(
                field, {"prepare_kickoff": "kickoff", "prepare_penalty": "penalty"}.get(state, state), kicking
            )
            match = ours.controller.state
            official.tick(0.1)
            if state.startswith("stop"):
                official.change(command("STOP"), command("FORCE_START"))
                for event in before(field, state, kicking):
                    official.report(event)
            else:
                match.stop(match.following)
                match.resume()
                kind = "KICKOFF" if state == "prepare_kickoff" else "PENALTY"
                official.change(command("STOP"), command(kind, kicking))
            begin = match.time
            for frame in frames(field, ball, robots, official.time):
                official.time = frame.time
                official.controller.ask(frame.time, frame)
                official.follow(official.controller.answer() + official.controller.rest())
                begin += 0.25
                ours.controller.update(replace(frame, time=begin), ())
            mine, theirs = ours.controller.game.command, official.follower.game.command
            outcomes.add(mine)
            if mine is not theirs:
                differing.append(f"{state} of {kicking}, {mine.name} / {theirs.name}: ball {ball}, {robots}")
    assert len(outcomes) > 6
    assert not differing, f"{len(differing)} of 160: " + "\n".join(differing)


CANNOT: dict[str, dict[Team, dict[str, object]]] = {
    "both can": {},
    "they cannot": {Team.YELLOW: {"can_place_ball": False}},
    "they failed": {Team.YELLOW: {"ball_placement_failures": 5}},
    "nobody can": {team: {"can_place_ball": False} for team in Team},
}


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B], ids=["a", "b"])
@pytest.mark.parametrize("case", CANNOT)
def test_both_ask_the_same_teams_to_place_a_ball_that_nobody_touches(field: FieldGeometry, case: str) -> None:
    given = {f"{team.value}_can_place": "can_place_ball" not in told for team, told in CANNOT[case].items()}
    ours = Controller(
        field,
        RefereeSettings(opening="force_start", **given),
        np.random.default_rng(1),
    )
    ours.update(Frame(0.0, field, BallState(-1.0, 0.0)), ())
    (event,) = before(field, "stop_free_kick", Team.YELLOW)
    mine: list[object] = []
    theirs: list[object] = []
    with begun(field, by_itself=True) as official:
        official.tick(12.0)
        for team, told in CANNOT[case].items():
            values = {name: {"value": value} for name, value in told.items()}
            update = Change.UpdateTeamState(for_team=team.name, **values)  # type: ignore[arg-type]
            official.change(Change(update_team_state_change=update))
            ours.state.records[team].failures = int(told.get("ball_placement_failures", 0))  # type: ignore[call-overload]
        official.change(command("STOP"), command("FORCE_START"))
        official.report(event)
        for tick in range(1, 300):
            frame = Frame(12.0 + 0.25 * tick, field, BallState(-1.0, 0.0))
            official.controller.ask(frame.time, frame)
            official.follow(official.controller.answer() + official.controller.rest())
            ours.update(replace(frame, time=0.25 * tick), (event,) if tick == 1 else ())
            for states, game in ((mine, ours.game), (theirs, official.follower.game)):
                state = game.command, game.upcoming
                if game.command is not RefereeCommand.STOP and state not in states[-1:]:
                    states.append(state)
        assert (ours.game.command, ours.game.upcoming) == (
            RefereeCommand.STOP,
            official.follower.game.upcoming,
        )
    assert mine == theirs
