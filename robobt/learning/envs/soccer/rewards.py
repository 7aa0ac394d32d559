"""The reward of tasks of several robots: what a weight is called and what it weighs.

For a new term add its weight to :class:`SoccerReward`, its name to :class:`SoccerTerms`, and the term to
:func:`team_reward` or :func:`own_reward`.
"""

from __future__ import annotations

from math import hypot, isnan
from typing import Protocol

from pydantic import Field

from robobt.config.validation import Settings
from robobt.learning.envs.task import FloatArray
from robobt.world.compiled import compilable
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_WITHIN = 0.4
"""From here on a kick is not at a mate [m]."""
_REWARDED = 4
"""So many shots of an episode are rewarded. If all were, shooting at the goalkeeper and fetching the ball
could pay more than a goal, and in one seed of five did; if the first alone is, learning takes far longer."""
SHOTS = 2
"""Index of how many have been, in what is kept for a robot's reward."""
_BLOCKED = 0.2
"""An opponent nearer than this to its way gets a pass [m]."""


class SoccerReward(Settings):
    """Weights of the reward's terms: the team's, the same for all its robots, and a robot's own."""

    goal: float = Field(5.0, ge=0, le=1e3, description="team: on a goal, and taken off on one against it")
    fault: float = Field(
        1.0,
        ge=0,
        le=1e3,
        description="team: taken off for a ball out or lost or a rule broken, which the others earn",
    )
    passed: float = Field(0.0, ge=0, le=1e3, description="team: on a pass that has come to a mate")
    holding: float = Field(
        0.0, ge=0, le=10, description="team: every tick with the ball in a mouth of its own"
    )
    advance: float = Field(
        0.3, ge=0, le=10, description="team: each metre that the ball gets nearer to the goal"
    )
    time: float = Field(0.002, ge=0, le=10, description="team: taken off every tick")
    approach: float = Field(0.3, ge=0, le=10, description="own: for each metre nearer to the ball")
    shot: float = Field(
        0.5,
        ge=0,
        le=100,
        description="own: on a kick that will go between the posts, its first four of an episode",
    )
    sent: float = Field(
        0.0, ge=0, le=100, description="own: on a kick at a mate, less beside it and none past an opponent"
    )
    crash: float = Field(
        0.02, ge=0, le=10, description="own: taken off every tick in which it touches a robot"
    )
    shared: float = Field(
        0.0, ge=0, le=1, description="share of the own terms that are the team's mean instead"
    )


class SoccerTerms(Protocol):
    """What each term has brought since an episode began, by the name of its weight: the learners' mean."""

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


@compilable
def team_reward(
    weights: SoccerReward,
    goal: float,
    fault: float,
    passed: bool,
    holding: bool,
    ball_to_goal: float,
    before: FloatArray,
    terms: SoccerTerms,
    part: float,
) -> float:
    """Compute the team's terms of a tick, seen from one of its robots.

    Args:
        weights: of the terms.
        goal: 1 for a goal of the team, -1 for one against it, 0 for none.
        fault: 1 where the team ended the episode by a fault, -1 where the others did, else 0.
        passed: whether a pass of the team has come to a mate.
        holding: whether the ball lies in a mouth of the team.
        ball_to_goal: distance from the ball to the attacked goal [m].
        before: (3,) that of the tick before, nan at first, which is replaced, the robot's to the ball, and
            how often it has shot.
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
    if not isnan(before[0]):
        nearer = weights.advance * (before[0] - ball_to_goal)
        terms.advance += part * nearer
        total += nearer
    before[0] = ball_to_goal
    return total


@compilable
def own_reward(
    weights: SoccerReward,
    goal_x: float,
    post_y: float,
    robot: FloatArray,
    ball: FloatArray,
    fired: bool,
    gap: float,
    before: FloatArray,
    terms: SoccerTerms,
    part: float,
) -> float:
    """Compute a robot's own terms of a tick.

    Args:
        weights: of the terms.
        goal_x: where the attacked goal's line is, which may be negative [m].
        post_y: distance of its posts from the field's long axis [m].
        robot: (6,) x, y, heading, vx, vy, omega after the tick.
        ball: (4,) x, y, vx, vy after it.
        fired: whether its kicker fired in it.
        gap: from its hull to the nearest one [m].
        before: as for :func:`team_reward`; the second entry is replaced, the third counts shots.
        terms: of the episode, added to.
        part: of one learner in the mean of all.
    """
    total = 0.0
    far = max(hypot(ball[0] - robot[0], ball[1] - robot[1]) - ROBOT_RADIUS - BALL_RADIUS, 0.0)
    if not isnan(before[1]):
        nearer = weights.approach * (before[1] - far)
        terms.approach += part * nearer
        total += nearer
    before[1] = far
    shots = 0.0 if isnan(before[SHOTS]) else before[SHOTS]
    if fired and shots < _REWARDED and (goal_x - ball[0]) * ball[2] > 0.0:
        crosses = ball[1] + (goal_x - ball[0]) * ball[3] / ball[2]
        if abs(crosses) < post_y - BALL_RADIUS:
            terms.shot += part * weights.shot
            total += weights.shot
            before[SHOTS] = shots + 1.0
    if gap < 0.005:
        terms.crash -= part * weights.crash
        total -= weights.crash
    return total


@compilable
def sent(ball: FloatArray, robots: FloatArray, first: int, last: int, least: float) -> float:
    """Return how well a kick is aimed at a mate: 1 at its centre, 0 beside it or with an opponent on the way.

    Args:
        ball: (4,) x, y, vx, vy as it has left.
        robots: (R, 6) states, the team's being ``first`` to ``last``, who kicked included.
        first: index of the team's first robot.
        last: behind its last.
        least: how far away a mate must be [m].
    """
    fast = hypot(ball[2], ball[3])
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
def _off(ball: FloatArray, robot: FloatArray, fast: float) -> tuple[float, float]:
    """Return how far along the ball's way a robot is, and how far beside it [m]."""
    dx, dy = robot[0] - ball[0], robot[1] - ball[1]
    return (dx * ball[2] + dy * ball[3]) / fast, abs(dy * ball[2] - dx * ball[3]) / fast
