"""How a robot answers its commands: the lag, gains and cross-talk of its axes, for predictions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from robobt.world.command import RobotCommand
from robobt.world.driving import approached
from robobt.world.limits import RobotLimits
from robobt.world.state import Frame, RobotId


@dataclass(slots=True)
class FollowedCommand:
    """The velocity that a robot's controller follows, in the robot's frame [m/s, rad/s]."""

    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0

    def follow(self, command: RobotCommand, limits: RobotLimits, time: float) -> None:
        """Follow a command for a time [s], with the lag of each axis."""
        self.vx = approached(self.vx, command.vx, limits.lag, time)
        self.vy = approached(self.vy, command.vy, limits.side_lag, time)
        self.omega = approached(self.omega, command.omega, limits.turn_lag, time)

    def reached(self, limits: RobotLimits) -> tuple[float, float, float]:
        """Return what the robot makes of it: velocity ahead and to the left [m/s], turning rate [rad/s]."""
        return (
            limits.gain * self.vx + limits.cross_ahead * self.vy,
            limits.side_gain * self.vy + limits.cross_aside * self.vx,
            limits.turn_gain * self.omega,
        )


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
            followed.follow(before[1], limits, min(since, time) - before[0])
        if since > time:
            return followed
        before = since, command
    if before is not None:
        followed.follow(before[1], limits, time - before[0])
    return followed


def compensated(commands: Mapping[RobotId, RobotCommand], frame: Frame) -> Mapping[RobotId, RobotCommand]:
    """Return the commands by which robots with known gains reach what they are to do.

    Args:
        commands: velocities that the robots are to reach.
        frame: with the robots' limits.
    """
    if all(state.limits.answers_as_commanded for state in (*frame.own, *frame.opponents)):
        return commands
    changed = {}
    for robot, state in frame.robots().items():
        if robot in commands and not state.limits.answers_as_commanded:
            wanted = commands[robot]
            vx, vy, omega = state.limits.command_for(wanted.vx, wanted.vy, wanted.omega)
            changed[robot] = replace(wanted, vx=vx, vy=vy, omega=omega)
    return {**commands, **changed}
