"""The league's restarts in tasks with several robots: the team, the distances, and the double touch.

Source: RoboCup SSL rules of 2026, chapters "Ball Leaves The Field", "Resuming The Game" and "Offenses";
places and distances are those of the match's referee.
"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin
from typing import NamedTuple, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.judging import Report, fresh, parameters, report_of
from robobt.learning.envs.soccer.judge import StopReason
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.opponents.restart_players import RESTART, RestartState
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import AGAIN
from robobt.match.referee.rules.restart_distances import POINT_TOLERANCE
from robobt.match.referee.verdicts import resumption_after
from robobt.sim.arenas import Arenas
from robobt.sim.records import FLIGHT, Flight, RecordArray, Records, size
from robobt.world.compiled import Index, compilable, compiled_inline, compiled_lean, record_dtype
from robobt.world.division import division_of
from robobt.world.field import FieldGeometry
from robobt.world.game import OPEN_PLAY, GameState, RefereeCommand, Restart, Team
from robobt.world.geometry import Point
from robobt.world.records import BALL, ROBOT, Ball, Robot
from robobt.world.rules import (
    AREA_DISTANCE,
    IN_PLAY_DISTANCE,
    STOP_DISTANCE,
    against_hull,
    exit_point,
    in_area,
)
from robobt.world.state import BALL_RADIUS, ROBOT_HEIGHT, ROBOT_RADIUS

_STOP_EVENTS = {
    StopReason.CARRIED: EventKind.BOT_DRIBBLED_BALL_TOO_FAR,
    StopReason.IN_AREA: EventKind.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA,
    StopReason.TWICE: EventKind.ATTACKER_DOUBLE_TOUCHED_BALL,
}
_OPPONENT_DISTANCE = STOP_DISTANCE + ROBOT_RADIUS
"""Least distance from an opponent's centre to the ball of a restart [m]."""
_PUT_DOWN_DISTANCE = ROBOT_RADIUS + BALL_RADIUS + 0.05
"""Least distance from any robot's centre when the ball is placed [m]."""
_ROBOT_SPACING = 2.0 * ROBOT_RADIUS + 0.01
"""Least distance between centres [m]."""
_SEARCH_DIRECTIONS, _SEARCH_DISTANCES = 24, 8
"""Number of directions round the ball, and of distances, in which a place is searched."""


class _RestartRules(Protocol):
    """Parameters of restarts.

    ``time`` is the number of ticks for taking a restart, ``again`` the ticks after which an opponent too near
    counts as a new fault, ``double_touch`` whether a double touch is a fault; the first ``blue`` robots are
    blue.
    """

    field: FieldGeometry
    blue: Index
    time: float
    again: float
    double_touch: float


_RESTART_RULES = record_dtype(_RestartRules)
_NO_RESTART = fresh(RESTART, taker=-1.0)
"""State of restarts at the start of an episode."""


class _RestartArrays(NamedTuple):
    """State of ``n`` arenas with R robots, and the results of a tick."""

    states: FloatArray  # (n, size(RESTART))
    fouls: FloatArray  # (n,)
    stops: IntArray  # (n,)
    moved: BoolArray  # (n, R + 1)


