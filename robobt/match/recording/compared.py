"""A team's plan as a recording shows it: the passes that robots compared, marks and threats."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from pydantic import JsonValue

from robobt.match.recording.recording import Timeline
from robobt.match.recording.stores import plain
from robobt.skills.store import Pass

CANDIDATES = "candidates"
"""Store entry with the compared passes."""

Written: TypeAlias = Timeline[dict[str, JsonValue]]
"""Values that skills wrote, by tick and entry."""


def candidates(changes: Written) -> Iterator[tuple[int, list[JsonValue]]]:
    """Return the passes that a robot compared, the best first: x, y [m] and score of each."""
    for tick, change in changes:
        if CANDIDATES not in change:
            continue
        try:
            found = [Pass(**one) for one in change[CANDIDATES] or []]  # type: ignore[arg-type, union-attr]
            rows = [plain([*map(float, one.target), float(one.score)]) for one in found]
            if any(len(row) != 3 or None in row for row in rows):  # type: ignore[arg-type, operator]
                raise ValueError("no pass to a place")
        except (TypeError, ValueError):
            # Another skill wrote this entry in its own form, which the page does not show.
            rows = []
        yield tick, rows


class Plans:
    """A team's plan, derived from the values that its skills have written so far."""

    def __init__(self) -> None:
        self._marks: dict[int, int] = {}
        self._threats: list[int] = []
        self._attacker: int | None = None
        self._meeting: list[float] = []

    def follow(self, changes: Written) -> Iterator[tuple[int, list[object]]]:
        """Return the marked opponents by the marker's number, and the threats, the most dangerous first.

        The attacker's number and its meeting point with the rolling ball, x and y [m], follow if there is
        one.
        """
        for tick, change in changes:
            if not {"marks", "threats", "attacker", "meeting"} & change.keys():
                continue
            try:
                self._take(change)
            except (TypeError, ValueError):
                self._marks, self._threats, self._attacker, self._meeting = {}, [], None, []
            meets = self._attacker is not None and bool(self._meeting)
            yield tick, [self._marks, self._threats, [self._attacker, *self._meeting] if meets else []]

    def _take(self, change: dict[str, JsonValue]) -> None:
        if "marks" in change:
            self._marks = {int(a): int(b) for a, b in dict(change["marks"] or {}).items()}  # type: ignore[arg-type]
        if "threats" in change:
            self._threats = [int(one) for one in change["threats"] or []]  # type: ignore[arg-type, union-attr]
        if "attacker" in change:
            self._attacker = None if change["attacker"] is None else int(change["attacker"])  # type: ignore[arg-type]
        if "meeting" in change:
            self._meeting = [float(one) for one in change["meeting"] or []]  # type: ignore[arg-type, union-attr]
            if len(self._meeting) not in (0, 2) or None in plain(self._meeting):  # type: ignore[operator]
                raise ValueError("no place")
