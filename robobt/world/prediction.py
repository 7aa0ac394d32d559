"""Delayed observations, predicted to the present with the commands on their way."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import replace
from math import ceil, cos, exp, hypot, sin
from statistics import fmean
from typing import NamedTuple

from robobt.world.answer import FollowedCommand
from robobt.world.command import RobotCommand
from robobt.world.driving import drive, follow
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.predicted_ball import PLACE, STAND_STILL, RobotWay, met_ball
from robobt.world.protocol import Placement, World, WrappedWorld
from robobt.world.state import (
    ROBOT_HEIGHT,
    BallState,
    Frame,
    RobotId,
    RobotState,
)

_PREDICTION_STEP = 0.005
"""Longest step of the motion model [s]."""

_LONGEST_COMMANDED_GAP = 0.1
"""A robot seen in the same place for longer than this stands there, despite its commands [s]."""

_CARRIED_DISTANCE = 0.03
"""A ball seen within this distance of its place in the mouth is in the mouth [m]."""

_ASIDE = 0.04
"""Distance from the middle of the mouth within which it holds a ball [m]."""

_MET_WITHIN = 1.5
"""A robot farther from the ball than this does not meet it before the next command takes effect [m]."""

_FADES = 0.04
"""Time after which the observed motion of a ball held by several robots counts for a third [s]."""


class _Sent(NamedTuple):
    """What was sent at which frame's time [s]."""

    time: float
    commands: Mapping[RobotId, RobotCommand]


class _LastSeen(NamedTuple):
    """A robot as it was seen last, and from when on its commands count [s]."""

    robot: RobotState
    since: float


def predicted(
    world: World,
    limits: Iterable[RobotLimits],
    vision_delay: float = 0.0,
    command_delay: float = 0.0,
    gaps: bool = False,
) -> World:
    """Return the world with its frames predicted, or the world itself if nothing in it is late.

    Args:
        world: the world that is seen late, or whose robots obey late.
        limits: of its robots, which have their dead times.
        vision_delay: age of what it observes [s].
        command_delay: from a command's sending to its arrival at the robots [s].
        gaps: as for :class:`PredictedWorld`.
    """
    if vision_delay + command_delay + max((own.dead_time for own in limits), default=0.0) == 0.0:
        return world
    return PredictedWorld(world, vision_delay, command_delay, gaps)


class PredictedWorld(WrappedWorld):
    """A world whose frames are predicted to the present from the commands sent.

    Every robot is moved on from where it was seen, by the commands in force since then and within its limits,
    to the moment at which the next command moves it, less the reaction that pilots allow for
    (:meth:`robobt.world.limits.RobotLimits.obeys_after`, ``shown_after``).
    A ball in the mouth, which the robot's sensor reports without delay, moves with its robot until a kick on
    its way to the robot sends it off; any other ball rolls on as observed, until a robot takes it, kicks it
    on or lets it bounce off. The robots' ``ball_contact`` is predicted with it.

    Args:
        world: the world that is seen late.
        vision_delay: age of what it observes [s].
        command_delay: from a command's sending to its arrival at the robots [s].
        gaps: whether a detection that is missing repeats the one before; then one that is
            the same to the last digit counts as missing and is predicted for longer.
    """

    def __init__(
        self, world: World, vision_delay: float, command_delay: float = 0.0, gaps: bool = False
    ) -> None:
        super().__init__(world)
        self.vision_delay = vision_delay
        self.command_delay = command_delay
        self._gaps = gaps
        self._sent: deque[_Sent] = deque(maxlen=64)
        self._missed: dict[RobotId, _LastSeen] = {}
        self._now = 0.0

    def reset(self, placement: Placement, seed: int) -> None:
        """See :meth:`robobt.world.World.reset`."""
        self.world.reset(placement, seed)
        self._sent.clear()
        self._missed.clear()
        self._now = 0.0

    def observe(self) -> Frame:
        """Return what the world reports, predicted to the moment at which the next command takes effect."""
        seen = self._look()
        self._now = seen.time
        before = seen.robots()
        after = {robot: self._moved(robot, state) for robot, state in before.items()}
        ball, touched = self._ball(seen, before, after)
        states = tuple(after.values())
        count = len(seen.own)
        return replace(
            seen,
            ball=ball,
            own=states[:count],
            opponents=states[count:],
            last_touch=touched or seen.last_touch,
        )

    @property
    def shows_truth(self) -> bool:
        """Never: it shows what is predicted."""
        return False

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """See :meth:`robobt.world.World.act`."""
        self._sent.append(_Sent(self._now, dict(commands)))
        self.world.act(commands)

    def _look(self) -> Frame:
        """Return what is to be predicted."""
        return self.world.observe()

    def _moved(self, robot: RobotId, seen: RobotState) -> RobotState:
        limits = seen.limits
        delay = self._delay(robot, limits)
        until = self._now + delay - limits.reaction
        since = self._now - self.vision_delay
        if self._gaps:
            last = self._missed.get(robot)
            if last is not None and _same(last.robot, seen):
                since = max(last.since, since - _LONGEST_COMMANDED_GAP)
            self._missed[robot] = _LastSeen(seen, since)
        if since < 0.0:
            since = min(0.0, until)
        state, followed = replace(seen), FollowedCommand()
        for i, (time, commands) in enumerate(self._sent):
            command = commands.get(robot, STAND_STILL)
            begin, end = time + delay, until
            if i + 1 < len(self._sent):
                end = min(end, self._sent[i + 1].time + delay)
            if limits.longest_lag > 0.0 and begin < min(since, end):
                follow(followed, command, limits, min(since, end) - begin)
            begin = max(since, begin)
            if end > begin:
                _drive(state, followed, command, end - begin)
        return state

    def _delay(self, robot: RobotId, limits: RobotLimits) -> float:  # noqa: ARG002
        """Return how long after a command is sent a robot follows it [s]."""
        return limits.obeys_after(self.command_delay)

    def _ball_age(self, robots: tuple[RobotState, ...]) -> float:
        """Return for how long the ball is predicted: the vision's age and the robots' mean delay [s]."""
        dead = fmean(robot.limits.dead_time for robot in robots) if robots else 0.0
        return self.vision_delay + self.command_delay + dead

    def _present(self) -> float:
        """Return when the robots' sensors reported, on the clock by which they are predicted [s]."""
        return self._now

    def _orders(self, robot: RobotId, limits: RobotLimits) -> list[tuple[float, RobotCommand]]:
        """Return a robot's commands, each with the time from which it is in force [s]."""
        delay = self._delay(robot, limits)
        return [(it.time + delay, it.commands.get(robot, STAND_STILL)) for it in self._sent]

    def _ball(
        self, frame: Frame, before: Mapping[RobotId, RobotState], after: Mapping[RobotId, RobotState]
    ) -> tuple[BallState, RobotId | None]:
        """Return the predicted ball and who touches it last; tell predicted robots whether they have it."""
        ball, model = frame.ball, frame.ball_model
        age = self._ball_age(tuple(after.values()))
        seen, until, present = (
            self._now - self.vision_delay,
            self._now - self.vision_delay + age,
            self._present(),
        )
        holders = [robot for robot, state in after.items() if state.ball_contact]
        ways = {
            robot: RobotWay(
                robot,
                state,
                after[robot],
                seen,
                self._now + self._delay(robot, state.limits) - state.limits.reaction,
                self._orders(robot, state.limits),
            )
            for robot, state in before.items()
            if robot in holders or hypot(state.x - ball.x, state.y - ball.y) < _MET_WITHIN
        }
        if holders:
            now = _held(ball, [(before[robot], after[robot]) for robot in holders], age)
            if len(holders) > 1:
                # Where a robot sends a ball that another has too, nobody knows.
                return now, None
            holder = ways[holders[0]]
            met = met_ball(now, tuple(ways.values()), present, present, until, model, holder)
            if met.kept and met.touched is holder:
                return now, None
            after[holder.robot].ball_contact = False
        else:
            met = met_ball(ball, tuple(ways.values()), seen, present, until, model)
        touched = None if met.touched is None else met.touched.robot
        later = met.ball
        if touched is not None and met.kept:
            after[touched].ball_contact = True
            return later, touched
        for robot in after.values():
            dx, dy = later.x - robot.x, later.y - robot.y
            gap = hypot(dx, dy)
            # No ball lies inside a robot.
            if 0.0 < gap < PLACE and later.z < ROBOT_HEIGHT:
                later.x, later.y = robot.x + dx / gap * PLACE, robot.y + dy / gap * PLACE
        return later, touched


