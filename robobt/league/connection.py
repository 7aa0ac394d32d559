"""How a field of the league is reached."""

from __future__ import annotations

from ipaddress import IPv4Address
from typing import Literal

from pydantic import Field

from robobt.config.errors import RobobtError
from robobt.config.validation import Settings
from robobt.league.wire.endpoints import Endpoints, HostAddress
from robobt.league.wire.links import GrSimLink, Link, ProtocolLink
from robobt.league.wire.sockets import LOOPBACK_ADDRESS
from robobt.league.wire.steps import StepLink
from robobt.world.game import Team


class LeagueError(RobobtError, RuntimeError):
    """The field does not respond as expected; the message is one line."""


class Connection(Settings):
    """How a field of the league is reached. Nothing leaves this machine unless a host is named."""

    simulator: Literal["grsim", "protocol", "steps", "observer"] = Field(
        "grsim",
        description="grSim's packets, the simulation protocol, its steps (lock step), or no commands at all",
    )
    host: HostAddress = Field(LOOPBACK_ADDRESS, description="where the robots are commanded (IPv4 address)")
    interface: HostAddress | None = Field(
        None, description="own address of the interface to listen on; none: this machine's packets only"
    )
    endpoints: Endpoints = Endpoints()
    geometry: Literal["scenario", "seen"] = Field(
        "scenario",
        description="the scenario's field, which the vision's has to equal, or the one that is seen",
    )
    source: Literal["vision", "tracker"] = Field("vision", description="cameras, or a vision filter's frames")
    teams: tuple[Team, ...] = Field(
        (Team.BLUE, Team.YELLOW),
        description="teams whose robots are commanded; other trees' decisions are ignored",
    )
    blue_on_positive_half: bool | None = Field(
        None, description="whether blue defends +x there; none: as the game controller says, else no"
    )
    follow_referee: bool = Field(False, description="whether to follow a game controller")
    ends: bool = Field(
        False, description="whether the scenario's ends apply although a game controller is followed"
    )
    place: bool | None = Field(
        None,
        description="whether robots and ball are placed; none: if both teams are commanded and the robots' "
        "host is this machine",
    )
    latency: float = Field(
        0.0, ge=0, le=0.5, description="latency of the vision beyond what its timestamps show [s]"
    )
    delay: Literal["known", "measured"] = Field(
        "known",
        description="the robots' delay: as the settings of the physics have it, or measured while they play",
    )
    speed: float = Field(1.0, ge=0.05, le=20, description="simulated time over real time")

    @property
    def places(self) -> bool:
        """Whether robots and ball are placed: never on a field with people."""
        if self.place is not None:
            return self.place and self.simulator != "observer"
        local = IPv4Address(self.host).is_loopback or self.host == self.interface
        return self.simulator != "observer" and local and set(self.teams) == set(Team)

    @property
    def where(self) -> str:
        """The name of the commanded field, from its ports."""
        ports = self.endpoints
        return f"{self.host}:{ports.grsim}/{ports.blue}/{ports.yellow}"

    def link(self) -> Link:
        """Return a new link that commands the robots."""
        if self.simulator == "grsim":
            return GrSimLink(self.host, self.endpoints, self.interface, self.teams)
        if self.simulator == "steps":
            return StepLink(self.host, self.endpoints, self.teams)
        return ProtocolLink(self.host, self.endpoints) if self.simulator == "protocol" else Link()
