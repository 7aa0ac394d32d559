"""Lead the opponent's goalkeeper from one side of its goal to the other."""

from __future__ import annotations

from dataclasses import field
from math import inf

from robobt.motion.dribbling import dribbling_limits, turn_to
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.geometry import direction, wrap_angle
from robobt.world.rules import has_ball
from robobt.world.state import BALL_RADIUS


@skill
class DrawGoalkeeper(Skill):
    """Turn with the ball from one post to the other and back, standing still.

    A goalkeeper covers the line along which the robot with the ball points. The robot turns faster than the
    goalkeeper drives, so the goalkeeper is left behind while the robot swings to the other post, and a shot
    rater then sees an opening. The swing starts towards the post nearer to the robot's heading and reverses
    once the robot has pointed at a post for ``hold``. FAILURE without the ball, and once ``patience`` has run
    out; an interruption of less than a second does not reset it.

    Args:
        patience: longest time to spend [s]; None for no limit.
        hold: how long to point at a post, for the goalkeeper to come [s].
        max_turn: turning rate with the ball [rad/s].
        inset: how far inside the post it points [m].
    """

    patience: float | None = None
    hold: float = 0.3
    max_turn: float = 4.0
    inset: float = 0.05
    _side: float = field(default=0.0, init=False)
    _there_since: float = field(default=inf, init=False)
    _began: float = field(default=-inf, init=False)
    _last: float = field(default=-inf, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._limits = dribbling_limits(2.0, self.max_turn)

    def on_start(self) -> None:
        """Restart the wait at a post."""
        self._there_since = inf

    def on_running(self) -> Status:
        """Swing for one tick."""
        frame, me, ball = self.frame, self.me, self.ball
        if not has_ball(me, ball):
            return self.fail("it does not have the ball")
        if not 0.0 <= frame.time - self._last < _RESTART_PAUSE:
            self._began = frame.time
            self._side = min((1.0, -1.0), key=lambda side: abs(wrap_angle(self._aim(side) - me.heading)))
        self._last = frame.time
        if self.patience is not None and frame.time - self._began > self.patience:
            return self.fail("its patience is at an end")
        error = wrap_angle(self._aim(self._side) - me.heading)
        if abs(error) > _POINTS_AT:
            self._there_since = inf
        elif self._there_since == inf:
            self._there_since = frame.time
        elif frame.time - self._there_since >= self.hold - 1e-9:
            self._side = -self._side
            self._there_since = inf
        self.store.command = turn_to(me, ball, self._aim(self._side), self._limits, frame.period)
        return self.run("to the left post" if self._side > 0.0 else "to the right post")

    def _aim(self, side: float) -> float:
        field = self.frame.field
        y = side * max(0.0, field.goal_width / 2.0 - BALL_RADIUS - self.inset)
        return direction(self.me.position, (field.half_length, y))


_RESTART_PAUSE = 1.0
"""An interruption longer than this resets the skill [s]."""

_POINTS_AT = 0.06
"""Angle to the post's direction within which the robot points at the post [rad]."""
