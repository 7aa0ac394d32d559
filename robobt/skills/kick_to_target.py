"""Kick the ball at the chosen target."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, radians, sin
from typing import ClassVar, Literal

from robobt.skills.base import Skill, skill
from robobt.skills.dribbling import dribbling_limits
from robobt.skills.go_to_ball import meeting_point
from robobt.skills.pace import Pace
from robobt.skills.path_planner import allowed_target, travel
from robobt.skills.pick_up_ball import grab
from robobt.skills.pilot import command, turn_rate
from robobt.skills.possession import has_ball
from robobt.skills.robobulls_kick import ROBOBULLS_KICK_SPEED, RobobullsKick
from robobt.skills.store import Pass
from robobt.tree import Status
from robobt.world.command import KickTrigger
from robobt.world.geometry import Point, direction, distance, wrap_angle
from robobt.world.limits import RobotLimits

SHOT_SPEED = 6.4
"""Kick speed of a shot [m/s]: the rules' 6.5 m/s less what sideways motion may add."""

_SHOT_TOLERANCE = (radians(0.5), radians(4.0))
"""Least and most angle by which a shot may be off its point [rad]."""
_PASS_TOLERANCE = radians(1.5)
_ROBOBULLS_TOLERANCE = {"shot": radians(1.0), "pass": radians(5.0)}

_BEHIND = 0.16
_THROUGH = 0.06
_ROUND = radians(25.0)
_NEAR = 0.25
_IN_MOUTH = 0.03
"""A ball no farther than this from the heading's line meets the mouth [m]."""
_CREEP = 0.5
_GOT_AWAY = 0.7
_RUN_UP = 1.0
"""Speed at which the robot drives into a ball that it is aimed through [m/s]."""
_TURN_DISTANCE = 1.2
_REACHABLE = 0.03
_LEFT_SHARE = 0.6
"""A ball with this share of the kick's speed towards the target has been kicked."""
_CARRY_SPEED = 2.0
_CARRY_ACCELERATION = 1.0


@dataclass(slots=True, frozen=True)
class _Order:
    target: Point
    tolerance: float
    speed: float
    pass_: Pass | None


