"""Manual driving: converts a page's commands to the robot's, and stops it when they no longer arrive."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, pi, radians
from typing import Literal

from robobt.world.command import RobotCommand
from robobt.world.geometry import direction, distance, to_robot_frame, wrap_angle
from robobt.world.rules import own_side
from robobt.world.state import Frame, RobotState

STOPS_IN = 0.2
"""A robot whose page falls silent is stopped in this time [s]."""

_TICK_LATENESS = 0.02
"""Tolerated delay of a tick [s]."""

HELD_UP = 0.1
"""A command with this much more delay than the fastest counts as that old [s]."""

_DELAY_WINDOW = 30.0
"""Time for which the shortest delay is kept, because clocks drift apart [s]."""

_RECEIVER_ANGLE = radians(35.0)
"""A pass is not meant for a team-mate farther off the heading than this."""

_PASS_ANGLE_ERROR = radians(2.5)
"""Angle error allowed for a pass."""

_ASSISTED_TURN, _ASSISTED_TURN_GAIN = 3.0, 10.0
"""Turning rate with the ball of an assisted robot [rad/s], and rate per remaining angle [1/s]."""

_ARRIVAL = 2.5
"""Arrival speed of an assisted pass [m/s]."""

Frames = Literal["field", "robot"]


class HandDriver:
    """Drives one robot by its page's commands: called in every tick, it returns the robot's command.

    Args:
        clock: clock for the age of commands [s].
        period: time between two ticks [s].

    Attributes:
        deadline: age from which a command no longer counts [s].
    """

    def __init__(self, clock: Callable[[], float], period: float) -> None:
        self._clock = clock
        # The last tick that still follows a command lasts for a period.
        self.deadline = STOPS_IN - period - _TICK_LATENESS
        self._wanted: tuple[float, float, float, Frames, bool, float, bool] | None = None
        self._at = 0.0
        self._way = _ShortestWay()

    def command(
        self,
        sent: float,
        arrived: float,
        velocity: tuple[float, float],
        omega: float,
        frame: Frames,
        dribbler: bool,
        kick: float,
        assist: bool = False,
    ) -> bool:
        """Take a command; return False for a delayed one.

        Args:
            sent: when the page sent it, by the page's own clock [s].
            arrived: when it came, by ours [s].
            velocity: as a share of the robot's top speed, in the field's frame as the page shows it (blue
                defends -x) or the robot's own.
            omega: as a share of its top turning rate.
            frame: which of them.
            dribbler: whether the dribbler is on.
            kick: speed of a kick [m/s], 0 for none.
            assist: whether a kick becomes a pass to the team-mate that the robot roughly faces.
        """
        if self._way.excess(arrived, arrived - sent) > HELD_UP:
            return False
        self._wanted = (*velocity, omega, frame, dribbler, kick, assist)
        self._at = arrived
        return True

    @property
    def told(self) -> bool:
        """Whether a command is in force."""
        return self._wanted is not None and self._clock() <= self._at + self.deadline

    def stop(self) -> None:
        """Stop the robot until the next command."""
        self._wanted = None

    def __call__(self, view: Frame, me: RobotState) -> RobotCommand:
        """Return the command of this tick."""
        if self._wanted is None or not self.told:
            return RobotCommand()
        x, y, omega, frame, dribbler, kick, assist = self._wanted
        if assist and kick > 0.0:
            passed = _passed(view, me, kick)
            if passed is not None:
                return passed
        size = max(1.0, hypot(x, y))
        x, y = x / size * me.limits.max_speed, y / size * me.limits.max_speed
        if frame == "field":
            # The page shows blue's view; the command is given in the team's own.
            side = -own_side(view.team)
            x, y = to_robot_frame(side * x, side * y, me.heading)
        return RobotCommand(x, y, omega * me.limits.max_turn, kick, dribbler=dribbler)


def _passed(view: Frame, me: RobotState, most: float) -> RobotCommand | None:
    """Return the command that turns to the intended team-mate and passes to it, or None without one."""
    mates = [mate for mate in view.own if mate.id != me.id]
    offs = [(wrap_angle(direction(me.position, mate.position) - me.heading), mate) for mate in mates]
    off, meant = min(offs, key=lambda each: abs(each[0]), default=(pi, me))
    if abs(off) > _RECEIVER_ANGLE:
        return None
    turn = min(_ASSISTED_TURN, max(-_ASSISTED_TURN, _ASSISTED_TURN_GAIN * off))
    if abs(off) > _PASS_ANGLE_ERROR:
        return RobotCommand(omega=turn, dribbler=True)
    speed = view.ball_model.kick_speed(distance(me.position, meant.position), _ARRIVAL)
    return RobotCommand(omega=turn, kick_speed=min(most, speed), dribbler=True)


class _ShortestWay:
    """The shortest recent delay, including the clocks' difference."""

    def __init__(self) -> None:
        self._since = float("-inf")
        self._before = self._now = float("inf")

    def excess(self, at: float, took: float) -> float:
        """Return the delay beyond the shortest one [s]."""
        if at > self._since + _DELAY_WINDOW:
            self._since, self._before, self._now = at, self._now, float("inf")
        self._now = min(self._now, took)
        return took - min(self._before, self._now)
