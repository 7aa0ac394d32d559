"""Get to the ball so that it can be picked up."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import atan2, cos, hypot, pi, radians, sin, sqrt
from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from robobt.config.validation import Settings
from robobt.motion.dribbling import carry
from robobt.motion.path_planner import allowed_target, travel
from robobt.motion.pilot import roughly, stop_time
from robobt.skills.ball.learned_control import LearnedControl, PolicyError, find_policy, policies_by_name
from robobt.skills.ball.pick_up_ball import LOST_DISTANCE
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.skills.store import Store
from robobt.tree import Registry, Status
from robobt.world.ball_model import way_in
from robobt.world.command import RobotCommand
from robobt.world.compiled import compilable
from robobt.world.geometry import Point, direction, distance, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.records import Ball, Robot
from robobt.world.rules import has_ball
from robobt.world.state import TOUCH_DISTANCE, BallState, Frame, RobotState

HANDOVER_DISTANCE = 0.2
"""Distance to the ball's centre at which the approach ends [m]. Source: the paper's Go-To-Ball."""

FACING_BALL = radians(30.0)
_FACING_STILL = radians(60.0)
_APPROACH_DISTANCE = 0.16
"""Distance from the ball's centre at which the approach aims [m]; the planner's detour round the ball is
slightly narrower."""
_REACHABLE_ERROR = 0.03
_ROUND_BALL_ANGLE = radians(30.0)
_FACE_BALL_DISTANCE = 1.0
_LOOKING = radians(10.0)
"""Heading error allowed while the robot is still on its way."""
_BRAKING_SHARE = 0.8
"""Share of the robot's braking that the plan relies on."""
_RESTS = 0.05
"""A ball slower than this is approached where it is [m/s]."""


@dataclass(slots=True)
class Approach:
    """What one approach has to do.

    Attributes:
        meeting: where the ball can be met [m].
        facing: direction in which to come to it [rad]; None for any.
        limits: how to drive.
        goalkeeper: may enter the own defence area.
    """

    meeting: Point
    facing: float | None
    limits: RobotLimits
    goalkeeper: bool


Policy = Callable[[Store, Approach], RobotCommand]
"""A policy for approaching the ball, called in every tick."""

GO_TO_BALL_POLICIES: Registry[Callable[..., object]] = Registry("go-to-ball policy")
"""The policies by name. Each is a function, or a class of which each leaf builds one instance."""

_GO_TO_BALL_BY_NAME = policies_by_name(GO_TO_BALL_POLICIES)

GoToBallPolicy: TypeAlias = Annotated[str | Mapping[str, object] | Policy, _GO_TO_BALL_BY_NAME]
"""A policy for approaching the ball, as parameters accept it."""


