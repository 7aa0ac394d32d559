"""The paper's rater with a learned filter: a network removes some of the clear target points."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from robobt.skills.aim.goalkeeper_watch import GoalkeeperWatch
from robobt.skills.aim.raters.base import RATERS, Chances
from robobt.skills.aim.raters.goal_line import goal_candidates, lane_clearances, obstacles, shots_at_groups
from robobt.skills.aim.raters.shot_predictor import LearnedRater, shot_predictor
from robobt.skills.store import Shot
from robobt.world.features import SHOT, shot_features
from robobt.world.geometry import FloatArray, Point
from robobt.world.state import Frame, RobotState


@RATERS.register("nn_filtered")
class NNFiltered(LearnedRater):
    """A clear target point is good if the predictor gives the shot a chance past each robot on its own.

    As :class:`~robobt.skills.aim.raters.SegmentClearance`, but robots behind the ball are
    left out, and a point counts only when for every robot the predicted chance is at
    least ``threshold``; robots behind the shooter are left out. All points and robots go through the network
    in one call.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    AttackNN, with its tolerance and threshold.
    """

    observation = SHOT

    model: str = Field(
        "shot_nn",
        validate_default=True,
        description="predictor of the features of Eq. 4: a shipped model or a file",
    )
    threshold: float = Field(0.5, ge=0, le=1, description="least predicted chance past every robot")
    tolerance: float = Field(
        0.3645, ge=0, le=5, description="a robot closer to the lane than this blocks it [m]"
    )
    spacing: float = Field(0.01, ge=0.001, le=1, description="between target points [m]")

    def judge(
        self,
        frame: Frame,
        origin: Point,
        me: RobotState,
        *,
        delay: float = 0.0,  # noqa: ARG002
        watch: GoalkeeperWatch | None = None,  # noqa: ARG002
    ) -> tuple[list[Shot], Chances | None]:
        """See :meth:`LearnedRater.judge`; a point that is not clear has no chance."""
        if origin[0] >= frame.field.half_length:
            return [], None
        points = goal_candidates(frame.field, self.spacing)
        good = np.all(lane_clearances(origin, points, obstacles(frame, me)) > self.tolerance, axis=1)
        chances = np.zeros(len(points))
        if good.any():
            chances[good] = self.chances(frame, me, points[good])
            good &= chances >= self.threshold
        return shots_at_groups(points, good, self.spacing, origin, me.heading), (points, chances)

    def chances(self, frame: Frame, me: RobotState, points: FloatArray) -> FloatArray:
        """Compute the lowest chance past any robot for each of (T, 2) target points, (T,).

        It is 1 where nobody is ahead of the shooter, ``me``. ``frame`` is seen from the shooter's side, and
        ``points`` are on the opponent's goal line [m].
        """
        others = obstacles(frame, me)
        ahead = others[others[:, 0] >= me.x]
        if not len(ahead):
            return np.ones(len(points))
        features = shot_features(np.array(me.position, dtype=np.float64), points, ahead)
        answers = shot_predictor(self.model, SHOT)(features.reshape(-1, SHOT.size))
        chances: FloatArray = answers.reshape(len(points), len(ahead)).min(axis=1)
        return chances
