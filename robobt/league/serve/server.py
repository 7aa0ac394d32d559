"""Our simulator as one of the league's: vision and tracked frames out, commands and teleports in."""

from __future__ import annotations

import heapq
import select
import time as clocks
from collections.abc import Callable
from contextlib import ExitStack
from itertools import count
from typing import Literal
from uuid import UUID

import numpy as np

from robobt.config.closing import Closing
from robobt.league.log.files import LogKind, LogWriter
from robobt.league.serve.cameras import Cameras
from robobt.league.serve.pace import ServingPace
from robobt.league.serve.ports import ClientPorts
from robobt.league.serve.publishing import GEOMETRY_INTERVAL
from robobt.league.serve.served_field import ServedField
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.messages import GameEvent
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.league.wire.sockets import LOOPBACK_ADDRESS, Sender
from robobt.league.wire.tracker import SOURCE, write_tracked
from robobt.league.wire.vision import CameraFrame, write_vision
from robobt.match.referee.referee import Referee
from robobt.match.referee.settings import RefereeSettings
from robobt.signals import check, uninterrupted
from robobt.world.delay import MeasuredDelay
from robobt.world.game import Team
from robobt.world.state import RobotId

_REPEAT = 6
"""Frames from one referee message to the next while nothing changes."""


class ServedReferee:
    """Referees a served field and puts the ball down for restarts."""

    def __init__(self, field: ServedField, settings: RefereeSettings) -> None:
        self.referee = Referee(field.field, settings)
        self._field = field
        self._publisher = RefereePublisher({team: settings.keeper(team).number for team in Team})
        self._frames = 0
        self._events: list[GameEvent] = []

    def judge(self, timestamp: float) -> bytes | None:
        """Judge the field after a step; return the message if one is due."""
        before = self.referee.game
        truth = self._field.truth()
        decision = self.referee.update(truth)
        # The state lists the events still to be sent, the newest last.
        epoch = timestamp - truth.time
        self._events += [write_event(event, epoch, SOURCE) for event in decision.events]
        del self._events[: -len(decision.game.events) or None]
        if decision.place_ball is not None:
            self._field.place_ball(*decision.place_ball)
        due = decision.game != before or self._frames % _REPEAT == 0
        self._frames += 1
        return self._publisher.write(decision.game, timestamp, self._events) if due else None


Clock = Literal["sim", "unix"]
"""What timestamps count from: the start of the simulation, as grSim's, or 1970."""


