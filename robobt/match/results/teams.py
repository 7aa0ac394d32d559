"""Team statistics of a match, counted from frames as the league's analysts count.

The same code serves a running match, a recording and a league log.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import atan2, hypot

import numpy as np
from pydantic import ConfigDict

from robobt.match.referee.events import EventKind
from robobt.match.referee.touches import Touches
from robobt.match.referee.verdicts import FOULS
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.world.game import GameState, Restart, Team
from robobt.world.geometry import Point, distance, line_crossing_x
from robobt.world.protocol import ReportedEvent
from robobt.world.rules import ball_out
from robobt.world.state import BallState, Frame, RobotId, RobotState

_KICKED_BALL_SPEED = 1.0
"""A ball that leaves a robot faster than this counts as kicked, not lost [m/s]."""

_BOUNCES = 0.1
"""A ball that leaves a robot within this time, no faster than it came, counts as bounced off [s]."""

_SHOT_ON_GOAL_SPEED = 2.0
"""A ball faster than this on its way into the goal counts as a shot [m/s]."""

_PASS_LINE_DISTANCE = 1.0
"""A kick whose line passes a team-mate ahead within this distance counts as a pass [m]."""

_SHORTEST_PASS = 0.3
"""A ball that a team-mate touches closer than this to the kick counts as handed over, not passed [m]."""

_COUNTED_RESTARTS = (Restart.KICKOFF, Restart.FREE_KICK)

_STRIDE = 0.1
"""Robots' distance is measured in straight pieces of this duration [s]."""

_TELEPORT_DISTANCE = 1.0
"""A robot that moved farther than this within one piece was placed there by hand [m]."""


@dataclass(slots=True)
class TeamResult:
    """One team's figures in one match.

    Attributes:
        goals: the score.
        passes: kicks towards a team-mate that were not shots (a ball that bounces or slips off is not
            kicked); ``passes_completed`` were next touched by a team-mate, ``passes_intercepted`` by an
            opponent.
        shots_on_goal: kicks of at least 2 m/s whose line led into the goal.
        expected_goals: sum of the shots' probabilities against a goalkeeper like the real ones, by the rater
            ``expected_goal``.
        possession: share of the time in play in which this team was the last to touch the ball.
        distance: total distance that its robots drove [m].
        fouls, yellow_cards, red_cards: as the referee counts them.
        placements, placements_succeeded: ball placements that it was asked for, and those that succeeded.
        restarts, restarts_kept: own kick-offs and free kicks after which the ball came into play, taken or
            not; those after which the first robot other than the kicker to touch the ball was of this team.
    """

    __pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)

    goals: int = 0
    passes: int = 0
    passes_completed: int = 0
    passes_intercepted: int = 0
    shots_on_goal: int = 0
    expected_goals: float = 0.0
    possession: float = 0.0
    distance: float = 0.0
    fouls: int = 0
    yellow_cards: int = 0
    red_cards: int = 0
    placements: int = 0
    placements_succeeded: int = 0
    restarts: int = 0
    restarts_kept: int = 0


@dataclass(slots=True)
class _Flight:
    """A kicked ball that no robot has touched yet."""

    kicker: RobotId
    start: Point
    is_pass: bool