class Restarts:
    """The restarts of ``n`` arenas.

    An opponent too near to the ball of a restart is moved away, at rest. That is a fault, counted again after
    :data:`AGAIN` seconds.

    Attributes:
        rows: (n, size(RESTART)) of :class:`~robobt.learning.opponents.restart_players.RestartState`.
        fouls: (n,) the team that broke a rule in this tick: 1 blue, -1 yellow, 0 none.
        stops: (n,) the reason for stopping play after this tick, 0 for none.
    """

    def __init__(self, settings: SoccerSettings, n: int) -> None:
        field, robots = settings.field, len(settings.roles)
        self._field, self._blue, self._period = field, len(settings.blue), settings.period
        self._time = round(division_of(field).kick_time / settings.period)
        self._double_touch = settings.rules.double_touch
        self._rules = parameters(
            _RESTART_RULES,
            field=field,
            blue=self._blue,
            time=self._time,
            again=round(AGAIN / settings.period),
            double_touch=self._double_touch,
        )
        self.rows = np.zeros((n, size(RESTART)))
        self.fouls = np.zeros(n)
        self.stops = np.zeros(n, dtype=np.int64)
        self._moved: BoolArray = np.zeros((n, robots + 1), dtype=np.bool_)

    @property
    def states(self) -> RecordArray:
        """(n,) the ``rows`` by name."""
        return self.rows.view(RESTART)[:, 0]

    def begin(self, which: IntArray) -> None:
        """Begin episodes, with the ball in play."""
        self.rows[which] = _NO_RESTART

    def watch(self, arenas: Arenas, over: BoolArray) -> BoolArray:
        """Check a tick: fill ``fouls`` and ``stops``; return the objects that were moved, (n, R + 1).

        Args:
            arenas: the arenas after the tick.
            over: (n,) which episodes ended earlier in this decision.
        """
        found = cast(_RestartArrays, (self.rows, self.fouls, self.stops, self._moved))
        moved = _watch(self._rules, report_of(arenas), arenas.flight, over, found)
        if moved:
            which, who = np.nonzero(self._moved[:, :-1])
            arenas.place_robot(which, who, arenas.robots[which, who])
        return self._moved

    def place(self, arenas: Arenas, which: IntArray, before: FloatArray, carried: FloatArray) -> None:
        """Restart play in the arenas ``which``: ball and robots are placed at rest.

        Args:
            arenas: the simulator.
            which: (m,) indices.
            before: (m, 2) positions of their balls a tick ago [m].
            carried: (m, 2) where their balls came into the mouth in which they are [m].
        """
        robots, balls = arenas.robots[which], np.zeros((len(which), size(BALL)))
        for k, arena in enumerate(which.tolist()):
            event = self._event(arena, arenas, tuple(before[k].tolist()), tuple(carried[k].tolist()))
            x, y, _, _ = arenas.balls[arena].tolist()
            following = resumption_after(self._field, event, (x, y))
            assert following is not None
            sign = 0.0 if following.team is None else 1.0 if following.team is Team.BLUE else -1.0
            self.states[arena] = sign, *following.spot, -1.0, self._time, 0.0, sign
            balls[k] = *following.spot, 0.0, 0.0
            _clear(self._rules, robots[k], sign, *following.spot)
        arenas.place(robots[..., :3], balls, which)
        self._moved[which] = True

    def _event(self, arena: int, arenas: Arenas, before: Point, carried: Point) -> RefereeEvent:
        kind, touch, fault = StopReason(self.stops[arena]), int(arenas.touch[arena]), self.fouls[arena]
        x, y, _, _ = arenas.balls[arena].tolist()
        if kind == StopReason.OUT:
            team = None if touch < 0 else Team.BLUE if touch < self._blue else Team.YELLOW
            at, over_goal_line = exit_point(self._field, before, (x, y))
            left = EventKind.BALL_LEFT_FIELD_TOUCH_LINE
            if over_goal_line:
                left = EventKind.BALL_LEFT_FIELD_GOAL_LINE
            return RefereeEvent(0.0, left, team, None, *at)
        if kind == StopReason.TWICE:
            x, y = float(self.states["spot_x"][arena]), float(self.states["spot_y"][arena])
        elif kind == StopReason.CARRIED:
            x, y = carried
        return RefereeEvent(0.0, _STOP_EVENTS[kind], Team.BLUE if fault > 0.0 else Team.YELLOW, None, x, y)

    def tell(self, seen: FloatArray, which: IntArray, who: NDArray[np.int64]) -> None:
        """Fill in the restart entries of the robots ``who``, in observations (m, L * size) of ``which``."""
        each, states = seen.reshape(len(which), len(who), -1), self.rows[which].view(RESTART)
        sides = np.where(who < self._blue, 1.0, -1.0)
        told = 1 + self._double_touch
        # Without -0.
        each[..., -told] = states["team"] * sides + 0.0
        if self._double_touch:
            each[..., -1] = states["taker"] == who

    def game(self, arena: int) -> GameState:
        """Return the state of the game in an arena, as blue sees it."""
        team, x, y, _, left, _, last_team = self.rows[arena].tolist()
        if last_team == 0.0:
            return OPEN_PLAY
        blue = last_team > 0.0
        command = RefereeCommand.DIRECT_FREE_BLUE if blue else RefereeCommand.DIRECT_FREE_YELLOW
        if team == 0.0:
            return GameState(command)
        return GameState(
            command,
            restart=Restart.FREE_KICK,
            restart_team=Team.BLUE if blue else Team.YELLOW,
            placement=(x, y),
            action_time=left * self._period,
        )


