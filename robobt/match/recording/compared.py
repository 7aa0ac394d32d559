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


class Plans:
    """What a team plans, as it follows from what its skills have written so far."""

    def __init__(self) -> None:
        self._marks: dict[int, int] = {}
        self._threats: list[int] = []
        self._attacker: int | None = None
        self._meeting: list[float] = []

    def follow(self, changes: Written) -> Iterator[tuple[int, list[object]]]:
        """Give whom it marks, by the marker's number, and whom it fears, the most dangerous first.

        Then its attacker's number and where that is to meet the rolling ball, x and y [m]; nothing
        without one.
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
