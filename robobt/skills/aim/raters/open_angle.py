"""Rates a shot by the free angle between robots that stand still."""

from __future__ import annotations

from math import radians

from pydantic import Field

from robobt.skills.aim.raters.base import RATERS, ShotRater
from robobt.skills.aim.raters.openings import opening_shots
from robobt.skills.store import Shot
from robobt.world.geometry import Point
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState


@RATERS.register("open_angle")
class OpenAngle(ShotRater):
    """Each robot hides an angle of the goal; each angle left is a shot along its middle.

    Source: the idea of Thunderbots' best-shot evaluation, which shoots from 6
    degrees on and thinks 10 ideal. It ignores the ball's radius (``clearance`` 0);
    here the whole ball fits through an opening.
    """

    full_angle: float = Field(radians(10.0), gt=0, le=3, description="free angle that scores 1 [rad]")
    clearance: float = Field(
        BALL_RADIUS, ge=0, le=1, description="added to every robot and taken off at either post [m]"
    )

    def rate_all(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> list[Shot]:  # noqa: ARG002
        """See :meth:`ShotRater.rate_all`."""
        radius = ROBOT_RADIUS + self.clearance
        discs = [(robot.position, radius) for robot in frame.others(me.id)]
        return opening_shots(frame.field, origin, me.heading, self.clearance, discs, self.full_angle)
