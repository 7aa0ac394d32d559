"""What a page shows besides new ticks: the state at the newest one, and a match that stands still."""

from __future__ import annotations

from collections.abc import Mapping
from struct import iter_unpack, pack
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


_BALL, _ROBOT = 4, 8
"""Numbers of the ball on the ground and of a robot in a packed frame."""


def standing(shown: bytes, before: bytes, now: bytes) -> bytes:
    """Return the frame to show: what viewers have moved where it is now, all else where it was shown.

    The world is a tick ahead of what was shown last, so that without this all would move with the first thing
    that is moved. Frames are packed (:meth:`robobt.world.state.Frame.packed`).

    Args:
        shown: the newest tick's.
        before: the world's when viewers began to move things.
        now: the world's.
    """
    was, there = _parts(before), _parts(now)
    seen = _parts(shown)
    parts = {name: seen.get(name, it) if was.get(name) == it else it for name, it in there.items()}
    counts = [[name[0] for name in parts].count(team) for team in ("own", "opponent")]
    if was["ball", 0.0] != there["ball", 0.0]:
        parts["air", 0.0] = there["air", 0.0]
    numbers = [*parts["time", 0.0], *parts["ball", 0.0]]
    for team, count in zip(("own", "opponent"), counts, strict=True):
        numbers.append(count)
        for name, it in parts.items():
            if name[0] == team:
                numbers += it
    numbers += parts["air", 0.0]
    return pack(f"<{len(numbers)}d", *numbers)


def _parts(frame: bytes) -> dict[tuple[str, float], list[float]]:
    """Return the numbers of a packed frame's time, ball and robots, these by their ids."""
    numbers = [number for (number,) in iter_unpack("<d", frame)]
    parts = {("time", 0.0): numbers[:1], ("ball", 0.0): numbers[1 : 1 + _BALL]}
    at = 1 + _BALL
    for team in ("own", "opponent"):
        count = int(numbers[at])
        at += 1
        for _ in range(count):
            parts[team, numbers[at]] = numbers[at : at + _ROBOT]
            at += _ROBOT
    parts["air", 0.0] = numbers[at:]
    return parts
