"""What decisions at moments of a match are worth, as tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from rich.markup import escape

from robobt.cli.common import console, table

if TYPE_CHECKING:
    from rich.table import Column

    from robobt.what_if import DecisionFigures, Found
    from robobt.what_if.compare import MeanEstimate


_CHANGES = "change\n(95 %)", "change of\ngoals (95 %)"
"""Headings of the changes of expected goals and of goals."""

_ONE_LINE = {"moments": 88, "decisions": 112}
"""Width of the screen from which each table has a figure and its interval on one line."""


def print_moments(found: Sequence[Found]) -> None:
    """Print the moments that a scan has found."""
    listed = table("time, s", "robot", "decision", "expected\ngoals", *_CHANGES)
    _keep_whole(listed.columns[4:])
    for one in found:
        assert one.changed.gain is not None
        assert one.changed.goals_gain is not None
        listed.add_row(
            f"{one.time:.2f}",
            str(one.decision.robot),
            one.decision.name,
            f"{one.unchanged.expected.mean:+z.2f}",
            _text(one.changed.gain, "moments"),
            _text(one.changed.goals_gain, "moments"),
        )
    console.print(listed)


def print_decisions(found: Sequence[DecisionFigures]) -> None:
    """Print what each decision at a moment is worth."""
    expected, goals = _CHANGES
    listed = table("decision", "expected\ngoals (95 %)", expected, "goals\n(95 %)", goals)
    _keep_whole(listed.columns[1:])
    for one in found:
        listed.add_row(
            escape(one.name),
            _text(one.expected, "decisions"),
            "" if one.gain is None else _text(one.gain, "decisions"),
            _text(one.goals, "decisions"),
            "" if one.goals_gain is None else _text(one.goals_gain, "decisions"),
        )
    console.print(listed)


def _keep_whole(columns: Iterable[Column]) -> None:
    for column in columns:
        column.no_wrap = True


def _text(estimate: MeanEstimate, shown: str) -> str:
    mean, interval = f"{estimate.mean:+z.2f}", f"{estimate.low:+z.2f} to {estimate.high:+z.2f}"
    return f"{mean} ({interval})" if console.width >= _ONE_LINE[shown] else f"{mean}\n{interval}"
