"""The compiled rule that decides which robot goes for the ball, for a team's plan and for arenas."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

from robobt.skills.tactics_settings import TACTICS, AppliedTactics
from robobt.world.compiled import FloatArray, compiled, record_dtype
from robobt.world.rules import in_area

NOBODY = -1


class AttackerCandidate(NamedTuple):
    """A robot that may go for the ball.

    Attributes:
        time: when it can have the ball [s]; infinite if it may not go for the ball.
        x: x coordinate of the robot [m].
        has_ball: whether it has the ball.
    """

    time: float
    x: float
    has_ball: float


ATTACKER_CANDIDATE = record_dtype(AttackerCandidate)
"""The record of a :class:`AttackerCandidate`."""


@compiled
def may_be_attacked(x: float, y: float, numbers: FloatArray) -> bool:
    """Return whether a ball at (x, y) is far enough from the defence areas for field players to go for it."""
    tactics: AppliedTactics = numbers.view(TACTICS)[0]
    length, depth, width = tactics.half_length, tactics.defense_depth, tactics.defense_width
    in_own = in_area(-x, y, length, depth, width, tactics.own_reach)
    return not in_own and not in_area(x, y, length, depth, width, tactics.their_reach)


@compiled
def choose_attacker(
    candidates: FloatArray,
    ball_x: float,
    ball_speed: float,
    meant: int,
    before: int,
    attacking_for: float,
    restart: bool,
    numbers: FloatArray,
) -> int:
    """Return who goes for the ball: the soonest robot, unless the previous attacker is hardly later.

    Args:
        candidates: (n, 3) :data:`ATTACKER_CANDIDATE` of the team's robots.
        ball_x: x of the ball [m].
        ball_speed: its speed [m/s].
        meant: row of the receiver of a pass under way, :data:`NOBODY` without one.
        before: row of the previous attacker, :data:`NOBODY` without one.
        attacking_for: how long that robot has been the attacker [s].
        restart: whether a restart is to be taken.
        numbers: result of :func:`~robobt.skills.tactics_settings.applied`.

    Returns:
        The row of the attacker; ``NOBODY`` if no robot may go for the ball.
    """
    tactics: AppliedTactics = numbers.view(TACTICS)[0]
    best, least, present = NOBODY, inf, inf
    for row in range(len(candidates)):
        candidate: AttackerCandidate = candidates[row].view(ATTACKER_CANDIDATE)[0]
        time = candidate.time
        if time == inf:
            continue
        if candidate.has_ball > 0.0:
            time = -tactics.held_gain
        elif ball_speed < tactics.behind_below:
            time += min(tactics.behind_ball, max(0.0, candidate.x - ball_x))
        if row == meant:
            time -= tactics.meant_gain
        if row == before:
            present = time
        if time < least:
            best, least = row, time
    gain = tactics.switch_gain if attacking_for > tactics.fresh_for else tactics.fresh_gain
    if restart:
        gain = tactics.restart_gain
    return before if present < least + gain else best
