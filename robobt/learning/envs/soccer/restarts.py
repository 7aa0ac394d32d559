"""The league's restarts in tasks of several robots: who has the ball, who keeps off, who may not touch it.

Source: RoboCup SSL rules of 2026, chapters "Ball Leaves The Field", "Resuming The Game" and "Offenses";
places and distances are those of the match's own referee.
"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.soccer.judge import Stop
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.opponents.restart_players import RESTART, RestartState
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import AGAIN
from robobt.match.referee.rules.restart_distances import POINT_TOLERANCE
from robobt.match.referee.verdicts import resumption_after
from robobt.sim.arenas import Arenas
from robobt.sim.records import FLIGHT, RecordArray, size
from robobt.world.compiled import compilable, compiled
from robobt.world.division import division_of
from robobt.world.game import OPEN_PLAY, GameState, RefereeCommand, Restart, Team
from robobt.world.geometry import Point
from robobt.world.rules import (
    AREA_DISTANCE,
    IN_PLAY_DISTANCE,
    STOP_DISTANCE,
    against_hull,
    exit_point,
    in_area,
)
from robobt.world.state import BALL_RADIUS, ROBOT_HEIGHT, ROBOT_RADIUS

_KINDS = {
    Stop.CARRIED: EventKind.BOT_DRIBBLED_BALL_TOO_FAR,
    Stop.IN_AREA: EventKind.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA,
    Stop.TWICE: EventKind.ATTACKER_DOUBLE_TOUCHED_BALL,
}
_AWAY = STOP_DISTANCE + ROBOT_RADIUS
"""From an opponent's centre to the ball of a restart [m]."""
_CLEAR = ROBOT_RADIUS + BALL_RADIUS + 0.05
"""From anybody's, when the ball is put down [m]."""
_BESIDE = 2.0 * ROBOT_RADIUS + 0.01
"""From one centre to another [m]."""
_TURNS, _REACHES = 24, 8
"""How many ways round the ball, and how much farther off, a place is looked for."""


