"""Turn with the ball and kick it into the goal."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from math import atan2, cos, hypot, inf, sin, sqrt
from typing import Annotated, TypeAlias

from pydantic import Field

from robobt.config.validation import Settings
from robobt.motion.dribbling import carried_into_kick, dribbling_limits, sideways_after_kick, turn_with_ball
from robobt.motion.path_planner import TARGETS
from robobt.skills.ball.kick_to_target import LEAST_KICK
from robobt.skills.ball.learned_control import LearnedControl, PolicyError, find_policy, policies_by_name
from robobt.skills.base import Skill, skill
from robobt.skills.store import Store
from robobt.tree import Registry, Status
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.geometry import Point, direction, wrap_angle
from robobt.world.state import BALL_RADIUS, TOUCH_DISTANCE, BallState, RobotState

_OPEN_ANGLE_SHARE = 0.6
"""Share of the open angle on each side of the aim within which the robot kicks."""
_LEAVING_SPEED = 1.0
"""A ball that is this much faster than the robot after a kick has left [m/s]."""
_LOST_AFTER = 0.15
"""A ball out of the mouth for longer is lost [s]: it may bounce on the dribbler for a tick or two."""

Policy = Callable[[Store], RobotCommand]
"""A policy for shooting, called in every tick while the robot has the ball."""

SHOOT_POLICIES: Registry[Callable[..., object]] = Registry("shoot policy")
"""The policies by name. Each is a function, or a class of which each leaf builds one instance."""

_SHOOT_BY_NAME = policies_by_name(SHOOT_POLICIES)

ShootPolicy: TypeAlias = Annotated[str | Mapping[str, object] | Policy, _SHOOT_BY_NAME]
"""A policy for shooting, as parameters accept it."""


@skill
class Shoot(Skill):
    """Turn on the spot with the ball and kick it into the attacked goal: the paper's Shoot-Towards-Goal.

    Succeeds when the ball has left after a kick. Fails when the ball is not in the mouth: a ball merely in
    front of it cannot be kicked without driving. When a trained policy's answer is not a valid action, the
    skill fails and the robot stops.

    Args:
        policy: what decides turning and kick, by name or as ``{name: NAME, SETTING: VALUE}``: "geometric"
            aims at ``store.shot``, else at the middle of the goal; "ddpg", or another of ``SHOOT_POLICIES``;
            or another trained one by its model's name or file.

    Raises:
        ValueError: no policy has that name, or its model cannot be used.
    """

    reads = ("shot",)
    optional = ("shot",)

    policy: ShootPolicy = "geometric"
    _kicked: bool = field(default=False, init=False)
    _had_it: float = field(default=-inf, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._decide = find_policy(self.policy, _SHOOT_BY_NAME, LearnedShot)

    @property
    def learned(self) -> bool:
        """Return whether a trained policy decides; it chooses its own aim."""
        return isinstance(self._decide, LearnedShot)

    def on_start(self) -> None:
        """Forget the last shot."""
        self._kicked = False
        self._had_it = -inf
        if isinstance(self._decide, LearnedShot):
            self._decide.restart()

    def on_running(self) -> Status:
        """Turn, or kick, for one tick."""
        me, ball, time = self.me, self.ball, self.frame.time
        if self._kicked and _has_left(me, ball):
            return self.succeed("kicked")
        if me.ball_contact:
            self._had_it = time
        elif not 0.0 <= time - self._had_it <= _LOST_AFTER:
            return self.fail("it does not have the ball")
        try:
            self.store.command = self._decide(self.store)
        except PolicyError as error:
            self.store.command = RobotCommand()
            return self.fail(str(error))
        self._kicked |= self.store.command.kick_speed > 0.0
        return self.run("kicking" if self.store.command.kick_speed > 0.0 else "turning with the ball")


@SHOOT_POLICIES.register("geometric")
class GeometricShot(Settings):
    """Turn to the aim as fast as the dribbler holds the ball, and kick once the ball would leave towards it.

    The ball leaves along the heading and keeps its sideways velocity. The kick's speed is the rules' 6.5 m/s
    minus what sideways motion may add, and minus what the kick adds to a ball that moves ahead.
    """

    kick_speed: float = Field(6.4, gt=0, le=20, description="speed of the shot [m/s]")
    max_turn: float = Field(4.0, gt=0, le=30, description="turning rate with the ball [rad/s]")

    def __call__(self, store: Store) -> RobotCommand:
        """Compute the command of one tick."""
        frame, me, ball = store.frame, store.me, store.frame.ball
        aim, tolerance = _aim(store)
        store.draw.line(TARGETS, ball.position, aim)
        heading = direction(ball.position, aim)
        decided = turn_with_ball(me, heading, dribbling_limits(max_turn=self.max_turn), frame.period)
        sideways = sideways_after_kick(me, ball)
        if abs(wrap_angle(heading - me.heading - atan2(sideways, self.kick_speed))) <= tolerance:
            decided.kick_speed = _kick_at(self.kick_speed, me, ball)
            decided.kick_trigger = KickTrigger.NOW
        return decided


class LearnedShot:
    """A shot by a trained policy, which turns and brakes only as hard as the dribbler can hold the ball.

    Its kick is softer by what a kick adds to a ball that moves ahead, which training knows nothing of.

    Args:
        model: name or file of a model for Shoot.
    """

    def __init__(self, model: str) -> None:
        self._control = LearnedControl(model, skill="Shoot")
        self._velocity: tuple[float, float] | None = None

    def restart(self) -> None:
        """Forget the last shot."""
        self._control.forget()
        self._velocity = None

    def __call__(self, store: Store) -> RobotCommand:
        """Compute the command of one tick."""
        decided, me = self._control.decide(store.frame, store.me, store.draw), store.me
        if decided.kick_speed > 0.0:
            decided.kick_speed = _kick_at(decided.kick_speed, me, store.frame.ball)
        held, vx, vy = me.limits.hold_acceleration, me.vx, me.vy
        if self._control.remembers:
            # Turning and braking pull at the ball at right angles.
            held *= sqrt(0.5)
            if self._velocity is not None:
                # A late robot's own speed would let it brake too slowly.
                vx, vy = self._velocity
        # Turning at rate w with the ball at distance L needs the acceleration w^2 L.
        fastest = sqrt(held / TOUCH_DISTANCE)
        decided.omega = min(fastest, max(-fastest, decided.omega))
        speed = hypot(vx, vy)
        self._velocity = 0.0, 0.0
        if speed > held * store.frame.period:
            left = 1.0 - held * store.frame.period / speed
            self._velocity = left * vx, left * vy
            c, s = left * cos(me.heading), left * sin(me.heading)
            decided.vx, decided.vy = c * vx + s * vy, c * vy - s * vx
        return decided


@SHOOT_POLICIES.register("ddpg")
class DdpgShot(LearnedShot):
    """Turn and kick by the shipped model that was trained with DDPG."""

    def __init__(self) -> None:
        super().__init__("shoot_ddpg")


def _kick_at(speed: float, me: RobotState, ball: BallState) -> float:
    """Return the kick that sends a ball off at a speed [m/s], which is less where the ball moves ahead."""
    return max(min(LEAST_KICK, speed), speed - carried_into_kick(me, ball))


def _aim(store: Store) -> tuple[Point, float]:
    """Return the target of the shot [m] and its tolerance [rad]."""
    if store.shot is not None:
        return store.shot.target, 0.5 * store.shot.tolerance
    frame = store.frame
    goal, half = frame.field.their_goal, frame.field.goal_width / 2 - BALL_RADIUS
    x, y = frame.ball.position
    upper, lower = (direction((x, y), (goal[0], side)) for side in (half, -half))
    middle = direction((x, y), goal)
    nearer_post = min(abs(wrap_angle(upper - middle)), abs(wrap_angle(lower - middle)))
    return goal, _OPEN_ANGLE_SHARE * nearer_post


def _has_left(me: RobotState, ball: BallState) -> bool:
    return not me.ball_contact and hypot(ball.vx - me.vx, ball.vy - me.vy) > _LEAVING_SPEED