class SimServer(Closing):
    """Serves a field over the league's protocols.

    Args:
        field: what is simulated.
        endpoints: where to send and to listen.
        interface: own address of the interface to use: the loopback unless named.
        cameras: how many share the field.
        speed: simulated time over real time; clients may change it.
        seed: of the cameras' noise.
        epoch: Unix time of the start, for what has Unix time always: the referee's messages and logs [s].
        log: also receives everything that is sent.
        referee: settings of the referee, whose decisions are published; None plays without one.
        clock: of the timestamps of vision and tracked frames. They advance with the simulated time
            exactly, however busy this machine is.

    Attributes:
        endpoints: as above, with the ports that were picked for 0.
        counts: what happened to the packets, by port.
        frames: how many were made; the last may still wait to be sent.
        kept: share of its speed that the field has kept.
        referee: the referee, None without one.
        ports: where clients command the field.

    Raises:
        OSError: a port is taken, or no interface has the address.
        ValueError: an argument is out of range.
    """

    def __init__(
        self,
        field: ServedField,
        endpoints: Endpoints | None = None,
        interface: str = LOOPBACK_ADDRESS,
        cameras: int = 1,
        speed: float = 1.0,
        seed: int = 0,
        epoch: float = 0.0,
        log: LogWriter | None = None,
        referee: RefereeSettings | None = None,
        clock: Clock = "sim",
    ) -> None:
        self.field = field
        self.frames = 0
        self.kept = 1.0
        self.referee = None if referee is None else ServedReferee(field, referee)
        self._epoch, self._log = epoch, log
        self._stamped_from = epoch if clock == "unix" else 0.0
        rng = np.random.default_rng(seed)
        settings = field.settings
        self._cameras = Cameras(field.field, settings.realism, cameras, rng, field.period, settings.body.face)
        self._uuid = str(UUID(bytes=rng.bytes(16), version=4))
        to = endpoints or Endpoints()
        with ExitStack() as opened:
            self._vision = opened.enter_context(Sender(*to.vision, interface))
            self._tracker = opened.enter_context(Sender(*to.tracker, interface))
            self._controller = opened.enter_context(Sender(*to.referee, interface))
            self.ports = ClientPorts(field, self._cameras, to, interface, speed)
            opened.callback(self.ports.close)
            self._opened = opened.pop_all()
        self.endpoints, self.counts = self.ports.endpoints, self.ports.counts
        self._kinds = {
            self._vision: LogKind.VISION,
            self._tracker: LogKind.TRACKER,
            self._controller: LogKind.REFEREE,
        }
        # Packets on their way: when they are due, their order, sender and data.
        self._outbox: list[tuple[float, int, Sender, bytes]] = []
        self._order = count()
        self._pictured = -1.0

    @property
    def speed(self) -> float:
        """Simulated time over real time."""
        return self.ports.speed

    def run(
        self,
        seconds: float | None = None,
        on_step: Callable[[ServedField], None] | None = None,
        stop: Callable[[], bool] | None = None,
        on_slow: Callable[[float], None] | None = None,
    ) -> None:
        """Serve in real time, scaled by ``speed``, until interrupted or for a while.

        Args:
            seconds: of this machine's clock [s].
            on_step: called after every step.
            stop: called after every step; True ends it.
            on_slow: called with the share of its speed that the field kept in the last
                seconds, where this machine is too busy for it.
        """
        began = clocks.monotonic()
        pace = ServingPace(began, self.field.time)
        speed = self.speed
        while True:
            check()
            now = clocks.monotonic()
            if seconds is not None and now - began >= seconds:
                return
            pace.advance(now, speed)
            speed = self.speed
            pace.reached(self.field.time, self.field.period)
            self.kept = pace.kept
            if pace.due >= self.field.time + self.field.period:
                self.receive()
                self.step()
                slow = pace.slow()
                if slow is not None and on_slow is not None:
                    on_slow(slow)
                if on_step is not None:
                    on_step(self.field)
                if stop is not None and stop():
                    return
            self.send_due(pace.due)
            due = self.field.time + self.field.period
            if self._outbox:
                due = min(due, self._outbox[0][0])
            left = (due - pace.due) / speed + now - clocks.monotonic()
            if left > 0.0 and select.select(self.ports.receivers, [], [], left)[0]:
                self.receive()

    def receive(self) -> None:
        """Process the waiting packets; a flood of them not all at once."""
        self.ports.receive()

    def step(self) -> list[CameraFrame]:
        """Simulate one period, queue what the cameras then see, and return it."""
        field = self.field
        field.step()
        self.frames += 1
        now, stamped = field.time, self._stamped_from + field.time
        realism = self._cameras.realism
        delay, admitted = realism.vision_delay, realism.processing_time
        sent = now + delay
        truth = field.truth()
        field.trips.stepped(now, truth.robots())
        captured = stamped if admitted is None else stamped + delay - admitted
        frames = self._cameras.capture(truth, captured, stamped + delay)
        geometry = None
        if self.frames % GEOMETRY_INTERVAL == 1:
            geometry = write_geometry(
                field.field, list(self._cameras.calibrated.values()), field.settings.ball
            )
        for frame in frames:
            self._post(sent, self._vision, write_vision(frame, geometry))
            geometry = None
        tracked = write_tracked(truth, self.frames, stamped, self._uuid)
        self._post(now, self._tracker, tracked)
        self.ports.report_status()
        message = None if self.referee is None else self.referee.judge(self._epoch + now)
        if message is not None:
            self._send(now, self._controller, message)
        return frames

    def look(self) -> list[CameraFrame]:
        """Return what the cameras see now, without time passing."""
        stamped = self._stamped_from + self.field.time
        return self._cameras.capture(self.field.truth(), stamped, stamped)

    def send_due(self, time: float) -> None:
        """Send what is due at a simulated time [s]."""
        while self._outbox and self._outbox[0][0] <= time + 1e-9:
            due, _, sender, data = heapq.heappop(self._outbox)
            self._send(due, sender, data)
            if sender is self._vision and due > self._pictured:
                # The pictures of several cameras, of one instant, are one.
                self._pictured = due
                self.field.trips.picture_sent()

    def close(self) -> None:
        """Release all ports."""
        self._opened.close()

    def delays(self) -> dict[RobotId, MeasuredDelay | None]:
        """Return each commanded robot's delay, from a command's coming until a picture shows its effect.

        It is None for a robot that was not seen enough.
        """
        return self.field.trips.delays(self._cameras.realism.vision_delay)

    def _send(self, due: float, sender: Sender, data: bytes) -> None:
        with uninterrupted:
            sender.send(data)
            if self._log is not None:
                self._log.write(round((self._epoch + due) * 1e9), self._kinds[sender], data)

    def _post(self, due: float, sender: Sender, data: bytes) -> None:
        heapq.heappush(self._outbox, (due, next(self._order), sender, data))
