"""Kick the ball at the chosen target."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from math import atan2, cos, radians, sin

from robobt.motion.dribbling import (
    carried_into_kick,
    dribbling_limits,
    sideways_after_kick,
    turn_to,
    turn_with_ball,
)
from robobt.motion.path_planner import TARGETS, allowed_target, next_waypoint, travel
from robobt.motion.pilot import roughly
from robobt.motion.run_up import RUN_UP_SPEED, run_up
from robobt.skills.ball.go_to_ball import meeting_point
from robobt.skills.ball.pick_up_ball import grab
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.skills.store import Pass
from robobt.tree import Status
from robobt.world.command import CHIP_ANGLE, KickTrigger
from robobt.world.geometry import Point, direction, distance, wrap_angle
from robobt.world.rules import has_ball

SHOT_SPEED = 6.4
"""Kick speed of a shot [m/s]: the rules' 6.5 m/s minus what sideways motion may add."""

MAX_CHIP_SPEED = 6.4
"""Fastest chip [m/s]; like :data:`SHOT_SPEED`, it counts in space."""

_SHOT_TOLERANCE = (radians(0.5), radians(4.0))
"""Smallest and largest tolerance of a shot's direction [rad]."""
_PASS_TOLERANCE = radians(1.5)

_BEHIND_BALL_DISTANCE = 0.16
"""Distance behind the ball at which the robot lines up [m]; just outside the planner's detour round the
ball."""
_THROUGH = 0.05
_ROUND_BALL_TANGENT = 1.0
"""Tangent of the angle to the line of the kick from which the robot drives round the ball first."""
_ROUND_BALL_TANGENT_RESTART = 0.35
"""That tangent at a restart, where the robot must not touch the ball at an angle."""
_RUN_UP_DISTANCE = 2.5
_MOUTH_HALF_WIDTH = 0.03
"""A ball within this distance of the heading's line meets the mouth [m]."""
_NEAR_BALL_DISTANCE = 0.25
_GOT_AWAY = 0.7
_CREEPING_SPEED = 0.5
_FACE_TARGET_DISTANCE = 1.2
_HEADING_SLACK = radians(10.0)
"""Heading error allowed while the robot is still driving behind the ball."""
_TAKEN_BALL_ANGLE = radians(75.0)
"""Angle off the heading within which a ball is taken at once."""
_WALL_TOLERANCE = 0.03
_KICKED_SPEED_SHARE = 0.6
"""A ball with this share of the kick's speed towards the target has been kicked."""
LEAST_KICK = 0.1
"""Slowest kick [m/s]."""
_CARRY_SPEED = 2.0
_CARRY_ACCELERATION = 1.0


@dataclass(slots=True, frozen=True)
class _Order:
    target: Point
    tolerance: float
    speed: float
    pass_: Pass | None
    angle: float = 0.0

    @property
    def along(self) -> float:
        """Speed with which the ball leaves along the ground [m/s]."""
        return self.speed * cos(self.angle)


