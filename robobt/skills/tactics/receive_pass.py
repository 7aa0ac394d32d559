"""Meet a rolling ball: redirect it at the goal with one touch if that pays, else take it."""

from __future__ import annotations

from dataclasses import field
from math import cos, hypot, sin

from robobt.motion.arrival import arrival_time
from robobt.motion.catch import MOUTH, catch
from robobt.motion.dribbling import velocity_for_kick
from robobt.motion.path_planner import travel
from robobt.skills.ball.intercept import earliest_meeting, meet
from robobt.skills.base import Skill, skill
from robobt.skills.store import Shot
from robobt.skills.tactics.agree import agree, pass_under_way
from robobt.skills.tactics.chances import aim_of, redirect_angle, redirect_kick, shot_from
from robobt.tree import Status
from robobt.world.command import KickTrigger
from robobt.world.geometry import Point, wrap_angle
from robobt.world.records import movers
from robobt.world.rules import has_ball, in_own_defense_area


@skill
class ReceivePass(Skill):
    """Meet a rolling ball.

    If the ball's line allows a good enough one-touch shot at the goal, the robot stands so that the ball
    meets its mouth and is redirected there; else it faces the ball and takes it. FAILURE while the ball does
    not roll or the robot has it.

    Args:
        slowest: a ball slower than this does not count as rolling [m/s].
        widest: largest angle between where the ball comes from and the goal [rad].
        redirect_at: least chance of a goal for a one-touch shot, 0 to 1.

    Raises:
        ValueError: ``slowest`` is not positive, ``widest`` is negative, or ``redirect_at`` is not 0 to 1.
    """

    reads = ("team",)
    writes = ("team", "shot")

    slowest: float = 0.5
    widest: float = 1.15
    redirect_at: float = 0.15
    _redirecting: bool = field(default=False, init=False)
    _armed: float = field(default=0.0, init=False)
    _armed_at: float = field(default=-1.0, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.slowest > 0.0:
            raise ValueError(f"slowest must be positive, not {self.slowest}")
        if not self.widest >= 0.0:
            raise ValueError(f"widest must be 0 or more, not {self.widest}")
        if not 0.0 <= self.redirect_at <= 1.0:
            raise ValueError(f"redirect_at must be 0 to 1, not {self.redirect_at}")

    def on_start(self) -> None:
        """Forget the last decision."""
        self._redirecting = False
        self._armed = 0.0

    def on_running(self) -> Status:
        """Drive one tick."""
        frame, me, ball, store = self.frame, self.me, self.ball, self.store
        speed, tactics = ball.speed, store.team.plan.tactics
        if speed < self.slowest and not has_ball(me, ball):
            return self.fail("the ball does not roll")
        if self._armed > 0.0 and 0.0 < frame.time - self._armed_at < tactics.bounced and has_ball(me, ball):
            # The ball bounced off before the kicker saw it, so kick it now.
            store.command.kick_speed = self._armed
            store.command.kick_trigger = KickTrigger.ON_CONTACT
            return self.run("sending it on")
        if has_ball(me, ball):
            return self.fail("it has the ball")
        plan = agree(frame, store.team)
        rolling = plan.rolling
        limits = self.drive_limits
        ux, uy = ball.vx / speed, ball.vy / speed
        dx, dy = me.x - ball.x, me.y - ball.y
        ahead = dx * ux + dy * uy
        aside = abs(dx * uy - dy * ux)
        if ahead < -0.05:
            return self.fail("the ball has passed")
        (x, y), _ = earliest_meeting(frame, me, limits, rolling)
        planned = self._planned(ux, uy, speed, rolling)
        if planned is not None:
            x, y = planned
        elif aside < tactics.stays_within and ahead > 0.1:
            # The robot is already on the line: it takes the ball here, unless an opponent would get it
            # before.
            place = max(ahead - MOUTH, 0.0)
            time = frame.ball_model.time_for(place, speed, rolling)
            first = min(plan.their_times.values(), default=10.0)
            if time < first - 0.1:
                x, y = ball.x + place * ux, ball.y + place * uy
        way = hypot(x - ball.x, y - ball.y)
        time = min(3.0, frame.ball_model.time_for(way, speed, rolling))
        heading = self._redirect(x, y, time, speed, ux, uy)
        if heading is None:
            if (
                ahead > MOUTH
                and aside < tactics.catch_within
                and not in_own_defense_area(frame.field, me.x, me.y, tactics.catch_area)
            ):
                store.command = catch(me, ball, limits, frame.period)
            else:
                store.command = meet(
                    frame, me, limits, rolling, slack=tactics.receive_facing, sketch=self.draw
                )
            return self.run("taking the ball")
        place_at = (x - MOUTH * cos(heading), y - MOUTH * sin(heading))
        order = travel(frame, me, place_at, heading, limits, sketch=self.draw)
        gap = hypot(dx, dy)
        if gap < tactics.armed and abs(wrap_angle(heading - me.heading)) < 0.12:
            v = max(0.0, speed - frame.ball_model.roll_deceleration * min(time, 0.3))
            c, s = cos(me.heading), sin(me.heading)
            incoming_x, incoming_y = velocity_for_kick(me, ux * v, uy * v)
            order.kick_speed = (
                redirect_kick(c * incoming_y - s * incoming_x, tactics.shot_speed, tactics.fastest)
                + me.limits.touch_returned * (c * ux + s * uy) * v
            )
            order.kick_trigger = KickTrigger.ON_CONTACT
            self._armed, self._armed_at = order.kick_speed, frame.time
        store.command = order
        return self.run("sending it on")

    def _planned(self, ux: float, uy: float, speed: float, rolling: float) -> Point | None:
        """Return the planned point of reception on the ball's line, if the robot is still in time."""
        frame, team, ball = self.frame, self.store.team, self.ball
        target, tactics = team.pass_target, team.plan.tactics
        if team.receiver != self.me.id or target is None or not pass_under_way(frame, team):
            return None
        target_x, target_y = target
        way = (target_x - ball.x) * ux + (target_y - ball.y) * uy
        if way < 0.15:
            return None
        x, y = ball.x + way * ux, ball.y + way * uy
        time = frame.ball_model.time_for(way, speed, rolling)
        if hypot(x - target_x, y - target_y) > tactics.astray or time > tactics.planned_within:
            return None
        (mover,) = movers((self.me,))
        return (x, y) if arrival_time(mover, x, y, 0.15) <= time + 0.1 else None

    def _redirect(self, x: float, y: float, time: float, speed: float, ux: float, uy: float) -> float | None:
        """Return the heading of a one-touch shot at the goal; None if the ball is to be taken."""
        store, frame = self.store, self.frame
        plan, tactics, field = store.team.plan, store.team.plan.tactics, frame.field
        angle = redirect_angle(x - ux, y - uy, x, y, field.half_length)
        first = min(plan.their_times.values(), default=10.0)
        flies = frame.ball.z > tactics.flies or abs(frame.ball.vz) > tactics.hops
        if (
            plan.without == "one_touch"
            or flies
            or speed < tactics.redirect_from
            or time > tactics.redirect_within
            or first < time
        ):
            self._redirecting = False
            return None
        if angle > self.widest + (0.1 if self._redirecting else 0.0):
            self._redirecting = False
            return None
        chance, goal_y, half_angle = shot_from(x, y, time, plan.their_movers, plan.numbers)
        if chance < self.redirect_at * (0.5 if self._redirecting else 1.0):
            self._redirecting = False
            return None
        self._redirecting = True
        store.shot = Shot((field.half_length, goal_y), max(0.01, half_angle), chance)
        v = max(0.3, speed - 0.5 * time)
        to_goal = field.half_length - x
        incoming = velocity_for_kick(self.me, ux * v, uy * v)
        return aim_of(to_goal, goal_y - y, *incoming, tactics.shot_speed, tactics.fastest)
