"""Goes through a match and finds the moments at which another decision would have been worth most."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from math import floor
from statistics import fmean

from robobt.what_if.branches import Branch, Branches
from robobt.what_if.compare import UNCHANGED, DecisionFigures, compared
from robobt.what_if.decisions import BallDecision, decisions_of
from robobt.what_if.logged import LoggedMatch, WhatIfError, playable
from robobt.world.game import Team
from robobt.world.rules import owner
from robobt.world.state import RobotId

_OF_A_MOMENT = 3
"""No more decisions of one moment are kept after the first round."""

_FIRST_FRESH = 1_000_000
"""Number of the first branch of the final figures; the search has smaller ones."""


@dataclass(slots=True, frozen=True)
class Found:
    """A moment at which another decision would have been worth something.

    Attributes:
        time: when [s].
        tick: number of that tick of the log.
        decision: the decision.
        unchanged: what came of the moment without it.
        changed: what came of it with the decision, from branches that the search has not seen.
        typical: number of the branch whose gain is nearest to the mean, for a replay.
    """

    time: float
    tick: int
    decision: BallDecision
    unchanged: DecisionFigures
    changed: DecisionFigures
    typical: int

    @property
    def gain(self) -> float:
        """Change of expected goals by the decision."""
        return self.changed.expected.mean - self.unchanged.expected.mean


@dataclass(slots=True)
class _Arm:
    """A decision at a moment, and the gains of its branches so far."""

    tick: int
    decision: BallDecision
    gains: list[float] = field(default_factory=list)

    @property
    def gain(self) -> float:
        return fmean(self.gains)


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
        frame = logged.recording.frame(tick)
        holder = owner(frame) if frame.game.in_play and playable(frame.game) else None
        if holder is None or holder.team is not team or holder.number == _keeper(logged, team):
            continue
        if time >= until.get(holder, time):
            found.append((tick, holder))
            until[holder] = time + every - 1e-6
    return found


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


def scan(
    logged: LoggedMatch,
    team: Team,
    branches: Branches,
    *,
    every: float = 0.5,
    count: int = 5,
    trials: int = 40,
    first: int = 4,
    apart: float = 1.0,
    seed: int = 0,
    begin: float = 0.0,
    end: float | None = None,
    on_branch: Callable[[int, int], object] = lambda _done, _all: None,
) -> list[Found]:
    """Return the moments at which another decision of ``team`` would have been worth most, the best first.

    Every decision at every moment is played in a few branches, except those that change nothing, such as a
    shot without a free way. The best half gets as many again, and so on (successive halving). The figures of
    the best, where they gained anything, come from fresh branches, because the best of many has also been
    lucky; those of the first come from fresh ones once more, because the first of a few has been, too.

    Args:
        logged: the match.
        team: the team that decides.
        branches: plays the branches.
        every: time from one moment to the next while a robot keeps the ball [s].
        count: how many moments to return at most.
        trials: number of fresh branches for the figures of each.
        first: number of branches of each decision in the first round.
        apart: least time between two of the moments that are returned [s].
        seed: seed of all branches.
        begin: no moments before this time [s].
        end: no moments after this time [s]; None for the whole match.
        on_branch: called after each branch with the numbers of branches played and to play.

    Returns:
        The moments in the order of their figures; the first one's were drawn again after that.
    """
    follow = [team.other] if logged.known else list(Team)
    moments = moments_of(logged, team, every, begin, end)
    arms = [
        _Arm(tick, decision)
        for tick, robot in moments
        for decision in decisions_of(logged.recording.frame(tick), robot)
    ]
    done = 0
    rounds = _rounds(len(arms), first, 2 * count)
    planned = sum(size * number for size, number in rounds)
    next_trial = 0

    def tell() -> None:
        nonlocal done
        done += 1
        on_branch(done, max(planned, done))

    for size, number in rounds:
        arms = _best(arms, size, _OF_A_MOMENT) if next_trial else arms
        numbers = range(next_trial, next_trial + number)
        arms = _play_round(branches, arms, team, seed, numbers, follow, tell)
        next_trial += number
    chosen: list[_Arm] = []
    for arm in _best(arms, len(arms), 1):
        time = logged.recording.times[arm.tick]
        if (
            len(chosen) < count
            and arm.gain > 0.0
            and all(abs(logged.recording.times[one.tick] - time) >= apart for one in chosen)
        ):
            chosen.append(arm)
    fresh = range(_FIRST_FRESH, _FIRST_FRESH + trials)
    found = [(_figures(branches, arm, team, seed, fresh, follow, tell), arm) for arm in chosen]
    found.sort(key=lambda pair: -pair[0].gain)
    if len(found) > 1:
        numbers, best = range(fresh.stop, fresh.stop + trials), found[0][1]
        found[0] = _figures(branches, best, team, seed, numbers, follow, tell), best
    return [one for one, _ in found]


def _rounds(arms: int, first: int, enough: int) -> list[tuple[int, int]]:
    """Return for each round how many decisions are played, and in how many branches each."""
    rounds, played = [(arms, first)], first
    while arms > enough:
        arms = max(enough, arms // 2)
        rounds.append((arms, played))
        played *= 2
    return rounds


def _best(arms: Sequence[_Arm], size: int, of_a_moment: int) -> list[_Arm]:
    """Return the decisions that gained most, no more than ``of_a_moment`` of each moment."""
    chosen: list[_Arm] = []
    ticks: list[int] = []
    for arm in sorted(arms, key=lambda arm: -arm.gain):
        if len(chosen) < size and ticks.count(arm.tick) < of_a_moment:
            chosen.append(arm)
            ticks.append(arm.tick)
    return chosen


def _play_round(
    branches: Branches,
    arms: Sequence[_Arm],
    team: Team,
    seed: int,
    numbers: range,
    follow: Collection[Team],
    tell: Callable[[], None],
) -> list[_Arm]:
    """Play branches of decisions, and return those whose first branch was another one."""
    by_tick: dict[int, list[_Arm]] = {}
    for arm in arms:
        by_tick.setdefault(arm.tick, []).append(arm)
    carried_out: list[_Arm] = []
    for tick, here in sorted(by_tick.items()):
        branches.begin(tick)
        unchanged = [branches.play(seed, number, follow=follow) for number in numbers]
        for arm in here:
            for number, before in zip(numbers, unchanged, strict=True):
                branch = branches.play(seed, number, follow=follow, decision=arm.decision)
                tell()
                if branch == before and not arm.gains:
                    break
                arm.gains.append(branch.value(team) - before.value(team))
            else:
                carried_out.append(arm)
    return carried_out


def _figures(
    branches: Branches,
    arm: _Arm,
    team: Team,
    seed: int,
    numbers: range,
    follow: Collection[Team],
    tell: Callable[[], None],
) -> Found:
    branches.begin(arm.tick)
    unchanged: list[Branch] = []
    changed: list[Branch] = []
    for number in numbers:
        unchanged.append(branches.play(seed, number, follow=follow))
        changed.append(branches.play(seed, number, follow=follow, decision=arm.decision))
        tell()
    without = compared(UNCHANGED, unchanged, None, team)
    with_it = compared(arm.decision.name, changed, unchanged, team)
    assert with_it.gain is not None
    mean = with_it.gain.mean
    gains = [one.value(team) - other.value(team) for one, other in zip(changed, unchanged, strict=True)]
    typical = min(range(len(numbers)), key=lambda i: abs(gains[i] - mean))
    time = float(branches.logged.recording.times[arm.tick])
    return Found(time, arm.tick, arm.decision, without, with_it, numbers[typical])


def _keeper(logged: LoggedMatch, team: Team) -> int | None:
    return logged.scenario.goalkeepers().get(team)
