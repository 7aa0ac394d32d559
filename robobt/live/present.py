"""The complete state at the newest tick, derived from all changes so far."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class Present:
    """Gathers changes by the names of :class:`~robobt.match.recording.stream.TickChanges`.

    Attributes:
        lasting: the changes that concern no tree and no drawing: the referee's state and the last touch.
    """

    def __init__(self) -> None:
        self._statuses: dict[str, str] = {}
        self._feedback: dict[str, dict[int, str]] = {}
        self._written: dict[str, dict[str, Any]] = {}
        self._drawn: dict[str, list[Any]] = {}
        self.lasting: dict[str, Any] = {}

    def follow(self, changes: Mapping[str, Any]) -> None:
        """Take the changes of the next tick."""
        self._statuses.update(changes.get("statuses", ()))
        for robot, said in changes.get("feedback", {}).items():
            self._feedback.setdefault(robot, {}).update(said)
        for owner, values in changes.get("written", {}).items():
            self._written.setdefault(owner, {}).update(values)
        self._drawn.update(changes.get("drawn", ()))
        for name in ("game", "touch"):
            if name in changes:
                self.lasting[name] = changes[name]

    def changes(self) -> dict[str, Any]:
        """Return the complete state, in the form of the changes of a first tick."""
        told: dict[str, Any] = {
            "statuses": dict(self._statuses),
            "feedback": {robot: dict(said) for robot, said in self._feedback.items()},
            "drawn": dict(self._drawn),
            "written": {owner: dict(values) for owner, values in self._written.items()},
        }
        return {**{name: value for name, value in told.items() if value}, **self.lasting}
