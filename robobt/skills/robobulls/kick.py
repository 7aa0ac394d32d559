"""Kicking as the paper's team did it: get behind the ball, line up, creep forward, kick.

Source: RoboBulls' published code, KickToPointOmni. Its counters of 30 ms cycles are converted to times, so
that the skill behaves the same at any control period.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import atan2, cos, hypot, radians, sin

from robobt.motion.pilot import ROBOBULLS_LIMITS
from robobt.skills.robobulls.detour import RADIUS, allowed, first_waypoint
from robobt.skills.robobulls.pilot import robobulls_drive
from robobt.skills.store import Store
from robobt.tree import Status
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.geometry import Point, direction, distance, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.state import BALL_RADIUS, BallState, RobotState

ROBOBULLS_KICK_SPEED = 7.5
"""Kick speed that RoboBulls commands for a shot at full power [m/s]."""

_LINE_UP_DISTANCE = RADIUS + BALL_RADIUS + 0.005
_CONTACT_DISTANCE = RADIUS + BALL_RADIUS
_HOLD_DISTANCE = RADIUS + BALL_RADIUS + 0.02
_HOLD_ANGLE = radians(75.0)
_POSITION_BOX = 0.1
_HEADING = radians(5.0)
_AT_POINT = 0.005
_BALL_AHEAD = radians(60.0)
_BALL_STRAIGHT_AHEAD = radians(5.0)
_CREEPING_SHARE = 0.2
_LOST_BALL_DISTANCE = 6 * RADIUS
_ROLLING_BALL_LIMIT = 0.5

# "More than n cycles of 30 ms", half a cycle later so that rounding cannot shift it.
_LINED_UP_TIME = 5.5 * 0.03
_LOCKED = 15.5 * 0.03
_KICKING = 100 * 0.03


class KickStage(StrEnum):
    """The stages of the kick."""

    BEHIND = "driving behind the ball"
    LINE_UP = "lining up"
    FORWARD = "creeping to the ball"
    KICK = "kicking"


@dataclass(kw_only=True)
class RobobullsKick:
    """One robot's kick at a point, as a plain object that is ticked.

    The stages and what ends them:

    | stage | drives | ends |
    | --- | --- | --- |
    | BEHIND | to 0.127 m behind the ball, round it and other robots | there for 0.18 s, or it can kick |
    | LINE_UP | to 0.122 m behind the ball, straight | there for 0.18 s |
    | FORWARD | a fifth of the way through the ball, dribbler on | can kick and holds the ball |
    | KICK | on, kick sent | the ball has left |

    *There* is a box of 0.1 m and 5 degrees, *holds* is a ball within 0.1415 m and
    75 degrees, and it *can kick* when the target lies within ``tolerance`` of the
    heading and the ball within 60 degrees. A robot that has had the ball more than 5 degrees off its heading
    for 0.48 s is *kick-locked*: it restarts from BEHIND and cannot kick before it has completed that stage.

    It kicks at ``kick_speed`` [m/s] when heading and target differ by at most ``tolerance`` [rad]; a
    ``goalkeeper`` may drive in its own defence area.
    """

    tolerance: float = radians(1.0)
    kick_speed: float = ROBOBULLS_KICK_SPEED
    limits: RobotLimits = ROBOBULLS_LIMITS
    goalkeeper: bool = False

    def __post_init__(self) -> None:
        self.start()

    def start(self) -> None:
        """Forget the last kick."""
        self.stage = KickStage.BEHIND
        self._there_for = 0.0
        self._askew_for = 0.0
        self._kicking_for = 0.0
        self._locked = False

    def tick(self, store: Store, target: Point) -> Status:
        """Set the command of one control period; SUCCESS once the ball has been kicked."""
        frame, me, ball = store.frame, store.me, store.frame.ball
        period = frame.period
        heading = direction(ball.position, target)
        behind = _from_ball(ball, heading, -_LINE_UP_DISTANCE)
        held = _holds(me, ball)
        at_point = hypot(behind[0] - me.x, behind[1] - me.y) < _AT_POINT

        if not at_point and abs(_off_heading(me, ball.position)) > _BALL_STRAIGHT_AHEAD:
            self._askew_for += period
        if self._askew_for > _LOCKED:
            self._askew_for = 0.0
            self._locked = True
            self._enter(KickStage.BEHIND)

        can_kick = (
            not self._locked
            and not at_point
            and abs(_off_heading(me, ball.position)) < _BALL_AHEAD
            and abs(_off_heading(me, target)) < self.tolerance
        )

        if self.stage is KickStage.KICK:
            self._kicking_for += period
            if not held and ball.speed > _ROLLING_BALL_LIMIT:
                return Status.SUCCESS
            if not held or self._kicking_for > _KICKING:
                self._enter(KickStage.BEHIND)

        if self.stage is KickStage.BEHIND:
            goal = allowed(frame.field, behind, goalkeeper=self.goalkeeper)
            via = first_waypoint(frame, me, goal, goalkeeper=self.goalkeeper)
            store.command = self._drive(me, via, heading, period)
            store.command.dribbler = held
            if self._settled(me, goal, heading, period):
                self._locked = False
                self._enter(KickStage.LINE_UP)
            elif can_kick:
                self._enter(KickStage.LINE_UP)
        elif self.stage is KickStage.LINE_UP:
            goal = _from_ball(ball, heading, -_CONTACT_DISTANCE)
            store.command = self._drive(me, goal, heading, period)
            store.command.dribbler = held
            if self._settled(me, goal, heading, period):
                self._enter(KickStage.FORWARD)
        else:
            if self.stage is KickStage.FORWARD and distance(me.position, ball.position) > _LOST_BALL_DISTANCE:
                self._enter(KickStage.BEHIND)
            elif self.stage is KickStage.FORWARD and can_kick and held:
                self._enter(KickStage.KICK)
            beyond = _from_ball(ball, heading, _CONTACT_DISTANCE)
            ahead = (me.x + _CREEPING_SHARE * (beyond[0] - me.x), me.y + _CREEPING_SHARE * (beyond[1] - me.y))
            store.command = self._drive(me, ahead, heading, period)
            store.command.dribbler = True
            if self.stage is KickStage.KICK:
                store.command.kick_speed = self.kick_speed
                store.command.kick_trigger = KickTrigger.NOW
        return Status.RUNNING

    def _enter(self, stage: KickStage) -> None:
        self.stage = stage
        self._there_for = 0.0
        self._kicking_for = 0.0

    def _settled(self, me: RobotState, goal: Point, heading: float, period: float) -> bool:
        if (
            abs(goal[0] - me.x) <= _POSITION_BOX
            and abs(goal[1] - me.y) <= _POSITION_BOX
            and abs(wrap_angle(heading - me.heading)) < _HEADING
        ):
            self._there_for += period
        return self._there_for > _LINED_UP_TIME

    def _drive(self, me: RobotState, goal: Point, heading: float, period: float) -> RobotCommand:
        return robobulls_drive(me, goal, heading, period, self.limits)


def _from_ball(ball: BallState, heading: float, way: float) -> Point:
    return (ball.x + way * cos(heading), ball.y + way * sin(heading))


def _off_heading(me: RobotState, point: Point) -> float:
    return wrap_angle(atan2(point[1] - me.y, point[0] - me.x) - me.heading)


def _holds(me: RobotState, ball: BallState) -> bool:
    return (
        hypot(ball.x - me.x, ball.y - me.y) < _HOLD_DISTANCE
        and abs(_off_heading(me, ball.position)) < _HOLD_ANGLE
    )
