"""The common parts of the compiled loops that judge the arenas of each task.

Python hands such a loop plain tuples of plain arrays, whose types numba finds fastest. The loop begins with
``Ledger(*ledger_)`` or ``Report(*report_)`` and views the arrays as records.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.opponents.sides import FIELD_GEOMETRY
from robobt.sim.arenas import Arenas
from robobt.sim.records import filled
from robobt.world.compiled import (
    compilable,
    compiled,
    compiled_inline,
    compiled_lean,
    numbers_of,
    record_dtype,
)
from robobt.world.field import FieldGeometry
from robobt.world.records import BALL, Ball
from robobt.world.rules import goal_side


class EpisodeProgress(Protocol):
    """The progress of one episode: a row of :data:`PROGRESS`.

    Attributes:
        ticks: ticks since the start.
        ticks_held: ticks in a row with the ball in the mouth and the dribbler on; with a goalkeeper, in the
            goalkeeper's mouth.
        kick_tick: tick in which the kicker first fired; -1 before.
        kick_rewarded: 1 once a kick has been rewarded, or while a rewarded shot is on its way; else 0.
        total_reward: undiscounted sum of rewards.
        ball_x, ball_y: position of the ball before the tick [m].
            carried_x, carried_y: where the ball came into the present mouth [m]; nan if it is in none.
        potential: potential of the state before the tick, for reward shaping; nan at first.
    """

    ticks: float
    ticks_held: float
    kick_tick: float
    kick_rewarded: float
    total_reward: float
    ball_x: float
    ball_y: float
    carried_x: float
    carried_y: float
    potential: float


PROGRESS = record_dtype(EpisodeProgress)
"""Record of the progress of an episode; see :class:`EpisodeProgress`."""


def progress_at(balls: FloatArray) -> NDArray[np.void]:
    """Return the progress of new episodes with these balls (m, size(BALL))."""
    starts, progress = balls.view(BALL)[:, 0], np.zeros(len(balls), dtype=PROGRESS)
    progress["kick_tick"] = -1.0
    progress["ball_x"], progress["ball_y"] = starts["x"], starts["y"]
    for name in ("carried_x", "carried_y", "potential"):
        progress[name] = np.nan
    return progress


class Report(NamedTuple):
    """The report of ``n`` arenas with R robots each after a tick; see :class:`~robobt.sim.arenas.Arenas`."""

    robots: FloatArray  # (n, R, ROBOT_SIZE)
    balls: FloatArray  # (n, size(BALL))
    contact: BoolArray  # (n, R)
    kicked: BoolArray  # (n, R)
    touch: IntArray  # (n,)


class Ledger(NamedTuple):
    """The bookkeeping of the episodes in ``n`` arenas, which judging reads and updates."""

    progress: FloatArray  # (n, size(PROGRESS))
    terms: FloatArray  # (n, number of terms) of the reward, added to
    rewards: FloatArray  # (n,) added to
    terminated: BoolArray  # (n,) how they have ended, see Ends
    truncated: BoolArray
    success: BoolArray


def report_of(arenas: Arenas) -> Report:
    """Return the arenas' arrays as a plain tuple."""
    return cast(Report, (arenas.robots, arenas.balls, arenas.contact, arenas.kicked, arenas.touch))


def parameters(kind: np.dtype[np.void], **parts: float | BaseModel) -> FloatArray:
    """Return the record ``kind`` of a task's judging parameters as numbers, including those of settings."""
    numbers = {
        name: tuple(numbers_of(part, kind[name])) if isinstance(part, BaseModel) else part
        for name, part in parts.items()
    }
    return filled(kind, None, **numbers).reshape(1).view(np.float64)


def fresh(kind: np.dtype[np.void], **fields: float) -> FloatArray:
    """Return the numbers of a record ``kind``, with 0 in all other fields."""
    made = np.zeros(1, kind)
    for name, value in fields.items():
        made[name] = value
    return made.view(np.float64)


@compiled_inline
def is_over(ledger: Ledger, arena: int) -> bool:
    """Return whether the arena's episode ended earlier in this decision, so that later ticks do not count."""
    return bool(ledger.terminated[arena] or ledger.truncated[arena])


@compilable
def begin_tick(episode: EpisodeProgress, fired: bool) -> None:
    """Count a tick, and note the first kick."""
    episode.ticks += 1
    if fired and episode.kick_tick < 0:
        episode.kick_tick = episode.ticks


@compilable
def goal_of(episode: EpisodeProgress, ball: Ball, field: FieldGeometry) -> int:
    """Note the ball's position, and return the sign of x of the goal that it entered, 0 for none."""
    half_length, half_width, post = field.length / 2, field.width / 2, field.goal_width / 2
    side = goal_side(episode.ball_x, episode.ball_y, ball.x, ball.y, half_length, half_width, post)
    episode.ball_x = ball.x
    episode.ball_y = ball.y
    return side


@compiled_lean
def count(time_limit: float, fired: BoolArray, ledger_: Ledger) -> bool:
    """Count a tick in all arenas of a task that only time ends; return whether any episode has ended.

    Args:
        time_limit: ticks after which episodes are truncated.
        fired: (n,) whether a learner has kicked.
        ledger_: the bookkeeping of the episodes.
    """
    ledger = Ledger(*ledger_)
    episodes = ledger.progress.view(PROGRESS)[..., 0]
    any_ended = False
    for i in range(len(fired)):
        if not is_over(ledger, i):
            episode: EpisodeProgress = episodes[i]
            begin_tick(episode, fired[i])
            ledger.truncated[i] = episode.ticks >= time_limit
        any_ended = any_ended or is_over(ledger, i)
    return any_ended


@compiled
def goals(before_: FloatArray, after_: FloatArray, field_: FloatArray) -> IntArray:
    """Return the sign of x of the goal that each ball enters in a tick, 0 for none, (n,).

    Args:
        before_: (n, size(BALL)) balls before the tick.
        after_: (n, size(BALL)) balls after the tick.
        field_: numbers of the field.
    """
    before, after = before_.view(BALL)[..., 0], after_.view(BALL)[..., 0]
    field: FieldGeometry = field_.view(FIELD_GEOMETRY)[0]
    half_length, half_width, post = field.length / 2, field.width / 2, field.goal_width / 2
    found = np.zeros(len(after), dtype=np.int64)
    for i in range(len(after)):
        one, other = before[i], after[i]
        found[i] = goal_side(one.x, one.y, other.x, other.y, half_length, half_width, post)
    return found


@compiled_inline
def end_tick(
    ledger: Ledger, arena: int, earned: float, success: bool, failed: bool, time_limit: float
) -> bool:
    """Book a tick; return whether it was the episode's last. Success comes before the time limit.

    Args:
        ledger: the bookkeeping of all arenas.
        arena: index of the arena.
        earned: reward of the tick.
        success: whether the episode ends in success.
        failed: whether the episode ends without success, in a terminal state.
        time_limit: ticks after which the episode is truncated.
    """
    episode: EpisodeProgress = ledger.progress.view(PROGRESS)[arena, 0]
    ledger.rewards[arena] += earned
    episode.total_reward += earned
    terminated = success or failed
    ledger.terminated[arena] = terminated
    ledger.success[arena] = success
    ledger.truncated[arena] = not terminated and episode.ticks >= time_limit
    return bool(terminated or ledger.truncated[arena])
