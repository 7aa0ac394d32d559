"""Rates a shot by the calibrated probability that it scores."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from robobt.skills.aim.raters.base import RATERS, Chances, best_first
from robobt.skills.aim.raters.goal_line import directions, goal_candidates, lane_clearances, normal_cdf, runs
from robobt.skills.aim.raters.openings import goal_mouth
from robobt.skills.aim.raters.shot_predictor import LearnedRater, shot_predictor
from robobt.skills.store import Shot
from robobt.world.features import SCENE_OPPONENTS, SHOT_SCENE, shot_scene
from robobt.world.geometry import FloatArray, Point, distance
from robobt.world.records import BALL, BALL_SIZE, ROBOT, ROBOT_SIZE
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState


@RATERS.register("expected_goal")
class ExpectedGoal(LearnedRater):
    """The probability of a goal for every target point, from the state of everyone at once.

    The predictor sees the positions and velocities of all robots, in one call for the whole goal line. Its
    prediction is multiplied by the chance that a kick with a small error stays between the posts; a point
    with a robot in its lane has probability 0.

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
    threshold: float = Field(0.9, ge=0, le=1, description="probability that any aim within the tolerance has")
    keep: float = Field(
        0.9, gt=0, le=1, description="the same where the maximum is below the threshold, as a share of it"
    )
    kick_error: float = Field(0.01, gt=0, le=1, description="standard deviation of the direction [rad]")
    spacing: float = Field(0.01, ge=0.001, le=1, description="between target points [m]")

    def judge(
        self,
        frame: Frame,
        origin: Point,
        me: RobotState,
        *,
        delay: float = 0.0,  # noqa: ARG002
    ) -> tuple[list[Shot], Chances | None]:
        """See :meth:`ShotRater.judge`."""
        points = goal_candidates(frame.field, self.spacing)
        chances = self.chances(frame, origin, me, points)
        if chances is None:
            return [], None
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

    def chances(self, frame: Frame, origin: Point, me: RobotState, points: FloatArray) -> FloatArray | None:
        """Compute the probability of a goal for every target point, None where no shot can enter the goal.

        Args:
            frame: the field, seen from the shooter's side.
            origin: where the ball will be kicked from [m].
            me: the robot that kicks.
            points: (T, 2) on the opponent's goal line, from right to left [m].

        Returns:
            The probabilities (T,).
        """
        mouth = goal_mouth(frame.field, origin, BALL_RADIUS)
        if mouth is None:
            return None
        aims = directions(origin, points)
        low, high = mouth
        chances = normal_cdf((high - aims) / self.kick_error) - normal_cdf((low - aims) / self.kick_error)
        ahead = [robot for robot in frame.others(me.id) if robot.x >= me.x]
        if ahead:
            centres = np.array([robot.position for robot in ahead])
            clear = lane_clearances(origin, points, centres).min(axis=1) >= ROBOT_RADIUS + BALL_RADIUS
            chances[~clear] = 0.0
            if clear.any():
                chances[clear] *= self._predicted(origin, me, points[clear], ahead)
        result: FloatArray = chances
        return result

    def _predicted(
        self, origin: Point, me: RobotState, points: FloatArray, ahead: list[RobotState]
    ) -> FloatArray:
        """Predict the probability of every target point, (T,).

        More robots than a scene holds are judged in groups. The shooter is assumed to point at each target
        already with the ball in front of it, because the predictor was fitted to scenes at the moment of the
        kick.
        """
        gap = distance(me.position, origin)
        shooter = np.full((len(points), ROBOT_SIZE), (me.x, me.y, 0.0, me.vx, me.vy, 0.0), dtype=np.float64)
        ball = np.full((len(points), BALL_SIZE), (*origin, me.vx, me.vy), dtype=np.float64)
        heading = shooter.view(ROBOT)["heading"][:, 0]
        heading[:] = directions(me.position, points)
        if gap < _HELD_BALL_DISTANCE:
            held = ball.view(BALL)[:, 0]
            held["x"], held["y"] = me.x + gap * np.cos(heading), me.y + gap * np.sin(heading)
        rows = np.array([(r.x, r.y, r.heading, r.vx, r.vy, r.omega) for r in ahead], dtype=np.float64)
        scenes = [
            shot_scene(
                shooter, ball, points, np.tile(rows[begin : begin + SCENE_OPPONENTS], (len(points), 1, 1))
            )
            for begin in range(0, len(rows), SCENE_OPPONENTS)
        ]
        answers = shot_predictor(self.model, SHOT_SCENE)(np.concatenate(scenes))
        predicted: FloatArray = answers.reshape(len(scenes), len(points)).min(axis=0)
        return predicted


_HELD_BALL_DISTANCE = 0.13
"""A ball closer to the robot's centre than this turns with the robot [m]."""

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
