"""Rates a shot by the calibrated probability that it scores."""

from __future__ import annotations

from typing import Self

import numpy as np
from pydantic import Field, model_validator

from robobt.config.errors import FieldError, unknown_name
from robobt.models.find import read_fitting_model
from robobt.skills.aim.goalkeeper_watch import GoalkeeperWatch
from robobt.skills.aim.raters.base import RATERS, Chances, best_first
from robobt.skills.aim.raters.goal_line import directions, goal_candidates, lane_clearances, normal_cdf, runs
from robobt.skills.aim.raters.openings import goal_mouth
from robobt.skills.aim.raters.scene_chances import chances_by_kind, kind_weights
from robobt.skills.aim.raters.shot_predictor import LearnedRater
from robobt.skills.store import Shot
from robobt.world.features import SHOT_SCENE
from robobt.world.geometry import FloatArray, Point
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState


@RATERS.register("expected_goal")
class ExpectedGoal(LearnedRater):
    """The probability of a goal for every target point, from the state of everyone at once.

    The predictor sees the positions and velocities of all robots, in one call for the whole goal line. Its
    prediction is multiplied by the chance that a kick with a small error stays between the posts; a point
    with a robot in its lane has probability 0.

    How good the opponents' goalkeeper is, a skill's rater learns from the match so far
    (:mod:`~robobt.skills.aim.goalkeeper_watch`): the predictions past each kind that the predictor knows are
    averaged, each as likely as that kind is.

    Every local maximum along the goal line is a shot with that probability as its
    score; any aim within its tolerance has at least the probability ``threshold``, or ``keep`` times the
    maximum if the maximum is below the threshold. Robots behind the shooter are ignored; team-mates ahead of
    it block as opponents do.
    """

    observation = SHOT_SCENE

    model: str = Field(
        "shot_expected",
        validate_default=True,
        description="predictor of a shot's scene: a shipped model or a file",
    )
    goalkeeper: str = Field(
        "", description="kind of goalkeeper, by the name of the model's output; empty: as the match tells"
    )
    threshold: float = Field(0.9, ge=0, le=1, description="probability that any aim within the tolerance has")
    keep: float = Field(
        0.9, gt=0, le=1, description="the same where the maximum is below the threshold, as a share of it"
    )
    kick_error: float = Field(0.01, gt=0, le=1, description="standard deviation of the direction [rad]")
    spacing: float = Field(0.01, ge=0.001, le=1, description="between target points [m]")

    @model_validator(mode="after")
    def _known_goalkeeper(self) -> Self:
        if self.goalkeeper:
            outputs = read_fitting_model(self.model, kind="shot_predictor").card.outputs
            names = [output.name for output in outputs]
            if self.goalkeeper not in names:
                there = unknown_name(self.goalkeeper, names)
                raise FieldError("goalkeeper", f"{self.model} knows no {self.goalkeeper!r}; {there}")
        return self

    def judge(
        self,
        frame: Frame,
        origin: Point,
        me: RobotState,
        *,
        delay: float = 0.0,  # noqa: ARG002
        watch: GoalkeeperWatch | None = None,
    ) -> tuple[list[Shot], Chances | None]:
        """See :meth:`LearnedRater.judge`."""
        points = goal_candidates(frame.field, self.spacing)
        chances = self.chances(frame, origin, me, points, watch)
        if chances is None:
            return [], None
        if not chances.any():
            return [], (points, chances)
        aims, (_, y) = directions(origin, points), points.T
        half_step = float(aims[-1] - aims[0]) / max(1, len(aims) - 1) / 2.0
        shots = []
        openings = _openings(np.round(chances, 4), self.threshold, self.keep)
        for score, (right, left), (first, stop) in openings:
            middle = (float(y[first]) + float(y[stop - 1])) / 2.0
            aim = (float(aims[first]) + float(aims[stop - 1])) / 2.0
            # Measured to the nearer end, so that an aim off by the tolerance is still good on either side.
            near = min(float(aims[left - 1]) - aim, aim - float(aims[right]))
            shots.append(Shot((frame.field.half_length, middle), near + half_step, score))
        return best_first(shots, origin, me.heading), (points, chances)

    def chances(
        self,
        frame: Frame,
        origin: Point,
        me: RobotState,
        points: FloatArray,
        watch: GoalkeeperWatch | None = None,
    ) -> FloatArray | None:
        """Compute the probability of a goal for every target point, None where no shot can enter the goal.

        Args:
            frame: the field, seen from the shooter's side.
            origin: where the ball will be kicked from [m].
            me: the robot that kicks.
            points: (T, 2) on the opponent's goal line, from right to left [m].
            watch: what the match so far says about the goalkeeper; None knows nothing.

        Returns:
            The probabilities (T,).
        """
        mouth = goal_mouth(frame.field, origin, BALL_RADIUS)
        if mouth is None:
            return None
        ahead = [robot for robot in frame.others(me.id) if robot.x >= me.x]
        clear = np.ones(len(points), dtype=np.bool_)
        if ahead:
            centres = np.array([robot.position for robot in ahead])
            clear = lane_clearances(origin, points, centres).min(axis=1) >= ROBOT_RADIUS + BALL_RADIUS
            if not clear.any():
                return np.zeros(len(points))
        aims = directions(origin, points)
        low, high = mouth
        chances: FloatArray = normal_cdf((high - aims) / self.kick_error)
        chances -= normal_cdf((low - aims) / self.kick_error)
        if ahead:
            chances[~clear] = 0.0
            predicted = chances_by_kind(self.model, origin, me, points[clear], ahead)
            chances[clear] *= predicted @ kind_weights(self.model, self.goalkeeper, watch)
        return chances


_SAME = 0.02
"""Probabilities that differ by less than this count as one maximum."""


Run = tuple[int, int]
"""Neighbouring target points as (first, one past the last)."""


def _openings(level: FloatArray, threshold: float, keep: float) -> list[tuple[float, Run, Run]]:
    """Score, region and maximum of each opening along the goal line, the best first.

    A region is the unbroken stretch around a maximum that reaches ``threshold``, or ``keep`` times the
    maximum if the maximum is below the threshold.
    """
    left = level.copy()
    found: list[tuple[float, Run, Run]] = []
    while len(left) and (score := float(left.max())) > 0.0:
        top = int(left.argmax())
        least = threshold if score >= threshold else keep * score
        region = _around(level, top, min(least, score))
        best = _around(level, top, max(least, score - _SAME))
        begin, end = region
        lone = (begin == 0 or level[begin - 1] <= score) and (end == len(level) or level[end] <= score)
        if lone and not (found and _overlap(region, found)):
            found.append((score, region, best))
        # The slopes on either side lead up to this maximum and have none of their own.
        while begin > 0 and level[begin - 1] <= level[begin]:
            begin -= 1
        while end < len(level) and level[end] <= level[end - 1]:
            end += 1
        left[begin:end] = 0.0
    return found


def _around(level: FloatArray, top: int, least: float) -> Run:
    return next((first, stop) for first, stop in runs(level >= least) if first <= top < stop)


def _overlap(region: Run, found: list[tuple[float, Run, Run]]) -> bool:
    begin, end = region
    return any(begin < stop and first < end for _, (first, stop), _ in found)
