"""What decisions at moments of a match are worth, as tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.markup import escape

from robobt.cli.common import console, table

if TYPE_CHECKING:
    from robobt.what_if import DecisionFigures, Found
    from robobt.what_if.compare import MeanEstimate


def print_moments(found: Sequence[Found]) -> None:
    """Print the moments that a scan has found."""
    listed = table(
        "time, s", "robot", "decision", "expected goals", "change (95 %)", "change of goals (95 %)"
    )
    for one in found:
        assert one.changed.gain is not None
        assert one.changed.goals_gain is not None
        listed.add_row(
            f"{one.time:.2f}",
            str(one.decision.robot),
            one.decision.name,
            f"{one.unchanged.expected.mean:+z.2f}",
            _text(one.changed.gain),
            _text(one.changed.goals_gain),
        )
    console.print(listed)


def print_decisions(found: Sequence[DecisionFigures]) -> None:
    """Print what each decision at a moment is worth."""
    listed = table(
        "decision", "expected goals (95 %)", "change (95 %)", "goals (95 %)", "change of goals (95 %)"
    )
    for one in found:
        listed.add_row(
            escape(one.name),
            _text(one.expected),
            "" if one.gain is None else _text(one.gain),
            _text(one.goals),
            "" if one.goals_gain is None else _text(one.goals_gain),
        )
    console.print(listed)


def _text(estimate: MeanEstimate) -> str:
    return f"{estimate.mean:+z.2f} ({estimate.low:+z.2f} to {estimate.high:+z.2f})"
