"""The ports of one match: what its programs see, and where they command their robots."""

from __future__ import annotations

import socket
from collections.abc import Collection, Mapping
from contextlib import ExitStack

from robobt.config.closing import Closing
from robobt.league.programs.program import STREAMS
from robobt.league.wire.endpoints import REFEREE_GROUP, VISION_GROUP
from robobt.league.wire.grsim import read_grsim
from robobt.league.wire.messages import RobotControlResponse
from robobt.league.wire.simulation import read_control
from robobt.league.wire.sockets import LOOPBACK_ADDRESS, Packet, Receiver, Sender
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import Frame, RobotId

_LEAGUE = {"vision": VISION_GROUP, "tracker": VISION_GROUP, "referee": REFEREE_GROUP}

MOST_PACKETS = 50
"""Packets of a team in a control period: each of eleven robots may be commanded four times."""

_TOLERATED = 60 * MOST_PACKETS
"""Packets beyond these that are tolerated, as when many come at once; they are forgotten as slowly."""


class MatchPorts(Closing):
    """Ports that no other match on this machine has. A context manager.

    What is sent goes over the loopback to multicast groups that are this match's alone as well. Every team
    has ports of its own for grSim's packets and the simulation protocol, at which only its own robots can
    be commanded.

    Args:
        teams: whose programs command robots.
        league_groups: what of vision, tracker and referee is sent to the league's group instead.

    Attributes:
        senders: of vision, tracker and referee, by these names.
        flooded: the team that has sent far too many packets, or None.

    Raises:
        OSError: there is no free port.
    """

    def __init__(self, teams: Collection[Team], league_groups: Collection[str] = ()) -> None:
        self.senders: dict[str, Sender] = {}
        self._places: dict[str, str] = {}
        self._receivers: dict[tuple[Team, str], Receiver] = {}
        self._beyond = dict.fromkeys(teams, 0)
        self.flooded: Team | None = None
        with ExitStack() as opened:
            for name in STREAMS:
                port: int = opened.enter_context(_reserved()).getsockname()[1]
                group = _LEAGUE[name] if name in league_groups else _own_group(port)
                self.senders[name] = opened.enter_context(Sender(group, port))
                self._places |= {f"{name}_group": group, f"{name}_port": str(port), name: f"{group}:{port}"}
            for team in teams:
                for kind in ("grsim", "protocol", "control"):
                    self._receivers[team, kind] = opened.enter_context(Receiver(LOOPBACK_ADDRESS, 0))
            self._opened = opened.pop_all()

    def close(self) -> None:
        """Release all ports."""
        self._opened.close()

    def addresses(self, team: Team) -> dict[str, str]:
        """Return the addresses and port numbers for a team's program, by name."""
        own = {kind: str(port.port) for (whose, kind), port in self._receivers.items() if whose is team}
        return {"team": team.value, "host": LOOPBACK_ADDRESS, **self._places, **own}

    def sockets(self) -> list[Receiver]:
        """Return the sockets at which commands arrive, for ``select``."""
        return list(self._receivers.values())

    def period_over(self) -> None:
        """Take note that a control period is over."""
        for team, beyond in self._beyond.items():
            if beyond > _TOLERATED:
                self.flooded = self.flooded or team
            self._beyond[team] = max(0, beyond - MOST_PACKETS)

    def commands(self, truth: Frame) -> dict[Team, dict[RobotId, RobotCommand]]:
        """Return the commands that have come, for teams of which any has.

        Args:
            truth: what is on the field; its headings turn commands in field coordinates.
        """
        found: dict[Team, dict[RobotId, RobotCommand]] = {}
        robots = truth.robots()
        for (team, kind), port in self._receivers.items():
            headings = {robot.number: state.heading for robot, state in robots.items() if robot.team is team}
            for number, packet in enumerate(port.receive()):
                self._beyond[team] += 1
                if number >= MOST_PACKETS:
                    # Who floods its own port must not delay the match.
                    continue
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
        return found


def _answer(port: Receiver, packet: Packet, commanded: Mapping[RobotId, object], truth: Frame) -> None:
    """Tell which of the commanded robots have the ball, as the simulation protocol does."""
    robots, response = truth.robots(), RobotControlResponse()
    for robot in commanded:
        if robot in robots:
            response.feedback.add(id=robot.number, dribbler_ball_contact=robots[robot].ball_contact)
    port.answer(response.SerializeToString(), packet.sender)


def _own_group(port: int) -> str:
    """Return the group of a port that only one match on this machine has, in the local scope (RFC 2365)."""
    return f"239.255.{port >> 8}.{port & 255}"


def _reserved() -> socket.socket:
    """Return a socket that reserves a free port of the loopback against other requests for one.

    The port's number is for a multicast group, which receivers may share.
    """
    holder = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        holder.bind((LOOPBACK_ADDRESS, 0))
        # Set only now, so that it does not share another match's port; a program bound to all addresses still
        # may.
        holder.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    except OSError:
        holder.close()
        raise
    return holder
