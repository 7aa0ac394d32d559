"""Fouls while the ball is in play."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import hypot

from robobt.match.referee.events import EventKind
from robobt.match.referee.restarts import Resumption, drop_ball, free_kick, penalty
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.touches import Touches
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import PUSH_FACTOR, in_defense_area
from robobt.world.state import ROBOT_RADIUS, Frame, RobotId, RobotState

_MEMORY = 2.0
"""A foul that did not stop play annuls its team's goals for this long [s]."""

_EQUAL_SPEEDS = 0.3
"""Both robots are at fault in a crash when their speeds differ by less than this [m/s]."""

SPEED_TOLERANCE = 0.02
"""Measuring tolerance of speeds [m/s]."""


@dataclass(slots=True, frozen=True)
class Foul:
    """An offence, or a lack of progress.

    ``team`` is the offender's, None where nobody is at fault, and ``robot`` the offender as far as known;
    play resumes with ``resumption``, None where the foul does not stop it.
    """

    kind: EventKind
    team: Team | None
    robot: RobotId | None
    resumption: Resumption | None = None


class Fouls:
    """Watches for fouls while the ball is in play; frames are seen from blue's side.

    ``settings`` say which checks are on; ``touches`` are kept up to date by the caller.
    """

    def __init__(self, field: FieldGeometry, settings: RefereeSettings, touches: Touches) -> None:
        self._field, self._settings, self._touches = field, settings, touches
        self._last_foul: dict[Team, float] = {}
        self._reported: set[RobotId] = set()
        self._crashing: set[tuple[RobotId, RobotId]] = set()
        self._before: Frame | None = None
        self._kicker: RobotId | None = None
        self._kicker_left = False
        self._kick_spot: Point = (0.0, 0.0)
        self._too_fast = False
        self._rest_point: Point = (0.0, 0.0)
        self._rest_since = 0.0
        self._area_since: float | None = None

    def begin(self, frame: Frame, kicker: RobotId | None, spot: Point) -> None:
        """Start watching as the ball comes into play.

        ``frame`` is the first with the ball in play; ``kicker`` took the restart at ``spot`` [m] and may not
        touch the ball twice; it is None where play is open.
        """
        self._kicker, self._kicker_left, self._kick_spot = kicker, False, spot
        self._crashing.clear()
        self._before = None
        self._reported.clear()
        self._rest_point, self._rest_since = frame.ball.position, frame.time
        self._area_since = None
        self._too_fast = False

    def annuls_goal(self, team: Team, time: float) -> bool:
        """Return whether a recent foul of ``team`` that did not stop play annuls its goal."""
        last = self._last_foul.get(team)
        return last is not None and time - last <= _MEMORY

    def without_stop(self, frame: Frame) -> Iterator[Foul]:
        """Find the fouls of this frame that do not stop play."""
        yield from self._crashes(frame)
        yield from self._ball_speed(frame)

    def with_stop(self, frame: Frame) -> Iterator[Foul]:
        """Find the fouls of this frame that may stop play; the first that does ends the search."""
        for check in (self._areas, self._double_touch, self._dribbling, self._keeper_hold, self._progress):
            for foul in check(frame):
                yield foul
                if foul.resumption is not None:
                    return

    def _areas(self, frame: Frame) -> Iterator[Foul]:
        if not self._settings.defense_areas:
            return
        for toucher in self._touches.now:
            team, other = toucher.team, toucher.team.other
            if toucher == self._settings.keeper(team):
                continue
            robot = _robot(frame, toucher)
            if in_defense_area(self._field, team, robot.x, robot.y, -ROBOT_RADIUS):
                yield Foul(EventKind.DEFENDER_IN_DEFENSE_AREA, team, toucher, penalty(self._field, other))
            elif in_defense_area(self._field, other, robot.x, robot.y, ROBOT_RADIUS):
                self._last_foul[team] = frame.time
                if toucher not in self._reported:
                    self._reported.add(toucher)
                    yield Foul(EventKind.ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA, team, toucher)

    def _double_touch(self, frame: Frame) -> Iterator[Foul]:
        kicker, touches = self._kicker, self._touches
        if kicker is None or not self._settings.double_touch:
            return
        most = PUSH_FACTOR * self._settings.in_play_distance
        if touches.last != kicker or any(robot != kicker for robot in touches.now):
            self._kicker = None
        elif kicker not in touches.now:
            self._kicker_left = True
        elif self._kicker_left or distance(frame.ball.position, self._kick_spot) > most:
            yield self._against(EventKind.ATTACKER_DOUBLE_TOUCHED_BALL, kicker, frame)

    def _dribbling(self, frame: Frame) -> Iterator[Foul]:
        most, carrier = self._settings.max_dribble, self._touches.carrier
        if most is not None and carrier is not None and self._touches.carried > most:
            yield self._against(EventKind.BOT_DRIBBLED_BALL_TOO_FAR, carrier, frame)

    def _keeper_hold(self, frame: Frame) -> Iterator[Foul]:
        limit, ball = self._settings.keeper_hold_time, frame.ball
        if limit == "rules":
            limit = 10.0
        if limit is None:
            return
        team = next((team for team in Team if in_defense_area(self._field, team, ball.x, ball.y)), None)
        if team is None:
            self._area_since = None
        elif self._area_since is None:
            self._area_since = frame.time
        elif frame.time - self._area_since > limit:
            yield self._against(EventKind.KEEPER_HELD_BALL, self._settings.keeper(team), frame)

    def _progress(self, frame: Frame) -> Iterator[Foul]:
        limit, ball = self._settings.no_progress_time, frame.ball.position
        if limit == "rules":
            limit = 10.0
        if limit is None:
            return
        if distance(ball, self._rest_point) > self._settings.no_progress_distance:
            self._rest_point, self._rest_since = ball, frame.time
        elif frame.time - self._rest_since > limit:
            yield Foul(EventKind.NO_PROGRESS_IN_GAME, None, None, drop_ball(self._field, *ball))

    def _crashes(self, frame: Frame) -> Iterator[Foul]:
        limit = self._settings.crash_speed
        if limit is None:
            return
        before, self._before = self._before, frame
        reach = 2.0 * ROBOT_RADIUS + 0.01
        for blue in frame.own:
            for yellow in frame.opponents:
                dx, dy = yellow.x - blue.x, yellow.y - blue.y
                if abs(dx) < reach and abs(dy) < reach and hypot(dx, dy) < reach:
                    # In the frame in which they are seen to touch they may have stopped each other already.
                    coming = blue, yellow
                    known = {} if before is None else before.robots()
                    one = known.get(RobotId(Team.BLUE, blue.id), blue)
                    other = known.get(RobotId(Team.YELLOW, yellow.id), yellow)
                    if _closing(one, other) > _closing(*coming):
                        coming = one, other
                    if _closing(*coming) > limit:
                        yield from self._crash(frame, *coming)

    def _crash(self, frame: Frame, blue: RobotState, yellow: RobotState) -> Iterator[Foul]:
        pair = (RobotId(Team.BLUE, blue.id), RobotId(Team.YELLOW, yellow.id))
        if pair in self._crashing:
            return
        self._crashing.add(pair)
        lead = blue.speed - yellow.speed
        drawn = abs(lead) < _EQUAL_SPEEDS
        for robot, faster in ((pair[0], lead), (pair[1], -lead)):
            if drawn or faster > 0.0:
                self._last_foul[robot.team] = frame.time
                if not drawn:
                    yield Foul(EventKind.BOT_CRASH_UNIQUE, robot.team, robot)
        if drawn:
            yield Foul(EventKind.BOT_CRASH_DRAWN, None, None)

    def _ball_speed(self, frame: Frame) -> Iterator[Foul]:
        most = self._settings.max_ball_speed
        if most is None:
            return
        ball, last = frame.ball, self._touches.last
        fast = ball.vx * ball.vx + ball.vy * ball.vy > (most + SPEED_TOLERANCE) ** 2
        if fast and not self._too_fast and last is not None:
            self._last_foul[last.team] = frame.time
            yield Foul(EventKind.BOT_KICKED_BALL_TOO_FAST, last.team, last)
        self._too_fast = fast

    def _against(self, kind: EventKind, offender: RobotId, frame: Frame) -> Foul:
        """Return a foul that gives the other team a free kick where the ball is."""
        resumption = free_kick(self._field, offender.team.other, *frame.ball.position)
        return Foul(kind, offender.team, offender, resumption)


def _closing(one: RobotState, other: RobotState) -> float:
    dx, dy = other.x - one.x, other.y - one.y
    gap = hypot(dx, dy)
    return ((one.vx - other.vx) * dx + (one.vy - other.vy) * dy) / gap if gap > 0.0 else 0.0


def _robot(frame: Frame, identity: RobotId) -> RobotState:
    robots = frame.own if identity.team is frame.team else frame.opponents
    return next(robot for robot in robots if robot.id == identity.number)
