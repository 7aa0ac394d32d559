"""Count passes as the passing challenge of 2024 and 2025 defines them, from true frames alone.

Source: RoboCup SSL team vs. team passing challenge, 2025. A pass leads from where a robot kicks the ball to
where the ball stops or is deflected. It counts if both ends lie inside the lines and at least 1 m apart, the
robots at both ends are team-mates, and the ball never exceeds 6.5 m/s. The rules do not say whether a robot
may pass to itself; here it may not.
"""

from __future__ import annotations

from dataclasses import dataclass

from robobt.world.game import STARTED, GameState, Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import ball_out, touches
from robobt.world.state import Frame, RobotId

LEAST_LENGTH = 1.0
"""Least length of a pass [m]."""

MOST_SPEED = 6.5
"""Greatest speed of the ball in a pass [m/s]."""

_STOPPED_BELOW = 0.05
"""A ball slower than this has stopped [m/s]."""


@dataclass(slots=True)
class _PassUnderWay:
    """A ball on its way: whence, from which robot, its greatest speed, and where it stopped if it did."""

    source: Point
    shooter: RobotId
    speed: float = 0.0
    stopped: Point | None = None


class PassCounter:
    """Counts both teams' passes; frames are seen from blue's side.

    Attributes:
        passes: the valid passes of each team so far.
    """

    def __init__(self) -> None:
        self.passes = {Team.BLUE: 0, Team.YELLOW: 0}
        self._flight: _PassUnderWay | None = None
        self._held: tuple[RobotId, Point] | None = None
        self._before: Point | None = None
        self._last_touch: RobotId | None = None

    def see(self, frame: Frame, game: GameState) -> None:
        """Take in the next true frame, while the ball may be played."""
        ball = frame.ball
        if game.command not in STARTED or ball_out(frame.field, ball.position):
            self._flight = self._held = None
        else:
            self._follow(frame)
        self._before, self._last_touch = ball.position, frame.last_touch

    def _follow(self, frame: Frame) -> None:
        flight, ball = self._flight, frame.ball
        if flight is None and self._held is not None:
            shooter, source = self._held
            flight = self._flight = _PassUnderWay(source, shooter)
        if flight is not None:
            flight.speed = max(flight.speed, ball.speed)
            if flight.stopped is None and ball.speed < _STOPPED_BELOW:
                flight.stopped = ball.position
        touching = self._touching(frame)
        if touching is None:
            self._held = None
            return
        receiver, place = touching
        if flight is not None:
            self._count(frame, flight, receiver, flight.stopped or place)
        self._flight, self._held = None, (receiver, place)

    def _touching(self, frame: Frame) -> tuple[RobotId, Point] | None:
        """Return the robot that touches the ball, or that touched it since the last frame, and where."""
        ball, robots = frame.ball, frame.robots()
        there = [robot for robot, state in robots.items() if touches(state, ball)]
        if there:
            return min(there, key=lambda one: distance(robots[one].position, ball.position)), ball.position
        last = frame.last_touch
        if last is None or last == self._last_touch or last not in robots or self._before is None:
            return None
        # It met and left the robot between two frames.
        at = robots[last].position
        return last, min(self._before, ball.position, key=lambda place: distance(place, at))

    def _count(self, frame: Frame, flight: _PassUnderWay, receiver: RobotId, target: Point) -> None:
        if (
            receiver.team is flight.shooter.team
            and receiver != flight.shooter
            and distance(flight.source, target) >= LEAST_LENGTH
            and flight.speed <= MOST_SPEED
            and frame.field.contains(*flight.source)
            and frame.field.contains(*target)
        ):
            self.passes[receiver.team] += 1
