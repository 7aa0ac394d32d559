"""The shipped play ``goalkeeper`` in its default style, over many arenas at once.

What it computes it computes with the functions of the play's skills; a test compares
the two on random frames.
"""

from __future__ import annotations

from math import atan2, hypot, inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.learning.opponents.cases import (
    AIM,
    COVER,
    HOME,
    SHOT,
    case_of,
    see,
    set_out_for_home,
)
from robobt.motion.ball_watch import rolling_after
from robobt.motion.path_planner import travel_law
from robobt.motion.pilot import drive_law, roughly
from robobt.motion.scene import scene_of, trip_of
from robobt.skills.base import FACING
from robobt.skills.defence.block_shot import dive_speed
from robobt.skills.defence.cover_angle import CoverAngle, cover_place
from robobt.skills.defence.shot_coming import ShotComing
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.compiled import compiled, numbers_dtype, numbers_of
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import (
    FloatArray,
    closest_point_on_segment,
    direction,
    distance,
)
from robobt.world.limits import RobotLimits
from robobt.world.records import (
    LIMITS,
    MOVER_SIZE,
    ROBOT_SIZE,
    SCENE,
    TRIP,
    Limits,
    Scene,
    Trip,
    limits_of,
    mover_records,
)
from robobt.world.rules import in_area
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotState

_FIELD = numbers_dtype(FieldGeometry)
_WATCHES, _FETCHING, _MEMORY = 2, 6, 7
"""A memory has, for AIM and for SHOT, when the ball was seen, how fast, and from which speed on it
rolls [s, m/s, m/s]; then whether a ball is being fetched."""

_MARGIN = 0.1
"""How far beside the goal a shot still counts, as the play has it [m]."""

_MIN_SPEED = ShotComing.min_speed
_STAND_OUT = CoverAngle.stand_out
_SLIDE, _ROLL = DEFAULT_BALL.slide_deceleration, DEFAULT_BALL.roll_deceleration
_SHARE = DEFAULT_BALL.switch_share


class Goalkeepers:
    """One goalkeeper in each of ``n`` arenas; it defends the goal at +x, everybody else attacks that.

    The game is in play and the ball on the ground. A ball that rests before the goal
    or in the defence area is the goalkeeper's: in the cases :data:`FETCH` and
    :data:`CLEAR` it stands still, for a task to end the episode.

    Args:
        field: dimensions.
        limits: what the goalkeeper can do.
        period: control period [s].
        n: number of arenas.
        speed: factor on the top speed and turning rate, one for all or (n,).

    Attributes:
        cases: (n,) which case each played last.
    """

    def __init__(
        self, field: FieldGeometry, limits: RobotLimits, period: float, n: int, speed: ArrayLike = 1.0
    ) -> None:
        self.cases: NDArray[np.int64] = np.full(n, HOME, dtype=np.int64)
        self._field = numbers_of(field)
        self._own = limits_of(limits)
        self._given = np.empty((n, len(self._own)))
        self._slowed: NDArray[np.bool_] = np.empty(n, dtype=np.bool_)
        # Open play, seen by a team whose only robot is the goalkeeper.
        me = RobotState(0, 0.0, 0.0)
        frame = Frame(0.0, field, BallState(0.0, 0.0), (me,), (), Team.BLUE, period)
        self._scene = scene_of(frame)
        self._trip = trip_of(me, me.position, goalkeeper=True)
        self._period = period
        self._ticks = np.zeros(n)
        self._memory = np.zeros((n, _MEMORY))
        self.restart(np.arange(n), speed)

    def restart(self, which: NDArray[np.int64], speed: ArrayLike | None = None) -> None:
        """Forget what was seen in the arenas ``which``; ``speed``, if given, is as for the constructor."""
        if speed is not None:
            factors = np.broadcast_to(np.asarray(speed, dtype=np.float64), which.shape)
            if not ((factors > 0.0) & np.isfinite(factors)).all():
                raise ValueError("speed must be above 0 and finite")
            self._given[which] = self._own
            for limit in ("max_speed", "max_turn"):
                self._given.view(LIMITS)[limit][which, 0] *= factors
            self._slowed[which] = factors != 1.0
        self._ticks[which] = 0.0
        self._memory[which] = 0.0
        self._memory[which, : 3 * _WATCHES : 3] = -inf

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], me: int, commands: FloatArray
    ) -> None:
        """Decide one control tick.

        Args:
            robots: (n, R, 6) x, y, heading, vx, vy, omega in field coordinates [m, rad, m/s, rad/s].
            balls: (n, 4) x, y, vx, vy [m, m/s].
            contact: (n, R) whether the ball lies in the robot's mouth.
            me: which of the R is the goalkeeper.
            commands: (n, 6) to be filled, as :meth:`robobt.sim.arenas.Arenas.step` takes them.
        """
        _decide(
            self._field,
            self._scene,
            self._trip,
            self._own,
            self._given,
            self._slowed,
            self._ticks * self._period,
            robots,
            balls,
            contact,
            me,
            self._memory,
            commands,
            self.cases,
        )
        self._ticks += 1.0


