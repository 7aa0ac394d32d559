"""The paper's rater: target points whose lane no robot comes near."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from robobt.skills.aim.raters.base import RATERS, ShotRater
from robobt.skills.aim.raters.goal_line import goal_candidates, lane_clearances, obstacles, shots_at_groups
from robobt.skills.store import Shot
from robobt.world.geometry import Point
from robobt.world.state import Frame, RobotState


@RATERS.register("segment_clearance")
class SegmentClearance(ShotRater):
    """A target point is clear when every robot keeps ``tolerance`` from the lane to it.

    The lane is the segment from the ball to the point, its ends included, so a
    robot that stands close behind the ball blocks every shot, as in the paper.

    Neighbouring clear points form a group; each group is a shot at its middle,
    the largest the best. The score is the group's share of all target points, the
    shot's tolerance half the angle the group spans.

    Robots count as standing still, and the kick's error is ignored.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    shot selection. The paper's tolerances in metres: 0.1965 in the original
    behaviour, 0.243, 0.3645 and 0.486 while its data was collected.
    """

    tolerance: float = Field(
        0.1965, ge=0, le=5, description="a robot closer to the lane than this blocks it [m]"
    )
    spacing: float = Field(0.01, ge=0.001, le=1, description="between target points [m]")

    def rate_all(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> list[Shot]:  # noqa: ARG002
        """See :meth:`ShotRater.rate_all`."""
        if origin[0] >= frame.field.half_length:
            return []
        points = goal_candidates(frame.field, self.spacing)
        distances = lane_clearances(origin, points, obstacles(frame, me), behind=True)
        clear: NDArray[np.bool_] = np.all(distances > self.tolerance, axis=1)
        return shots_at_groups(points, clear, self.spacing, origin, me.heading)
