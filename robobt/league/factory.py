"""Worlds of the league by address: ``league://grsim``, ``league://protocol?host=...``."""

from __future__ import annotations

from typing import Any
from urllib.parse import parse_qsl, urlsplit

from pydantic import ValidationError

from robobt.config.errors import ConfigError, message_of
from robobt.config.validation import first_problem
from robobt.league.wire.endpoints import Endpoints, parse_endpoint
from robobt.league.world import Connection, LeagueWorld
from robobt.match.scenario.scenario import Scenario
from robobt.sim.settings import PRESETS, SimSettings, settings_from

SCHEME = "league://"

_OPTIONS = (
    "host",
    "interface",
    "source",
    "teams",
    "blue_on_positive_half",
    "follow_referee",
    "latency",
    "speed",
    "physics",
)
_ADDRESSES = ("vision", "tracker", "referee")
_PORTS = ("grsim", "blue_status", "yellow_status", "control", "blue", "yellow")


class AddressError(ConfigError):
    """An address that names no world; the file is the address, the field one of its options."""


def parse_address(address: str) -> tuple[Connection, str | None]:
    """The connection an address describes, and the preset of the physics there if it names one.

    ``league://SIMULATOR?name=value&...`` with the simulator "grsim",
    "protocol" or "observer" and as names host, interface, source, teams (blue, yellow or
    both), blue_on_positive_half, follow_referee, latency, speed, physics; vision,
    tracker and referee (ADDRESS:PORT); and the ports grsim, blue_status,
    yellow_status, control, blue and yellow.

    Raises:
        AddressError: it is none.
    """
    if not address.startswith(SCHEME):
        raise AddressError(address, f"a world of the league is {SCHEME}SIMULATOR")
    try:
        parts = urlsplit(address)
        given = dict(parse_qsl(parts.query, keep_blank_values=True, strict_parsing=bool(parts.query)))
    except ValueError as error:
        raise AddressError(address, message_of(error)) from error
    known = (*_OPTIONS, *_ADDRESSES, *_PORTS)
    for name in given:
        if name not in known:
            raise AddressError(address, f"there is no option {name!r}; there are {', '.join(known)}")
    physics = given.pop("physics", None)
    if physics is not None and physics not in PRESETS:
        problem = f"no preset is called {physics!r}; there are {', '.join(PRESETS)}"
        raise AddressError(address, problem, "physics")
    endpoints: dict[str, Any] = {name: given.pop(name) for name in _PORTS if name in given}
    for name in _ADDRESSES:
        if name in given:
            try:
                endpoints[name] = parse_endpoint(given.pop(name))
            except ValueError as error:
                raise AddressError(address, message_of(error), name) from error
    options: dict[str, Any] = {"simulator": parts.netloc, **given}
    if "teams" in options:
        teams = options["teams"]
        options["teams"] = ("blue", "yellow") if teams == "both" else (teams,)
    try:
        options["endpoints"] = Endpoints.model_validate(endpoints)
        return Connection.model_validate(options), physics
    except ValidationError as error:
        field, problem = first_problem(error, Connection)
        raise AddressError(address, problem, field) from error


class LeagueFactory:
    """Makes the world of each match on one connection; the one before is closed first.

    Args:
        address: see :func:`parse_address`.

    Raises:
        AddressError: the address is none.
    """

    def __init__(self, address: str) -> None:
        self._connection, self._physics = parse_address(address)
        self._world: LeagueWorld | None = None

    def __call__(self, scenario: Scenario) -> LeagueWorld:
        """The scenario's robots on the field at the other end.

        Raises:
            ScenarioError: the simulator's settings in the scenario are wrong.
        """
        self.close()
        settings = _settings(scenario, self._physics)
        robots = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
        self._world = LeagueWorld(scenario.field, robots, settings, scenario.period, self._connection)
        return self._world

    def close(self) -> None:
        """Let go of the robots."""
        if self._world is not None:
            self._world.close()
            self._world = None


def _settings(scenario: Scenario, physics: str | None) -> SimSettings:
    """The physics that are expected: as the address says, or as the scenario does."""
    if physics is not None:
        return settings_from(physics)
    try:
        return settings_from(scenario.simulator)
    except ValidationError as error:
        field, problem = first_problem(error, SimSettings, scenario.simulator)
        raise scenario.error(problem, f"simulator.{field}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise scenario.error(message_of(error), "simulator") from error
