"""The moments of a match at which a robot decides what becomes of the ball."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import floor, inf

import numpy as np

from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.what_if.decisions import chances_of
from robobt.what_if.logged import LoggedMatch, WhatIfError, playable
from robobt.world.game import Team
from robobt.world.rules import owner
from robobt.world.state import RobotId

_LOOKS = 0.1
"""Time between two looks at what a robot with the ball can do [s]."""

_NEARLY = 0.8
"""A chance of this share of the best one is as good if it comes earlier: it leaves more time."""


@dataclass(slots=True, frozen=True)
class Moment:
    """A moment at which a robot has the ball.

    Attributes:
        tick: number of the tick.
        robot: the robot.
        chances: how likely a goal is by its decisions, as raters see it; by their names, others are 0.
    """

    tick: int
    robot: RobotId
    chances: Mapping[str, float]

    @property
    def best(self) -> float:
        """The greatest of these chances."""
        return max(self.chances.values())


def moments_of(
    logged: LoggedMatch, team: Team, every: float, begin: float = 0.0, end: float | None = None
) -> list[tuple[int, RobotId]]:
    """Return the ticks at which a robot of ``team`` has the ball in play, and that robot.

    A moment is where a robot gets the ball, and from there every ``every`` seconds while it keeps the ball. A
    robot that loses the ball and gets it again within that time has one moment.

    Args:
        logged: the match.
        team: the team.
        every: time from one moment to the next [s].
        begin: no moments before this time [s].
        end: no moments after this time [s]; None for the whole match.
    """
    found: list[tuple[int, RobotId]] = []
    times, until = logged.recording.times, dict[RobotId, float]()
    for tick in range(len(logged.recording)):
        time = float(times[tick])
        if time < begin or (end is not None and time > end):
            continue
        holder = _decides(logged, tick)
        if holder is None or holder.team is not team:
            continue
        if time >= until.get(holder, time):
            found.append((tick, holder))
            until[holder] = time + every - 1e-6
    return found


def promising_moments(
    logged: LoggedMatch, team: Team, every: float, begin: float = 0.0, end: float | None = None
) -> list[Moment]:
    """Return when a robot of ``team`` can do most with the ball, once in each stretch of ``every`` seconds.

    The stretches begin at the moments of :func:`moments_of`. In each, the first moment counts at which a
    decision is nearly as good as the best one of the stretch, as raters see it.

    Args:
        logged: the match.
        team: the team.
        every: length of a stretch [s].
        begin: no moments before this time [s].
        end: no moments after this time [s]; None for the whole match.
    """
    rater, times, found = ExpectedGoal(goalkeeper="fitted"), logged.recording.times, list[Moment]()
    step = max(1, round(_LOOKS / logged.scenario.period))
    for first, robot in moments_of(logged, team, every, begin, end):
        until = min(times[first] + every - 1e-6, inf if end is None else end)
        later = range(first + step, int(np.searchsorted(times, until)), step)
        ticks = [first, *(tick for tick in later if _decides(logged, tick) == robot)]
        seen = [Moment(tick, robot, chances_of(logged.recording.frame(tick), robot, rater)) for tick in ticks]
        enough = _NEARLY * max(one.best for one in seen)
        found.append(next(one for one in seen if one.best >= enough))
    return found


def _decides(logged: LoggedMatch, tick: int) -> RobotId | None:
    """Return the field player that has the ball in play; None without one."""
    frame = logged.recording.frame(tick)
    holder = owner(frame) if frame.game.in_play and playable(frame.game) else None
    if holder is None or holder.number == logged.scenario.goalkeepers().get(holder.team):
        return None
    return holder


def nobody_decides(logged: LoggedMatch, at: float, team: Team | None) -> WhatIfError:
    """Return the error that no robot has the ball to decide about, which says who has it next.

    Args:
        logged: the match.
        at: when nobody has it [s].
        team: the team whose robots count; None for both.
    """
    who = "nobody" if team is None else f"no robot of {team.value}"
    teams = list(Team) if team is None else [team]
    later = [moment for one in teams for moment in moments_of(logged, one, 1e6, at)[:1]]
    then = ""
    if later:
        tick, robot = min(later, key=lambda moment: moment[0])
        then = f"{robot} has it at {_short_time(logged, tick)} s; "
    return WhatIfError(
        f"{logged.recording.path}: {who} has the ball at {at:g} s, so no other decision can be tried; "
        f"{then}--scan looks for moments that count, --blue or --yellow lets a team play otherwise"
    )


def _short_time(logged: LoggedMatch, tick: int) -> str:
    """Return a time at which the log is at this tick [s], with two digits or as many more as it takes."""
    times = logged.recording.times
    time = float(times[tick])
    for digits in range(2, 6):
        for text in (f"{floor(time * 10**digits) / 10**digits:.{digits}f}", f"{time:.{digits}f}"):
            if times[0] <= float(text) <= times[-1] and logged.tick(float(text)) == tick:
                return text
    return str(time)
