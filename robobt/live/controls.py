"""Viewers' control of time: pause, single ticks, speed."""

from __future__ import annotations

from robobt.live.messages import Act, Pause, Speed, Step
from robobt.live.server import Server

IDLE_POLL = 0.05
"""How often a match that is paused or over looks for what viewers ask for [s]."""


class Controls:
    """Keeps the time settings of a server's viewers, and sends them to all.

    Attributes:
        speed: factor on real time.
        paused: whether only single ticks are played.
    """

    def __init__(self, server: Server, speed: float = 1.0, paused: bool = False) -> None:
        self._server = server
        self.speed, self.paused, self._steps = speed, paused, 0

    @property
    def wait(self) -> bool:
        """Whether the next tick waits for a viewer."""
        return self.paused and not self._steps

    def ticked(self) -> None:
        """Count a tick that was played."""
        if self._steps:
            self._steps -= 1

    def take(self, act: Act) -> None:
        """Carry out a request about time."""
        match act:
            case Pause(on=on):
                self.paused, self._steps = on, 0
            case Step(ticks=ticks):
                self.paused, self._steps = True, self._steps + ticks
            case Speed(factor=factor):
                self.speed = factor
        self.tell()

    def tell(self, **more: object) -> None:
        """Send the state to the viewers."""
        self._server.tell(paused=self.paused, speed=self.speed, **more)
