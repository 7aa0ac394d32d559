"""The play ``fitted_goalkeeper`` as real shots show it, over many arenas at once.

Like :mod:`robobt.learning.opponents.goalkeeper` it computes with the functions of the play's skills, and a
test compares the two on random frames.
"""

from __future__ import annotations

from math import atan2

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.learning.opponents.cases import AIM, COVER, HOME, SHOT, case_of, see, set_out_for_home
from robobt.motion.path_planner import travel_law
from robobt.motion.pilot import ROBOBULLS_LIMITS, drive_law, roughly
from robobt.motion.scene import scene_of, trip_of
from robobt.skills.base import FACING
from robobt.skills.defence.cover_near_post import CoverNearPost
from robobt.world.compiled import compiled, numbers_dtype, numbers_of
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import FloatArray, closest_point_on_segment, direction, distance
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
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotState

_FIELD = numbers_dtype(FieldGeometry)
_MIN_SPEED = 0.01
"""Slowest approach that the play takes for a shot [m/s]."""
_BEFORE_GOAL = CoverNearPost.before_goal


class FittedGoalkeepers:
    """One goalkeeper in each of ``n`` arenas; it defends the goal at +x, everybody else attacks that.

    It drives by RoboBulls' limits with the acceleration and braking given, which its robot has to be able to,
    and stands on the line of a shot, not beside it. A ball that is the goalkeeper's it leaves alone, as
    :class:`~robobt.learning.opponents.goalkeeper.Goalkeepers` does.

    Args:
        field: dimensions.
        limits: what its robot can do.
        period: control period [s].
        n: number of arenas.
        acceleration: how fast it speeds up [m/s^2].
        braking: it drives so that it could stop at this rate [m/s^2].
        delay: from what happens to what it does about it [s]; between two decisions, in proportion.

    Attributes:
        cases: (n,) which case each decided for last, :mod:`robobt.learning.opponents.cases`.
    """

    def __init__(
        self,
        field: FieldGeometry,
        limits: RobotLimits,
        period: float,
        n: int,
        acceleration: float = ROBOBULLS_LIMITS.acceleration,
        braking: float = ROBOBULLS_LIMITS.braking,
        delay: float = 0.0,
    ) -> None:
        self.cases: NDArray[np.int64] = np.full(n, HOME, dtype=np.int64)
        self._field = numbers_of(field)
        self._own = limits_of(limits)
        driven = ROBOBULLS_LIMITS.model_copy(update={"acceleration": acceleration, "braking": braking})
        self._given = np.tile(limits_of(driven), (n, 1))
        # Open play, seen by a team whose only robot is the goalkeeper.
        me = RobotState(0, 0.0, 0.0)
        frame = Frame(0.0, field, BallState(0.0, 0.0), (me,), (), Team.BLUE, period)
        self._scene = scene_of(frame)
        self._trip = trip_of(me, me.position, goalkeeper=True)
        self._fetching = np.zeros((n, 1))
        self._share = delay / period % 1.0
        # What was decided and is not done yet, the oldest first.
        self._held = np.zeros((int(delay / period) + 2, n, 6))

    def restart(self, which: NDArray[np.int64], speed: ArrayLike) -> None:
        """Begin anew in the arenas ``which``, with these top speeds [m/s], one for all or as many."""
        self._given.view(LIMITS)["max_speed"][which, 0] = speed
        self._fetching[which] = 0.0
        self._held[:, which] = 0.0

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
        self._held[:-1] = self._held[1:]
        _decide(
            self._field,
            self._scene,
            self._trip,
            self._own,
            self._given,
            robots,
            balls,
            contact,
            me,
            self._fetching,
            self._held[-1],
            self.cases,
        )
        commands[:] = self._share * self._held[0] + (1.0 - self._share) * self._held[1]


@compiled
def _decide(
    field_: FloatArray,
    scene_: FloatArray,
    trip_: FloatArray,
    own_: FloatArray,
    given_: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    contact: NDArray[np.bool_],
    me: int,
    fetching: FloatArray,
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
        case, y = case_of(field_, seen, sensed, ball, fetching[i], _MIN_SPEED, 0.0, _BEFORE_GOAL)
        commands[i], order = 0.0, (0.0, 0.0, 0.0)
        trip_[:ROBOT_SIZE] = seen[0]
        given = given_.view(LIMITS)[i, 0]
        here, there = (trip.me.x, trip.me.y), (ball[0], ball[1])
        if case in (AIM, SHOT):
            place = closest_point_on_segment(here, there, (ROBOT_RADIUS - scene.half_length, y))
            trip.x, trip.y, trip.heading = place[0], place[1], direction(here, there)
            trip.final_speed = 0.0
            order = drive_law(trip.me, place, trip.heading, 0.0, own, given, True, scene.period)
        elif case in (COVER, HOME):
            if case == HOME or not _set_out(field_, trip, ball):
                case = HOME
                set_out_for_home(trip, scene.half_length)
            scene.ball.x, scene.ball.y, scene.ball.vx, scene.ball.vy = ball[0], ball[1], ball[2], ball[3]
            order = travel_law(trip, scene, mover_records(movers), own, given, True, False)
        cases[i] = case
        commands[i, 0], commands[i, 1], commands[i, 2] = order


@compiled
def _set_out(field_: FloatArray, trip: Trip, ball: FloatArray) -> bool:
    """Set the task of the skill CoverNearPost; return False where it fails."""
    field: FieldGeometry = field_.view(_FIELD)[0]
    here, there = (trip.me.x, trip.me.y), (ball[0], ball[1])
    half_length, half_goal = field.length / 2, field.goal_width / 2
    post = (-half_length, min(half_goal, max(-half_goal, ball[1])))
    place = closest_point_on_segment(here, there, post)
    far_out = place[0] > field.defense_depth - half_length - ROBOT_RADIUS
    if far_out or abs(place[1]) > field.defense_width / 2:
        return False
    slack = FACING + atan2(ROBOT_RADIUS, distance(here, there))
    trip.x, trip.y = place
    trip.heading = roughly(trip.me.heading, direction(here, there), slack)
    trip.final_speed, trip.ball_gap, trip.avoids_robots = 0.0, -1.0, 0.0
    return True