@skill
class KickToTarget(DrivingSkill):
    """Kick the ball at a point: turn with it if the robot has it, else get behind it and kick it.

    Running until the ball has left, then succeeding. Fails without a target and
    when the ball has got away. A pass is noted in the team's store as its kick
    goes out.

    The ball leaves along the heading and keeps the share ``limits.touch_kept`` of its sideways velocity; the
    robot corrects its aim for that, and may kick while it still turns.

    A chip flies over robots and first touches down at the target, or as close to it as the speed limit of the
    rules allows; from there it hops and rolls on.

    Args:
        target: where to kick [m]; None takes ``store.shot``, else ``store.pass_``.
        kick_speed: speed of the kick [m/s]; None takes the pass's speed, a full shot, or for a chip the speed
            that the distance needs.
        tolerance: angle by which the kick may be off [rad]; None is half the
            shot's own tolerance, 1.5 degrees for a pass.
        pass_tolerance: tolerance for passes only [rad]; None takes ``tolerance``.
        take: take a ball right in front of the robot at once instead of driving round it.
        round_ball: turn round the ball if the dribbler is too weak to swing it round the robot.
        max_turn: turning rate with the ball [rad/s].
        limits: how to drive without the ball; None for the robot's own.
        speed_factor: factor on the top speed.
        goalkeeper: may enter the own defence area.
        chip: chip the ball over robots in its way.
        touch_downs: number of the chip's touch-down that is to be at the target.

    Raises:
        ValueError: fewer than one touch-down, or a kick speed or tolerance that is not positive.
    """

    reads = ("shot", "pass_")
    writes = ("team",)

    target: Point | None = None
    kick_speed: float | None = None
    tolerance: float | None = None
    pass_tolerance: float | None = None
    take: bool = False
    round_ball: bool = False
    max_turn: float = 4.0
    goalkeeper: bool = False
    chip: bool = False
    touch_downs: int = 1
    _kicking: _Order | None = field(default=None, init=False)
    _was_near: bool = field(default=False, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.touch_downs < 1:
            raise ValueError(f"touch_downs must be at least 1, not {self.touch_downs}")
        for setting in ("kick_speed", "tolerance", "pass_tolerance"):
            value = getattr(self, setting)
            if value is not None and not value > 0.0:
                raise ValueError(f"{setting} must be positive, not {value}")
        self._carry = dribbling_limits(_CARRY_SPEED, self.max_turn, _CARRY_ACCELERATION)

    def needs(self) -> list[tuple[str, ...]]:
        """Require a shot or a pass, unless ``target`` is given."""
        return [("shot", "pass_")] if self.target is None else []

    def on_start(self) -> None:
        """Forget the last kick."""
        self._kicking = None
        self._was_near = False

    def on_running(self) -> Status:
        """Aim, or kick, for one tick."""
        if self._kicking is not None and self._has_left(self._kicking):
            self._note_pass(self._kicking)
            return self.succeed("kicked")
        order = self._order()
        if order is None:
            return self.fail("no target")
        self.draw.line(TARGETS, self.ball.position, order.target)
        gap = distance(self.me.position, self.ball.position)
        if gap < _NEAR_BALL_DISTANCE:
            self._was_near = True
        elif self._was_near and gap > _GOT_AWAY:
            return self.fail("the ball got away")
        if self.me.ball_contact:
            self._turn_with_ball(order)
            doing = "aiming with the ball"
        else:
            self._come_from_behind(order)
            doing = "getting behind the ball"
        self._kicking = order if self._kick_if_aimed(order, gap) else None
        return self.run(doing if self._kicking is None else "kicking")

    def _order(self) -> _Order | None:
        shot, pass_ = self.store.shot, self.store.pass_
        if self.target is not None:
            return self._with(self.target, _SHOT_TOLERANCE[0], SHOT_SPEED, None)
        if shot is not None:
            least, most = _SHOT_TOLERANCE
            return self._with(shot.target, min(most, max(least, 0.5 * shot.tolerance)), SHOT_SPEED, None)
        if pass_ is not None:
            order = self._with(pass_.target, _PASS_TOLERANCE, pass_.speed, pass_)
            if pass_.chip:
                order = replace(order, angle=CHIP_ANGLE)
            return order if self.pass_tolerance is None else replace(order, tolerance=self.pass_tolerance)
        return None

    def _with(self, target: Point, tolerance: float, speed: float, pass_: Pass | None) -> _Order:
        if self.chip:
            away = distance(self.ball.position, target)
            speed = min(self.frame.ball_model.chip_speed(away, self.touch_downs), MAX_CHIP_SPEED)
        return _Order(
            target,
            tolerance if self.tolerance is None else self.tolerance,
            speed if self.kick_speed is None else self.kick_speed,
            pass_,
            CHIP_ANGLE if self.chip else 0.0,
        )

    def _turn_with_ball(self, order: _Order) -> None:
        heading = direction(self.ball.position, order.target)
        turn = partial(turn_to, ball=self.ball) if self.round_ball else turn_with_ball
        self.store.command = turn(self.me, heading=heading, limits=self._carry, period=self.frame.period)

    def _come_from_behind(self, order: _Order) -> None:
        frame, me, ball = self.frame, self.me, self.ball
        limits = self.drive_limits
        near = distance(me.position, ball.position) < _NEAR_BALL_DISTANCE
        x, y = ball.position if near else meeting_point(frame, me, limits)
        line = direction((x, y), order.target)
        across = me.limits.touch_kept * (ball.vy * cos(line) - ball.vx * sin(line))
        facing = line - atan2(across, order.along)
        ux, uy = cos(facing), sin(facing)
        # The robot's distance behind the ball and beside the line of the kick.
        back = (x - me.x) * ux + (y - me.y) * uy
        aside = abs((x - me.x) * uy - (y - me.y) * ux)
        behind = (x - _BEHIND_BALL_DISTANCE * ux, y - _BEHIND_BALL_DISTANCE * uy)
        allowed = allowed_target(frame, me, behind, goalkeeper=self.goalkeeper)
        at_wall = distance(allowed, behind) > _WALL_TOLERANCE
        round_ = _ROUND_BALL_TANGENT if frame.game.in_play else _ROUND_BALL_TANGENT_RESTART
        in_line = aside < round_ * back and (not near or aside < _MOUTH_HALF_WIDTH)
        close = (
            self.take
            and near
            and abs(wrap_angle(direction(me.position, (x, y)) - me.heading)) < _TAKEN_BALL_ANGLE
        )
        if not in_line and frame.game.in_play and (has_ball(me, ball) or (at_wall and near) or close):
            # The ball is in front of the mouth but off the line, or cannot be approached from behind: take
            # it, then turn with it. Not at a restart, where the first touch is the kick.
            self.store.command = grab(me, ball, _CREEPING_SPEED, frame.period)
            return
        heading = facing if back < _FACE_TARGET_DISTANCE else direction(me.position, (x, y))
        if in_line and not at_wall and back < _RUN_UP_DISTANCE:
            through = (x + _THROUGH * ux, y + _THROUGH * uy)
            if next_waypoint(frame, me, through, goalkeeper=self.goalkeeper)[0] == through:
                self.store.command = run_up(me, ball, facing, limits, frame.period)
                self.store.command.dribbler = near
                return
        place, final_speed = behind, RUN_UP_SPEED if in_line else 0.0
        if at_wall:
            heading = direction(me.position, (x, y))
            place = (x - _BEHIND_BALL_DISTANCE * cos(heading), y - _BEHIND_BALL_DISTANCE * sin(heading))
            final_speed = _CREEPING_SPEED
        if not (in_line and near):
            heading = roughly(me.heading, heading, _HEADING_SLACK)
        self.store.command = travel(
            frame,
            me,
            place,
            heading,
            limits,
            avoid_ball=not in_line and not at_wall,
            goalkeeper=self.goalkeeper,
            final_speed=final_speed,
            sketch=self.draw,
        )
        self.store.command.dribbler = near

    def _kick_if_aimed(self, order: _Order, gap: float) -> bool:
        me, ball = self.me, self.ball
        if gap > _NEAR_BALL_DISTANCE or (order.pass_ is not None and order.pass_.wait > 0.0):
            return False
        c, s = cos(me.heading), sin(me.heading)
        sideways, ahead = sideways_after_kick(me, ball), c * ball.vx + s * ball.vy
        leaving = me.heading + atan2(sideways, order.along)
        off = abs(wrap_angle(direction(ball.position, order.target) - leaving))
        # At a restart the first touch is the kick, whatever its aim; a second touch would be a foul.
        touched = me.ball_contact and not self.frame.game.in_play
        if off > order.tolerance and not touched:
            return False
        # A ball that rolls towards the robot, or moves ahead with it, may leave faster than the kick alone.
        added = me.limits.touch_returned * max(-ahead, 0.0) + carried_into_kick(
            me, ball, self.store.command.vx
        )
        self.store.command.kick_speed = max(LEAST_KICK, order.speed - added)
        self.store.command.kick_angle = order.angle
        self.store.command.kick_trigger = KickTrigger.ON_CONTACT
        if has_ball(me, ball):
            self._note_pass(order)
        return True

    def _has_left(self, order: _Order) -> bool:
        me, ball = self.me, self.ball
        if me.ball_contact:
            return False
        line = direction(ball.position, order.target)
        return ball.vx * cos(line) + ball.vy * sin(line) > _KICKED_SPEED_SHARE * order.along

    def _note_pass(self, order: _Order) -> None:
        if order.pass_ is not None:
            team = self.store.team
            team.passer, team.receiver = self.me.id, order.pass_.receiver
            team.pass_target, team.pass_time = order.pass_.target, self.frame.time
