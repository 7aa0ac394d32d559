"""The shipped play ``goalkeeper`` in its default style, over many arenas at once.

What it computes it computes with the functions of the play's skills; a test compares
the two on random frames.
"""

from __future__ import annotations

from math import atan2, cos, hypot, inf, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.motion.ball_watch import rolling_after
from robobt.motion.path_planner import BALL_GAP as PLANNED_GAP
from robobt.motion.pilot import roughly
from robobt.motion.scene import (
    AVOID_ROBOTS,
    BALL_GAP,
    BALL_VX,
    BALL_VY,
    BALL_X,
    BALL_Y,
    FINAL_SPEED,
    HALF_LENGTH,
    HEADING,
    PERIOD,
    TARGET_X,
    TARGET_Y,
    scene_of,
    task_of,
)
from robobt.motion.speeds import BRAKING, FORWARD, REACTION, TOP, TURN, drive_numbers, numbers
from robobt.motion.way import travel_numbers
from robobt.skills.base import FACING
from robobt.skills.conditions.ball_at_defense_edge import BallAtDefenseEdge
from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense
from robobt.skills.defence.block_shot import dive_speed
from robobt.skills.defence.cover_angle import CoverAngle, cover_place
from robobt.skills.defence.return_to_goal import ReturnToGoal
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
    line_crossing_x,
    wrap_angle,
)
from robobt.world.limits import RobotLimits
from robobt.world.rules import ALONG, MOUTH_SECTOR, before_mouth, in_area
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotState

AIM, SHOT, FETCH, CLEAR, COVER, HOME = range(6)
"""Cases of the play, in the order in which their conditions are looked at."""

_FIELD = numbers_dtype(FieldGeometry)
_WATCHES, _FETCHING, _MEMORY = 2, 6, 7
"""A memory has, for AIM and for SHOT, when the ball was seen, how fast, and from which speed on it
rolls [s, m/s, m/s]; then whether a ball is being fetched."""

_MARGIN = 0.1
"""How far beside the goal a shot still counts, as the play has it [m]."""

_MIN_SPEED, _EDGE_REST, _REST = (
    ShotComing.min_speed,
    BallAtDefenseEdge.rest_speed,
    BallRestsInDefense.rest_speed,
)
_STAND_OUT, _BEFORE_GOAL = CoverAngle.stand_out, ReturnToGoal.before_goal
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
        self._own = numbers(limits)
        self._given = np.empty((n, len(self._own)))
        self._slowed: NDArray[np.bool_] = np.empty(n, dtype=np.bool_)
        # Open play, seen by a team whose only robot is the goalkeeper.
        me = RobotState(0, 0.0, 0.0)
        self._scene = scene_of(Frame(0.0, field, BallState(0.0, 0.0), (me,), (), Team.BLUE, period))
        self._task = task_of(me, me.position, goalkeeper=True)
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
            self._given[which[:, None], [TOP, TURN]] *= factors[:, None]
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
            self._task,
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
    task_: FloatArray,
    own: FloatArray,
    given: FloatArray,
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
    seen, movers, sensed = np.empty((count, 6)), np.zeros((count, 7)), np.empty(count, dtype=np.bool_)
    scene, task = scene_.copy(), task_.copy()
    for i in range(len(balls)):
        # As its team sees it: the own goal at -x, the own robot first.
        for k in range(count):
            row = 0 if k == me else (k + 1 if k < me else k)
            seen[row] = -robots[i, k]
            seen[row, 2], seen[row, 5] = wrap_angle(robots[i, k, 2] + pi), robots[i, k, 5]
            sensed[row] = contact[i, k]
            # All of a mover that a way in open play depends on.
            movers[row, :2] = seen[row, :2]
            movers[row, 2:4] = seen[row, 3:5]
        ball = -balls[i]
        case, y = _case(field_, seen, sensed, ball, memory[i])
        cases[i] = case
        commands[i] = 0.0
        task[:TARGET_X] = seen[0]
        if case in (AIM, SHOT):
            watch = memory[i, 3 * case : 3 * case + 3]
            order = _block(task, scene, own, given[i], slowed[i], ball, y, times[i], watch)
            commands[i, 5] = 1.0
        elif case in (COVER, HOME):
            scene[BALL_X], scene[BALL_Y], scene[BALL_VX], scene[BALL_VY] = ball[0], ball[1], ball[2], ball[3]
            _set_out(field_, task, ball, case == COVER)
            order = travel_numbers(task, scene, movers, own, given[i], slowed[i], False)
        else:
            continue
        commands[i, 0], commands[i, 1], commands[i, 2] = order