class TeamStatistics:
    """Counts a match frame by frame; frames are true and seen from blue's side."""

    def __init__(self) -> None:
        self._teams = {team: TeamResult() for team in Team}
        self._touches = Touches()
        self._before: Frame | None = None
        self._marked: tuple[float, dict[RobotId, Point]] | None = None
        self._last: RobotId | None = None
        self._holder: RobotId | None = None
        self._came = -_BOUNCES, 0.0
        self._flight: _Flight | None = None
        self._placing: Team | None = None
        self._pending: Team | None = None
        self._restarted: Team | None = None
        self._taker: RobotId | None = None
        self._game: GameState | None = None
        self._cards = dict.fromkeys(Team, 0)
        self._owner: Team | None = None
        self._owned = dict.fromkeys(Team, 0)
        self._rater = ExpectedGoal(goalkeeper="fitted")

    def update(self, frame: Frame, game: GameState, events: Iterable[ReportedEvent] = ()) -> None:
        """Take in the next frame with its state of the game and its events."""
        self._touches.watch(frame)
        for event in events:
            self._count(event)
        if game is not self._game:
            self._game = game
            self._read(game)
        self._drive(frame)
        self._follow_restart(game)
        if game.in_play and not ball_out(frame.field, frame.ball.position):
            self._follow_ball(frame)
        else:
            if self._flight is not None and self._flight.is_pass:
                self._teams[self._flight.kicker.team].passes += 1
            # The kick of a restart counts when the ball leaves its kicker once it is in play.
            self._holder, self._flight = self._taker, None
        self._before, self._last = frame, self._touches.last

    def result(self) -> dict[str, TeamResult]:
        """Return the figures so far, by the team's name."""
        owned = sum(self._owned.values())
        return {
            team.value: replace(figures, possession=self._owned[team] / owned if owned else 0.0)
            for team, figures in self._teams.items()
        }

    def _count(self, event: ReportedEvent) -> None:
        if event.team is None:
            return
        figures = self._teams[event.team]
        if event.kind in FOULS:
            figures.fouls += 1
        elif event.kind == EventKind.PLACEMENT_SUCCEEDED:
            figures.placements_succeeded += 1

    def _read(self, game: GameState) -> None:
        """Take goals and cards from another state of the game."""
        for team in Team:
            figures, status = self._teams[team], game.status(team)
            figures.goals = game.blue_score if team is Team.BLUE else game.yellow_score
            figures.red_cards = status.red_cards
            figures.yellow_cards += max(0, status.yellow_cards - self._cards[team])
            self._cards[team] = status.yellow_cards

    def _drive(self, frame: Frame) -> None:
        if self._marked is not None and frame.time - self._marked[0] < _STRIDE:
            return
        places = {robot: state.position for robot, state in frame.robots().items()}
        if self._marked is not None:
            known = self._marked[1]
            for robot, place in places.items():
                way = distance(known.get(robot, place), place)
                if way < _TELEPORT_DISTANCE:
                    self._teams[robot.team].distance += way
        self._marked = frame.time, places

    def _follow_restart(self, game: GameState) -> None:
        placing = game.restart_team if game.restart is Restart.BALL_PLACEMENT else None
        if placing is not None and placing is not self._placing:
            self._teams[placing].placements += 1
        self._placing = placing
        if game.restart in _COUNTED_RESTARTS and game.may_touch and not game.stopped:
            takers = [robot for robot in self._touches.now if robot.team is game.restart_team]
            if self._pending is None or takers:
                self._taker = takers[0] if takers else None
            self._pending, self._restarted = game.restart_team, None
        elif not game.in_play:
            self._pending = self._restarted = self._taker = None
        elif self._pending is not None:
            self._restarted, self._pending = self._pending, None
            self._teams[self._restarted].restarts += 1

    def _follow_ball(self, frame: Frame) -> None:
        now = self._touches.now
        if now:
            toucher = now[0] if self._holder not in now else self._holder
            assert toucher is not None
            self._touched(toucher, frame)
            self._holder = toucher
        else:
            last = self._touches.last
            if last is not None and last != self._last:
                # One-touch contact: the ball came and left between two frames.
                self._touched(last, frame)
                self._holder = last
            if self._holder is not None:
                self._left(self._holder, frame)
                self._holder = None
        if self._owner is not None:
            self._owned[self._owner] += 1

    def _touched(self, toucher: RobotId, frame: Frame) -> None:
        self._owner = toucher.team
        if toucher != self._holder and self._before is not None:
            self._came = frame.time, self._before.ball.speed
        if self._restarted is not None and toucher != self._taker:
            self._teams[self._restarted].restarts_kept += toucher.team is self._restarted
            self._restarted = self._taker = None
        flight, self._flight = self._flight, None
        if flight is None or not flight.is_pass or toucher == flight.kicker:
            return
        figures = self._teams[flight.kicker.team]
        if toucher.team is not flight.kicker.team:
            figures.passes += 1
            figures.passes_intercepted += 1
        elif distance(flight.start, frame.ball.position) >= _SHORTEST_PASS:
            figures.passes += 1
            figures.passes_completed += 1

    def _left(self, kicker: RobotId, frame: Frame) -> None:
        """Decide whether the ball that has just left a robot was lost, shot or passed."""
        before = self._before
        if before is None or frame.ball.speed < _KICKED_BALL_SPEED:
            return
        since, speed = self._came
        if frame.time - since < _BOUNCES and frame.ball.speed <= speed:
            return
        view, seen = before.seen_by(kicker.team), frame.seen_by(kicker.team)
        me = view.robot(kicker.number)
        if me is None or _going_away(seen.ball, me) < _KICKED_BALL_SPEED:
            return
        at = _goal_crossing(seen)
        if at is not None and seen.ball.speed >= _SHOT_ON_GOAL_SPEED:
            figures = self._teams[kicker.team]
            figures.shots_on_goal += 1
            figures.expected_goals += self._chance(view, me, at)
            return
        self._flight = _Flight(kicker, frame.ball.position, _is_pass(seen, me))

    def _chance(self, view: Frame, me: RobotState, y: float) -> float:
        points = np.array([[view.field.half_length, y]])
        chances = self._rater.chances(view, view.ball.position, me, points)
        return 0.0 if chances is None else float(chances[0])


def _going_away(ball: BallState, me: RobotState) -> float:
    """Return the ball's speed relative to the robot's mouth, which may drive and turn [m/s]."""
    return hypot(ball.vx - me.vx + me.omega * (ball.y - me.y), ball.vy - me.vy - me.omega * (ball.x - me.x))


def _goal_crossing(view: Frame) -> float | None:
    """Return the y at which the ball's line enters the opponents' goal [m], or None if it does not."""
    ball, field = view.ball, view.field
    y = line_crossing_x(ball.position, atan2(ball.vy, ball.vx), field.half_length)
    return None if y is None or abs(y) >= field.goal_width / 2 else y


def _is_pass(view: Frame, me: RobotState) -> bool:
    ball = view.ball
    speed = hypot(ball.vx, ball.vy)
    ux, uy = ball.vx / speed, ball.vy / speed
    for mate in view.own:
        dx, dy = mate.x - ball.x, mate.y - ball.y
        if mate.id != me.id and ux * dx + uy * dy > 0.0 and abs(ux * dy - uy * dx) < _PASS_LINE_DISTANCE:
            return True
    return False
