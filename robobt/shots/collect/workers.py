"""Plays the trials of a collection in worker processes."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

from robobt.config.errors import RobobtError
from robobt.shots.collect.balanced import balanced_attempt
from robobt.shots.collect.paper import PARTS, paper_attempt
from robobt.shots.collect.plan import CollectionSettings
from robobt.shots.collect.watch import take_shot
from robobt.shots.data.schema import complete_row
from robobt.workers import Work, run_tasks
from robobt.worlds import sim_world

_AHEAD = 4
"""Trials a worker holds at a time: they take milliseconds."""


class CollectionError(RobobtError, RuntimeError):
    """A trial could not be played to its end; the message is one line."""


@dataclass(slots=True, frozen=True)
class Taken:
    """What came of one trial.

    Attributes:
        trial: which one.
        row: its shot, a row of the table, None without one.
        time: how long it lasted in the world [s].
    """

    trial: int
    row: dict[str, Any] | None
    time: float


def streams(settings: CollectionSettings) -> int:
    """How many series of trials the collection has: trial n is one of series n modulo this."""
    return len(PARTS) if settings.protocol == "paper" else 1


def play_trial(settings: CollectionSettings, trial: int) -> Taken:
    """Play one trial; the same settings and number give the same shot wherever it is played."""
    if settings.protocol == "paper":
        attempt = paper_attempt(settings, trial % len(PARTS), trial)
    else:
        attempt = balanced_attempt(settings, trial)
    shot, time = take_shot(attempt, sim_world, trial)
    return Taken(trial, None if shot is None else complete_row(shot), time)


def play_trials(
    settings: CollectionSettings, trials: Iterator[int], workers: int
) -> Generator[Taken, None, None]:
    """Play trials as they are asked for, in this process or in several.

    Args:
        settings: of the collection.
        trials: what to play; it may end once enough has been played.
        workers: number of processes; 1 is this process itself.

    Raises:
        CollectionError: a trial raised or its worker died.
    """
    return run_tasks(Work(partial(_play, settings), "trial", CollectionError), trials, workers, ahead=_AHEAD)


def _play(settings: CollectionSettings, trial: int, _report: object) -> Taken:
    return play_trial(settings, trial)
