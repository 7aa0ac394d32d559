"""A person drives a robot: from a page's commands to the robot's, and to a stop where they no longer come."""

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

_SLACK = 0.02
"""What a tick may be late [s]."""

HELD_UP = 0.1
"""A command that took so much longer on its way than others did is as old [s]."""

_WINDOW = 30.0
"""How long the shortest way is remembered, for clocks drift apart [s]."""

_MEANT = radians(35.0)
"""A mate further off the heading is not who a pass is meant for."""

_SURE = radians(2.5)
"""How far off a pass may be."""

_TURN, _GAIN = 3.0, 10.0
"""How fast an assisted robot turns with the ball [rad/s], and that by the angle that is left [1/s]."""

_ARRIVAL = 2.5
"""How fast an assisted pass arrives [m/s]."""

Frames = Literal["field", "robot"]


class HandDriver:
    """Drives one robot as its page says: called at every tick, it returns the command.

    Args:
        clock: the time by which commands are as old as they are [s].
        period: from one tick to the next [s].

    Attributes:
        deadline: a command that is older than this counts no more [s].
    """

    def __init__(self, clock: Callable[[], float], period: float) -> None:
        self._clock = clock
        # The last tick that still follows a command lasts for a period.
        self.deadline = STOPS_IN - period - _SLACK
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
        """Take a command; False for one that was held up on its way.

        Args:
            sent: when the page sent it, by the page's own clock [s].
            arrived: when it came, by ours [s].
            velocity: as a share of the robot's top speed, in the field's frame as the page shows it (blue
                defends -x) or the robot's own.
            omega: as a share of its top turning rate.
            frame: which of them.
            dribbler: whether the dribbler turns.
            kick: speed of a kick [m/s], 0 for none.
            assist: whether a kick is turned into a pass to the mate whom the robot about looks at.
        """
        if self._way.excess(arrived, arrived - sent) > HELD_UP:
            return False
        self._wanted = (*velocity, omega, frame, dribbler, kick, assist)
        self._at = arrived
        return True

    @property
    def told(self) -> bool:
        """Whether a command holds now."""
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
    """Return the command that turns to the mate who is meant and passes to it; None where nobody is."""
    mates = [mate for mate in view.own if mate.id != me.id]
    offs = [(wrap_angle(direction(me.position, mate.position) - me.heading), mate) for mate in mates]
    off, meant = min(offs, key=lambda each: abs(each[0]), default=(pi, me))
    if abs(off) > _MEANT:
        return None
    turn = min(_TURN, max(-_TURN, _GAIN * off))
    if abs(off) > _SURE:
        return RobotCommand(omega=turn, dribbler=True)
    speed = view.ball_model.kick_speed(distance(me.position, meant.position), _ARRIVAL)
    return RobotCommand(omega=turn, kick_speed=min(most, speed), dribbler=True)


class _ShortestWay:
    """The shortest time that anything took on its way lately, the clocks' difference included."""

    def __init__(self) -> None:
        self._since = float("-inf")
        self._before = self._now = float("inf")

    def excess(self, at: float, took: float) -> float:
        """Return by how much this took longer [s]."""
        if at > self._since + _WINDOW:
            self._since, self._before, self._now = at, self._now, float("inf")
        self._now = min(self._now, took)
        return took - min(self._before, self._now)
