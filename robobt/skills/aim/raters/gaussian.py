"""Rates a shot by the chance that a kick with a Gaussian error goes in."""

from __future__ import annotations

from math import atan, atan2, hypot

import numpy as np
from pydantic import Field

from robobt.skills.aim.raters.base import RATERS, ShotRater, best_first
from robobt.skills.aim.raters.goal_line import directions, goal_candidates, normal_cdf, runs
from robobt.skills.aim.raters.openings import Interval, goal_mouth
from robobt.skills.store import Shot
from robobt.world.geometry import FloatArray, Point
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState


@RATERS.register("gaussian")
class Gaussian(ShotRater):
    """The chance that the kick's direction is inside the goal mouth, minus the share that robots stop.

    The direction is normally distributed around the aim. A robot stops a ball aimed straight at it for
    certain; beside it the chance falls as a Gaussian of the angle, as wide as ``blocker_width`` appears from
    the ball. The integral of the product over the mouth has a closed form. The shares that robots stop are
    summed, which underrates a shot at robots standing in one line.

    Every local maximum over the aim is a shot with that chance as its score and
    half the angle over which the chance keeps 90 % of it as its tolerance.

    Source: the idea of RoboJackets' historic KickEvaluator and its constants.
    """

    kick_error: float = Field(0.04, gt=0, le=1, description="standard deviation of the direction [rad]")
    blocker_width: float = Field(0.3, gt=0, le=5, description="standard deviation of a robot's reach [m]")
    spacing: float = Field(0.02, ge=0.001, le=1, description="between the target points tried [m]")

    def rate_all(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> list[Shot]:  # noqa: ARG002
        """See :meth:`ShotRater.rate_all`."""
        mouth = goal_mouth(frame.field, origin, BALL_RADIUS)
        if mouth is None:
            return []
        points = goal_candidates(frame.field, self.spacing)
        aims, (_, y) = directions(origin, points), points.T
        chance = self.chances(aims, mouth, self._blockers(frame, origin, me))
        # Rounded, so that a plateau is one opening and aimed at in its middle.
        level = np.round(chance, 6)
        shots = []
        for first, stop in _plateaus(level):
            score = float(chance[first:stop].max())
            near = runs(level >= 0.9 * level[first])
            right, left = next((begin, end) for begin, end in near if begin <= first < end)
            spread = float(aims[left - 1] - aims[right])
            step = float(aims[-1] - aims[0]) / max(1, len(aims) - 1)
            middle = (float(y[first]) + float(y[stop - 1])) / 2.0
            shots.append(Shot((frame.field.half_length, middle), (spread + step) / 2.0, score))
        return best_first(shots, origin, me.heading)

    def chances(self, aims: FloatArray, mouth: Interval, blockers: list[tuple[float, float]]) -> FloatArray:
        """Compute the chance of a goal for every aim, (T,).

        ``aims`` (T,) and the posts, ``mouth``, are directions [rad]; ``blockers`` the direction and standard
        deviation of each robot [rad].
        """
        low, high = mouth
        error = self.kick_error
        chance = normal_cdf((high - aims) / error) - normal_cdf((low - aims) / error)
        if blockers:
            centre, width = np.array(blockers).T[:, None, :]
            aim = aims[:, None]
            variance = width * width + error * error
            # The product of two Gaussians is a Gaussian around this mean with this deviation.
            mean = (aim * (width * width) + centre * (error * error)) / variance
            deviation = error * width / np.sqrt(variance)
            peak = deviation / error * np.exp(np.square(aim - centre) / (-2.0 * variance))
            stopped = peak * (normal_cdf((high - mean) / deviation) - normal_cdf((low - mean) / deviation))
            chance -= stopped.sum(axis=1)
        return np.maximum(chance, 0.0)

    def _blockers(self, frame: Frame, origin: Point, me: RobotState) -> list[tuple[float, float]]:
        (x, y), goal_x = origin, frame.field.half_length
        gx, gy = goal_x - x, -y
        found = []
        for robot in frame.others(me.id):
            dx, dy = robot.x - x, robot.y - y
            if dx * gx + dy * gy > 0.0 and robot.x - ROBOT_RADIUS < goal_x:
                found.append((atan2(dy, dx), atan(self.blocker_width / hypot(dx, dy))))
        return found


def _plateaus(level: FloatArray) -> list[tuple[int, int]]:
    """Find runs of equal positive values above both neighbours, as (first, one past the last)."""
    edges = [0, *(np.flatnonzero(level[1:] != level[:-1]) + 1).tolist(), len(level)]
    values = [0.0, *level[edges[:-1]].tolist(), 0.0]
    return [
        (edges[i], edges[i + 1]) for i in range(len(edges) - 1) if values[i] < values[i + 1] > values[i + 2]
    ]
