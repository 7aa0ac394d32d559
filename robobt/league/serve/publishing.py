"""A match told to the league while it is played: what its referee says, and where everything is."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from uuid import UUID

import numpy as np

from robobt.league.serve.cameras import Cameras
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.gamecontroller import RefereePublisher
from robobt.league.wire.sockets import LOOPBACK, Sender
from robobt.league.wire.tracker import write_tracked
from robobt.league.wire.vision import write_field, write_vision
from robobt.match.loop import WorldFactory
from robobt.match.scenario.scenario import Scenario
from robobt.sim.settings import REALISM
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.protocol import Placement, World
from robobt.world.state import Frame, RobotId

_GEOMETRY_EVERY = 60
"""Frames from one geometry packet to the next."""


class PublishedWorld(World):
    """Another world, in real time and told to everybody: vision, tracked frames and referee messages.

    Args:
        world: where the match is played.
        endpoints: where the packets go.
        interface: own address of the interface they leave by: the loopback unless named.
        keepers: numbers of the goalkeepers.
        speed: of the match in shares of real time.
        clock, sleep: this machine's.
    """

    def __init__(
        self,
        world: World,
        endpoints: Endpoints | None = None,
        interface: str = LOOPBACK,
        keepers: Mapping[Team, int] | None = None,
        speed: float = 1.0,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self.world = world
        to = endpoints or Endpoints()
        self._senders = [Sender(*end, interface) for end in (to.vision, to.tracker, to.referee)]
        self._publisher = RefereePublisher(keepers=keepers)
        self._speed, self._clock, self._sleep = speed, clock, sleep
        self._uuid = str(UUID(bytes=np.random.default_rng(0).bytes(16), version=4))
        self._number = 0
        self._judged: Frame | None = None
        self._began = clock()

    def reset(self, placement: Placement, seed: int) -> None:
        """See :class:`robobt.world.World`."""
        self.world.reset(placement, seed)
        self._began = self._clock()

    def observe(self) -> Frame:
        """See :class:`robobt.world.World`."""
        return self.world.observe()

    def truth(self) -> Frame:
        """See :class:`robobt.world.World`."""
        # The match writes the referee's word into the frame that it judges.
        self._judged = self.world.truth()
        return self._judged

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """See :class:`robobt.world.World`; waits for this machine's clock where the world is ahead of it."""
        if self._judged is not None:
            self._publish(self._judged)
            ahead = self._judged.time / self._speed - (self._clock() - self._began)
            if ahead > 0.0:
                self._sleep(ahead)
        self.world.act(commands)

    def place_ball(self, x: float, y: float) -> None:
        """See :class:`robobt.world.World`."""
        self.world.place_ball(x, y)

    def close(self) -> None:
        """Stop talking."""
        for sender in self._senders:
            sender.close()

    def _publish(self, frame: Frame) -> None:
        vision, tracker, referee = self._senders
        robots = {RobotId(Team.BLUE, r.id): (r.x, r.y, r.heading) for r in frame.own}
        robots |= {RobotId(Team.YELLOW, r.id): (r.x, r.y, r.heading) for r in frame.opponents}
        camera = Cameras(frame.field, REALISM["none"], 1, np.random.default_rng(0))
        (seen,) = camera.look(frame.time, frame.time, robots, frame.ball.position)
        seen.number = self._number
        geometry = write_field(frame.field) if self._number % _GEOMETRY_EVERY == 0 else None
        vision.send(write_vision(seen, geometry))
        tracker.send(write_tracked(frame, self._number, frame.time, self._uuid))
        referee.send(self._publisher.write(frame.game, frame.time))
        self._number += 1


class PublishingFactory:
    """Makes the worlds that another factory makes, published.

    Args:
        factory: makes the worlds.
        endpoints, interface, speed: of :class:`PublishedWorld`.
    """

    def __init__(
        self,
        factory: WorldFactory,
        endpoints: Endpoints | None = None,
        interface: str = LOOPBACK,
        speed: float = 1.0,
    ) -> None:
        self._factory, self._endpoints, self._interface, self._speed = factory, endpoints, interface, speed
        self._world: PublishedWorld | None = None

    def __call__(self, scenario: Scenario) -> PublishedWorld:
        """The world of a scenario; the one before falls silent."""
        self.close()
        world = self._factory(scenario)
        keepers = scenario.goalkeepers()
        self._world = PublishedWorld(world, self._endpoints, self._interface, keepers, self._speed)
        return self._world

    def close(self) -> None:
        """Fall silent."""
        if self._world is not None:
            self._world.close()
            self._world = None
