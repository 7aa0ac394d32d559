"""A sweep's parameters and opponent, and the sequential test that confirms its result."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import prod
from pathlib import Path
from typing import Any

from robobt.match.loop import WorldFactory
from robobt.match.refereeing import RefereeFactory, own_referee
from robobt.match.scenario.scenario import Scenario, ScenarioError
from robobt.tournament.entrants import Entrant, meeting, read_entrant
from robobt.tournament.fixtures import Fixture
from robobt.tournament.plan import Plan
from robobt.tournament.play import Played, play_tournament
from robobt.tournament.played import PlayedMatch
from robobt.tournament.sequential import RunningTest, SequentialTest
from robobt.tournament.sweeps.vary import SweepError, Varied
from robobt.worlds import sim_world


@dataclass(slots=True, frozen=True)
class Sweep:
    """A sweep: the parameters to tune, and the method.

    Candidates are proposed by Optuna's tree-structured Parzen estimator, ``at_once`` at a time, so that what
    is proposed does not depend on which match ends first.

    Attributes:
        scenario: the field, the starts, the rules and the ends of every match.
        play: the play to tune.
        params: those that stay as they are.
        varied: those that are varied.
        against: the opponent of every candidate.
        candidates: how many are tried; where there are no more, all in turn.
        at_once: how many of them are proposed, and play, at a time.
        rounds: how many a candidate plays that is not stopped.
        seed: of the rounds and of what is proposed.
        error: largest probability that a candidate is stopped that is not worse.
        referee: makes the referee of a match.
        world: makes the world of a match.

    Raises:
        SweepError: a parameter is varied twice, or fixed as well, or the play refuses some of the values.
        EntrantError: whom all play does not fit the scenario.
    """

    scenario: Scenario
    play: str
    params: Mapping[str, object]
    varied: tuple[Varied, ...]
    against: Entrant
    candidates: int
    at_once: int
    rounds: int
    seed: int
    error: float = 0.05
    referee: RefereeFactory = own_referee
    world: WorldFactory = sim_world

    def __post_init__(self) -> None:
        names = [one.name for one in self.varied]
        if not names:
            raise SweepError("nothing is varied")
        for name in names:
            if names.count(name) > 1 or name in self.params:
                raise SweepError(f"{name}: is given twice")
        try:
            meeting(self.scenario, self.against, self.against)
        except ScenarioError as error:
            raise self.against.error(str(error)) from error
        for one in self.varied:
            for value in one.extremes():
                try:
                    meeting(self.scenario, self.entrant({one.name: value}), self.against)
                except ScenarioError as error:
                    raise SweepError(f"{one.name}={_text(value)}: {error}") from error

    @property
    def tries(self) -> int:
        """Return how often Optuna is asked."""
        return len(self.combinations()) or self.candidates

    def combinations(self) -> list[dict[str, int]]:
        """Return all that Optuna may propose if it is no more than is to be tried, else nothing."""
        size = prod(one.count() or self.candidates + 1 for one in self.varied)
        if size > self.candidates:
            return []
        places = [one.proposals() for one in self.varied]
        names = [one.name for one in self.varied]
        return [dict(zip(names, values, strict=True)) for values in product(*places)]

    def entrant(self, params: Mapping[str, object]) -> Entrant:
        """Return the play with these values of what is varied."""
        return read_entrant(self.play, {**self.params, **params}, self.named(params))

    def named(self, params: Mapping[str, object]) -> str:
        """Return what the play is called with these values, as a command line would write it."""
        return f"{self.play}:" + ",".join(
            [f"{name}={_text(value)}" for name, value in {**self.params, **params}.items()]
        )

    def plan(self, entrants: Sequence[Entrant], rounds: int, first_round: int = 0) -> Plan:
        """Return a gauntlet of entrants against the one that all meet."""
        return Plan(
            self.scenario,
            (*entrants, self.against),
            rounds,
            self.seed,
            self.against.name,
            self.referee,
            world=self.world,
            first_round=first_round,
        )

    def says(self) -> dict[str, str]:
        """Return what the store keeps, by field: two sweeps that say the same propose the same candidates."""
        return {
            "sweep": self.named({}) if self.params else self.play,
            "vary": ", ".join(f"{one.name}={one.text}" for one in self.varied),
            "against": self.against.name,
            "rounds": str(self.rounds),
            "at_once": str(self.at_once),
            "error": f"{self.error:g}",
            "optuna": load_optuna().__version__,
        }


def confirm(
    sweep: Sweep,
    params: Mapping[str, object],
    test: SequentialTest,
    rounds: int,
    path: Path,
    workers: int = 0,
    on_progress: Callable[[RunningTest], object] | None = None,
    tell_outputs: bool = True,
) -> tuple[RunningTest, Played]:
    """Test sequentially, on new seeds, whether a candidate is better than the common opponent.

    Args:
        sweep: what was tuned.
        params: what is varied, as the candidate has it.
        test: what is asked.
        rounds: how many are played at most.
        path: the store of the search, which keeps these matches too.
        workers: processes; 0 is this process itself.
        on_progress: called after each match.
        tell_outputs: as for :func:`~robobt.tournament.play.play_tournament`.

    Raises:
        StoreError: the store cannot be written.
    """
    plan = sweep.plan([sweep.entrant(params)], rounds, sweep.rounds)
    running = RunningTest(test, sweep.named(params), sweep.against.name, sweep.rounds)

    def enough(matches: Collection[PlayedMatch], failed: Collection[Fixture]) -> bool:
        decided = running.enough(matches, failed)
        if on_progress is not None:
            on_progress(running)
        return decided

    with plan.open_store(path, **sweep.says()) as store:
        return running, play_tournament(plan, store, workers, enough=enough, tell_outputs=tell_outputs)


def load_optuna() -> Any:
    """Return Optuna, which is imported only where it is needed."""
    try:
        import optuna
    except ImportError as error:
        raise SweepError('Optuna is not installed; pip install "robobt[sweep]"') from error
    return optuna


def _text(value: object) -> str:
    """Return a value as on a command line."""
    return value if isinstance(value, str) else json.dumps(value)
