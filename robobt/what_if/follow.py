"""Robots that follow the log, and when the game has left it."""

from __future__ import annotations

from math import cos, hypot, isfinite, sin

import numpy as np

from robobt.match.recording import Recording
from robobt.what_if.logged import LoggedMatch, playable
from robobt.world.command import RobotCommand
from robobt.world.geometry import wrap_angle
from robobt.world.rules import own_side
from robobt.world.state import Frame, RobotId, RobotState

_PULL = 6.0
"""How fast a robot gets back to its logged way [1/s]."""

_GAINED_BY_KICK = 1.0
"""Gain of speed in one tick from which a ball that leaves a robot was kicked [m/s]."""

_KICK_TICKS = 3
"""Number of ticks in which a ball that was kicked has its full speed."""

_TOUCH_SLACK = 0.3
"""A touch may come this much sooner or later than in the log [s]."""


class LogFollower:
    """Drives a robot along its logged way, with the dribbler and kicks as in the log.

    Where the log holds no commands, as a league log, a kick is inferred from the ball's speed, and the
    dribbler runs while the ball is near.

    Args:
        recording: the log.
        robot: the robot.

    Attributes:
        tick: number of the log's tick that the next frame corresponds to.
    """

    def __init__(self, recording: Recording, robot: RobotId) -> None:
        self._recording, self._robot = recording, robot
        self._slot = recording.slot(robot)
        self._side = -own_side(robot.team)
        self.tick = 0

    def __call__(self, _view: Frame, me: RobotState) -> RobotCommand:
        """Return the command for a robot in its team's view."""
        rows, last = self._recording.truth.robots, len(self._recording) - 1
        now, then = min(self.tick, last), min(self.tick + 1, last)
        here, there = rows[now, self._slot].tolist(), rows[then, self._slot].tolist()
        if not (isfinite(here[0]) and isfinite(there[0])):
            return RobotCommand()
        side = self._side
        # The way is in world coordinates; yellow sees the field turned by half a turn.
        vx = side * there[3] + _PULL * (side * here[0] - me.x)
        vy = side * there[4] + _PULL * (side * here[1] - me.y)
        turned = 0.0 if side > 0.0 else np.pi
        omega = there[5] + _PULL * wrap_angle(here[2] + turned - me.heading)
        c, s = cos(me.heading), sin(me.heading)
        command = RobotCommand(c * vx + s * vy, c * vy - s * vx, omega)
        logged = self._recording.command(self._robot, now)
        if logged is not None:
            command.dribbler, command.kick_speed = logged.dribbler, logged.kick_speed
            command.kick_angle, command.kick_trigger = logged.kick_angle, logged.kick_trigger
        else:
            self._tell_kick(command, now)
        return command

    def _tell_kick(self, command: RobotCommand, now: int) -> None:
        ball = self._recording.truth.ball
        x, y = self._recording.truth.robots[now, self._slot, :2].tolist()
        if hypot(float(ball[now, 0]) - x, float(ball[now, 1]) - y) > _REACH:
            return
        command.dribbler = True
        after = ball[now + 1 : now + 1 + _KICK_TICKS, 2:4]
        speeds = np.hypot(after[:, 0], after[:, 1])
        if len(speeds) and np.isfinite(speeds).all():
            fastest = float(speeds.max())
            if fastest > hypot(float(ball[now, 2]), float(ball[now, 3])) + _GAINED_BY_KICK:
                command.kick_speed = fastest


_REACH = 0.2
"""A robot whose centre is this near to the ball may have it [m]."""


class LogWatch:
    """Judges whether a branch still goes as the log.

    Args:
        logged: the match.
        leave: distance of the ball from its logged place from which the game has left the log [m].
    """

    def __init__(self, logged: LoggedMatch, leave: float) -> None:
        self._logged, self._leave = logged, leave
        recording = logged.recording
        self._touches = [(float(recording.times[tick]), robot) for tick, robot in recording.touches]

    def left(self, truth: Frame, tick: int) -> bool:
        """Return whether the game has left the log.

        That is where the ball is too far from its logged place, a robot has touched it that did not touch it
        about then, the logged game is stopped, or the log has ended.

        Args:
            truth: the true frame of the branch.
            tick: number of the log's tick at its time.
        """
        recording = self._logged.recording
        if tick >= len(recording) - 1 or not playable(self._logged.game(tick)):
            return True
        x, y = recording.truth.ball[tick, :2].tolist()
        if isfinite(x) and hypot(truth.ball.x - x, truth.ball.y - y) > self._leave:
            return True
        return truth.last_touch is not None and truth.last_touch not in self._touched(truth.time)

    def _touched(self, time: float) -> set[RobotId | None]:
        """Return the robots that had touched the ball last at some time close to this one."""
        robots: set[RobotId | None] = set()
        for since, robot in self._touches:
            if since > time + _TOUCH_SLACK:
                break
            if since <= time - _TOUCH_SLACK:
                robots.clear()
            robots.add(robot)
        return robots