@skill
class KickToTarget(Skill):
    """Kick the ball at a point: turn with it when the robot has it, else come from behind and kick it.

    Running until the ball has left, then succeeding. Fails without a target and
    when the ball has got away. A pass is noted in the team's store as its kick
    goes out.

    The ball leaves along the heading with whatever sideways velocity it has, so
    the robot aims that much to the other side, and may kick while it still turns.

    Args:
        target: where to kick [m]; None takes ``store.shot``, else ``store.pass_``.
        style: "default", or "robobulls" for the paper's baseline
            (:class:`~robobt.skills.robobulls_kick.RobobullsKick`).
        kick_speed: [m/s]; None is the pass's own speed, or a full shot.
        tolerance: angle by which the kick may be off [rad]; None is half the
            shot's own tolerance, 1.5 degrees for a pass.
        max_turn: turning rate with the ball [rad/s].
        limits: how to drive without the ball; None for the robot's own, or
            RoboBulls' in that style.
        speed: factor on the top speed.
        goalkeeper: may enter the own defence area.

    Raises:
        ValueError: no such style.
    """

    reads: ClassVar[tuple[str, ...]] = ("shot", "pass_")
    writes: ClassVar[tuple[str, ...]] = ("team",)

    def __init__(
        self,
        *,
        target: Point | None = None,
        style: Literal["default", "robobulls"] = "default",
        kick_speed: float | None = None,
        tolerance: float | None = None,
        max_turn: float = 4.0,
        limits: RobotLimits | None = None,
        speed: float = 1.0,
        goalkeeper: bool = False,
        name: str = "",
    ) -> None:
        super().__init__(name)
        if style not in ("default", "robobulls"):
            raise ValueError(f"style must be 'default' or 'robobulls', not {style!r}")
        self.target = target
        self.style = style
        self.kick_speed = kick_speed
        self.tolerance = tolerance
        self.goalkeeper = goalkeeper
        self.pace = Pace(limits, speed)
        self._carry = dribbling_limits(_CARRY_SPEED, max_turn, _CARRY_ACCELERATION)
        self._robobulls = RobobullsKick(goalkeeper=goalkeeper) if style == "robobulls" else None
        if self._robobulls is not None and limits is not None:
            self._robobulls.limits = limits
        self._kicking: _Order | None = None
        self._was_near = False

    def needs(self) -> list[tuple[str, ...]]:
        """A shot or a pass, unless it has been told where to kick."""
        return [("shot", "pass_")] if self.target is None else []

    def on_start(self) -> None:
        """Forget the last kick."""
        self._kicking = None
        self._was_near = False
        if self._robobulls is not None:
            self._robobulls.start()

    def on_running(self) -> Status:
        """Aim, or kick, for one tick."""
        if self._kicking is not None and self._has_left(self._kicking):
            return self.succeed("kicked")
        order = self._order()
        if order is None:
            return self.fail("no target")
        if self._robobulls is not None:
            return self._as_robobulls(self._robobulls, order)
        gap = distance(self.me.position, self.ball.position)
        if gap < _NEAR:
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
            return self._with(pass_.target, _PASS_TOLERANCE, pass_.speed, pass_)
        return None

    def _with(self, target: Point, tolerance: float, speed: float, pass_: Pass | None) -> _Order:
        return _Order(
            target,
            tolerance if self.tolerance is None else self.tolerance,
            speed if self.kick_speed is None else self.kick_speed,
            pass_,
        )

    def _turn_with_ball(self, order: _Order) -> None:
        me, limits, period = self.me, self._carry, self.frame.period
        wanted = direction(self.ball.position, order.target)
        omega = turn_rate(me, wanted, limits, period)
        self.store.command = command(me, 0.0, 0.0, omega, limits, period)
        self.store.command.dribbler = True

    def _come_from_behind(self, order: _Order) -> None:
        frame, me = self.frame, self.me
        limits = self.pace.of(me.limits)
        meeting = meeting_point(frame, me, limits)
        line = direction(meeting, order.target)
        drift = frame.ball.vy * cos(line) - frame.ball.vx * sin(line)
        facing = line - atan2(drift, order.speed)
        ux, uy = cos(facing), sin(facing)
        off = abs(wrap_angle(direction(me.position, meeting) - facing))
        gap = distance(me.position, meeting)
        behind = (meeting[0] - _BEHIND * ux, meeting[1] - _BEHIND * uy)
        allowed = allowed_target(frame, me, behind, goalkeeper=self.goalkeeper)
        at_wall = distance(allowed, behind) > _REACHABLE
        in_line = off < _ROUND and (gap > _NEAR or gap * sin(off) < _IN_MOUTH)
        if not in_line and (has_ball(me, frame.ball) or (at_wall and gap < _NEAR)):
            # It lies askew before the mouth, or cannot be come at from behind: take it, then turn with it.
            self.store.command = grab(me, frame.ball, _CREEP, frame.period)
            return
        if at_wall:
            bearing = direction(me.position, meeting)
            behind = (meeting[0] - _BEHIND * cos(bearing), meeting[1] - _BEHIND * sin(bearing))
            facing, in_line = bearing, True
        heading = facing if gap < _TURN_DISTANCE else direction(me.position, meeting)
        if in_line:
            place = (meeting[0] - _THROUGH * cos(facing), meeting[1] - _THROUGH * sin(facing))
        else:
            place = behind
        self.store.command = travel(
            frame,
            me,
            place,
            heading,
            limits,
            avoid_ball=not in_line,
            goalkeeper=self.goalkeeper,
            final_speed=_RUN_UP if in_line else 0.0,
        )
        self.store.command.dribbler = gap < _NEAR

    def _kick_if_aimed(self, order: _Order, gap: float) -> bool:
        me, ball = self.me, self.ball
        if gap > _NEAR:
            return False
        sideways = cos(me.heading) * ball.vy - sin(me.heading) * ball.vx
        leaving = me.heading + atan2(sideways, order.speed)
        if abs(wrap_angle(direction(ball.position, order.target) - leaving)) > order.tolerance:
            return False
        self.store.command.kick_speed = order.speed
        self.store.command.kick_trigger = KickTrigger.ON_CONTACT
        if order.pass_ is not None and has_ball(me, ball):
            self._note_pass(order.pass_)
        return True

    def _has_left(self, order: _Order) -> bool:
        me, ball = self.me, self.ball
        if me.ball_contact:
            return False
        line = direction(ball.position, order.target)
        return ball.vx * cos(line) + ball.vy * sin(line) > _LEFT_SHARE * order.speed

    def _as_robobulls(self, kick: RobobullsKick, order: _Order) -> Status:
        default = _ROBOBULLS_TOLERANCE["shot" if order.pass_ is None else "pass"]
        kick.tolerance = default if self.tolerance is None else self.tolerance
        kick.kick_speed = ROBOBULLS_KICK_SPEED if self.kick_speed is None else self.kick_speed
        status = kick.tick(self.store, order.target)
        if order.pass_ is not None and self.store.command.kick_speed > 0.0:
            self._note_pass(order.pass_)
        return self.succeed("kicked") if status is Status.SUCCESS else self.run(kick.stage.value)

    def _note_pass(self, chosen: Pass) -> None:
        team = self.store.team
        team.passer, team.receiver = self.me.id, chosen.receiver
        team.pass_target, team.pass_time = chosen.target, self.frame.time
