"""Judges passes: to whom, where to, how fast."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, hypot, inf
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field

from robobt.config.validation import Settings
from robobt.skills.aim.raters import OpenAngle, ShotRater, make_rater
from robobt.skills.aim.raters.base import BY_NAME
from robobt.skills.aim.raters.goal_line import lane_clearances, obstacles
from robobt.skills.store import Pass
from robobt.world.ball_model import BallModel
from robobt.world.geometry import Point, distance
from robobt.world.rules import in_own_defense_area, in_their_defense_area
from robobt.world.state import ROBOT_RADIUS, TOUCH_DISTANCE, Frame, RobotState

_LANE_SHARES = (0.2, 0.4, 0.6, 0.8, 1.0)


class PassRater(Settings):
    """Rates a straight pass to every team-mate.

    The pass goes to the point where the team-mate would come to rest if it braked now. A team-mate is left
    out if that point is too near, outside the field or in a defence area, or if any robot stands in the lane.
    Every other pass scores

        safety * (shot_weight * shot + (1 - shot_weight) * progress)

    * safety: a sigmoid of the least head start the ball has over any opponent at
      any point of the lane;
    * shot: the score of the receiver's own shot from there, when it gets the ball; * progress: the distance
      gained towards the goal line: 0 for half a field lost, 0.5 for none, 1 for half a field gained.

    Sources: RoboBulls' published code (bestPassPoint) for the lane; the ideas of
    Thunderbots' pass cost (product of soft terms, receive speed) and Sumatra's
    interception rating.
    """

    shot_rater: Annotated[ShotRater, BY_NAME, AfterValidator(make_rater)] = Field(
        OpenAngle(), description="judges the receiver's shot"
    )
    shot_weight: float = Field(0.6, ge=0, le=1, description="weight of the receiver's shot against progress")
    receive_speed: float = Field(2.0, gt=0, le=6.5, description="ball speed at the receiver [m/s]")
    max_speed: float = Field(6.0, gt=0, le=20, description="fastest kick [m/s]")
    min_distance: float = Field(1.0, ge=0, le=50, description="shortest pass [m]")
    lane_clearance: float = Field(
        0.2415, ge=0, le=5, description="a robot closer to the lane than this blocks it [m]"
    )
    reaction: float = Field(
        0.12, ge=0, le=2, description="reaction time before an opponent moves to intercept [s]"
    )
    margin_scale: float = Field(0.4, gt=0, le=10, description="head start that gives a safety of 0.73 [s]")
    receiver: int | None = Field(
        None, ge=0, le=31, description="number of the only robot to pass to; by default any"
    )
    ball: BallModel | None = Field(
        None, description="how the ball travels; by default the frame's ball model"
    )

    def rate_all(self, frame: Frame, me: RobotState) -> list[Pass]:
        """Return every possible pass of ``me`` from where the ball lies, the best first."""
        origin = frame.ball.position
        receivers = self._receivers(frame, me)
        if not receivers:
            return []
        ball = self.ball or frame.ball_model
        lengths = [distance(origin, target) for _, target in receivers]
        speeds = [min(self.max_speed, ball.kick_speed(length, self.receive_speed)) for length in lengths]
        starts = self.head_starts(frame, [target for _, target in receivers], speeds)
        passes = []
        for (mate, target), length, speed, start in zip(receivers, lengths, speeds, starts, strict=True):
            travel = ball.time_to(length, speed)
            if travel == inf:
                continue
            shot = self.shot_rater.rate(frame, target, mate, delay=travel)
            progress = 0.5 + (target[0] - origin[0]) / frame.field.length
            worth = self.shot_weight * (shot.score if shot is not None else 0.0)
            worth += (1.0 - self.shot_weight) * min(1.0, max(0.0, progress))
            passes.append(Pass(mate.id, target, speed, worth * _sigmoid(start / self.margin_scale)))
        return sorted(passes, key=lambda rated: (-rated.score, rated.receiver))

    def head_starts(self, frame: Frame, targets: Sequence[Point], speeds: Sequence[float]) -> list[float]:
        """Compute the least time by which the ball of each pass, kicked at its speed, beats any opponent [s].

        The time is compared at five points of the lane and is negative where an opponent could arrive first.
        An opponent keeps its velocity for its reaction time, then accelerates straight to the point and may
        pass it at any speed.
        """
        if not frame.opponents:
            return [inf] * len(targets)
        (x, y), ball = frame.ball.position, self.ball or frame.ball_model
        lanes = []
        for (target_x, target_y), speed in zip(targets, speeds, strict=True):
            dx, dy = target_x - x, target_y - y
            length = hypot(dx, dy)
            lanes.append(
                [
                    (x + share * dx, y + share * dy, ball.time_to(share * length, speed))
                    for share in _LANE_SHARES
                ]
            )
        px, py, arrival = np.array(lanes).transpose(2, 0, 1)[..., None]
        robot_x, robot_y, vx, vy, acceleration, top = np.array(
            [self._opponent(robot) for robot in frame.opponents]
        ).T
        dx, dy = px - robot_x, py - robot_y
        gap = np.sqrt(dx * dx + dy * dy)
        towards = (dx * vx + dy * vy) / np.maximum(gap, 1e-9)
        gap = np.maximum(gap - TOUCH_DISTANCE, 0.0)
        needed = (np.sqrt(towards * towards + 2.0 * acceleration * gap) - towards) / acceleration
        ahead = np.maximum(needed, gap / top) - arrival
        return [start + self.reaction for start in ahead.min(axis=(1, 2)).tolist()]

    def _opponent(self, robot: RobotState) -> tuple[float, ...]:
        limits = robot.limits
        return (
            robot.x + robot.vx * self.reaction,
            robot.y + robot.vy * self.reaction,
            robot.vx,
            robot.vy,
            max(limits.acceleration, limits.lateral_acceleration),
            limits.max_speed,
        )

    def _receivers(self, frame: Frame, me: RobotState) -> list[tuple[RobotState, Point]]:
        origin = frame.ball.position
        mates = frame.teammates(me.id)
        targets = [resting_point(mate) for mate in mates]
        able = [
            index
            for index, target in enumerate(targets)
            if _may_receive(frame, target)
            and distance(origin, target) >= self.min_distance
            and self.receiver in (None, mates[index].id)
        ]
        if not able:
            return []
        gaps = lane_clearances(origin, np.array([targets[index] for index in able]), obstacles(frame, me))
        # The obstacles begin with the team-mates in the same order; no receiver blocks its own lane.
        gaps[np.arange(len(able)), able] = inf
        free = (gaps.min(axis=1) > self.lane_clearance).tolist()
        return [(mates[index], targets[index]) for index, clear in zip(able, free, strict=True) if clear]


def resting_point(robot: RobotState) -> Point:
    """Return where the robot comes to rest if it brakes from now on [m]."""
    stretch = robot.speed / (2.0 * robot.limits.braking)
    return (robot.x + stretch * robot.vx, robot.y + stretch * robot.vy)


def _may_receive(frame: Frame, target: Point) -> bool:
    field = frame.field
    return (
        field.contains(*target, tolerance=-ROBOT_RADIUS)
        and not in_own_defense_area(field, *target, tolerance=ROBOT_RADIUS)
        and not in_their_defense_area(field, *target, tolerance=ROBOT_RADIUS)
    )


def _sigmoid(x: float) -> float:
    return 1.0 / (1.0 + exp(-x)) if x > -700.0 else 0.0
