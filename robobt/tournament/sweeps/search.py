"""Candidates play the same rounds against one team, and Optuna proposes the next ones."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING

from robobt.config.errors import RobobtError
from robobt.tournament.fixtures import Fixture
from robobt.tournament.play import play_tournament
from robobt.tournament.played import PlayedMatch
from robobt.tournament.sweeps.race import Race
from robobt.tournament.sweeps.sweep import Sweep, load_optuna

if TYPE_CHECKING:
    from optuna import Study, Trial


@dataclass(slots=True)
class Candidate:
    """A candidate: a set of tried values.

    Attributes:
        number: from 0, in the order of proposal.
        name: of the entrant.
        params: the varied parameters.
        rounds: how many rounds count.
        score: mean score in them, 0 to 1; None where none could be played.
        lead: goals by which it wins a match in the mean.
        stopped: whether it was stopped because it surely is worse than the other, or than the best before it.
        problem: why it could not play; None where it could.
        errors: ticks in which one of its trees failed.
        first_error: the first such failure, or why it lost a match by rule; None without one.
    """

    number: int
    name: str
    params: dict[str, object]
    rounds: int = 0
    score: float | None = None
    lead: float | None = None
    stopped: bool = False
    problem: str | None = None
    errors: int = 0
    first_error: str | None = None


@dataclass(slots=True)
class Swept:
    """The result of a search.

    Attributes:
        candidates: those that were tried, in the order of proposal.
        best: the one with the highest score of those that were not stopped; None without one.
        matches: all that were played.
        failed: what kept matches from being played, by match.
        interrupted: whether it was stopped (Ctrl-C) before all candidates were tried.
    """

    candidates: list[Candidate] = field(default_factory=list)
    best: Candidate | None = None
    matches: list[PlayedMatch] = field(default_factory=list)
    failed: dict[Fixture, str] = field(default_factory=dict)
    interrupted: bool = False


def search(
    sweep: Sweep,
    path: Path,
    workers: int = 0,
    on_progress: Callable[[int, Swept], object] | None = None,
    on_wait: Callable[[int], object] | None = None,
    tell_outputs: bool = True,
) -> Swept:
    """Try candidates, and continue a search that was stopped. Return the result.

    Optuna starts again each time and gets the results from the store, so that it proposes the same
    candidates.

    Args:
        sweep: the sweep.
        path: its store.
        workers: processes; 0 is this process itself.
        on_progress: called with a number of matches that are played, or need not be played any more, and
            what is known so far.
        on_wait: called when another program holds this one up, as by
            :func:`robobt.tournament.play.play_tournament`.
        tell_outputs: as for :func:`robobt.tournament.play.play_tournament`.

    Raises:
        SweepError: Optuna is not installed.
        StoreError: the store is of something else, or cannot be written.
    """
    swept = Swept()
    try:
        _search(sweep, path, swept, on_progress or (lambda *_: None), workers, on_wait, tell_outputs)
    except KeyboardInterrupt:
        # While no match was played; those that were are in the store.
        swept.interrupted = True
    return swept


def _search(
    sweep: Sweep,
    path: Path,
    swept: Swept,
    tell: Callable[[int, Swept], object],
    workers: int,
    on_wait: Callable[[int], object] | None,
    tell_outputs: bool,
) -> None:
    """Enter in ``swept`` what is found, batch by batch."""
    study = _study(sweep.seed)
    known: dict[str, Candidate] = {}
    scores: dict[str, dict[int, float]] = {}
    waiting = deque(sweep.combinations())
    for begun in range(0, sweep.tries, sweep.at_once):
        trials = []
        for _ in range(min(sweep.at_once, sweep.tries - begun)):
            if waiting:
                study.enqueue_trial(waiting.popleft())
            trials.append(study.ask())
        batch = [_proposed(sweep, trial, known) for trial in trials]
        new = [one for one in known.values() if one.problem is None and one.name not in scores]
        best = {} if swept.best is None else scores[swept.best.name]
        race = Race(sweep.against.name, best, sweep.error)
        done = 0
        if new:

            def on_match(match: PlayedMatch, race: Race = race) -> None:
                nonlocal done
                race.take(match)
                done += 1
                tell(1, swept)

            plan = sweep.plan([sweep.entrant(one.params) for one in new], sweep.rounds)
            with plan.open_store(path, **sweep.says()) as store:
                played = play_tournament(
                    plan,
                    store,
                    workers,
                    on_match=on_match,
                    needless=race.needless,
                    on_wait=on_wait,
                    tell_outputs=tell_outputs,
                )
            swept.matches += played.matches
            swept.failed |= played.failed
            if played.interrupted:
                swept.interrupted = True
                return
        for one in new:
            scores[one.name] = race.scores(one.name, swept.failed)
            _judge(one, scores[one.name], race, swept)
        for trial, one in zip(trials, batch, strict=True):
            _tell(study, trial, one, scores.get(one.name, {}))
        swept.candidates = list(known.values())
        swept.best = max(filter(_finished, swept.candidates), key=_rank, default=None)
        tell(2 * sweep.rounds * len(batch) - done, swept)


def _study(seed: int) -> Study:
    optuna = load_optuna()
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    # Those of one batch do not know of each other's results: the liar keeps them apart.
    sampler = optuna.samplers.TPESampler(seed=seed % 2**32, constant_liar=True)
    study: Study = optuna.create_study(direction="maximize", sampler=sampler)
    return study


def _proposed(sweep: Sweep, trial: Trial, known: dict[str, Candidate]) -> Candidate:
    """Return the candidate that is proposed, one of the known where it was proposed before."""
    params = {one.name: one.suggested(trial) for one in sweep.varied}
    problem = None
    try:
        sweep.plan([sweep.entrant(params)], 1)
    except RobobtError as error:
        # Each value is possible, but not with the others; or it is whom it would play.
        problem = str(error)
    name = sweep.named(params)
    return known.setdefault(name, Candidate(len(known), name, params, problem=problem))


def _judge(one: Candidate, scores: Mapping[int, float], race: Race, swept: Swept) -> None:
    """Enter what a candidate has done."""
    one.rounds, one.stopped = len(scores), one.name in race.stopped
    matches = [match for match in race.matches(one.name) if match.round in scores]
    if not scores:
        whys = [why for fixture, why in swept.failed.items() if one.name in fixture]
        one.problem = whys[0] if whys else "no match was played"
        return
    one.score = fmean(scores.values())
    one.lead = fmean(match.lead(one.name) for match in matches)
    sides = [match.side(one.name) for match in matches]
    one.errors = sum(side.errors for side in sides)
    one.first_error = next((side.first_error for side in sides if side.first_error is not None), None)


def _tell(study: Study, trial: Trial, one: Candidate, scores: Mapping[int, float]) -> None:
    """Report a candidate's result to Optuna."""
    state = load_optuna().trial.TrialState
    if one.score is None:
        study.tell(trial, state=state.FAIL)
    elif one.stopped:
        for number in range(one.rounds):
            trial.report(fmean([*scores.values()][: number + 1]), number)
        study.tell(trial, state=state.PRUNED)
    else:
        study.tell(trial, one.score)


def _finished(one: Candidate) -> bool:
    return one.score is not None and not one.stopped


def _rank(one: Candidate) -> tuple[float, float, int]:
    return one.score or 0.0, one.lead or 0.0, -one.number
