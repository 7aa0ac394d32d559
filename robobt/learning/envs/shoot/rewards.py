"""The reward of Shoot-Towards-Goal: its weights and terms.

For a new term, add its weight to :class:`ShootReward`, its name to :class:`ShootTerms` and the term to
:func:`reward`.
"""

from __future__ import annotations

from math import atan2, hypot
from typing import Literal, Protocol

from pydantic import Field

from robobt.config.validation import Settings
from robobt.learning.envs.judging import EpisodeProgress
from robobt.learning.envs.settings import weight
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.geometry import wrap_angle
from robobt.world.records import Ball, Robot


class ShootReward(Settings):
    """Weights of the reward's terms."""

    face_goal: float = weight(1.0, "times (alpha - beta) |v_ball|, Eq. 12")
    inside_share: float = Field(0.05, ge=0, le=1, description="Eq. 12: factor where alpha >= beta")
    kick: float = weight(10.0, "Eq. 13: once, on kicking while facing the goal")
    kick_counts: Literal["pressed", "fired"] = Field(
        "pressed",
        description="the kick in Eq. 13: first kick action, even without the ball, or the kicker's firing",
    )
    waiting: float = weight(0.25, "Eq. 13: subtracted in a tick before the kick or not facing the goal")
    goal: float = weight(20.0, "on a goal, instead of all other terms")
    time: float = weight(0.0, "subtracted in every tick that does not end the episode")


SHOOT_REWARDS: dict[str, ShootReward] = {
    "coded": ShootReward(),
    "printed": ShootReward(goal=0.0),
    "cmu": ShootReward(kick=0.0, waiting=0.0),
    "sparse": ShootReward(face_goal=0.0, kick=0.0, waiting=0.0, time=0.05),
}
"""Rewards by name: the authors' code, the paper's equations alone, Eq. 12 and the goal, the goal and time."""


class ShootTerms(Protocol):
    """Sum of each term since the episode's start, by the name of its weight."""

    face_goal: float
    kick: float
    waiting: float
    goal: float
    time: float


@compilable
def reward(
    weights: ShootReward,
    field: FieldGeometry,
    robot: Robot,
    ball: Ball,
    kick: bool,
    goal: bool,
    out: bool,
    progress: EpisodeProgress,
    terms: ShootTerms,
) -> float:
    """Compute the reward of a step.

    Args:
        weights: weights of the terms.
        field: the field; the goal at +x is attacked.
        robot: the robot after the step.
        ball: the ball after the step.
        kick: whether the step had a kick, as ``weights`` defines it.
        goal: whether a goal was scored.
        out: whether the episode ended out of play.
        progress: progress of the episode; keeps whether there was a kick.
        terms: sums of the episode, which are updated.
    """
    first_kick = kick and progress.kick_rewarded == 0.0
    if kick:
        progress.kick_rewarded = 1.0
    if goal:
        terms.goal += weights.goal
        return weights.goal
    if out:
        return 0.0
    goal_x, post_y = field.length / 2, field.goal_width / 2
    upper = atan2(post_y - robot.y, goal_x - robot.x)
    lower = atan2(-post_y - robot.y, goal_x - robot.x)
    alpha = wrap_angle(upper - lower)
    beta = max(abs(wrap_angle(upper - robot.heading)), abs(wrap_angle(lower - robot.heading)))
    facing = alpha >= beta
    speed = hypot(ball.vx, ball.vy)
    turned = weights.face_goal * (alpha - beta) * speed  # Eq. 12
    terms.face_goal += turned
    terms.time -= weights.time
    total = turned - weights.time
    if facing:
        inside = weights.face_goal * (1.0 - weights.inside_share) * (alpha - beta) * speed
        terms.face_goal -= inside
        total -= inside
        if first_kick:
            terms.kick += weights.kick
            total += weights.kick  # Eq. 13
    if not facing or progress.kick_rewarded == 0.0:
        terms.waiting -= weights.waiting
        total -= weights.waiting  # Eq. 13
    return total