def _held(ball: BallState, holding: list[tuple[RobotState, RobotState]], age: float) -> BallState:
    """Return the ball held by robots, which are given as seen and as they are now.

    The mean of the robots' predictions is used. The ball's own observed motion counts less the older it is.
    """
    x = y = vx = vy = 0.0
    fresh = exp(-age / _FADES) if len(holding) > 1 else 0.0
    for before, after in holding:
        c, s = cos(before.heading), sin(before.heading)
        dx, dy = ball.x - before.x, ball.y - before.y
        ahead, aside = c * dx + s * dy, c * dy - s * dx
        if abs(ahead - PLACE) > _CARRIED_DISTANCE or abs(aside) > _ASIDE:
            # The ball was not in the mouth yet when it was seen.
            ahead, aside, fresh = PLACE, 0.0, 0.0
        c, s = cos(after.heading), sin(after.heading)
        dx, dy = c * ahead - s * aside, s * ahead + c * aside
        x, y = x + after.x + dx, y + after.y + dy
        vx, vy = vx + after.vx - after.omega * dy, vy + after.vy + after.omega * dx
    count = len(holding)
    x, y, vx, vy = x / count, y / count, vx / count, vy / count
    if fresh:
        seen_vx, seen_vy = zip(*(_velocity(before, ball.x, ball.y) for before, _ in holding), strict=True)
        vx += fresh * (ball.vx - sum(seen_vx) / count)
        vy += fresh * (ball.vy - sum(seen_vy) / count)
    return BallState(x, y, vx, vy)


def _velocity(robot: RobotState, x: float, y: float) -> tuple[float, float]:
    """Return how fast a place that goes with the robot moves [m/s]."""
    return robot.vx - robot.omega * (y - robot.y), robot.vy + robot.omega * (x - robot.x)


def _same(one: RobotState, other: RobotState) -> bool:
    return (one.x, one.y, one.heading) == (other.x, other.y, other.heading)


def _drive(state: RobotState, followed: FollowedCommand, command: RobotCommand, time: float) -> None:
    """Move a robot on under one command, as its limits let it."""
    limits = state.limits
    steps = max(1, ceil(time / _PREDICTION_STEP - 1e-9))
    dt = time / steps
    for _ in range(steps):
        follow(followed, command, limits, dt)
        drive(state, followed, limits, dt)
        state.x += state.vx * dt
        state.y += state.vy * dt
        state.heading = wrap_angle(state.heading + state.omega * dt)
