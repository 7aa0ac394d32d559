"""Starts on a field of the league: put everything in its place, and wait until it is seen there."""

from __future__ import annotations

import logging
from collections.abc import Callable
from math import hypot, inf, pi

from robobt.league.connection import LeagueError
from robobt.league.feed import Feed
from robobt.league.wire.commands import BallTeleport, Teleport
from robobt.league.wire.links import Link
from robobt.world.command import RobotCommand
from robobt.world.geometry import wrap_angle
from robobt.world.protocol import Placement
from robobt.world.state import RobotId

_log = logging.getLogger(__name__)

TIMEOUT = 4.0
"""Longest wait for the vision, or until everything is seen where it was put [s]."""

_RESEND = 0.3
"""Interval at which teleports are repeated, because packets get lost [s]."""

_PLACE_TOLERANCE, _HEADING_TOLERANCE = 0.05, 0.2
"""How close to its place everything has to be seen [m, rad]."""

_HIDDEN, _SHADOW = 0.8, 0.5
"""A ball not seen for this long after it was put this close to a robot is hidden by it [s, m]."""

_BALL_NAME = "the ball"

_UNUSED_ROBOT_DISTANCE = 0.6
"""Distance from the walls to robots that do not play, which the simulator takes off the field [m]."""

_FRAME_COLLECTION_TIME = 0.1
"""How long frames are collected before the start, so that velocities are known [s]."""


class FieldPlacer:
    """Sets up a field; the robots that ``commanded`` returns have to stand still meanwhile."""

    def __init__(
        self, feed: Feed, link: Link, commanded: Callable[[], list[RobotId]], clock: Callable[[], float]
    ) -> None:
        self._feed, self._link, self._commanded, self._clock = feed, link, commanded, clock

    def place(self, placement: Placement) -> None:
        """Put everything in its place, where the field allows it, and wait until it is seen there.

        Robots without a pose are taken off the field. Where nothing may be placed, it only
        waits until every robot that is commanded is seen.

        Raises:
            LeagueError: nothing is received, or something is not seen where it was put.
        """
        self._await_vision()
        if self._feed.connection.geometry == "seen":
            self._await_field()
        if self._feed.connection.places:
            self._put(placement)
        else:
            self._await_robots()
        end = self._clock() + _FRAME_COLLECTION_TIME / self._feed.rate
        while self._clock() < end:
            self._feed.receive(end - self._clock())

    def place_ball(self, x: float, y: float, vx: float = 0.0, vy: float = 0.0) -> BallTeleport:
        """Return the teleport of the ball to world coordinates [m, m/s]."""
        sign = self._feed.sign()
        return BallTeleport(sign * x, sign * y, sign * vx, sign * vy, rolls=bool(vx or vy))

    def _await_vision(self) -> None:
        end = self._clock() + TIMEOUT
        while not self._feed.filter.robots() and self._feed.filter.ball_unseen() == inf:
            if self._clock() > end:
                raise LeagueError(self._feed.no_frames(TIMEOUT))
            self._feed.receive(0.05)

    def _await_field(self) -> None:
        end = self._clock() + TIMEOUT
        while self._feed.known.field is None and self._clock() < end:
            self._feed.receive(0.05)

    def _await_robots(self) -> None:
        """Wait, as long as it takes, until people have brought the robots; they stand still meanwhile."""
        told, patience = False, self._clock() + _FRAME_COLLECTION_TIME * 10
        while missing := [
            str(robot) for robot in self._commanded() if robot not in self._feed.filter.robots()
        ]:
            if not told and self._clock() > patience:
                _log.warning("waiting until these robots are seen on the field: %s", ", ".join(missing))
                told = True
            self._link.send({robot: RobotCommand() for robot in self._commanded()}, self._feed.now())
            self._feed.receive(0.05)

    def _put(self, placement: Placement) -> None:
        sign = self._feed.sign()
        turn = 0.0 if sign > 0.0 else pi
        robots = [
            Teleport(robot, sign * x, sign * y, wrap_angle(heading + turn), present=True)
            for robot, (x, y, heading) in placement.robots.items()
        ]
        x, y, vx, vy = placement.ball
        self._until_seen(placement, robots, self.place_ball(x, y))
        if vx or vy:
            self._link.place([], self.place_ball(x, y, vx, vy))

    def _until_seen(self, placement: Placement, robots: list[Teleport], ball: BallTeleport) -> None:
        feed = self._feed
        began = self._clock()
        sent_at = -1e9
        while True:
            now = self._clock()
            strangers = [robot for robot in feed.filter.robots() if robot not in placement.robots]
            misplaced = self._misplaced(placement)
            if not misplaced and not strangers:
                return
            waited = now > began + _HIDDEN / self._feed.rate
            if misplaced == [_BALL_NAME] and not strangers and waited and self._ball_hidden(placement):
                feed.filter.put_ball(*placement.ball[:2])
                return
            if now > began + TIMEOUT:
                what = ", ".join(misplaced or map(str, strangers))
                raise LeagueError(
                    f"not seen where put within {TIMEOUT:g} s: {what}; "
                    "check that the simulator has these robots and accepts teleports"
                )
            if now > sent_at + _RESEND / self._feed.rate:
                sent_at = now
                self._link.place([*robots, *self._off_field(strangers)], ball)
            self._link.send({robot: RobotCommand() for robot in self._commanded()}, feed.now())
            feed.receive(0.01)
            feed.receive(0.0)

    def _off_field(self, robots: list[RobotId]) -> list[Teleport]:
        field = self._feed.filter.field
        y = field.half_width + field.margin + _UNUSED_ROBOT_DISTANCE
        return [
            Teleport(robot, -field.half_length + 0.3 * i, y, 0.0, present=False)
            for i, robot in enumerate(robots)
        ]

    def _misplaced(self, placement: Placement) -> list[str]:
        """Return the names of what is not seen in its place."""
        captured = self._feed.filter.captured
        if captured is None:
            return ["everything"]
        frame = self._feed.filter.frame_at(captured)
        seen = frame.robots()
        misplaced = []
        for robot, (x, y, heading) in placement.robots.items():
            state = seen.get(robot)
            if state is None or (
                max(abs(state.x - x), abs(state.y - y)) > _PLACE_TOLERANCE
                or abs(wrap_angle(state.heading - heading)) > _HEADING_TOLERANCE
            ):
                misplaced.append(str(robot))
        off = max(abs(frame.ball.x - placement.ball[0]), abs(frame.ball.y - placement.ball[1]))
        if self._feed.filter.ball_unseen() == inf or off > _PLACE_TOLERANCE:
            misplaced.append(_BALL_NAME)
        return misplaced

    def _ball_hidden(self, placement: Placement) -> bool:
        """Return whether a robot may hide a ball that has not been seen since it was put."""
        if self._feed.filter.ball_unseen() < _HIDDEN / 2:
            return False
        x, y = placement.ball[:2]
        return any(hypot(pose[0] - x, pose[1] - y) < _SHADOW for pose in placement.robots.values())
