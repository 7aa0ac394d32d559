"""The table of results: a file with one line of JSON a row, to which anybody can append.

A row has everything to play it again: challenge, plays, settings, seed and number of runs; and what came of
it: scores, interval, and a hash over all true states. Who has the same version gets the same hash.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from os import SEEK_END
from pathlib import Path
from statistics import fmean
from typing import Annotated

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from robobt import __version__
from robobt.challenges.challenge import CHALLENGES, Figures
from robobt.challenges.run import ChallengeEntry, RunResult, play_runs
from robobt.config.errors import RobobtError
from robobt.match.loop import WorldFactory
from robobt.statistics import mean_interval

_STRICT = ConfigDict(extra="forbid", allow_inf_nan=False)


class TableError(RobobtError, ValueError):
    """A file of results cannot be read; the message is one line that names file and line."""


@dataclass(slots=True, frozen=True)
class Row:
    """One row of the table of results.

    Attributes:
        challenge: name of the challenge.
        entrant: what the row is called: ours, november, script, chance, or a play.
        blue: play of blue's robots.
        params: parameters of that play.
        yellow: play of yellow's robots; None for the challenge's own.
        yellow_params: parameters of that play.
        settings: changes of the scenario, by field name.
        seed: seed of the runs.
        scores: the score of each run.
        score: their mean.
        low, high: 95 % interval of the mean (Student); None where all scores are equal.
        unit: what the score counts.
        figures: means of all that was counted, by name, each over the runs that have it.
        trace: hash over the true states of all runs; equal for equal runs.
        robobt: version of robobt.
        commit: commit of the code when the runs began, followed by "+" if files were changed since; empty if
            unknown.
        source: the rules, with year and version.
    """

    __pydantic_config__ = _STRICT

    challenge: str
    entrant: str
    blue: str
    seed: Annotated[int, Field(ge=0, lt=2**63)]
    scores: Annotated[list[float], Field(min_length=1)]
    score: float
    low: float | None
    high: float | None
    unit: str
    figures: Mapping[str, float]
    trace: str
    params: Mapping[str, object] = field(default_factory=dict)
    yellow: str | None = None
    yellow_params: Mapping[str, object] = field(default_factory=dict)
    settings: Mapping[str, object] = field(default_factory=dict)
    robobt: str = __version__
    commit: str = ""
    source: str = ""

    @property
    def entry(self) -> ChallengeEntry:
        """Who took which challenge."""
        yellow = None if self.yellow is None else (self.yellow, self.yellow_params)
        return ChallengeEntry(self.challenge, (self.blue, self.params), yellow, self.settings)


def row_of(
    entry: ChallengeEntry, entrant: str, seed: int, results: Sequence[RunResult], commit: str = ""
) -> Row:
    """Return the row of an entrant's runs.

    Args:
        entry: who took which challenge.
        entrant: what the row is called.
        seed: seed of the runs.
        results: the runs, in the order of their numbers.
        commit: the commit of the code when the runs began; empty if unknown.
    """
    challenge = CHALLENGES[entry.challenge]
    scores = [result.score for result in results]
    low: float | None = None
    high: float | None = None
    # Equal scores say nothing about the spread.
    if len(set(scores)) > 1:
        low, high = mean_interval(scores)
    yellow, yellow_params = entry.yellow or (None, {})
    return Row(
        challenge=entry.challenge,
        entrant=entrant,
        blue=entry.blue[0],
        params=entry.blue[1],
        yellow=yellow,
        yellow_params=yellow_params,
        settings=entry.settings or {},
        seed=seed,
        scores=scores,
        score=fmean(scores),
        low=low,
        high=high,
        unit=challenge.unit,
        figures=_means([result.figures for result in results]),
        trace=trace_of(results),
        commit=commit,
        source=challenge.source,
    )


def _means(figures: Sequence[Figures]) -> dict[str, float]:
    """Return the mean of each figure over the runs that have it."""
    names = dict.fromkeys(name for one in figures for name in one)
    return {name: fmean(one[name] for one in figures if name in one) for name in names}


def trace_of(results: Sequence[RunResult]) -> str:
    """Return the hash over the true states of all runs."""
    return hashlib.blake2b("".join([result.trace for result in results]).encode(), digest_size=16).hexdigest()


def append_row(path: Path, row: Row) -> None:
    """Append a row to a file of results, which is made if it is not there.

    Raises:
        OSError: it cannot be written.
    """
    with path.open("ab+") as file:
        if file.tell():
            file.seek(-1, SEEK_END)
            # A line that was cut off stays one line.
            if file.read(1) != b"\n":
                file.write(b"\n")
        file.write(json.dumps(asdict(row), allow_nan=False).encode() + b"\n")


def read_rows(path: Path) -> list[Row]:
    """Return the rows of a file of results.

    Raises:
        TableError: a line is not a row, or the file is not text.
        OSError: it cannot be read.
    """
    adapter, rows = TypeAdapter(Row), []
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise TableError(f"{path}: is not a file of results: it holds no UTF-8 text") from error
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip():
            continue
        try:
            rows.append(adapter.validate_json(line))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join([str(part) for part in first["loc"]])
            raise TableError(f"{path}, line {number}: {place or 'row'}: {first['msg']}") from error
    return rows


def repeats(row: Row, world_factory: WorldFactory, workers: int = 1) -> bool:
    """Play a row again; return whether the hash over all true states is equal.

    Raises:
        ScenarioError: a play of the row, or a setting, is not there.
        RunError: a run raised.
    """
    played = play_runs(row.entry, len(row.scores), row.seed, world_factory, workers)
    return trace_of(played) == row.trace
