"""How robots of a simulator are commanded: over grSim's packets or the simulation protocol."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Protocol

from robobt.league.wire.commands import (
    BallTeleport,
    Teleport,
    read_feedback,
    read_status,
    write_control,
    write_grsim,
    write_grsim_placement,
    write_teleport,
)
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.sockets import LOOPBACK, PacketCounts, Receiver, Sender
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId

_log = logging.getLogger(__name__)

_KEEP_ALIVE = 0.25
"""How often grSim's control ports get an empty message; it stops robots after a second without [s]."""


class Link(Protocol):
    """A way to command robots.

    Attributes:
        places: whether robots and ball can be put somewhere.
    """

    places: bool

    def send(self, commands: Mapping[RobotId, RobotCommand], time: float) -> None:
        """Send the robots their commands."""

    def place(self, robots: Iterable[Teleport], ball: BallTeleport | None) -> None:
        """Put robots and ball somewhere."""

    def feedback(self) -> Iterator[tuple[RobotId, bool]]:
        """What robots have told since the last call: whether the ball lies in the mouth."""

    def counts(self) -> dict[str, PacketCounts]:
        """What became of the packets that came back, by port."""

    def close(self) -> None:
        """Free all ports."""


class GrSimLink:
    """Commands and replacements to grSim's own port, and what keeps its robots moving.

    grSim zeroes the blue robots after every frame unless something arrives on
    its yellow control port each second, and the yellow ones likewise; commands
    on its own port do not count. Both ports therefore get empty messages.
    """

    places = True

    def __init__(self, host: str, endpoints: Endpoints, interface: str | None) -> None:
        own = LOOPBACK if interface is None else interface
        self._commands = Sender(host, endpoints.grsim)
        self._alive = [Sender(host, endpoints.blue), Sender(host, endpoints.yellow)]
        self._alive_at = -math.inf
        self._status: dict[Team, Receiver] = {}
        ports = {Team.BLUE: endpoints.blue_status, Team.YELLOW: endpoints.yellow_status}
        for team, port in ports.items():
            try:
                self._status[team] = Receiver(own, port, interface)
            except OSError as error:
                # Another program has it: who has the ball is then told from what is seen.
                _log.warning("%s", error)

    def send(self, commands: Mapping[RobotId, RobotCommand], time: float) -> None:
        """See :class:`Link`."""
        for team, of_team in by_team(commands).items():
            self._commands.send(write_grsim(team, of_team, time))
        if not time - self._alive_at < _KEEP_ALIVE:
            self._alive_at = time
            empty = write_control({})
            for sender in self._alive:
                sender.send(empty)

    def place(self, robots: Iterable[Teleport], ball: BallTeleport | None) -> None:
        """See :class:`Link`."""
        self._commands.send(write_grsim_placement(robots, ball))

    def feedback(self) -> Iterator[tuple[RobotId, bool]]:
        """See :class:`Link`."""
        for sender in self._alive:
            for _ in sender.answers():
                pass
        for team, receiver in self._status.items():
            for packet in receiver.receive():
                for number, contact in read_status(packet.data, receiver.counts).items():
                    yield RobotId(team, number), contact

    def counts(self) -> dict[str, PacketCounts]:
        """See :class:`Link`."""
        return {f"{team.value}_status": receiver.counts for team, receiver in self._status.items()}

    def close(self) -> None:
        """See :class:`Link`."""
        sockets: list[Sender | Receiver] = [self._commands, *self._alive, *self._status.values()]
        for socket in sockets:
            socket.close()


class ProtocolLink:
    """The simulation protocol: a control port a team, and one for teleports.

    A team without commands gets empty messages, for grSim's sake; see :class:`GrSimLink`.
    """

    places = True

    def __init__(self, host: str, endpoints: Endpoints) -> None:
        self._control = Sender(host, endpoints.control)
        self._teams = {
            Team.BLUE: Sender(host, endpoints.blue),
            Team.YELLOW: Sender(host, endpoints.yellow),
        }
        self._counts = {team: PacketCounts() for team in Team}
        self._alive_at = -math.inf

    def send(self, commands: Mapping[RobotId, RobotCommand], time: float) -> None:
        """See :class:`Link`."""
        teams = by_team(commands)
        silent = not time - self._alive_at < _KEEP_ALIVE
        if silent:
            self._alive_at = time
        for team, sender in self._teams.items():
            if team in teams or silent:
                sender.send(write_control(teams.get(team, {})))

    def place(self, robots: Iterable[Teleport], ball: BallTeleport | None) -> None:
        """See :class:`Link`."""
        self._control.send(write_teleport(robots, ball))

    def feedback(self) -> Iterator[tuple[RobotId, bool]]:
        """See :class:`Link`."""
        for _ in self._control.answers():
            pass
        for team, sender in self._teams.items():
            for data in sender.answers():
                for number, contact in read_feedback(data, self._counts[team]).items():
                    yield RobotId(team, number), contact

    def counts(self) -> dict[str, PacketCounts]:
        """See :class:`Link`."""
        return {f"{team.value}_feedback": counts for team, counts in self._counts.items()}

    def close(self) -> None:
        """See :class:`Link`."""
        for socket in (self._control, *self._teams.values()):
            socket.close()


class NoLink:
    """Nobody is commanded: for whoever only watches."""

    places = False

    def send(self, commands: Mapping[RobotId, RobotCommand], time: float) -> None:
        """See :class:`Link`; nothing is sent."""

    def place(self, robots: Iterable[Teleport], ball: BallTeleport | None) -> None:
        """See :class:`Link`; nothing is sent."""

    def feedback(self) -> Iterator[tuple[RobotId, bool]]:
        """See :class:`Link`; nothing is told."""
        yield from ()

    def counts(self) -> dict[str, PacketCounts]:
        """See :class:`Link`."""
        return {}

    def close(self) -> None:
        """See :class:`Link`."""


def by_team(commands: Mapping[RobotId, RobotCommand]) -> dict[Team, dict[int, RobotCommand]]:
    """The commands by team and number, without teams that have none."""
    teams: dict[Team, dict[int, RobotCommand]] = {}
    for robot, command in commands.items():
        teams.setdefault(robot.team, {})[robot.number] = command
    return teams
