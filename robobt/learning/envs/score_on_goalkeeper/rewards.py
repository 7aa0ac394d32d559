"""The reward of Score-On-Goalkeeper: its weights and terms.

For a new term, add its weight to :class:`ScoreReward`, its name to :class:`ScoreTerms` and the term to
:func:`reward` or :func:`end_reward`.
"""

from __future__ import annotations

from math import atan2, cos, hypot, isnan, nan
from typing import Protocol

from pydantic import Field

from robobt.config.validation import Settings
from robobt.learning.envs.judging import EpisodeProgress
from robobt.learning.envs.settings import weight
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.records import Ball, Robot
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_SHOT_OVER_SPEED = 1.0
"""A shot that is slower than this is over [m/s]."""

_CLOSE_TO_GOAL = 1.5
"""Distance to the goal below which getting nearer is not rewarded [m]."""
_REACH_UNCERTAINTY = 0.3
"""Width between a shot that is certainly reached and one that certainly is not [m]."""


class ScoreReward(Settings):
    """Weights of the reward's terms."""

    goal: float = weight(5.0, "on a goal")
    lost: float = weight(0.5, "subtracted if the episode ends without a goal")
    time: float = weight(0.005, "subtracted in every tick")
    aimed: float = weight(0.1, "on a kick that will go between the posts")
    unreached: float = weight(2.0, "on such a kick, scaled by its distance beyond the goalkeeper's reach")
    miss: float = weight(0.2, "subtracted for a kick that will not go between the posts")
    approach: float = weight(0.5, "for each metre that the robot gets nearer to the ball")
    advance: float = weight(0.6, "for each metre that the robot gets nearer to the goal")
    facing: float = weight(0.5, "for a ball in the mouth, times the cosine of the heading to the goal")
    doubt: float = Field(
        0.25, ge=0, le=1, description="value of a kick at the limit of the goalkeeper's reach"
    )
    reach: float = Field(6.0, gt=0, le=50, description="acceleration assumed of a diving goalkeeper [m/s^2]")


class ScoreTerms(Protocol):
    """Sum of each term since the episode's start.

    ``kick`` is the sum of the terms weighted by ``aimed``, ``unreached`` and ``miss``, ``potential`` of those
    weighted by ``approach``, ``advance`` and ``facing``; the others have the names of their weights.
    """

    goal: float
    lost: float
    time: float
    kick: float
    potential: float


@compilable
def reward(
    weights: ScoreReward,
    field: FieldGeometry,
    robot: Robot,
    keeper: Robot,
    ball: Ball,
    held: bool,
    fired: bool,
    progress: EpisodeProgress,
    terms: ScoreTerms,
) -> float:
    """Compute the reward of a tick, without the reward for the episode's end.

    Args:
        weights: weights of the terms.
        field: the field; the goal at +x is attacked.
        robot: the attacker after the tick.
        keeper: the goalkeeper after the tick.
        ball: the ball after the tick.
        held: whether the ball is in the attacker's mouth.
        fired: whether the attacker's kicker fired in the tick.
        progress: progress of the episode; keeps the potential, whose increase is rewarded.
        terms: sums of the episode, which are updated.
    """
    goal_x = field.length / 2
    terms.time -= weights.time
    total = -weights.time
    if fired:
        earned = kicked(weights, field, keeper, ball)
        terms.kick += earned
        total += earned
        progress.kick_rewarded = 1.0 if earned > 0.0 else 0.0
    elif held or hypot(ball.vx, ball.vy) < _SHOT_OVER_SPEED:
        progress.kick_rewarded = 0.0
    potential = -weights.approach * hypot(ball.x - robot.x, ball.y - robot.y)
    # The robot's distance counts, because an aimless kick also brings the ball nearer to the goal.
    potential -= weights.advance * max(hypot(goal_x - robot.x, robot.y), _CLOSE_TO_GOAL)
    if held:
        potential += weights.facing * (1.0 + cos(atan2(-robot.y, goal_x - robot.x) - robot.heading))
    if progress.kick_rewarded > 0.0:
        # A robot that shoots at the goal loses the ball and must not be punished for it.
        potential = nan
    elif not isnan(progress.potential):
        gained = potential - progress.potential
        terms.potential += gained
        total += gained
    progress.potential = potential
    return total


@compilable
def end_reward(weights: ScoreReward, goal: bool, lost: bool, terms: ScoreTerms) -> float:
    """Compute the reward for ending an episode by a goal, or as ``lost``; 0 without an end."""
    if goal:
        terms.goal += weights.goal
        return weights.goal
    if lost:
        terms.lost -= weights.lost
        return -weights.lost
    return 0.0


@compilable
def kicked(weights: ScoreReward, field: FieldGeometry, keeper: Robot, ball: Ball) -> float:
    """Judge a kick by its direction, as soon as the ball has left."""
    goal_x, post_y = field.length / 2, field.goal_width / 2
    if ball.vx <= 0.0:
        return -weights.miss
    if abs(ball.y + (goal_x - ball.x) * ball.vy / ball.vx) > post_y - BALL_RADIUS:
        return -weights.miss
    # The goalkeeper's distance from the shot's line, and the ball's time to get there.
    fast = hypot(ball.vx, ball.vy)
    dx, dy = keeper.x - ball.x, keeper.y - ball.y
    ahead, beside = (dx * ball.vx + dy * ball.vy) / fast, abs(dy * ball.vx - dx * ball.vy) / fast
    lacking = beside - ROBOT_RADIUS - BALL_RADIUS
    time = max(ahead, 0.1) / fast
    beyond = lacking - 0.5 * weights.reach * time * time
    hard = min(max(weights.doubt + beyond / _REACH_UNCERTAINTY, 0.0), 1.0)
    worth: float = weights.aimed + weights.unreached * hard
    return worth
