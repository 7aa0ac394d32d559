"""The plays ``goalkeeper`` and ``fitted_goalkeeper`` over many arenas at once.

Each implements the play's table of conditions and actions, with the functions of the play's skills; a test
compares them with the trees on random frames.
"""

from __future__ import annotations

from math import hypot, inf

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.learning.opponents.goalkeeper_cases import (
    Case,
    GoalkeeperMemory,
    Setting,
    Style,
    case_of,
    set_out,
)
from robobt.learning.opponents.sides import Arenas, see_ball, see_robots
from robobt.motion.ball_watch import follow
from robobt.motion.path_planner import travel_law
from robobt.motion.pilot import ROBOBULLS_LIMITS, drive_law
from robobt.motion.scene import BALL_GAP, scene_of, trip_of
from robobt.sim.records import COMMAND, Command, size
from robobt.skills.defence.block_shot import blocking_place, dive_speed
from robobt.skills.defence.cover_near_post import CoverNearPost
from robobt.skills.defence.return_to_goal import ReturnToGoal
from robobt.skills.defence.shot_coming import ShotComing
from robobt.world.ball_model import ROLL_DECELERATION, SLIDE_DECELERATION, SWITCH_SHARE
from robobt.world.compiled import compiled, numbers_of, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import FloatArray, direction
from robobt.world.limits import RobotLimits
from robobt.world.records import (
    BALL,
    LIMITS,
    MOVER_SIZE,
    ROBOT,
    ROBOT_SIZE,
    limits_of,
    mover_records,
    robot_records,
)
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotState

_BEFORE_GOAL = ReturnToGoal.before_goal
_DEFAULT_STYLE = Style(ShotComing.min_speed, 0.1, 0.0, near_post=False, dives=True)
_FITTED = Style(0.01, 0.0, CoverNearPost.before_goal, near_post=True, dives=False)
_SETTING, _GOALKEEPER_MEMORY = record_dtype(Setting), record_dtype(GoalkeeperMemory)


class Goalkeepers:
    """One goalkeeper in each of ``n`` arenas; it defends the goal at +x, which all other robots attack.

    The game is in play and the ball on the ground. In the cases ``FETCH`` and ``CLEAR``, for a ball
    at rest that the goalkeeper may take, it stands still, so that a task can end the episode.

    Args:
        field: dimensions.
        limits: what the goalkeeper can do.
        period: control period [s].
        n: number of arenas.
        speed: factor on the top speed and turning rate, one for all or (n,).

    Attributes:
        cases: (n,) the last case of each.
    """

    style = _DEFAULT_STYLE

    def __init__(
        self, field: FieldGeometry, limits: RobotLimits, period: float, n: int, speed: ArrayLike = 1.0
    ) -> None:
        self.cases: NDArray[np.int64] = np.full(n, Case.HOME, dtype=np.int64)
        # Open play, seen by a team whose only robot is the goalkeeper.
        me = RobotState(0, 0.0, 0.0)
        frame = Frame(0.0, field, BallState(0.0, 0.0), (me,), (), Team.BLUE, period)
        trip = trip_of(me, me.position, goalkeeper=True)
        self._own = limits_of(limits)
        self._setting = np.concatenate((trip, scene_of(frame), self._own, numbers_of(field)))
        self._given = np.tile(self._own, (n, 1))
        self._period = period
        self._ticks = np.zeros(n)
        self._memory = np.zeros((n, size(_GOALKEEPER_MEMORY)))
        self._told = np.zeros((n, size(COMMAND)))
        self.restart(np.arange(n), speed)

    def restart(self, which: NDArray[np.int64], speed: ArrayLike | None = None) -> None:
        """Forget earlier observations in the arenas ``which``; ``speed`` is as for the constructor."""
        memory = self._memory.view(_GOALKEEPER_MEMORY)[:, 0]
        if speed is not None:
            factors = np.broadcast_to(np.asarray(speed, dtype=np.float64), which.shape)
            if not ((factors > 0.0) & np.isfinite(factors)).all():
                raise ValueError("speed must be above 0 and finite")
            self._given[which] = self._own
            for limit in ("max_speed", "max_turn"):
                self._given.view(LIMITS)[limit][which, 0] *= factors
            memory["slowed"][which] = factors != 1.0
        self._forget(which)

    def _forget(self, which: NDArray[np.int64]) -> None:
        self._ticks[which] = 0.0
        memory = self._memory.view(_GOALKEEPER_MEMORY)[:, 0]
        memory["fetching"][which] = 0.0
        for watch in ("aim", "shot"):
            memory[watch][which] = -inf, 0.0, 0.0

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], me: int, commands: FloatArray
    ) -> None:
        """Decide one control tick.

        Args:
            robots: (n, R, 6) x, y, heading, vx, vy, omega in field coordinates [m, rad, m/s, rad/s].
            balls: (n, 4) x, y, vx, vy [m, m/s].
            contact: (n, R) whether the ball lies in the robot's mouth.
            me: which of the R is the goalkeeper.
            commands: (n, 6) to be filled, or (n, 7), as :meth:`robobt.sim.arenas.Arenas.step` takes them.
        """
        self._decide((robots, balls, contact), me, self._told)
        commands[:] = self._told[:, : commands.shape[1]]

    def _decide(self, arenas: Arenas, me: int, told: FloatArray) -> None:
        now = self._ticks * self._period
        _decide(self.style, self._setting, self._given, self._memory, now, arenas, me, told, self.cases)
        self._ticks += 1.0