class Restarts:
    """The restarts of ``n`` arenas.

    An opponent too near to the ball of a restart is put back, at rest, and that is a fault, anew after
    :data:`AGAIN` seconds.

    Attributes:
        rows: (n, size(RESTART)) of :class:`~robobt.learning.opponents.restart_players.RestartState`.
        fouls: (n,) which team broke a rule in this tick, 1 blue, -1 yellow, 0 nobody.
        stops: (n,) what stops play after this tick, 0 for nothing.
    """

    def __init__(self, settings: SoccerSettings, n: int) -> None:
        field, robots = settings.field, len(settings.roles)
        self._field, self._blue, self._period = field, len(settings.blue), settings.period
        self._time = round(division_of(field).kick_time / settings.period)
        self._again = round(AGAIN / settings.period)
        self._double_touch = settings.rules.double_touch
        self._edges = np.array(
            [field.half_length, field.half_width, field.defense_depth, field.defense_width]
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
        self.rows[which] = 0.0
        self.states["taker"][which] = -1.0

    def watch(self, arenas: Arenas, over: BoolArray) -> BoolArray:
        """Look at a tick: fill ``fouls`` and ``stops``; return who was put back, (n, R + 1).

        Args:
            arenas: after it.
            over: (n,) which episodes ended earlier in this decision.
        """
        moved = _watch(
            self.rows, self._blue, self._time, self._again, self._double_touch, self._edges, arenas.robots,
            arenas.balls, arenas.flight, arenas.contact, arenas.touch, over, self.fouls, self.stops,
            self._moved,
        )  # fmt: skip
        if moved:
            which, who = np.nonzero(self._moved[:, :-1])
            arenas.place_robot(which, who, arenas.robots[which, who])
        return self._moved

    def place(self, arenas: Arenas, which: IntArray, before: FloatArray, carried: FloatArray) -> None:
        """Let play that is stopped in the arenas ``which`` go on: ball and robots are put there at rest.

        Args:
            arenas: the simulator.
            which: (m,) indices.
            before: (m, 2) where their balls were a tick ago [m].
            carried: (m, 2) where their balls came into the mouth in which they are [m].
        """
        robots, balls = arenas.robots[which], np.zeros((len(which), 4))
        for k, arena in enumerate(which.tolist()):
            event = self._event(arena, arenas, tuple(before[k].tolist()), tuple(carried[k].tolist()))
            ball = arenas.balls[arena, :2].tolist()
            following = resumption_after(self._field, event, (ball[0], ball[1]))
            assert following is not None
            sign = 0.0 if following.team is None else 1.0 if following.team is Team.BLUE else -1.0
            self.states[arena] = sign, *following.spot, -1.0, self._time, 0.0, sign
            balls[k, :2] = following.spot
            _clear(robots[k], self._blue, sign, *following.spot, self._edges)
        arenas.place(robots[..., :3], balls, which)
        self._moved[which] = True

    def _event(self, arena: int, arenas: Arenas, before: Point, carried: Point) -> RefereeEvent:
        kind, touch, fault = int(self.stops[arena]), int(arenas.touch[arena]), self.fouls[arena]
        ball = arenas.balls[arena].tolist()
        if kind == Stop.OUT:
            team = None if touch < 0 else Team.BLUE if touch < self._blue else Team.YELLOW
            at, over_goal_line = exit_point(self._field, before, (ball[0], ball[1]))
            left = EventKind.BALL_LEFT_FIELD_TOUCH_LINE
            if over_goal_line:
                left = EventKind.BALL_LEFT_FIELD_GOAL_LINE
            return RefereeEvent(0.0, left, team, None, *at)
        x, y = ball[:2]
        if kind == Stop.TWICE:
            x, y = float(self.states["spot_x"][arena]), float(self.states["spot_y"][arena])
        elif kind == Stop.CARRIED:
            x, y = carried
        return RefereeEvent(0.0, _KINDS[Stop(kind)], Team.BLUE if fault > 0.0 else Team.YELLOW, None, x, y)

    def tell(self, seen: FloatArray, which: IntArray, who: NDArray[np.int64]) -> None:
        """Fill what the robots ``who`` of the arenas ``which`` are told in observations (m, L * size)."""
        each, states = seen.reshape(len(which), len(who), -1), self.states[which]
        sides = np.where(who < self._blue, 1.0, -1.0)
        told = 1 + self._double_touch
        # Without -0.
        each[..., -told] = states["team"][:, None] * sides + 0.0
        if self._double_touch:
            each[..., -1] = states["taker"][:, None] == who

    def game(self, arena: int) -> GameState:
        """Return the state of the game in an arena, as blue sees it."""
        state = self.states[arena]
        if state["last_team"] == 0.0:
            return OPEN_PLAY
        blue = state["last_team"] > 0.0
        command = RefereeCommand.DIRECT_FREE_BLUE if blue else RefereeCommand.DIRECT_FREE_YELLOW
        if state["team"] == 0.0:
            return GameState(command)
        return GameState(
            command,
            restart=Restart.FREE_KICK,
            restart_team=Team.BLUE if blue else Team.YELLOW,
            placement=(float(state["spot_x"]), float(state["spot_y"])),
            action_time=float(state["left"]) * self._period,
        )


@compiled
def _watch(
    rows: FloatArray,
    blue: int,
    time: int,
    again: int,
    double_touch: bool,
    edges: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    flight: FloatArray,
    contact: BoolArray,
    touch: NDArray[np.int64],
    over: BoolArray,
    fouls: FloatArray,
    stops: NDArray[np.int64],
    moved: BoolArray,
) -> bool:
    any_moved = False
    for i in range(len(rows)):
        state: RestartState = rows.view(RESTART)[i, 0]
        ball = balls[i]
        fouls[i], stops[i], moved[i] = 0.0, 0, False
        if over[i]:
            continue
        state.pause = max(state.pause - 1.0, 0.0)
        if state.team != 0.0:
            state.left -= 1.0
            taken = hypot(ball[0] - state.spot_x, ball[1] - state.spot_y) > IN_PLAY_DISTANCE
            if taken or state.left <= 0.0:
                own = touch[i] >= 0 and (touch[i] < blue) == (state.team > 0.0)
                state.taker = touch[i] if double_touch and taken and own else -1.0
                state.team = 0.0
            else:
                first, last = (blue, robots.shape[1]) if state.team > 0.0 else (0, blue)
                for r in range(first, last):
                    away = hypot(robots[i, r, 0] - state.spot_x, robots[i, r, 1] - state.spot_y)
                    if away >= _AWAY - POINT_TOLERANCE:
                        continue
                    if state.pause == 0.0:
                        fouls[i], state.pause, state.left = -state.team, again, time
                    _put_off(robots[i], r, state.spot_x, state.spot_y, _AWAY, edges)
                    robots[i, r, 3:] = 0.0
                    moved[i, r] = any_moved = True
        elif state.taker >= 0.0:
            taker = int(state.taker)
            if touch[i] != taker:
                state.taker = -1.0
                continue
            me = robots[i, taker]
            hull = (
                against_hull(ball[0] - me[0], ball[1] - me[1], me[2])
                and flight.view(FLIGHT)[i, 0].z < ROBOT_HEIGHT
            )
            if hull or contact[i, taker]:
                fouls[i], stops[i] = 1.0 if taker < blue else -1.0, Stop.TWICE
    return any_moved


@compiled
def _clear(robots: FloatArray, blue: int, team: float, x: float, y: float, edges: FloatArray) -> None:
    """Put robots (R, 6) out of the others' areas, and off a ball at (x, y) that is ``team``'s to play."""
    front = edges[0] - edges[2] - AREA_DISTANCE - ROBOT_RADIUS
    for r in range(len(robots)):
        sign = 1.0 if r < blue else -1.0
        if in_area(sign * robots[r, 0], sign * robots[r, 1], edges[0], edges[2], edges[3]):
            robots[r, 0] = sign * front
            _put_off(robots, r, robots[r, 0], robots[r, 1], 0.0, edges)
    for r in range(len(robots)):
        theirs = team != 0.0 and (r < blue) != (team > 0.0)
        keep = _AWAY if theirs else _CLEAR
        if hypot(robots[r, 0] - x, robots[r, 1] - y) < keep:
            _put_off(robots, r, x, y, keep, edges)


@compiled
def _put_off(robots: FloatArray, me: int, x: float, y: float, reach: float, edges: FloatArray) -> None:
    """Put a robot ``reach`` from (x, y), straight away or else as near to that as it can stand."""
    straight = atan2(robots[me, 1] - y, robots[me, 0] - x)
    for step in range(_REACHES):
        far = reach + step * _BESIDE
        for turn in range(_TURNS):
            side = 1.0 if turn % 2 else -1.0
            angle = straight + side * ((turn + 1) // 2) * 2.0 * pi / _TURNS
            # No nearer by a rounding error than it has to be.
            to_x, to_y = x + (far + 1e-6) * cos(angle), y + (far + 1e-6) * sin(angle)
            if abs(to_x) <= edges[0] and abs(to_y) <= edges[1] and _is_free(robots, me, to_x, to_y):
                robots[me, 0], robots[me, 1] = to_x, to_y
                return


@compilable
def _is_free(robots: FloatArray, me: int, x: float, y: float) -> bool:
    for r in range(len(robots)):
        if r != me and hypot(robots[r, 0] - x, robots[r, 1] - y) < _BESIDE:
            return False
    return True
