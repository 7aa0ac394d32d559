"""What a recording tells of a team's mind: the passes that robots compared, marks and threats."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from pydantic import JsonValue

from robobt.match.recording.recording import Timeline
from robobt.match.recording.stores import plain
from robobt.skills.store import Pass

CANDIDATES = "candidates"
"""The store's entry with the passes that were compared."""

Written: TypeAlias = Timeline[dict[str, JsonValue]]
"""What skills wrote, by tick and entry."""


def candidates(changes: Written) -> Iterator[tuple[int, list[JsonValue]]]:
    """Give the passes that a robot compared, the best first: x, y [m] and score of each."""
    for tick, change in changes:
        if CANDIDATES not in change:
            continue
        try:
            found = [Pass(**one) for one in change[CANDIDATES] or []]  # type: ignore[arg-type, union-attr]
            rows = [plain([*map(float, one.target), float(one.score)]) for one in found]
            if any(len(row) != 3 or None in row for row in rows):  # type: ignore[arg-type, operator]
                raise ValueError("no pass to a place")
        except (TypeError, ValueError):
            # Some other skill's idea of it, which the page shows nothing of.
            rows = []
        yield tick, rows


def plans(changes: Written) -> Iterator[tuple[int, list[object]]]:
    """Give whom a team marks, by the marker's number, and whom it fears, the most dangerous first."""
    marks: dict[int, int] = {}
    threats: list[int] = []
    for tick, change in changes:
        if "marks" not in change and "threats" not in change:
            continue
        try:
            if "marks" in change:
                marks = {int(a): int(b) for a, b in dict(change["marks"] or {}).items()}  # type: ignore[arg-type]
            if "threats" in change:
                threats = [int(one) for one in change["threats"] or []]  # type: ignore[arg-type, union-attr]
        except (TypeError, ValueError):
            marks, threats = {}, []
        yield tick, [marks, threats]
