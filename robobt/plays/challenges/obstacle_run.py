"""Plays for the obstacle challenge: ways to the target, and the robots in the way."""

from __future__ import annotations

from dataclasses import field

from robobt.motion.pilot import command, drive
from robobt.plays.base import PLAYS
from robobt.plays.baselines.go_round import GoRound
from robobt.skills.base import Skill, skill
from robobt.skills.go_to_pose import GoToPose
from robobt.skills.keep_clear import KeepClear
from robobt.tree import Behaviour, Status
from robobt.world.geometry import Point, distance

OBSTACLE_TARGET = (4.35, 1.35)
"""Target of the challenge as blue sees it [m]; the rules play it at the other end: (-4350, -1350) mm."""

VIRTUAL_LINE = (2, 3)
"""Numbers of the two obstacle robots between which there is a line. Source: the challenge's rules of 2025."""

_TURNS_WITHIN = 0.03
"""Distance from an end at which an obstacle turns back [m]."""

_PATROL_ACCELERATION = 1.0
"""Acceleration of a moving obstacle, gentle so that it keeps a ball [m/s^2]."""


@skill
class ToAndFro(Skill):
    """Drive to and fro between where it started and another point, whatever is in the way; never ends.

    Args:
        to: the other point [m]; None stands still.
        speed: top speed [m/s].
        dribbler: whether the dribbler turns, to carry a ball along.
    """

    to: Point | None = None
    speed: float = 1.0
    dribbler: bool = False
    _home: tuple[Point, float] | None = field(default=None, init=False)
    _back: bool = field(default=False, init=False)

    def on_running(self) -> Status:
        """Drive one tick."""
        me = self.me
        if self._home is None:
            self._home = me.position, me.heading
        home, heading = self._home
        target = home if self.to is None or self._back else self.to
        if self.to is not None and distance(me.position, target) < _TURNS_WITHIN:
            self._back = not self._back
            target = home if self._back else self.to
        limits = me.limits.model_copy(
            update={
                "max_speed": self.speed,
                "acceleration": _PATROL_ACCELERATION,
                "side_acceleration": _PATROL_ACCELERATION,
                "braking": _PATROL_ACCELERATION,
                "side_braking": _PATROL_ACCELERATION,
            }
        )
        self.store.command = drive(me, target, heading, limits, self.frame.period)
        self.store.command.dribbler = self.dribbler
        return self.run("to and fro")


@skill
class DriveStraight(Skill):
    """Drive straight at a point at full speed, whatever is in the way.

    Args:
        target: the point [m].
    """

    target: Point = OBSTACLE_TARGET

    def on_running(self) -> Status:
        """Drive one tick."""
        me, limits = self.me, self.me.limits
        gap = max(distance(me.position, self.target), 1e-6)
        share = limits.max_speed / gap
        vx, vy = share * (self.target[0] - me.x), share * (self.target[1] - me.y)
        self.store.command = command(me, vx, vy, 0.0, limits, self.frame.period)
        return self.run("straight on")


@PLAYS.register("obstacle_run")
def obstacle_run(*, target: Point = OBSTACLE_TARGET, margin: float = 0.05) -> Behaviour:
    """Drive to the target of the obstacle challenge and keep clear of everything.

    Args:
        target: where to [m].
        margin: distance to keep from everything beyond what the rules ask [m].
    """
    return KeepClear(target=target, margin=margin, line=VIRTUAL_LINE)


@PLAYS.register("obstacle_run_planner")
def obstacle_run_planner(*, target: Point = OBSTACLE_TARGET) -> Behaviour:
    """Drive to the target of the obstacle challenge with the planner of the team's other skills.

    Args:
        target: where to [m].
    """
    return GoToPose(target=target)


@PLAYS.register("obstacle_run_2026_11")
def obstacle_run_2026_11(*, target: Point = OBSTACLE_TARGET) -> Behaviour:
    """Drive to the target of the obstacle challenge with the planner of November 2026.

    Args:
        target: where to [m].
    """
    return GoRound("as in 2026-11", GoToPose(target=target))


@PLAYS.register("obstacle_run_straight")
def obstacle_run_straight(*, target: Point = OBSTACLE_TARGET) -> Behaviour:
    """Drive straight to the target of the obstacle challenge, whatever is in the way.

    Args:
        target: where to [m].
    """
    return DriveStraight(target=target)


@PLAYS.register("patrol")
def patrol(*, to: Point | None = None, speed: float = 1.0, dribbler: bool = False) -> Behaviour:
    """Drive to and fro between where the robot started and another point, as obstacles of a challenge do.

    Args:
        to: the other point [m]; None stands still.
        speed: top speed [m/s].
        dribbler: whether the dribbler turns, to carry a ball along.
    """
    return ToAndFro(to=to, speed=speed, dribbler=dribbler)
