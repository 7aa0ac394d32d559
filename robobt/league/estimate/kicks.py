"""Detection of kicks and kickers from the ball's detections.

No command is needed to see a kick, but the recent ones help: a weak kick counts if it was commanded,
and a ball that bounces off a robot of ours, or that it pushes, is not kicked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot

from robobt.league.estimate.robot_track import RobotMotion, SentCommands
from robobt.world.geometry import to_robot_frame
from robobt.world.rules import KICKED_SHARE, KICKED_SPEED
from robobt.world.state import BALL_RADIUS, RobotId

_COMMAND_WINDOW, _EARLY = 0.3, 0.05
"""A detected kick may follow its command by this time, or precede it by the clocks' uncertainty [s]."""

_LEAST_SPEED_GAIN = 0.5
"""Least increase of speed of a kick without a command [m/s]."""

_LEAVING_DISTANCE = 0.05
"""A kicked ball gets this far from the front [m]."""

_KICKABLE_AHEAD, _KICKABLE_ASIDE, _KICKABLE_SPREAD = 0.06, 0.07, 0.35
"""Place of a ball that can be kicked: distance from the front and beside its middle [m], and their growth."""

_UNSEEN_TIME = 0.05
"""Longest time that a kicked ball has been on its way when first seen to leave [s]."""

_PAUSE_BETWEEN_KICKS = 0.15
"""Least time between two kicks of one robot [s]."""

_SAME_INSTANT, _LONGEST_SPEED_INTERVAL = 0.004, 0.5
"""Detections closer in time are simultaneous, those farther apart give no speed [s]."""


@dataclass(slots=True)
class Kick:
    """A kick by ``robot``; ``time`` is when the ball was first seen to leave, on the vision's clock [s]."""

    robot: RobotId
    time: float


@dataclass(slots=True)
class _BallBeforeRobot:
    """The ball's position in a robot's frame, and the speed at which it left [m, m/s]."""

    ahead: float
    aside: float
    leaves: float


@dataclass(slots=True)
class _Leaving:
    """A ball that leaves a robot: since when, and how fast it has to be to count as kicked [s, m/s]."""

    since: float
    enough: float


class KickWatch:
    """Finds kicks in the detections of ball and robots.

    ``face`` is the distance from a robot's centre to its flat front [m].
    """

    def __init__(self, face: float) -> None:
        self._place = face + BALL_RADIUS
        self._time = -1e9
        self._ball = (0.0, 0.0)
        self._speeds = (0.0, 0.0)
        self._seen: dict[RobotId, _BallBeforeRobot] = {}
        self._leaving: dict[RobotId, _Leaving] = {}
        self._kicked: dict[RobotId, float] = {}

    def update(
        self,
        time: float,
        x: float,
        y: float,
        motions: Mapping[RobotId, RobotMotion],
        sent: Mapping[RobotId, SentCommands],
    ) -> Kick | None:
        """Take in where the ball was seen; return the kick that is thereby known, if any.

        It was seen at ``x``, ``y`` [m] when the vision's clock showed ``time`` [s], among robots with these
        ``motions``; ``sent`` are the commands they got, and when these took effect.
        """
        elapsed = time - self._time
        if elapsed < _SAME_INSTANT:
            return None
        (x_before, y_before), (earlier, last) = self._ball, self._speeds
        speed = hypot(x - x_before, y - y_before) / elapsed
        # A kick between two detections shows half its speed at the first of them.
        faster = speed - min(earlier, last)
        kick: Kick | None = None
        nearest = _KICKABLE_AHEAD + self._place
        for robot, m in motions.items():
            ahead, aside = to_robot_frame(x - m.x, y - m.y, m.heading)
            before = self._seen.get(robot)
            if before is None or elapsed > _LONGEST_SPEED_INTERVAL:
                self._seen[robot] = _BallBeforeRobot(ahead, aside, 0.0)
                continue
            leaves = (ahead - before.ahead) / elapsed
            enough = _enough(sent.get(robot, []), time)
            begins = (
                enough is not None and before.leaves < enough <= leaves and self._at_front(before, leaves)
            )
            if enough is not None and begins and (robot in sent or faster >= _LEAST_SPEED_GAIN):
                self._leaving[robot] = _Leaving(time, enough)
            on_its_way = self._leaving.get(robot)
            if on_its_way is not None:
                if leaves < on_its_way.enough / 2:
                    del self._leaving[robot]
                elif ahead > self._place + _LEAVING_DISTANCE:
                    del self._leaving[robot]
                    near = hypot(before.ahead, before.aside)
                    fresh = on_its_way.since - self._kicked.get(robot, -1e9) > _PAUSE_BETWEEN_KICKS
                    if fresh and (kick is None or near < nearest):
                        kick, nearest = Kick(robot, on_its_way.since), near
            self._seen[robot] = _BallBeforeRobot(ahead, aside, leaves)
        self._time, self._ball, self._speeds = time, (x, y), (last, speed)
        if kick is not None:
            self._kicked[kick.robot] = kick.time
            self._leaving.clear()
        return kick

    def _at_front(self, ball: _BallBeforeRobot, leaves: float) -> bool:
        """Return whether a ball that leaves so fast was at the front when last seen, or just before."""
        gone = ball.ahead - self._place
        within = gone <= _KICKABLE_AHEAD + leaves * _UNSEEN_TIME
        return (
            ball.ahead > 0.0
            and within
            and abs(ball.aside) <= _KICKABLE_ASIDE + _KICKABLE_SPREAD * max(0.0, gone)
        )


def _enough(sent: SentCommands, time: float) -> float | None:
    """Return the least speed of a ball just kicked [m/s]; None if the robot had no kick command."""
    if not sent:
        return KICKED_SPEED
    ends = [since for since, _ in sent[1:]] + [time]
    speeds = [
        command.kick_speed
        for (since, command), end in zip(sent, ends, strict=True)
        if since <= time + _EARLY and end >= time - _COMMAND_WINDOW
    ]
    strongest = max(speeds, default=0.0)
    return min(KICKED_SHARE * strongest, KICKED_SPEED) if strongest > 0.0 else None