@compiled_lean
def _watch(
    rules_: FloatArray, report_: Report, flight_: FloatArray, over: BoolArray, found_: _RestartArrays
) -> bool:
    """See :meth:`Restarts.watch`; return whether any robot was moved."""
    rules: _RestartRules = rules_.view(_RESTART_RULES)[0]
    arenas, found = Report(*report_), _RestartArrays(*found_)
    robots, balls = arenas.robots.view(ROBOT)[..., 0], arenas.balls.view(BALL)[..., 0]
    states, flights = found.states.view(RESTART)[..., 0], flight_.view(FLIGHT)[..., 0]
    any_moved = False
    for i in range(len(balls)):
        found.fouls[i], found.stops[i], found.moved[i, :] = 0.0, StopReason.NOTHING, False
        if over[i]:
            continue
        state: RestartState = states[i]
        ball, touch = balls[i], arenas.touch[i]
        state.pause = max(state.pause - 1.0, 0.0)
        if state.team != 0.0:
            state.left -= 1.0
            taken = hypot(ball.x - state.spot_x, ball.y - state.spot_y) > IN_PLAY_DISTANCE
            if taken or state.left <= 0.0:
                own = touch >= 0 and (touch < rules.blue) == (state.team > 0.0)
                state.taker = touch if rules.double_touch and taken and own else -1.0
                state.team = 0.0
                continue
            first, last = (rules.blue, robots.shape[1]) if state.team > 0.0 else (0, rules.blue)
            for r in range(first, last):
                if _put_back(rules, state, robots[i], r):
                    found.moved[i, r] = any_moved = True
                    if state.pause == 0.0:
                        found.fouls[i], state.pause, state.left = -state.team, rules.again, rules.time
        elif state.taker >= 0.0:
            taker = int(state.taker)
            if touch != taker:
                state.taker = -1.0
            elif arenas.contact[i, taker] or _pushes(robots[i, taker], ball, flights[i]):
                found.fouls[i], found.stops[i] = 1.0 if taker < rules.blue else -1.0, StopReason.TWICE
    return any_moved


@compiled_inline
def _put_back(rules: _RestartRules, state: RestartState, robots: Records[Robot], me: int) -> bool:
    """Move a robot that is too near to the others' restart away, at rest; return whether it was moved."""
    robot = robots[me]
    away = hypot(robot.x - state.spot_x, robot.y - state.spot_y)
    if away >= _OPPONENT_DISTANCE - POINT_TOLERANCE:
        return False
    _put_off(rules.field, robots, me, state.spot_x, state.spot_y, _OPPONENT_DISTANCE)
    robot.vx = robot.vy = robot.omega = 0.0
    return True


@compilable
def _pushes(robot: Robot, ball: Ball, flight: Flight) -> bool:
    """Return whether the ball touches the robot's hull."""
    return against_hull(ball.x - robot.x, ball.y - robot.y, robot.heading) and flight.z < ROBOT_HEIGHT


@compiled_lean
def _clear(rules_: FloatArray, robots_: FloatArray, team: float, x: float, y: float) -> None:
    """Move robots (R, size(ROBOT)) out of the others' areas, and away from ``team``'s ball at (x, y)."""
    rules: _RestartRules = rules_.view(_RESTART_RULES)[0]
    robots, field = robots_.view(ROBOT)[..., 0], rules.field
    half_length, depth = field.length / 2, field.defense_depth
    front = half_length - depth - AREA_DISTANCE - ROBOT_RADIUS
    for r in range(len(robots)):
        sign, robot = 1.0 if r < rules.blue else -1.0, robots[r]
        if in_area(sign * robot.x, sign * robot.y, half_length, depth, field.defense_width):
            robot.x = sign * front
            _put_off(field, robots, r, robot.x, robot.y, 0.0)
    for r in range(len(robots)):
        theirs = team != 0.0 and (r < rules.blue) != (team > 0.0)
        keep = _OPPONENT_DISTANCE if theirs else _PUT_DOWN_DISTANCE
        if hypot(robots[r].x - x, robots[r].y - y) < keep:
            _put_off(field, robots, r, x, y, keep)


@compiled_lean
def _put_off(field: FieldGeometry, robots: Records[Robot], me: int, x: float, y: float, reach: float) -> None:
    """Move a robot to ``reach`` from (x, y), straight away or as near to that direction as it can stand."""
    half_length, half_width, robot = field.length / 2, field.width / 2, robots[me]
    straight = atan2(robot.y - y, robot.x - x)
    for step in range(_SEARCH_DISTANCES):
        far = reach + step * _ROBOT_SPACING
        for turn in range(_SEARCH_DIRECTIONS):
            side = 1.0 if turn % 2 else -1.0
            angle = straight + side * ((turn + 1) // 2) * 2.0 * pi / _SEARCH_DIRECTIONS
            # Rounding must not put the robot nearer than allowed.
            to_x, to_y = x + (far + 1e-6) * cos(angle), y + (far + 1e-6) * sin(angle)
            if abs(to_x) <= half_length and abs(to_y) <= half_width and _is_free(robots, me, to_x, to_y):
                robot.x, robot.y = to_x, to_y
                return


@compiled_inline
def _is_free(robots: Records[Robot], me: int, x: float, y: float) -> bool:
    for r in range(len(robots)):
        if r != me and hypot(robots[r].x - x, robots[r].y - y) < _ROBOT_SPACING:
            return False
    return True
