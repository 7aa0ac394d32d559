"""Who touches the ball, who touched it last and who has carried it how far."""

from __future__ import annotations

from robobt.world.game import Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import keeps_ball, touches
from robobt.world.state import BallState, Frame, RobotId, RobotState


class Touches:
    """Follows the ball from frame to frame; frames are seen from blue's side.

    Attributes:
        now: robots that touch the ball in this frame.
        last: who touched it last, as the world reports it, or else by the contact seen.
        where: where the ball was when it was last touched [m].
        times: when each team touched it last [s].
        highest: how high the ball has been since each team touched it last, in this phase of the game [m].
        carrier: who keeps the ball at its hull, None when nobody does.
        carry_start: where the carrier got it [m].
        carried: how far the carrier has taken it from there, as the crow flies [m].
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
        x, y = ball.x, ball.y
        touching = []
        carrier: RobotState | None = None
        for team, robots in ((frame.team, frame.own), (frame.team.other, frame.opponents)):
            for robot in robots:
                if -0.2 < robot.x - x < 0.2 and -0.2 < robot.y - y < 0.2:
                    identity = RobotId(team, robot.id)
                    if touches(robot, ball):
                        touching.append(identity)
                    if identity == self.carrier:
                        carrier = robot
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
        """Count from here how high the ball gets: another phase of the game begins."""
        self.highest = dict.fromkeys(Team, 0.0)

    def carry_anew(self, place: Point) -> None:
        """Count the carrier's way from here [m]."""
        self.carry_start, self.carried = place, 0.0

    def _follow_carrier(self, ball: BallState, carrier: RobotState | None) -> None:
        if carrier is not None and self.last == self.carrier and keeps_ball(carrier, ball):
            self.carried = distance(self.carry_start, ball.position)
            return
        self.carrier = self.last if self.last in self.now else None
        self.carry_start = ball.position
        self.carried = 0.0
