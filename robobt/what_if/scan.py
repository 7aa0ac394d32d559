"""Goes through a match and finds the moments at which another decision would have been worth most."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, field
from statistics import fmean

from robobt.what_if.branches import Branch, Branches
from robobt.what_if.compare import UNCHANGED, DecisionFigures, compared
from robobt.what_if.decisions import BallDecision, decisions_of
from robobt.what_if.logged import LoggedMatch
from robobt.what_if.moments import Moment
from robobt.world.game import Team

_OF_A_MOMENT, _OF_A_MOMENT_LATER = 3, 2
"""No more decisions of one moment are tried in the first round, and in later ones."""

_OF_A_CHANCE, _AS_BRANCHES = 0.4, 6
"""Expected goals that a decision gains for each that raters promise, and as how many branches that counts.

Shots that promised 0.3 or more came to 0.38 of it in branches (docs/measurements/what_if.md).
"""

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
    """A decision at a moment, what raters make of it, and the gains of its branches so far."""

    tick: int
    decision: BallDecision
    chance: float
    gains: list[float] = field(default_factory=list)

    @property
    def gain(self) -> float:
        estimated = _AS_BRANCHES * _OF_A_CHANCE * self.chance
        return (estimated + sum(self.gains)) / (_AS_BRANCHES + len(self.gains))


def scan(
    logged: LoggedMatch,
    team: Team,
    branches: Branches,
    moments: Iterable[Moment],
    *,
    count: int = 5,
    trials: int = 40,
    first: int = 4,
    apart: float = 1.0,
    seed: int = 0,
    on_branch: Callable[[int, int], object] = lambda _done, _all: None,
) -> list[Found]:
    """Return the moments at which another decision of ``team`` would have been worth most, the best first.

    The search begins with the decisions that raters promise most of. Each is played in a few branches, except
    those that change nothing, such as a shot without a free way. The best half gets as many again, and so on
    (successive halving). What raters promise counts as much as a few branches. The figures of the best come
    from fresh branches, because the best of many has also been lucky; those of the first come from fresh ones
    once more, because the first of a few has been, too.

    Args:
        logged: the match.
        team: the team that decides.
        branches: plays the branches.
        moments: where to look, from :func:`promising_moments`.
        count: how many moments to return at most.
        trials: number of fresh branches for the figures of each.
        first: number of branches of each decision in the first round.
        apart: least time between two of the moments that are returned [s].
        seed: seed of all branches.
        on_branch: called after each branch with the numbers of branches played and to play.

    Returns:
        The moments in the order of their figures; the first one's were drawn again after that.
    """
    follow = [team.other] if logged.known else list(Team)
    arms = [
        _Arm(one.tick, decision, one.chances.get(decision.name, 0.0))
        for one in moments
        for decision in decisions_of(logged.recording.frame(one.tick), one.robot)
    ]
    arms = _best(arms, len(arms), _OF_A_MOMENT)
    done = 0
    rounds = _rounds(len(arms), first, 2 * count)
    planned = sum(size * number for size, number in rounds)
    next_trial = 0

    def tell() -> None:
        nonlocal done
        done += 1
        on_branch(done, max(planned, done))

    for size, number in rounds:
        numbers = range(next_trial, next_trial + number)
        arms = _best(arms, size, _OF_A_MOMENT_LATER if next_trial else _OF_A_MOMENT)
        arms = _play_round(branches, arms, team, seed, numbers, follow, tell)
        next_trial += number
    times, chosen = logged.recording.times, list[_Arm]()
    for arm in _best(arms, len(arms), 1):
        near = any(abs(times[one.tick] - times[arm.tick]) < apart for one in chosen)
        if len(chosen) < count and not near and fmean(arm.gains) > 0.0:
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


def _best(arms: Iterable[_Arm], size: int, of_a_moment: int) -> list[_Arm]:
    """Return the decisions that gained most, no more than ``of_a_moment`` of each moment."""
    chosen: list[_Arm] = []
    of_moments = Counter[int]()
    for arm in sorted(arms, key=lambda arm: -arm.gain):
        if len(chosen) < size and of_moments[arm.tick] < of_a_moment:
            chosen.append(arm)
            of_moments[arm.tick] += 1
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
