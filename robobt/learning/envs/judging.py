"""What the judging of every task begins and ends with, for its compiled loop over the arenas."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs.progress import PROGRESS, Progress
from robobt.learning.envs.task import SUCCESS, TERMINATED, TRUNCATED, BoolArray, FloatArray, IntArray
from robobt.world.compiled import compilable, compiled
from robobt.world.rules import goal_side


@compilable
def is_over(ends: BoolArray, arena: int) -> bool:
    """Return whether the arena's episode ended earlier in this decision: what follows does not count."""
    return bool(ends[TERMINATED, arena] or ends[TRUNCATED, arena])


@compilable
def begin_tick(episode: Progress, fired: bool) -> None:
    """Count a tick, and note the first kick."""
    episode.ticks += 1
    if fired and episode.kick_tick < 0:
        episode.kick_tick = episode.ticks


@compilable
def goal_of(episode: Progress, ball: FloatArray, half_length: float, half_width: float, post: float) -> int:
    """Note where the ball is, and return the sign of x at the goal that it went into, 0 for none."""
    side = goal_side(episode.ball_x, episode.ball_y, ball[0], ball[1], half_length, half_width, post)
    episode.ball_x = ball[0]
    episode.ball_y = ball[1]
    return side


@compiled
def count(time_limit: float, fired: BoolArray, progress: FloatArray, ends: BoolArray) -> bool:
    """Count a tick in all arenas, which nothing ends but time; return whether any episode has ended.

    Args:
        time_limit: ticks after which episodes are truncated.
        fired: (n,) whether a learner has kicked.
        progress: (n, ...) rows of ``PROGRESS``.
        ends: (3, n) filled.
    """
    episodes = progress.view(PROGRESS)
    any_ended = False
    for i in range(len(fired)):
        if not is_over(ends, i):
            episode: Progress = episodes[i, 0]
            begin_tick(episode, fired[i])
            ends[TRUNCATED, i] = episode.ticks >= time_limit
        any_ended = any_ended or is_over(ends, i)
    return any_ended


@compiled
def goals(
    before: FloatArray, after: FloatArray, half_length: float, half_width: float, post: float
) -> IntArray:
    """Return the sign of x at the goal that each ball goes into in a tick, 0 for none, (n,).

    Args:
        before: (n, 4) balls.
        after: (n, 4).
        half_length: of the field [m].
        half_width: of the field [m].
        post: where the posts are [m].
    """
    found = np.zeros(len(after), dtype=np.int64)
    for i in range(len(after)):
        found[i] = goal_side(
            before[i, 0], before[i, 1], after[i, 0], after[i, 1], half_length, half_width, post
        )
    return found


@compilable
def end_tick(
    episode: Progress,
    earned: float,
    success: bool,
    failed: bool,
    time_limit: float,
    arena: int,
    rewards: FloatArray,
    ends: BoolArray,
) -> bool:
    """Book what a tick brought; return whether it was the episode's last. Success goes before the time limit.

    Args:
        episode: so far.
        earned: reward of the tick.
        success: whether the episode ends in success.
        failed: whether it ends otherwise, in a state from which nothing follows.
        time_limit: ticks after which it is truncated.
        arena: index in the arrays.
        rewards: (n,) added to.
        ends: (3, n) filled.
    """
    rewards[arena] += earned
    episode.total_reward += earned
    terminated = success or failed
    ends[TERMINATED, arena] = terminated
    ends[SUCCESS, arena] = success
    ends[TRUNCATED, arena] = not terminated and episode.ticks >= time_limit
    return bool(terminated or ends[TRUNCATED, arena])
