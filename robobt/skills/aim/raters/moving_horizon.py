"""Rates a shot by the angle that robots leave free, given what they can reach in time."""

from __future__ import annotations

from math import hypot

from pydantic import Field

from robobt.skills.aim.raters.base import RATERS, ShotRater
from robobt.skills.aim.raters.openings import opening_shots
from robobt.skills.store import Shot
from robobt.world.ball_model import DEFAULT_BALL, BallModel
from robobt.world.geometry import Point
from robobt.world.limits import RobotLimits
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState


@RATERS.register("moving_horizon")
class MovingHorizon(ShotRater):
    """Each robot hides the angle of the disc it can cover before the ball has passed it.

    A robot's horizon is ``travel_share`` of the ball's time to it and
    ``delay_share`` of the time until the kick, less its reaction time, between 0
    and ``longest``. The faster a robot already moves, the less reaction time is subtracted.
    The goalkeeper is treated like any other robot.

    Source: the idea and the constants of Sumatra's AngleRangeRater.
    """

    full_angle: float = Field(0.3, gt=0, le=3, description="free angle that scores 1 [rad]")
    goal_share: float = Field(0.95, gt=0, le=1, description="share of the goal's width aimed at")
    kick_speed: float = Field(6.5, gt=0, le=20, description="speed of the shot [m/s]")
    travel_share: float = Field(0.9, ge=0, le=2, description="share of the ball's travel time to use")
    delay_share: float = Field(0.1, ge=0, le=2, description="share of the time until the kick to use")
    reaction: float = Field(0.12, ge=0, le=2, description="reaction time of a robot at rest [s]")
    reacting_speed: float = Field(
        1.5, gt=0, le=20, description="speed from which a robot needs no reaction time [m/s]"
    )
    longest: float = Field(2.0, ge=0, le=10, description="longest horizon [s]")
    ball: BallModel | None = Field(
        None, description="how the ball travels; by default the frame's ball model"
    )

    def rate_all(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> list[Shot]:
        """See :meth:`ShotRater.rate_all`."""
        inset = frame.field.goal_width * (1.0 - self.goal_share) / 2.0
        ball = self.ball or frame.ball_model
        discs = [self.reach(robot, origin, delay, ball) for robot in frame.others(me.id)]
        return opening_shots(frame.field, origin, me.heading, inset, discs, self.full_angle)

    def reach(
        self, robot: RobotState, origin: Point, delay: float = 0.0, ball: BallModel = DEFAULT_BALL
    ) -> tuple[Point, float]:
        """Return centre and radius of the disc in which ``robot`` can meet a ball from ``origin`` [m]."""
        speed = hypot(robot.vx, robot.vy)
        travel = ball.time_to(hypot(robot.x - origin[0], robot.y - origin[1]), self.kick_speed)
        reaction = self.reaction * (1.0 - min(1.0, speed / self.reacting_speed))
        horizon = self.travel_share * travel + self.delay_share * delay - reaction
        body = ROBOT_RADIUS + BALL_RADIUS
        if horizon <= 0.0:
            return ((robot.x, robot.y), body)
        ahead, back = extent(speed, min(horizon, self.longest), robot.limits)
        shift = (ahead + back) / (2.0 * speed) if speed > 0.0 else 0.0
        centre = (robot.x + shift * robot.vx, robot.y + shift * robot.vy)
        return (centre, (ahead - back) / 2.0 + body)


def extent(speed: float, time: float, limits: RobotLimits) -> tuple[float, float]:
    """Compute how far a robot can be at most and at least along its motion after ``time`` [m].

    The most comes from full acceleration, the least from full braking and then full acceleration back.
    """
    acceleration = max(limits.acceleration, limits.lateral_acceleration)
    braking = max(limits.braking, limits.lateral_braking)
    ahead = _accelerate(speed, time, acceleration, max(limits.max_speed, speed))
    stop = speed / braking
    if time <= stop:
        return (ahead, speed * time - braking * time * time / 2.0)
    back = _accelerate(0.0, time - stop, acceleration, limits.max_speed)
    return (ahead, speed * stop / 2.0 - back)


def _accelerate(speed: float, time: float, acceleration: float, top: float) -> float:
    rising = min(time, (top - speed) / acceleration)
    return speed * rising + acceleration * rising * rising / 2.0 + top * (time - rising)