@compiled
def _case(
    field_: FloatArray, seen: FloatArray, sensed: NDArray[np.bool_], ball: FloatArray, memory: FloatArray
) -> tuple[int, float]:
    """Return the case, and where the ball would cross the goal line if it is one of a shot [m]."""
    field: FieldGeometry = field_.view(_FIELD)[0]
    half_length, half_goal = field.length / 2, field.goal_width / 2
    depth, width = field.defense_depth, field.defense_width
    x, y, speed = ball[0], ball[1], hypot(ball[2], ball[3])
    carried, carries, nearest = False, False, inf
    for k in range(len(seen)):
        robot = seen[k]
        dx, dy = x - robot[0], y - robot[1]
        held = sensed[k] or before_mouth(dx, dy, robot[2], MOUTH_SECTOR)
        along = held and hypot(ball[2] - robot[3], ball[3] - robot[4]) < ALONG
        carried = carried or along
        if k == 0:
            carries = along
            continue
        nearest = min(nearest, hypot(dx, dy))
        if held and cos(robot[2]) < 0.0:
            crossing = line_crossing_x((x, y), robot[2], -half_length)
            if crossing is not None and abs(crossing) < half_goal:
                return AIM, crossing
    if ball[2] <= -_MIN_SPEED and x >= -half_length and not carried:
        crosses = y - (x + half_length) * ball[3] / ball[2]
        if abs(crosses) < half_goal + _MARGIN:
            return SHOT, crosses
    inside = abs(x) <= half_length and abs(y) <= field.width / 2
    near = inside and in_area(-x, y, half_length, depth, width, 2.0 * ROBOT_RADIUS)
    if memory[_FETCHING] > 0.0:
        fetching = near and not in_area(-x, y, half_length, depth, width, -ROBOT_RADIUS)
        memory[_FETCHING] = 1.0 if fetching else 0.0
    elif near and not in_area(-x, y, half_length, depth, width, -0.5 * ROBOT_RADIUS):
        ours = nearest - hypot(x - seen[0, 0], y - seen[0, 1]) > ROBOT_RADIUS
        memory[_FETCHING] = 1.0 if ours and speed <= _EDGE_REST else 0.0
    if memory[_FETCHING] > 0.0:
        return FETCH, 0.0
    if inside and in_area(-x, y, half_length, depth, width, 0.0) and (speed <= _REST or carries):
        return CLEAR, 0.0
    return (COVER if x > -half_length else HOME), 0.0


@compiled
def _block(
    task: FloatArray,
    scene: FloatArray,
    own: FloatArray,
    given: FloatArray,
    slowed: bool,
    ball: FloatArray,
    y: float,
    time: float,
    watch: FloatArray,
) -> tuple[float, float, float]:
    """Do what the skill BlockShot does against a shot at ``y`` on the goal line."""
    here, there, speed = (task[0], task[1]), (ball[0], ball[1]), hypot(ball[2], ball[3])
    place = closest_point_on_segment(here, there, (ROBOT_RADIUS - scene[HALF_LENGTH], y))
    rolling = rolling_after(time - watch[0], watch[1], watch[2], speed, _SLIDE, _ROLL, _SHARE)
    watch[0], watch[1], watch[2] = time, speed, rolling
    rolling = min(rolling, speed)
    top, faster, slower = given[TOP], given[FORWARD], given[BRAKING]
    task[TARGET_X], task[TARGET_Y], task[HEADING] = place[0], place[1], direction(here, there)
    task[FINAL_SPEED] = dive_speed(
        here, (task[3], task[4]), place, there, speed, rolling, top, faster, slower, _SLIDE, _ROLL
    )
    leg, gentle = task[TARGET_X : FINAL_SPEED + 1], slowed or own[REACTION] > 0.0
    return drive_numbers(task[:TARGET_X], leg, own, given, gentle, scene[PERIOD])


@compiled
def _set_out(field_: FloatArray, task: FloatArray, ball: FloatArray, cover: bool) -> None:
    """Set the task of the skill CoverAngle, or else of ReturnToGoal."""
    field: FieldGeometry = field_.view(_FIELD)[0]
    half_length, depth, width = field.length / 2, field.defense_depth, field.defense_width
    task[FINAL_SPEED] = 0.0
    if cover:
        here, there = (task[0], task[1]), (ball[0], ball[1])
        place = cover_place(there, _STAND_OUT, half_length, field.goal_width / 2, depth, width)
        slack = FACING + atan2(ROBOT_RADIUS, distance(here, there))
        task[HEADING] = roughly(task[2], direction(here, there), slack)
        at_home = in_area(-here[0], here[1], half_length, depth, width, ROBOT_RADIUS)
        task[BALL_GAP], task[AVOID_ROBOTS] = -1.0, 0.0 if at_home else 1.0
    else:
        place = (_BEFORE_GOAL - half_length, 0.0)
        task[HEADING], task[BALL_GAP], task[AVOID_ROBOTS] = 0.0, PLANNED_GAP, 1.0
    task[TARGET_X], task[TARGET_Y] = place
