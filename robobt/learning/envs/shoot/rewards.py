"""The reward of Shoot-Towards-Goal: what a weight is called and what it weighs.

For a new term add its weight to :class:`ShootReward` and the term to :func:`reward`.
"""

from __future__ import annotations

from math import atan2, hypot
from typing import Literal

from pydantic import Field

from robobt.config.validation import Settings
from robobt.learning.envs.progress import Progress
from robobt.learning.envs.task import FloatArray
from robobt.world.compiled import compilable
from robobt.world.geometry import wrap_angle


class ShootReward(Settings):
    """Weights of the reward's terms."""

    face_goal: float = Field(1.0, ge=0, le=100, description="times (alpha - beta) |v_ball|, Eq. 12")
    inside_share: float = Field(
        0.05, ge=0, le=1, description="Eq. 12: share that is left where alpha >= beta"
    )
    kick: float = Field(10.0, ge=0, le=1e3, description="Eq. 13: once, on kicking while facing the goal")
    kick_counts: Literal["pressed", "fired"] = Field(
        "pressed",
        description="what a kick is to Eq. 13: the first kick action, ball or not, or the kicker's firing",
    )
    waiting: float = Field(
        0.25, ge=0, le=10, description="Eq. 13: taken off a tick before the kick or not facing the goal"
    )
    goal: float = Field(20.0, ge=0, le=1e3, description="on a goal, instead of all other terms")
    time: float = Field(0.0, ge=0, le=10, description="taken off every tick that does not end the episode")


SHOOT_REWARDS: dict[str, ShootReward] = {
    "coded": ShootReward(),
    "printed": ShootReward(goal=0.0),
    "cmu": ShootReward(kick=0.0, waiting=0.0),
    "sparse": ShootReward(face_goal=0.0, kick=0.0, waiting=0.0, time=0.05),
}
"""Rewards by name: the authors' code, the paper's equations alone, Eq. 12 and the goal, the goal and time."""


@compilable
def reward(
    weights: ShootReward,
    firing_counts: bool,
    goal_x: float,
    post_y: float,
    robot: FloatArray,
    ball: FloatArray,
    action: FloatArray,
    fired: bool,
    goal: bool,
    out: bool,
    progress: Progress,
) -> float:
    """Compute the reward of a step.

    Args:
        weights: of the terms.
        firing_counts: whether a kick is the kicker's firing, not the first kick action.
        goal_x: where the attacked goal's line is [m].
        post_y: distance of its posts from the field's long axis [m].
        robot: (6,) x, y, heading, vx, vy, omega after the step.
        ball: (4,) x, y, vx, vy after it.
        action: (2,) in [-1, 1], taken in it.
        fired: whether the kicker fired in it.
        goal: whether a goal was scored.
        out: whether the episode ended out of play.
        progress: of the episode; keeps whether there was a kick.
    """
    kick = fired if firing_counts else action[1] > 0.0
    first_kick = kick and progress.kick_rewarded == 0.0
    if kick:
        progress.kick_rewarded = 1.0
    if goal:
        return weights.goal
    if out:
        return 0.0
    upper = atan2(post_y - robot[1], goal_x - robot[0])
    lower = atan2(-post_y - robot[1], goal_x - robot[0])
    alpha = wrap_angle(upper - lower)
    beta = max(abs(wrap_angle(upper - robot[2])), abs(wrap_angle(lower - robot[2])))
    facing = alpha >= beta
    speed = hypot(ball[2], ball[3])
    total = weights.face_goal * (alpha - beta) * speed - weights.time  # Eq. 12
    if facing:
        total -= weights.face_goal * (1.0 - weights.inside_share) * (alpha - beta) * speed
        if first_kick:
            total += weights.kick  # Eq. 13
    if not facing or progress.kick_rewarded == 0.0:
        total -= weights.waiting  # Eq. 13
    return total
