"""What a page holds while it drags: it stays where it is held until it is let go."""

from __future__ import annotations

from robobt.live.messages import MoveBall, MoveRobot

_LASTS = 0.5
"""What is held is let go when its page says nothing for so long [s]."""


class Grip:
    """The robots and the ball that are held; times are by any clock, always the same [s]."""

    def __init__(self) -> None:
        self._held: dict[str, tuple[MoveBall | MoveRobot, float]] = {}

    def follow(self, move: MoveBall | MoveRobot, now: float) -> None:
        """Hold what is moved, or let go of it, as the move says."""
        name = move.robot if isinstance(move, MoveRobot) else "ball"
        if move.held:
            self._held[name] = move, now
        else:
            self.let_go(name)

    def let_go(self, name: str) -> None:
        """Hold this robot, or "ball", no longer."""
        self._held.pop(name, None)

    @property
    def holding(self) -> bool:
        """Whether anything is held."""
        return bool(self._held)

    def moves(self, now: float) -> list[MoveBall | MoveRobot]:
        """Return what keeps everything in its place that is still held."""
        if not self._held:
            return []
        self._held = {name: held for name, held in self._held.items() if now <= held[1] + _LASTS}
        return [move for move, _ in self._held.values()]
