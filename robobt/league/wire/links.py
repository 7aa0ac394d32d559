"""Links that command the robots of a simulator: grSim's packets or the simulation protocol."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping

from robobt.league.wire.commands import BallTeleport, Teleport
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.grsim import read_status, write_grsim, write_grsim_replacement
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.simulation import read_feedback, write_control, write_teleport
from robobt.league.wire.sockets import LOOPBACK_ADDRESS, Receiver, Sender
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId

_log = logging.getLogger(__name__)

_KEEP_ALIVE = 0.25
"""Interval of the empty messages to grSim's control ports, which stops robots after a second without [s]."""


class Link:
    """A link that commands robots; this base class commands none, for a world that only observes.

    Attributes:
        active: whether robots can be commanded, and robots and ball be placed.
        clock: the only clock of a world that lets time pass by this link; None where time passes by itself.
        counts: what happened to the packets that came back, by port.
    """

    active = False
    clock: Callable[[], float] | None = None

    def __init__(self) -> None:
        self.counts: dict[str, PacketCounts] = {}

    def send(self, commands: Mapping[RobotId, RobotCommand], time: float) -> None:
        """Send the robots their commands."""

    def place(self, robots: Iterable[Teleport], ball: BallTeleport | None) -> None:
        """Teleport robots and ball."""

    def feedback(self) -> Iterator[tuple[RobotId, bool]]:
        """Yield what the robots' break-beam sensors have reported since the last call."""
        yield from ()

    def close(self) -> None:
        """Release all ports."""


class _SimulatorLink(Link):
    """The control ports that every simulator has, one for each team."""

    active = True

    def __init__(self, host: str, endpoints: Endpoints) -> None:
        super().__init__()
        self._teams = {Team.BLUE: Sender(host, endpoints.blue), Team.YELLOW: Sender(host, endpoints.yellow)}
        self._sockets: list[Sender | Receiver] = list(self._teams.values())
        self._alive_at = -math.inf

    def close(self) -> None:
        """Release all ports."""
        for socket in self._sockets:
            socket.close()

    def _sender(self, host: str, port: int) -> Sender:
        sender = Sender(host, port)
        self._sockets.append(sender)
        return sender

    def _keep_alive(self, time: float) -> bool:
        """Return whether teams without commands are due for an empty message."""
        due = not time - self._alive_at < _KEEP_ALIVE
        if due:
            self._alive_at = time
        return due


class GrSimLink(_SimulatorLink):
    """Commands and replacements to grSim's own port, with keep-alives to the control ports.

    grSim stops the blue robots after every frame unless something arrives on its yellow control port every
    second, and the yellow robots unless something arrives on its blue one; commands on its own port do not
    count.
    """

    def __init__(
        self, host: str, endpoints: Endpoints, interface: str | None, teams: Collection[Team] = tuple(Team)
    ) -> None:
        super().__init__(host, endpoints)
        self._commands = self._sender(host, endpoints.grsim)
        self._status: dict[Team, Receiver] = {}
        ports = {Team.BLUE: endpoints.blue_status, Team.YELLOW: endpoints.yellow_status}
        for team, port in ports.items():
            try:
                receiver = Receiver(interface or LOOPBACK_ADDRESS, port, interface)
            except OSError as error:
                # Ball contact is then inferred from the vision.
                if team in teams:
                    _log.warning(
                        "%s: another program receives there, perhaps a second player; ball contact of %s "
                        "robots is estimated",
                        error,
                        team.value,
                    )
                continue
            self._status[team] = receiver
            self._sockets.append(receiver)
            self.counts[f"{team.value}_status"] = receiver.counts

    def send(self, commands: Mapping[RobotId, RobotCommand], time: float) -> None:
        """Send the robots their commands."""
        for team, of_team in by_team(commands).items():
            self._commands.send(write_grsim(team, of_team, time))
        if self._keep_alive(time):
            for sender in self._teams.values():
                sender.send(write_control({}))

    def place(self, robots: Iterable[Teleport], ball: BallTeleport | None) -> None:
        """Teleport robots and ball."""
        self._commands.send(write_grsim_replacement(robots, ball))

    def feedback(self) -> Iterator[tuple[RobotId, bool]]:
        """Yield what the robots' break-beam sensors have reported since the last call."""
        for sender in self._teams.values():
            for _ in sender.answers():
                pass  # answers to the keep-alives
        for team, receiver in self._status.items():
            for packet in receiver.receive():
                for number, contact in read_status(packet.data, receiver.counts).items():
                    yield RobotId(team, number), contact


class ProtocolLink(_SimulatorLink):
    """The simulation protocol: a control port for each team, and one for teleports.

    A team without commands gets keep-alives, for grSim's sake; see :class:`GrSimLink`.
    """

    def __init__(self, host: str, endpoints: Endpoints) -> None:
        super().__init__(host, endpoints)
        self._control = self._sender(host, endpoints.control)
        self.counts = {f"{team.value}_feedback": PacketCounts() for team in Team}

    def send(self, commands: Mapping[RobotId, RobotCommand], time: float) -> None:
        """Send the robots their commands."""
        teams, keep_alive = by_team(commands), self._keep_alive(time)
        for team, sender in self._teams.items():
            if team in teams or keep_alive:
                sender.send(write_control(teams.get(team, {})))

    def place(self, robots: Iterable[Teleport], ball: BallTeleport | None) -> None:
        """Teleport robots and ball."""
        self._control.send(write_teleport(robots, ball))

    def feedback(self) -> Iterator[tuple[RobotId, bool]]:
        """Yield what the robots' break-beam sensors have reported since the last call."""
        for _ in self._control.answers():
            pass  # answers to teleports
        for team, sender in self._teams.items():
            for data in sender.answers():
                for number, contact in read_feedback(data, self.counts[f"{team.value}_feedback"]).items():
                    yield RobotId(team, number), contact


def by_team(commands: Mapping[RobotId, RobotCommand]) -> dict[Team, dict[int, RobotCommand]]:
    """Return the commands by team and number, without teams that have none."""
    teams: dict[Team, dict[int, RobotCommand]] = {}
    for robot, command in commands.items():
        teams.setdefault(robot.team, {})[robot.number] = command
    return teams
