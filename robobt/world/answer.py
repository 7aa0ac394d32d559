"""How a robot answers its commands: the lag, gains and cross-talk of its axes, for predictions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from robobt.world.command import RobotCommand
from robobt.world.driving import follow
from robobt.world.limits import RobotLimits
from robobt.world.state import Frame, RobotId


@dataclass(slots=True)
class FollowedCommand:
    """The velocity that a robot's controller follows, in the robot's frame [m/s, rad/s]."""

    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0


def followed_until(
    sent: Iterable[tuple[float, RobotCommand]], limits: RobotLimits, time: float
) -> FollowedCommand:
    """Return what a robot follows at a time.

    Args:
        sent: when each command takes effect [s], and the command; the oldest first.
        limits: the robot's.
        time: as of which [s].
    """
    followed, before = FollowedCommand(), None
    for since, command in sent:
        if before is not None and since > before[0]:
            follow(followed, before[1], limits, min(since, time) - before[0])
        if since > time:
            return followed
        before = since, command
    if before is not None:
        follow(followed, before[1], limits, time - before[0])
    return followed


def compensated(commands: Mapping[RobotId, RobotCommand], frame: Frame) -> Mapping[RobotId, RobotCommand]:
    """Return the commands by which robots with known gains reach what they are to do.

    Args:
        commands: velocities that the robots are to reach.
        frame: with the robots' limits.
    """
    # Most robots have the same limits.
    limits = {id(state.limits): state.limits for state in (*frame.own, *frame.opponents)}
    if all(each.answers_as_commanded for each in limits.values()):
        return commands
    changed = {}
    for robot, state in frame.robots().items():
        if robot in commands and not state.limits.answers_as_commanded:
            wanted = commands[robot]
            vx, vy, omega = state.limits.command_for(wanted.vx, wanted.vy, wanted.omega)
            changed[robot] = replace(wanted, vx=vx, vy=vy, omega=omega)
    return {**commands, **changed}
