"""Touches of the ball: present, last, and the distance carried."""

from __future__ import annotations

from robobt.world.game import Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import keeps_ball, touches
from robobt.world.state import BallState, Frame, RobotId, RobotState

_TOUCH_BOX = 0.2
"""A robot farther from the ball in x or y neither touches nor keeps it [m]."""


class Touches:
    """Tracks touches of the ball from frame to frame; frames are seen from blue's side.

    Attributes:
        now: the robots that touch the ball in this frame.
        last: the robot that touched the ball last, from the world's report or else from contact.
        where: the ball's position at the last touch [m].
        times: time of each team's last touch [s].
        highest: greatest height of the ball since each team's last touch, in this phase of the game [m].
        carrier: the robot that keeps the ball at its hull, or None.
        carry_start: where the carrier got the ball [m].
        carried: straight-line distance that the carrier has taken the ball from there [m].
    """

    def __init__(self) -> None:
        self.now: list[RobotId] = []
        self.last: RobotId | None = None
        self.where: Point = (0.0, 0.0)
        self.times: dict[Team, float] = {}
        self.highest: dict[Team, float] = dict.fromkeys(Team, 0.0)
        self.carrier: RobotId | None = None
        self.carried = 0.0
        self.carry_start: Point = (0.0, 0.0)

    def watch(self, frame: Frame) -> None:
        """Take in the next frame."""
        ball = frame.ball
        at_ball = _at_ball(frame)
        touching = [identity for identity, robot in at_ball if touches(robot, ball)]
        carrier = next((robot for identity, robot in at_ball if identity == self.carrier), None)
        self.now = touching
        toucher = frame.last_touch
        if toucher is None and touching and self.last not in touching:
            toucher = touching[0]
        if touching or (toucher is not None and toucher != self.last):
            self.where = ball.position
        if toucher is not None:
            if toucher != self.last:
                self.times[toucher.team] = frame.time
                self.highest[toucher.team] = 0.0
            self.last = toucher
        for one in touching:
            self.times[one.team] = frame.time
            self.highest[one.team] = 0.0
        if ball.z > 0.0:
            self.highest = {team: max(height, ball.z) for team, height in self.highest.items()}
        self._follow_carrier(ball, carrier)

    def forget_heights(self) -> None:
        """Reset the ball's greatest height, because another phase of the game begins."""
        self.highest = dict.fromkeys(Team, 0.0)

    def carry_anew(self, place: Point) -> None:
        """Measure the carrier's distance from here [m]."""
        self.carry_start, self.carried = place, 0.0

    def _follow_carrier(self, ball: BallState, carrier: RobotState | None) -> None:
        if carrier is not None and self.last == self.carrier and keeps_ball(carrier, ball):
            self.carried = distance(self.carry_start, ball.position)
            return
        self.carrier = self.last if self.last in self.now else None
        self.carry_start = ball.position
        self.carried = 0.0


def _at_ball(frame: Frame) -> list[tuple[RobotId, RobotState]]:
    """Return the robots that may touch the ball or keep it; looked for once a frame."""
    found: list[tuple[RobotId, RobotState]] | None = frame.made.get("at ball")
    if found is None:
        x, y = frame.ball.x, frame.ball.y
        found = frame.made["at ball"] = [
            (RobotId(team, robot.id), robot)
            for team, robots in ((frame.team, frame.own), (frame.team.other, frame.opponents))
            for robot in robots
            if -_TOUCH_BOX < robot.x - x < _TOUCH_BOX and -_TOUCH_BOX < robot.y - y < _TOUCH_BOX
        ]
    return found
