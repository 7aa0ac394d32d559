"""A match published while it is played: vision, tracked frames and the referee's messages."""

from __future__ import annotations

import time
from collections.abc import Mapping
from uuid import UUID

import numpy as np

from robobt.league.serve.cameras import Cameras
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.league.wire.sockets import Sender
from robobt.league.wire.tracker import write_tracked
from robobt.league.wire.vision import write_vision
from robobt.match.loop import WorldFactory
from robobt.match.scenario.scenario import Scenario
from robobt.sim.realism import REALISM
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.protocol import Placement, World, WrappedWorld
from robobt.world.state import Frame, RobotId

GEOMETRY_INTERVAL = 30
"""Frames from one geometry packet to the next, as grSim's."""


class PublishedWorld(WrappedWorld):
    """Another world, played in real time and published over the loopback."""

    def __init__(
        self, world: World, keepers: Mapping[Team, int] | None = None, endpoints: Endpoints | None = None
    ) -> None:
        super().__init__(world)
        to = endpoints or Endpoints()
        self._senders = [Sender(*end) for end in (to.vision, to.tracker, to.referee)]
        self._publisher = RefereePublisher(keepers)
        self._uuid = str(UUID(bytes=np.random.default_rng(0).bytes(16), version=4))
        self._number = 0
        self._judged: Frame | None = None
        self._began = time.monotonic()

    def reset(self, placement: Placement, seed: int) -> None:
        """See :meth:`robobt.world.World.reset`."""
        self.world.reset(placement, seed)
        self._began = time.monotonic()

    def truth(self) -> Frame:
        """See :meth:`robobt.world.World.truth`."""
        # The match writes the referee's decision into the frame.
        self._judged = super().truth()
        return self._judged

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """See :meth:`robobt.world.World.act`; waits while the match is ahead of real time."""
        if self._judged is not None:
            self._publish(self._judged)
            ahead = self._judged.time - (time.monotonic() - self._began)
            if ahead > 0.0:
                time.sleep(ahead)
        self.world.act(commands)

    @property
    def paced(self) -> bool:
        """See :attr:`robobt.world.protocol.World.paced`."""
        return True

    def close(self) -> None:
        """Stop publishing."""
        for sender in self._senders:
            sender.close()

    def _publish(self, frame: Frame) -> None:
        vision, tracker, referee = self._senders
        camera = Cameras(frame.field, REALISM["none"], 1, np.random.default_rng(0))
        (seen,) = camera.capture(frame, frame.time, frame.time)
        seen.number = self._number
        geometry = None
        if self._number % GEOMETRY_INTERVAL == 0:
            geometry = write_geometry(frame.field, camera.places)
        vision.send(write_vision(seen, geometry))
        tracker.send(write_tracked(frame, self._number, frame.time, self._uuid))
        referee.send(self._publisher.write(frame.game, frame.time))
        self._number += 1


class PublishingFactory:
    """Publishes the worlds that another factory makes; each one ends the publication of the previous.

    ``address`` is that of the other factory, None where it has none.
    """

    def __init__(self, factory: WorldFactory, endpoints: Endpoints | None = None) -> None:
        self._factory, self._endpoints = factory, endpoints
        self.address: str | None = getattr(factory, "address", None)
        self._world: PublishedWorld | None = None

    def __call__(self, scenario: Scenario) -> PublishedWorld:
        """Return the world of a scenario."""
        self.close()
        self._world = PublishedWorld(self._factory(scenario), scenario.goalkeepers(), self._endpoints)
        return self._world

    def close(self) -> None:
        """Stop publishing."""
        if self._world is not None:
            self._world.close()
            self._world = None