class FittedGoalkeepers(Goalkeepers):
    """The play ``fitted_goalkeeper`` as real shots show it.

    It drives by RoboBulls' limits with the given acceleration and braking, which its robot must be capable
    of, and stands on the line of a shot, not beside it.

    Args:
        field: dimensions.
        limits: what its robot can do.
        period: control period [s].
        n: number of arenas.
        acceleration: acceleration [m/s^2].
        braking: deceleration with which it plans to stop [m/s^2].
        delay: reaction time [s]; between two decisions it is interpolated.
    """

    style = _FITTED

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
        self._share = delay / period % 1.0
        # Decisions that are not executed yet, the oldest first.
        self._held = np.zeros((int(delay / period) + 2, n, size(COMMAND)))
        super().__init__(field, limits, period, n)
        driven = ROBOBULLS_LIMITS.model_copy(update={"acceleration": acceleration, "braking": braking})
        self._given[:] = limits_of(driven)
        self._memory.view(_GOALKEEPER_MEMORY)["slowed"] = 1.0

    def restart(self, which: NDArray[np.int64], speed: ArrayLike | None = None) -> None:
        """Reset the arenas ``which``, with these top speeds [m/s], one for all or one each."""
        if speed is not None:
            self._given.view(LIMITS)["max_speed"][which, 0] = speed
        self._forget(which)
        self._held[:, which] = 0.0

    def decide(
        self, robots: FloatArray, balls: FloatArray, contact: NDArray[np.bool_], me: int, commands: FloatArray
    ) -> None:
        """See :meth:`Goalkeepers.decide`."""
        self._held[:-1] = self._held[1:]
        self._decide((robots, balls, contact), me, self._held[-1])
        told = self._share * self._held[0] + (1.0 - self._share) * self._held[1]
        commands[:] = told[:, : commands.shape[1]]


@compiled
def _decide(
    style: Style,
    setting_: FloatArray,
    given_: FloatArray,
    memory_: FloatArray,
    times: FloatArray,
    arenas: Arenas,
    me: int,
    commands: FloatArray,
    cases: NDArray[np.int64],
) -> None:
    robots_, balls_, contact = arenas
    robots, balls = robots_.view(ROBOT)[..., 0], balls_.view(BALL)[:, 0]
    memories, limits, orders = (
        memory_.view(_GOALKEEPER_MEMORY)[:, 0],
        given_.view(LIMITS)[:, 0],
        commands.view(COMMAND)[:, 0],
    )
    count = robots.shape[1]
    rows, has = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.bool_)
    for k in range(count):
        rows[0 if k == me else (k + 1 if k < me else k)] = k
    seen_, movers = np.empty((count, ROBOT_SIZE)), np.empty((count, MOVER_SIZE))
    seen, every = robot_records(seen_), mover_records(movers)
    setting: Setting = setting_.view(_SETTING)[0]
    scene, trip, own = setting.scene, setting.trip, setting.own
    for i in range(len(balls)):
        ball, memory, given = scene.ball, memories[i], limits[i]
        see_ball(balls[i], -1.0, ball)
        see_robots(robots[i], contact[i], rows, -1.0, own, ball, seen, every, has)
        setting_[:ROBOT_SIZE] = seen_[0]
        case, y = case_of(style, setting, seen, has, memory)
        slowed, order = memory.slowed > 0.0, (0.0, 0.0, 0.0)
        commands[i] = 0.0
        command: Command = orders[i]
        if case == Case.COVER and not set_out(style, setting):
            case = Case.HOME
        if case in (Case.AIM, Case.SHOT):
            target, final_speed = (ROBOT_RADIUS - scene.half_length, y), 0.0
            place = blocking_place(trip.me, ball, target, 0.0)
            if style.dives:
                watch, speed = memory.aim if case == Case.AIM else memory.shot, hypot(ball.vx, ball.vy)
                rolling = follow(watch, times[i], speed, SLIDE_DECELERATION, ROLL_DECELERATION, SWITCH_SHARE)
                pace = (given.max_speed, given.acceleration, given.braking)
                final_speed = dive_speed(
                    trip.me, ball, place, rolling, pace, SLIDE_DECELERATION, ROLL_DECELERATION
                )
                command.dribbler = 1.0
            facing = direction((trip.me.x, trip.me.y), (ball.x, ball.y))
            gentle = slowed or own.trailing_time > 0.0
            order = drive_law(trip.me, place, facing, final_speed, own, given, gentle, scene.period)
        elif case in (Case.COVER, Case.HOME):
            if case == Case.HOME:
                trip.x, trip.y, trip.heading = _BEFORE_GOAL - scene.half_length, 0.0, 0.0
                trip.final_speed, trip.ball_gap, trip.avoids_robots = 0.0, BALL_GAP, 1.0
            order = travel_law(trip, scene, every, own, given, slowed, False)
        cases[i] = case
        command.vx, command.vy, command.omega = order
