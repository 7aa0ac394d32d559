"""Branches with and without another decision, compared seed by seed."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import asdict, dataclass
from statistics import fmean

from robobt.statistics import mean_interval, wilson_interval
from robobt.what_if.branches import Branch, Branches
from robobt.what_if.decisions import BallDecision
from robobt.world.game import Team


@dataclass(slots=True, frozen=True)
class MeanEstimate:
    """A mean with its 95 % interval."""

    mean: float
    low: float
    high: float

    @classmethod
    def of(cls, values: Sequence[float]) -> MeanEstimate:
        """Return the mean of values and Student's interval.

        Where all values are equal the interval allows for a change by one in as many trials as may have been
        missed (Wilson), because the variance says nothing then.
        """
        mean = fmean(values)
        if len(set(values)) < 2:
            missed = wilson_interval(0, len(values)).high
            return cls(mean, mean - missed, mean + missed)
        return cls(mean, *mean_interval(values))


@dataclass(slots=True, frozen=True)
class DecisionFigures:
    """What a decision is worth at a moment.

    Attributes:
        name: the decision.
        trials: number of branches.
        expected: expected goals of the team minus its opponents'.
        goals: goals of the team minus its opponents'.
        gain: change of ``expected`` by the decision, from branches with the same errors; None for "nothing
            changed".
        goals_gain: change of ``goals`` by the decision, from these branches.
        followed: mean time that the game stayed in the log [s].
    """

    name: str
    trials: int
    expected: MeanEstimate
    goals: MeanEstimate
    gain: MeanEstimate | None
    goals_gain: MeanEstimate | None
    followed: float

    def to_json(self) -> dict[str, object]:
        """Return plain data; the keys are the attributes' names."""
        return asdict(self)


UNCHANGED = "nothing changed"
"""Name of what is compared with."""


def compared(
    name: str, branches: Sequence[Branch], unchanged: Sequence[Branch] | None, team: Team
) -> DecisionFigures:
    """Return what came of branches, and the change to others with the same seeds if there are any.

    Args:
        name: name of the decision.
        branches: its branches.
        unchanged: the branches without it, in the same order of seeds; None if these are they.
        team: the team whose goals count.
    """
    expected = [branch.value(team) for branch in branches]
    goals = [float(branch.lead(team)) for branch in branches]
    gain = goals_gain = None
    if unchanged is not None:
        pairs = list(zip(branches, unchanged, strict=True))
        gain = MeanEstimate.of([one.value(team) - other.value(team) for one, other in pairs])
        goals_gain = MeanEstimate.of([float(one.lead(team) - other.lead(team)) for one, other in pairs])
    return DecisionFigures(
        name,
        len(branches),
        MeanEstimate.of(expected),
        MeanEstimate.of(goals),
        gain,
        goals_gain,
        fmean(branch.followed for branch in branches),
    )


def compare_decisions(
    branches: Branches,
    decisions: Collection[BallDecision],
    team: Team,
    trials: int,
    seed: int,
    follow: Collection[Team],
    on_branch: Callable[[], object] = lambda: None,
) -> tuple[list[Branch], list[DecisionFigures]]:
    """Compare decisions at the present moment with what the log's plays do.

    Args:
        branches: set up at the moment.
        decisions: what is decided otherwise.
        team: the team whose goals count.
        trials: number of branches of each.
        seed: seed of all of them.
        follow: teams that follow the log until the game has left it.
        on_branch: called after each branch.

    Returns:
        The branches in which nothing changed, and what came of them and then of the decisions in their order.
    """

    def play(decision: BallDecision | None) -> list[Branch]:
        played = []
        for trial in range(trials):
            played.append(branches.play(seed, trial, follow=follow, decision=decision))
            on_branch()
        return played

    unchanged = play(None)
    found = [compared(UNCHANGED, unchanged, None, team)]
    found += [compared(one.name, play(one), unchanged, team) for one in decisions]
    return unchanged, found