@compiled
def _decide(
    field_: FloatArray,
    scene_: FloatArray,
    trip_: FloatArray,
    own_: FloatArray,
    given_: FloatArray,
    slowed: NDArray[np.bool_],
    times: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    contact: NDArray[np.bool_],
    me: int,
    memory: FloatArray,
    commands: FloatArray,
    cases: NDArray[np.int64],
) -> None:
    count = robots.shape[1]
    seen, movers, sensed = (
        np.empty((count, 6)),
        np.zeros((count, MOVER_SIZE)),
        np.empty(count, dtype=np.bool_),
    )
    scene: Scene = scene_.view(SCENE)[0]
    trip: Trip = trip_.view(TRIP)[0]
    own: Limits = own_.view(LIMITS)[0]
    given: Limits
    for i in range(len(balls)):
        see(robots[i], contact[i], me, seen, movers, sensed)
        ball = -balls[i]
        case, y = case_of(field_, seen, sensed, ball, memory[i, _FETCHING:], _MIN_SPEED, _MARGIN, 0.0)
        cases[i] = case
        commands[i] = 0.0
        trip_[:ROBOT_SIZE] = seen[0]
        given = given_.view(LIMITS)[i, 0]
        if case in (AIM, SHOT):
            watch = memory[i, 3 * case : 3 * case + 3]
            order = _block(trip, scene, own, given, slowed[i], ball, y, times[i], watch)
            commands[i, 5] = 1.0
        elif case in (COVER, HOME):
            scene.ball.x, scene.ball.y, scene.ball.vx, scene.ball.vy = ball[0], ball[1], ball[2], ball[3]
            if case == COVER:
                _set_out(field_, trip, ball)
            else:
                set_out_for_home(trip, scene.half_length)
            order = travel_law(trip, scene, mover_records(movers), own, given, slowed[i], False)
        else:
            continue
        commands[i, 0], commands[i, 1], commands[i, 2] = order


@compiled
def _block(
    trip: Trip,
    scene: Scene,
    own: Limits,
    given: Limits,
    slowed: bool,
    ball: FloatArray,
    y: float,
    time: float,
    watch: FloatArray,
) -> tuple[float, float, float]:
    """Do what the skill BlockShot does against a shot at ``y`` on the goal line."""
    here, there, speed = (trip.me.x, trip.me.y), (ball[0], ball[1]), hypot(ball[2], ball[3])
    place = closest_point_on_segment(here, there, (ROBOT_RADIUS - scene.half_length, y))
    rolling = rolling_after(time - watch[0], watch[1], watch[2], speed, _SLIDE, _ROLL, _SHARE)
    watch[0], watch[1], watch[2] = time, speed, rolling
    rolling = min(rolling, speed)
    top, faster, slower = given.max_speed, given.acceleration, given.braking
    trip.x, trip.y, trip.heading = place[0], place[1], direction(here, there)
    trip.final_speed = dive_speed(
        here, (trip.me.vx, trip.me.vy), place, there, speed, rolling, top, faster, slower, _SLIDE, _ROLL
    )
    gentle = slowed or own.reaction > 0.0
    return drive_law(trip.me, place, trip.heading, trip.final_speed, own, given, gentle, scene.period)


@compiled
def _set_out(field_: FloatArray, trip: Trip, ball: FloatArray) -> None:
    """Set the task of the skill CoverAngle."""
    field: FieldGeometry = field_.view(_FIELD)[0]
    half_length, depth, width = field.length / 2, field.defense_depth, field.defense_width
    here, there = (trip.me.x, trip.me.y), (ball[0], ball[1])
    place = cover_place(there, _STAND_OUT, half_length, field.goal_width / 2, depth, width)
    slack = FACING + atan2(ROBOT_RADIUS, distance(here, there))
    trip.heading = roughly(trip.me.heading, direction(here, there), slack)
    at_home = in_area(-here[0], here[1], half_length, depth, width, ROBOT_RADIUS)
    trip.final_speed, trip.ball_gap, trip.avoids_robots = 0.0, -1.0, 0.0 if at_home else 1.0
    trip.x, trip.y = place