@skill
class GoToBall(DrivingSkill):
    """Approach the ball until it is within 0.2 m and ahead, so that :class:`PickUpBall` can take over.

    A moving ball is met where it will be. After that the skill keeps succeeding until the ball is 0.3 m away
    or more than 60 degrees off the heading, so that approach and pick-up do not alternate.

    A trained policy succeeds by the contact rule in its model card and approaches from any side, so it
    ignores ``approach``. If its answer is not a valid action, the skill fails and the robot stops.

    Args:
        policy: what decides the motion, by name or as ``{name: NAME, SETTING: VALUE}``: "geometric", or
            another of ``GO_TO_BALL_POLICIES``; or a trained one by its model's name or file.
        approach: "nearest" drives straight at the ball; "behind_target" comes
            from the side opposite to ``store.shot``, else ``store.target``, else
            the attacked goal.
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
        goalkeeper: may enter the own defence area.

    Raises:
        ValueError: no policy has that name, its model cannot be used, or there is no such approach.
    """

    reads = ("shot", "target")
    optional = ("shot", "target")

    policy: GoToBallPolicy = "geometric"
    approach: Literal["nearest", "behind_target"] = "nearest"
    goalkeeper: bool = False
    _handed_over: bool = field(default=False, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.approach not in ("nearest", "behind_target"):
            raise ValueError(f"approach must be 'nearest' or 'behind_target', not {self.approach!r}")
        self._decide = find_policy(self.policy, _GO_TO_BALL_BY_NAME, LearnedApproach)
        self._learned = self._decide if isinstance(self._decide, LearnedApproach) else None

    def on_running(self) -> Status:
        """Drive one tick."""
        store = self.store
        me, ball, limits, facing = store.me, store.frame.ball, self.drive_limits, None
        try:
            if self._learned is not None:
                # Of an approach it needs only the limits.
                store.command = self._learned.command(store, limits)
            else:
                meeting = meeting_point(store.frame, me, limits)
                facing = self._facing(meeting)
                store.command = self._decide(store, Approach(meeting, facing, limits, self.goalkeeper))
        except PolicyError as error:
            store.command = RobotCommand()
            return self.fail(str(error))
        self._handed_over = has_ball(me, ball) or self._near(me, ball, facing)
        return self.succeed("at the ball") if self._handed_over else self.run("on the way to the ball")

    def _near(self, me: RobotState, ball: BallState, facing: float | None) -> bool:
        within, off = HANDOVER_DISTANCE, FACING_BALL
        if self._learned is not None:
            within, off = self._learned.reached
        if not is_at_ball(me, ball, self._handed_over, within, off):
            return False
        if self._handed_over:
            off = max(off, _FACING_STILL)
        bearing = atan2(ball.y - me.y, ball.x - me.x)
        return facing is None or abs(wrap_angle(bearing - facing)) <= off

    def _facing(self, meeting: Point) -> float | None:
        """Return the direction of approach; None for any direction, for example to a ball at a wall."""
        if self.approach == "nearest":
            return None
        store = self.store
        if store.shot is not None:
            aim = store.shot.target
        else:
            aim = self.frame.field.their_goal if store.target is None else store.target
        facing = direction(meeting, aim)
        place = beside(meeting, facing)
        allowed = allowed_target(self.frame, self.me, place, goalkeeper=self.goalkeeper)
        return facing if distance(allowed, place) < _REACHABLE_ERROR else None


@GO_TO_BALL_POLICIES.register("geometric")
class GeometricApproach(Settings):
    """Drive to the place beside the ball along the planned way, facing the ball."""

    arrival_speed: float = Field(0.5, ge=0, le=10, description="final speed, which the pick-up keeps [m/s]")

    def __call__(self, store: Store, approach: Approach) -> RobotCommand:
        """Compute the command of one tick."""
        frame, me = store.frame, store.me
        meeting, facing = approach.meeting, approach.facing
        bearing = direction(me.position, meeting)
        round_it = facing is not None and abs(wrap_angle(bearing - facing)) > _ROUND_BALL_ANGLE
        heading, far = approach_heading(me, frame.ball, meeting)
        if not far and facing is not None:
            heading = facing
        return travel(
            frame,
            me,
            beside(meeting, bearing if facing is None else facing),
            heading,
            approach.limits,
            avoid_ball=round_it,
            goalkeeper=approach.goalkeeper,
            final_speed=0.0 if round_it else self.arrival_speed,
            sketch=store.draw,
        )


class LearnedApproach:
    """An approach driven by a trained policy, within given limits.

    Its closing speed is limited so that it can still brake to the speed at which the robot's dribbler takes
    the ball: policies are trained to arrive, not to stop.

    Args:
        model: name or file of a model for GoToBall.

    Attributes:
        reached: distance to the ball [m] and angle off the heading [rad] at which training counted the ball
            as reached; a distance of 0 if it was trained to touch the ball.
    """

    def __init__(self, model: str) -> None:
        self._control = LearnedControl(model, skill="GoToBall")
        self.reached = _reached(self._control.card.environment.get("contact"))

    def __call__(self, store: Store, approach: Approach) -> RobotCommand:
        """Compute the command of one tick."""
        return self.command(store, approach.limits)

    def command(self, store: Store, limits: RobotLimits) -> RobotCommand:
        """Compute the command of one tick within these limits.

        Args:
            store: the robot's store.
            limits: how to drive.

        Raises:
            PolicyError: the policy's answer is not a valid action.
        """
        me, turn = store.me, limits.max_turn
        command = self._control.decide(store.frame, me, store.draw)
        speed = hypot(command.vx, command.vy)
        fastest = min(limits.max_speed, _closing_speed(store))
        if speed > fastest:
            command.vx *= fastest / speed
            command.vy *= fastest / speed
        command.omega = min(turn, max(-turn, command.omega))
        carry(command, me)
        return command


def _closing_speed(store: Store) -> float:
    """Return the highest speed from which it can brake before contact to what its dribbler takes [m/s]."""
    frame, me = store.frame, store.me
    limits, ball = me.limits, frame.ball
    way = hypot(ball.x - me.x, ball.y - me.y) - HANDOVER_DISTANCE - hypot(me.vx, me.vy) * frame.period
    along, across = limits.braking, limits.lateral_braking
    braking = _BRAKING_SHARE * (across if across < along else along)
    taken = limits.catch_speed**2 + 2.0 * braking * (way if way > 0.0 else 0.0)
    return hypot(ball.vx, ball.vy) + sqrt(taken)


def _reached(contact: object) -> tuple[float, float]:
    rule = contact if isinstance(contact, dict) else {}
    if rule.get("rule") in ("infrared", "held"):
        return (0.0, pi)
    distance_, angle = rule.get("distance"), rule.get("angle")
    within = float(distance_) if isinstance(distance_, int | float) else HANDOVER_DISTANCE
    if rule.get("rule") == "distance_facing" and isinstance(angle, int | float):
        return (within, float(angle))
    return (within, pi)


@GO_TO_BALL_POLICIES.register("ddpg")
class DdpgApproach(LearnedApproach):
    """Drive straight at the ball, from any side, by the shipped model that was trained with DDPG."""

    def __init__(self) -> None:
        super().__init__("go_to_ball_ddpg")


@compilable
def beside(ball: Point, facing: float) -> Point:
    """Return where a robot that faces ``ball`` along ``facing`` [rad] stands before it takes the ball [m]."""
    return (ball[0] - _APPROACH_DISTANCE * cos(facing), ball[1] - _APPROACH_DISTANCE * sin(facing))


def meeting_point(frame: Frame, me: RobotState, limits: RobotLimits) -> Point:
    """Predict where a rolling ball will be when the robot gets there [m]."""
    model, pace = frame.ball_model, (limits.max_speed, limits.acceleration, limits.braking)
    return meeting_law(me, frame.ball, pace, model.slide_deceleration, model.roll_deceleration)


@compilable
def meeting_law(me: Robot, ball: Ball, pace: tuple[float, float, float], slide: float, roll: float) -> Point:
    """Return :func:`meeting_point`, compiled.

    Args:
        me: the robot.
        ball: the rolling ball.
        pace: the robot's top speed, acceleration and braking [m/s, m/s^2, m/s^2].
        slide: deceleration of the ball while it slides [m/s^2].
        roll: deceleration of the ball while it rolls [m/s^2].
    """
    top, acceleration, braking = pace
    x, y, speed = ball.x, ball.y, hypot(ball.vx, ball.vy)
    if speed < _RESTS:
        return x, y
    ux, uy = ball.vx / speed, ball.vy / speed
    for _ in range(2):
        dx, dy = x - me.x, y - me.y
        gap = hypot(dx, dy)
        towards = (me.vx * dx + me.vy * dy) / gap if gap > 0.0 else 0.0
        time = stop_time(max(0.0, gap - TOUCH_DISTANCE), towards, acceleration, braking, top)
        way = way_in(time, speed, speed, slide, roll)
        x, y = ball.x + ux * way, ball.y + uy * way
    return x, y


@compilable
def is_at_ball(me: Robot, ball: Ball, handed_over: bool, within: float, off: float) -> bool:
    """Return whether the approach has ended.

    Args:
        me: the robot.
        ball: the ball.
        handed_over: whether it had ended in the tick before.
        within: distance at which it ends [m].
        off: angle between heading and ball up to which it ends [rad].
    """
    if handed_over:
        within, off = LOST_DISTANCE, max(off, _FACING_STILL)
    dx, dy = ball.x - me.x, ball.y - me.y
    return hypot(dx, dy) <= within and abs(wrap_angle(atan2(dy, dx) - me.heading)) <= off


@compilable
def approach_heading(me: Robot, ball: Ball, meeting: Point) -> tuple[float, bool]:
    """Return the heading on the way to the ``meeting`` point [rad], and whether that point is still far."""
    here = (me.x, me.y)
    heading = direction(here, (ball.x, ball.y))
    if distance(here, meeting) < _FACE_BALL_DISTANCE:
        return heading, False
    return roughly(me.heading, heading, _LOOKING), True
