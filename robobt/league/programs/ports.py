"""The ports of one match: what its programs see, and where they command their robots."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterable, Mapping
from contextlib import ExitStack
from typing import Self

from robobt.league.wire.endpoints import REFEREE_GROUP, VISION_GROUP
from robobt.league.wire.grsim import read_grsim
from robobt.league.wire.messages import RobotControlResponse
from robobt.league.wire.simulation import read_control
from robobt.league.wire.sockets import LOOPBACK, Packet, Receiver, Sender
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import Frame, RobotId

_GROUPS = {"vision": VISION_GROUP, "tracker": VISION_GROUP, "referee": REFEREE_GROUP}

_MAX_READING = 0.002
"""How long one port is read at a time, so that who floods its own does not delay the match [s]."""


class MatchPorts:
    """Ports that no other match on this machine has. A context manager.

    What is sent goes to the league's multicast groups over the loopback. Every team has ports of its own
    for grSim's packets and the simulation protocol, at which only its own robots can be commanded.

    Args:
        teams: whose programs command robots.

    Attributes:
        senders: of vision, tracker and referee, by these names.

    Raises:
        OSError: there is no free port.
    """

    def __init__(self, teams: Iterable[Team]) -> None:
        self.senders: dict[str, Sender] = {}
        self._places: dict[str, str] = {}
        self._receivers: dict[tuple[Team, str], Receiver] = {}
        with ExitStack() as opened:
            for name, group in _GROUPS.items():
                port = opened.enter_context(_reserved())
                self.senders[name] = opened.enter_context(Sender(group, port.getsockname()[1]))
                self._places[name] = f"{group}:{port.getsockname()[1]}"
            for team in teams:
                for kind in ("grsim", "protocol", "control"):
                    self._receivers[team, kind] = opened.enter_context(Receiver(LOOPBACK, 0))
            self._opened = opened.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Release all ports."""
        self._opened.close()

    def addresses(self, team: Team) -> dict[str, str]:
        """Return what a team's program is told: addresses and port numbers by their names."""
        own = {kind: str(port.port) for (whose, kind), port in self._receivers.items() if whose is team}
        return {"team": team.value, "host": LOOPBACK, **self._places, **own}

    def sockets(self) -> list[Receiver]:
        """Return the sockets at which commands arrive, for ``select``."""
        return list(self._receivers.values())

    def commands(self, truth: Frame) -> dict[Team, dict[RobotId, RobotCommand]]:
        """Return the commands that have come, for teams of which any has.

        Args:
            truth: what is on the field; its headings turn commands in field coordinates.
        """
        found: dict[Team, dict[RobotId, RobotCommand]] = {}
        robots = truth.robots()
        for (team, kind), port in self._receivers.items():
            end = time.monotonic() + _MAX_READING
            headings = {robot.number: state.heading for robot, state in robots.items() if robot.team is team}
            for packet in port.receive():
                if kind == "grsim":
                    request = read_grsim(packet.data, port.counts)
                elif kind == "protocol":
                    request = read_control(packet.data, team, headings, port.counts)
                else:
                    # Teams do not put robots where they like.
                    request = None
                commands = {} if request is None else request.commands
                own = {robot: one for robot, one in commands.items() if robot.team is team}
                if own:
                    found.setdefault(team, {}).update(own)
                if kind == "protocol":
                    _answer(port, packet, own, truth)
                if time.monotonic() > end:
                    break
        return found


def _answer(port: Receiver, packet: Packet, commanded: Mapping[RobotId, object], truth: Frame) -> None:
    """Tell which of the commanded robots have the ball, as the simulation protocol does."""
    robots, response = truth.robots(), RobotControlResponse()
    for robot in commanded:
        if robot in robots:
            response.feedback.add(id=robot.number, dribbler_ball_contact=robots[robot].ball_contact)
    port.answer(response.SerializeToString(), packet.sender)


def _reserved() -> socket.socket:
    """Return a socket that holds a free port of the loopback: nobody else who asks for one gets it.

    The port's number is for a multicast group, which receivers may share.
    """
    holder = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        holder.bind((LOOPBACK, 0))
        # Only now, lest it shares the port of another match. Who binds to every address may still do so.
        holder.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    except OSError:
        holder.close()
        raise
    return holder
