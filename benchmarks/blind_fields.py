"""How well a minute of play identifies fields that nobody knows."""

from __future__ import annotations

from math import sqrt
from typing import Annotated

import numpy as np
import typer

from benchmarks.blind.ahead import misses_ahead
from benchmarks.blind.field import draw_field, play
from benchmarks.blind.scores import Score, score, summed
from robobt.cli.common import MAX_SEED, Json, Progress, Workers, console, cores, print_json, say, table
from robobt.config.errors import RobobtError
from robobt.engines.run import run_tasks
from robobt.engines.work import Work
from robobt.identify import identify
from robobt.identify.ball import model_of
from robobt.statistics import wilson_interval
from robobt.world.ball_model import DEFAULT_BALL

_FIELDS_A_SEED = 1000

Scored = tuple[int, list[Score], list[float], list[float]]
"""A field's seed, its scores, and the misses of the identified and the default ball 1 s ahead [m]."""


class BlindFieldError(RobobtError, RuntimeError):
    """A field could not be played on or identified."""


def _scored(task: tuple[int, float], _: object) -> Scored:
    """Return what became of a field, from its seed and the seconds of play."""
    seed, seconds = task
    field = draw_field(seed)
    found = identify(play(field, seconds, seed))
    held_out = play(field, seconds, seed + MAX_SEED // 2)
    identified, default = (
        misses_ahead(held_out, ball).tolist() for ball in (model_of(found.ball), DEFAULT_BALL)
    )
    return seed, list(score(found, field)), identified, default


def blind_fields(
    fields: Annotated[int, typer.Option("--fields", min=1, max=200, help="How many fields.")] = 20,
    seconds: Annotated[
        float, typer.Option("--seconds", min=10, max=600, help="Play that each is identified from [s].")
    ] = 60.0,
    seed: Annotated[
        int, typer.Option("--seed", "-s", min=0, max=MAX_SEED // _FIELDS_A_SEED, help="Of the fields.")
    ] = 41,
    workers: Workers = None,
    as_json: Json = False,
) -> None:
    """Draw fields, play six against six, identify each from what its cameras saw, and score that.

    Blue believes the default robots, ball and 70 ms of delay; only its commands are known. A second match
    on each field tells how well the ball is foretold 1 s ahead.

    Keys of --json: seed, fields, seconds; rows: by kind of figure kind, figures, seen, bar, within (share of
    those seen), median_error, error_95 (relative, in seconds for delay, in shares for one touch), covered,
    covered_interval; covered and covered_interval over all; ahead: predictions, identified and default (root
    mean square, m); worst: the largest errors by kind, each with field and figure.
    """
    scores: list[tuple[int, Score]] = []
    identified: list[float] = []
    default: list[float] = []
    tasks = [(seed * _FIELDS_A_SEED + number, seconds) for number in range(fields)]
    work: Work[tuple[int, float], None, Scored] = Work(_scored, "field", BlindFieldError)
    with Progress("playing", fields) as progress:
        for field, own, ahead, ahead_default in run_tasks(work, tasks, workers or min(cores(), fields)):
            scores += [(field, it) for it in own]
            identified += ahead
            default += ahead_default
            progress.advance()
    scores.sort(key=lambda pair: pair[0])
    rows = summed([it for _, it in scores])
    seen = [it for _, it in scores if it.seen]
    covered = sum(it.covered for it in seen)
    low, high = wilson_interval(covered, len(seen))
    figures = {
        "seed": seed,
        "fields": fields,
        "seconds": seconds,
        "rows": rows,
        "covered": covered / len(seen) if seen else None,
        "covered_interval": [low, high],
        "ahead": {
            "predictions": len(identified),
            "identified": _rms(identified),
            "default": _rms(default),
        },
        "worst": [
            {"field": field, "figure": it.name, "error": it.error, "covered": it.covered}
            for field, it in sorted(
                [pair for pair in scores if pair[1].seen], key=lambda pair: -abs(pair[1].error)
            )[:20]
        ],
    }
    if as_json:
        print_json(figures)
        return
    listed = table(f"{fields} fields, {seconds:.0f} s", "seen", "bar", "within", "median", "95 %", "covered")
    for row in rows:
        listed.add_row(
            str(row["kind"]),
            f"{row['seen']} of {row['figures']}",
            *[_number(row[name]) for name in ("bar", "within", "median_error", "error_95", "covered")],
        )
    console.print(listed)
    say(f"Intervals hold {covered} of {len(seen)}: {covered / len(seen):.1%} ({low:.1%} to {high:.1%}).")
    say(
        f"Ball 1 s ahead, {len(identified)} predictions, root mean square: "
        f"{_rms(identified):.3f} m as identified, {_rms(default):.3f} m with the default ball."
    )


def _rms(values: list[float]) -> float:
    return sqrt(float(np.mean(np.square(values)))) if values else 0.0


def _number(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else ""
