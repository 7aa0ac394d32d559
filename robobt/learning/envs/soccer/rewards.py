"""The reward of tasks with several robots: its weights and terms.

For a new term, add its weight to :class:`SoccerReward`, its name to :class:`SoccerTerms`, and the term to
:func:`team_reward` or :func:`own_reward`.
"""

from __future__ import annotations

from math import hypot, isnan
from typing import Protocol

from pydantic import Field

from robobt.config.validation import Settings
from robobt.learning.envs.settings import weight
from robobt.sim.records import Records
from robobt.world.compiled import compilable, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.records import Ball, Robot
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_WITHIN = 0.4
"""Distance beside a team-mate from which a kick is not aimed at it [m]."""
_REWARDED = 4
"""Number of shots rewarded per episode. If all were, shooting at the goalkeeper and fetching the ball could
earn more than a goal, and in one seed of five it did; if only the first is, learning takes far longer."""
_BLOCKED = 0.2
"""An opponent closer than this to a pass's line intercepts it [m]."""


class SoccerReward(Settings):
    """Weights of the reward's terms: team terms, equal for all its robots, and individual terms."""

    goal: float = weight(5.0, "team: for a goal, and subtracted for a goal against it")
    fault: float = weight(1.0, "team: subtracted for a ball out or lost or a broken rule; the others earn it")
    passed: float = weight(0.0, "team: for a pass that has reached a team-mate")
    holding: float = weight(0.0, "team: for every tick with the ball in the mouth of one of its robots")
    advance: float = weight(0.3, "team: for each metre that the ball gets nearer to the goal")
    time: float = weight(0.002, "team: subtracted in every tick")
    approach: float = weight(0.3, "own: for each metre that the robot gets nearer to the ball")
    shot: float = weight(0.5, "own: for a kick that will go between the posts, the first four of an episode")
    sent: float = weight(0.0, "own: for a kick at a team-mate, scaled by aim; 0 if the lane is blocked")
    crash: float = weight(0.02, "own: subtracted in every tick in which it touches a robot")
    shared: float = Field(
        0.0, ge=0, le=1, description="share of the own terms that is replaced by the team's mean"
    )


class SoccerTerms(Protocol):
    """Sum of each term since the episode's start, by the name of its weight, as the learners' mean."""

    goal: float
    fault: float
    passed: float
    holding: float
    advance: float
    time: float
    approach: float
    shot: float
    sent: float
    crash: float


class RewardMemory(Protocol):
    """A learner's state for its reward.

    Attributes:
        to_goal: distance from the ball to the attacked goal in the last tick [m], nan at first.
        to_ball: distance from its hull to the ball in the last tick [m], nan at first.
        shots: number of rewarded shots.
        own: its individual reward in this tick.
    """

    to_goal: float
    to_ball: float
    shots: float
    own: float


REWARD_MEMORY = record_dtype(RewardMemory)


@compilable
def team_reward(
    weights: SoccerReward,
    goal: float,
    fault: float,
    passed: bool,
    holding: bool,
    ball_to_goal: float,
    memory: RewardMemory,
    terms: SoccerTerms,
    part: float,
) -> float:
    """Compute the team terms of a tick for one of its robots.

    Args:
        weights: of the terms.
        goal: 1 for a goal of the team, -1 for one against it, 0 for none.
        fault: 1 if the team ended the episode by a fault, -1 if the others did, else 0.
        passed: whether a pass of the team has reached a team-mate.
        holding: whether a robot of the team has the ball in its mouth.
        ball_to_goal: distance from the ball to the attacked goal [m].
        memory: state of the robot, updated.
        terms: of the episode, added to.
        part: of one learner in the mean of all.
    """
    scored, faulty = weights.goal * goal, weights.fault * fault
    terms.goal += part * scored
    terms.fault -= part * faulty
    terms.time -= part * weights.time
    total = scored - faulty - weights.time
    if passed:
        terms.passed += part * weights.passed
        total += weights.passed
    if holding:
        terms.holding += part * weights.holding
        total += weights.holding
    if not isnan(memory.to_goal):
        nearer = weights.advance * (memory.to_goal - ball_to_goal)
        terms.advance += part * nearer
        total += nearer
    memory.to_goal = ball_to_goal
    return total


@compilable
def own_reward(
    weights: SoccerReward,
    field: FieldGeometry,
    side: float,
    robot: Robot,
    ball: Ball,
    fired: bool,
    gap: float,
    memory: RewardMemory,
    terms: SoccerTerms,
    part: float,
) -> float:
    """Compute a robot's own terms of a tick.

    Args:
        weights: of the terms.
        field: on which they play.
        side: 1 where its team attacks the goal at +x, -1 where that at -x.
        robot: after the tick.
        ball: after it.
        fired: whether its kicker fired in it.
        gap: from its hull to the nearest one [m].
        memory: as for :func:`team_reward`.
        terms: of the episode, added to.
        part: of one learner in the mean of all.
    """
    total, goal_x, post_y = 0.0, side * (field.length / 2), field.goal_width / 2
    far = max(hypot(ball.x - robot.x, ball.y - robot.y) - ROBOT_RADIUS - BALL_RADIUS, 0.0)
    if not isnan(memory.to_ball):
        nearer = weights.approach * (memory.to_ball - far)
        terms.approach += part * nearer
        total += nearer
    memory.to_ball = far
    if fired and memory.shots < _REWARDED and (goal_x - ball.x) * ball.vx > 0.0:
        crosses = ball.y + (goal_x - ball.x) * ball.vy / ball.vx
        if abs(crosses) < post_y - BALL_RADIUS:
            terms.shot += part * weights.shot
            total += weights.shot
            memory.shots += 1.0
    if gap < 0.005:
        terms.crash -= part * weights.crash
        total -= weights.crash
    return total


@compilable
def sent(ball: Ball, robots: Records[Robot], first: int, last: int, least: float) -> float:
    """Return how well a kick is aimed at a mate: 1 at its centre, 0 beside it or with an opponent on the way.

    Args:
        ball: as it has left.
        robots: all of them, the team's being ``first`` to ``last``, who kicked included.
        first: index of the team's first robot.
        last: behind its last.
        least: how far away a mate must be [m].
    """
    fast = hypot(ball.vx, ball.vy)
    if fast == 0.0:
        return 0.0
    best, until = 0.0, 0.0
    for r in range(first, last):
        along, beside = _off(ball, robots[r], fast)
        if along >= least and 1.0 - beside / _WITHIN > best:
            best, until = 1.0 - beside / _WITHIN, along
    for r in range(len(robots)):
        along, beside = _off(ball, robots[r], fast)
        if not first <= r < last and 0.0 < along < until and beside < _BLOCKED:
            return 0.0
    return best


@compilable
def _off(ball: Ball, robot: Robot, fast: float) -> tuple[float, float]:
    """Return how far along the ball's way a robot is, and how far beside it [m]."""
    dx, dy = robot.x - ball.x, robot.y - ball.y
    return (dx * ball.vx + dy * ball.vy) / fast, abs(dy * ball.vx - dx * ball.vy) / fast
