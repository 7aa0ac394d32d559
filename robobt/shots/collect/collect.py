"""Collecting shots: plays trials until the requested number is reached, always saved on disk."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from robobt.config.errors import RobobtError
from robobt.engines.run import run_tasks
from robobt.engines.work import MAX_WORKERS, Work
from robobt.shots.collect.balanced import balanced_attempt
from robobt.shots.collect.file import CollectionFile
from robobt.shots.collect.fitted import against_fitted
from robobt.shots.collect.paper import PARTS, TEST, TRAIN, paper_attempt, splits
from robobt.shots.collect.plan import CollectionSettings
from robobt.shots.collect.watch import take_shot
from robobt.shots.data.schema import Row, complete_row


class Taken(NamedTuple):
    """The result of one trial: its shot, or None, and its simulated duration [s]."""

    trial: int
    row: Row | None
    time: float


def play_trial(settings: CollectionSettings, trial: int) -> Taken:
    """Play one trial; its shot depends only on the settings and the trial's number. Return the result."""
    attempt = (paper_attempt if settings.protocol == "paper" else balanced_attempt)(settings, trial)
    if settings.goalkeepers is not None:
        attempt = against_fitted(attempt, settings.goalkeepers)
    shot, time = take_shot(attempt, trial)
    return Taken(trial, None if shot is None else complete_row(shot), time)


PAPER_COUNT = TRAIN + TEST
"""Shots of the paper's protocol."""

MAX_COUNT = 10_000_000

_BARREN = 2000
"""Number of trials in a row without a shot after which the collection gives up."""

_TRIALS_PER_WORKER = 4
"""Trials a worker holds at a time: they take milliseconds."""


class CollectionError(RobobtError, RuntimeError):
    """A collection could not be completed; the message is one line."""


@dataclass(slots=True)
class Collected:
    """The result of a collection.

    Attributes:
        shots: in the file.
        goals: among them.
        new: those among them that this run has taken.
        simulated: time that this run has simulated [s].
        wall: time that it took [s].
        interrupted: whether it was stopped (Ctrl-C) before the last shot.
    """

    shots: int = 0
    goals: int = 0
    new: int = 0
    simulated: float = 0.0
    wall: float = 0.0
    interrupted: bool = False

    @property
    def real_time_factor(self) -> float:
        """Return simulated time over the time it took; 0 when nothing was played."""
        return self.simulated / self.wall if self.wall > 0.0 else 0.0


def collect_shots(
    settings: CollectionSettings,
    out: str | Path,
    count: int,
    workers: int = 1,
    on_shot: Callable[[], None] | None = None,
) -> Collected:
    """Collect shots into a file, or continue an earlier run's file. Return the result.

    Which shots they are depends on the settings and the count alone, not on the
    number of workers nor on how often the collection was interrupted. Ctrl-C ends
    the run; what is finished is kept.

    Args:
        settings: what they are shots of.
        out: ``.csv`` or ``.parquet``; see :class:`CollectionFile`.
        count: how many; always :data:`PAPER_COUNT` in the paper's protocol.
        workers: number of processes; 1 is this process itself.
        on_shot: called for each shot that is there, those of earlier runs first.

    Returns:
        How many there are, how many are goals, and whether it was interrupted.

    Raises:
        ShotDataError: ``out`` holds something else.
        CollectionError: a trial raised or its worker died.
        ValueError: an argument is out of range.
        OSError: a file cannot be written.
    """
    paper = settings.protocol == "paper"
    if paper and (count != PAPER_COUNT or settings.opponents != 1 or settings.scenario != "both"):
        raise ValueError(f"the paper's protocol is {PAPER_COUNT} shots of both scenarios at one opponent")
    if not 1 <= count <= MAX_COUNT:
        raise ValueError(f"count must be 1 to {MAX_COUNT}, not {count}")
    if not 1 <= workers <= MAX_WORKERS:
        raise ValueError(f"workers must be 1 to {MAX_WORKERS}, not {workers}")
    quotas = [part.shots for part in PARTS] if paper else [count]
    done = Collected()
    started = perf_counter()
    with CollectionFile(out, settings) as file:
        before = {row["trial"] for row in file.rows}
        tally = _Tally(quotas, file.rows)
        for _ in range(tally.shots):
            if on_shot is not None:
                on_shot()
        if file.complete and len(file.rows) == count:
            rows = file.rows
        else:
            work = Work(partial(_play, settings), "trial", CollectionError)
            results = run_tasks(work, tally.open_trials(), workers, ahead=_TRIALS_PER_WORKER)
            try:
                for taken in results:
                    done.simulated += taken.time
                    if taken.row is not None:
                        file.add(taken.row)
                        if on_shot is not None:
                            on_shot()
                    tally.add(taken.trial, taken.row)
            except KeyboardInterrupt:
                done.interrupted = True
            finally:
                results.close()
            rows = tally.chosen()
            if not done.interrupted:
                if paper:
                    for row, split in zip(
                        rows, splits([row["success"] for row in rows], settings.seed), strict=True
                    ):
                        row["early_stop_split"] = split
                file.finish(rows)
    done.wall = perf_counter() - started
    done.shots = len(rows) if not done.interrupted else tally.shots
    # Workers may have taken a few more than there was room for.
    done.new = sum(row["trial"] not in before for row in rows)
    done.goals = sum(row["success"] for row in rows)
    return done


def _play(settings: CollectionSettings, trial: int, _report: object) -> Taken:
    return play_trial(settings, trial)


class _Tally:
    """Which trials have been played, and whether each series has its shots.

    A series has its shots when they are there from its first trial on without a
    gap: which shots it consists of must not depend on who finished first.
    """

    def __init__(self, quotas: list[int], rows: list[Row]) -> None:
        self._quotas = quotas
        self._rows: dict[int, Row | None] = {row["trial"]: row for row in rows}
        self.shots = len(self._rows)
        self._next = [0] * len(quotas)
        self._kept = [0] * len(quotas)
        self._barren = 0
        for series in range(len(quotas)):
            self._move_on(series)

    def add(self, trial: int, row: Row | None) -> None:
        """Note that one more trial is over."""
        self._rows[trial] = row
        self._barren = 0 if row is not None else self._barren + 1
        if self._barren > _BARREN:
            raise CollectionError(f"no shot in {_BARREN} trials in a row")
        self.shots += row is not None
        self._move_on(trial % len(self._quotas))

    def open_trials(self) -> Iterator[int]:
        """Yield trials to play, series by series in turn, until every series has its shots."""
        series, size = 0, len(self._quotas)
        place = [0] * size
        while any(kept < quota for kept, quota in zip(self._kept, self._quotas, strict=True)):
            if self._kept[series] < self._quotas[series]:
                place[series] = max(place[series], self._next[series])
                trial = place[series] * size + series
                place[series] += 1
                if trial not in self._rows:
                    yield trial
            series = (series + 1) % size

    def chosen(self) -> list[Row]:
        """Return the shots of the collection: the first of each series, in order."""
        size = len(self._quotas)
        rows: list[Row] = []
        for series, quota in enumerate(self._quotas):
            found = [self._rows[trial] for trial in sorted(self._rows) if trial % size == series]
            rows += [row for row in found if row is not None][:quota]
        return rows

    def _move_on(self, series: int) -> None:
        size = len(self._quotas)
        while (
            self._kept[series] < self._quotas[series]
            and (trial := self._next[series] * size + series) in self._rows
        ):
            self._kept[series] += self._rows[trial] is not None
            self._next[series] += 1
