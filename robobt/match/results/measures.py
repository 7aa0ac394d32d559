"""Measurements of a match, from true frames and, if the world reports them, kicks."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from math import cos, sin
from struct import pack

from robobt.match.results.results import RobotResult
from robobt.world.command import RobotCommand
from robobt.world.game import GameState, Team
from robobt.world.rules import KICKED_SHARE, KICKED_SPEED
from robobt.world.state import BallState, Frame, RobotId, RobotState


class Measures:
    """Measures a match frame by frame; frames are seen from blue's side.

    ``in_play`` counts the frames among ``ticks`` with the ball in play; ``kicked`` has the robots that kicked
    between the last two frames.
    """

    def __init__(self, robots: Mapping[RobotId, object]) -> None:
        self.robots = {robot: RobotResult() for robot in robots}
        self.kicks = 0
        self.ticks = 0
        self.in_play = 0
        self.kicked: list[RobotId] = []
        self._outgoing: dict[RobotId, float] = {}

    def update(
        self,
        truth: Frame,
        game: GameState,
        commands: Mapping[RobotId, RobotCommand],
        seen: Sequence[tuple[RobotId, float]] | None = None,
    ) -> None:
        """Take in the next true frame.

        ``commands`` are the commands at the last frame; ``seen`` are the kicks since then and their times
        [s], or None for a world where kicks are derived from states and commands.
        """
        self.ticks += 1
        self.kicked.clear()
        if game.in_play and truth.field.contains(truth.ball.x, truth.ball.y):
            self.in_play += 1
        # Robots of which nothing can be found out, mostly all of them, are passed over.
        kicking = seen is None and (
            bool(self._outgoing) or any(command.kick_speed > 0.0 for command in commands.values())
        )
        for team, robots in ((Team.BLUE, truth.own), (Team.YELLOW, truth.opponents)):
            for robot in robots:
                if not (kicking or robot.ball_contact):
                    continue
                identity = RobotId(team, robot.id)
                if robot.ball_contact:
                    figures = self.robots.get(identity)
                    if figures is not None and figures.go_to_ball is None:
                        figures.go_to_ball = truth.time
                if not kicking:
                    continue
                command = commands.get(identity)
                if command is not None and command.kick_speed > 0.0:
                    self._look_for_kick(identity, robot, truth, command.kick_speed)
                elif identity in self._outgoing:
                    del self._outgoing[identity]

        for identity, time in seen or ():
            if identity in self.robots:
                self._count_kick(identity, time)

    def _look_for_kick(self, identity: RobotId, robot: RobotState, truth: Frame, speed: float) -> None:
        """Count a kick: commanded near the ball, which now starts to leave along the heading."""
        away = _leaving(robot, truth.ball)
        before = self._outgoing.get(identity, 0.0)
        self._outgoing[identity] = away
        enough = min(KICKED_SHARE * speed, KICKED_SPEED)
        if away < enough or before >= enough or truth.last_touch not in (None, identity):
            return
        reach = 0.15 + (away + robot.speed) * truth.period
        if abs(robot.x - truth.ball.x) > reach or abs(robot.y - truth.ball.y) > reach:
            return
        self._count_kick(identity, truth.time)

    def _count_kick(self, identity: RobotId, time: float) -> None:
        figures = self.robots[identity]
        if figures.go_to_ball is None:
            figures.go_to_ball = time
        if figures.kicks == 0:
            figures.shoot = max(0.0, time - figures.go_to_ball)
        figures.kicks += 1
        self.kicks += 1
        self.kicked.append(identity)


class Trace:
    """A hash over the exact true states of a match; matches with equal traces are equal bit for bit."""

    def __init__(self) -> None:
        self._hash = hashlib.blake2b(digest_size=16)

    def update(self, truth: bytes, game: GameState) -> None:
        """Take in the next true frame, packed, and the state of the game."""
        numbers = (game.command, game.stage, game.blue_score, game.yellow_score, game.may_touch)
        self._hash.update(truth + pack("<5d", *numbers))

    def event(self, text: str) -> None:
        """Take in an event."""
        self._hash.update(text.encode())

    def hexdigest(self) -> str:
        """Return the hash so far, 32 hexadecimal digits."""
        return self._hash.hexdigest()


def _leaving(robot: RobotState, ball: BallState) -> float:
    """Return the speed of the ball along the robot's heading, relative to the robot [m/s]."""
    return (ball.vx - robot.vx) * cos(robot.heading) + (ball.vy - robot.vy) * sin(robot.heading)
