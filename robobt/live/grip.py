"""Objects that a page drags: they stay where they are held until they are released."""

from __future__ import annotations

from robobt.live.messages import MoveBall, MoveRobot

_LASTS = 0.5
"""Silence of the page after which a held object is released [s]."""


class HeldObjects:
    """The held robots and ball; times are by one clock [s]."""

    def __init__(self) -> None:
        self._held: dict[str, tuple[MoveBall | MoveRobot, float]] = {}

    def follow(self, move: MoveBall | MoveRobot, now: float) -> None:
        """Hold or release the moved object, as the move says."""
        name = move.robot if isinstance(move, MoveRobot) else "ball"
        if move.held:
            self._held[name] = move, now
        else:
            self.let_go(name)

    def let_go(self, name: str) -> None:
        """Release this robot, or "ball"."""
        self._held.pop(name, None)

    @property
    def holding(self) -> bool:
        """Whether anything is held."""
        return bool(self._held)

    def moves(self, now: float) -> list[MoveBall | MoveRobot]:
        """Return the moves that keep all held objects in place."""
        if not self._held:
            return []
        self._held = {name: held for name, held in self._held.items() if now <= held[1] + _LASTS}
        return [move for move, _ in self._held.values()]
