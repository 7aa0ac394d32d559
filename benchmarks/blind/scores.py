"""What was identified of a blind field beside what it is: errors, intervals, and what was not seen."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from benchmarks.blind.field import BlindField
from robobt.identify.report import Identification
from robobt.statistics import wilson_interval
from robobt.world.game import Team

BARS = {
    "ball": 0.05,
    "hops": 0.05,
    "own robots' limits": 0.10,
    "opponents' limits": 0.10,
    "gains": 0.05,
    "lags": 0.005,
    "kick speed": 0.05,
    "one touch": 0.05,
    "carried": 0.05,
    "delay": 0.005,
    "noise and gaps": None,
}
"""Largest error allowed by kind of figure: relative; in seconds for delay and lags, in shares for one touch
and what a kick carries on."""

_LIMITS = {
    "max_speed": "max_speed",
    "acceleration": "acceleration",
    "braking": "braking",
    "side_acceleration": "lateral_acceleration",
    "side_braking": "lateral_braking",
    "max_turn": "max_turn",
    "turn_acceleration": "turn_acceleration",
}

_ABSOLUTE = ("one touch", "carried", "delay", "lags")


@dataclass(frozen=True, slots=True)
class Score:
    """One figure of one field.

    Attributes:
        kind: of figure, a key of :data:`BARS`.
        name: of the figure.
        seen: whether it was seen enough.
        error: estimate less truth; relative for all but one touch, what a kick carries on, delay and lags.
        covered: whether its interval holds the truth.
    """

    kind: str
    name: str
    seen: bool
    error: float
    covered: bool


def score(found: Identification, field: BlindField) -> Iterator[Score]:
    """Yield the scores of all figures that a field has."""
    figures = dict(found.figures())
    for kind, name, truth in _truths(field):
        figure = figures[name]
        error = figure.value - truth
        if kind not in _ABSOLUTE:
            error /= truth
        yield Score(kind, name, figure.seen, error, figure.low <= truth <= figure.high)


def _truths(field: BlindField) -> Iterator[tuple[str, str, float]]:
    """Yield kind, name and truth of every figure."""
    settings = field.settings
    for name in ("slide_deceleration", "roll_deceleration", "switch_share"):
        yield "ball", f"ball.{name}", getattr(settings.ball, name)
    for name in ("first_hop", "other_hops", "rebound"):
        yield "hops", f"ball.{name}", getattr(settings.ball, name)
    for robot, limits in field.limits.items():
        own = robot.team is Team.BLUE
        for name, attribute in _LIMITS.items():
            kind = "own robots' limits" if own else "opponents' limits"
            yield kind, f"{robot}.{name}", getattr(limits, attribute)
        if own:
            yield "delay", f"{robot}.delay", field.whole_delays[robot]
            for name in ("gain", "side_gain", "turn_gain"):
                yield "gains", f"{robot}.{name}", getattr(limits, name)
            for name in ("lag", "side_lag", "turn_lag"):
                yield "lags", f"{robot}.{name}", getattr(limits, name)
    yield "kick speed", "kicks.share", 1.0
    yield "one touch", "kicks.returned", next(iter(field.limits.values())).touch_returned
    yield "one touch", "kicks.kept", next(iter(field.limits.values())).touch_kept
    yield "carried", "kicks.carried", next(iter(field.limits.values())).carried
    for name in ("ball_noise", "robot_noise", "heading_noise", "missing_ball", "missing_robot"):
        yield "noise and gaps", f"noise.{name}", getattr(settings.realism, name)


def summed(scores: list[Score]) -> list[dict[str, object]]:
    """Return a row a kind of figure: how many were seen, how large errors are, how often intervals hold."""
    rows: list[dict[str, object]] = []
    for kind, bar in BARS.items():
        of_kind = [it for it in scores if it.kind == kind]
        seen = [it for it in of_kind if it.seen]
        errors = np.abs([it.error for it in seen])
        within = sum(bar is not None and abs(it.error) <= bar for it in seen)
        covered = sum(it.covered for it in seen)
        rows.append(
            {
                "kind": kind,
                "figures": len(of_kind),
                "seen": len(seen),
                "bar": bar,
                "within": within / len(seen) if seen and bar is not None else None,
                "median_error": float(np.median(errors)) if seen else None,
                "error_95": float(np.quantile(errors, 0.95)) if seen else None,
                "covered": covered / len(seen) if seen else None,
                "covered_interval": list(wilson_interval(covered, len(seen))) if seen else None,
            }
        )
    return rows
