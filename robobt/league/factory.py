"""Worlds of the league by address: ``league://grsim``, ``league://protocol?host=...``."""

from __future__ import annotations

from collections.abc import Callable
from urllib.parse import parse_qsl, urlsplit

from pydantic import ValidationError

from robobt.config.errors import ConfigError, message_of
from robobt.config.validation import first_problem
from robobt.league.connection import Connection
from robobt.league.known_field import KnownField
from robobt.league.wire.endpoints import Endpoints
from robobt.league.world import LeagueWorld
from robobt.match.scenario.scenario import Scenario
from robobt.sim.settings import PRESETS, SimSettings
from robobt.world.game import Team

SCHEME = "league://"

_OPTIONS = [name for name in Connection.model_fields if name not in ("simulator", "endpoints")]
_PHYSICS = {"grsim": "grsim"}
"""Presets for simulators with fixed robots: these limits replace the scenario's."""

_KNOWN_OPTIONS = [*_OPTIONS, "physics", *Endpoints.model_fields]


class AddressError(ConfigError):
    """An address that names no world; the file is the address, the field one of its options."""


def parse_address(address: str) -> tuple[Connection, str | None]:
    """Return the connection of an address, and the preset of the physics there if it names one.

    The form is ``league://SIMULATOR?name=value&...`` with "grsim", "protocol", "steps" or
    "observer" as the simulator. The names are the fields of :class:`Connection`, "physics", and the
    fields of :class:`Endpoints` (ADDRESS:PORT or a port); teams is blue, yellow or both.

    Raises:
        AddressError: the address has another form, or a value is wrong.
    """
    if not address.startswith(SCHEME):
        raise AddressError(address, f"a world of the league is {SCHEME}SIMULATOR")
    try:
        parts = urlsplit(address)
        named = parse_qsl(parts.query, keep_blank_values=True, strict_parsing=bool(parts.query))
    except ValueError as error:
        raise AddressError(address, message_of(error)) from error
    given: dict[str, str] = {}
    for name, value in named:
        if name in given:
            raise AddressError(address, "is given twice", name)
        given[name] = value
        if name not in _KNOWN_OPTIONS:
            raise AddressError(address, f"there is no option {name!r}; there are {', '.join(_KNOWN_OPTIONS)}")
    physics = given.pop("physics", None)
    if physics is not None and physics not in PRESETS:
        problem = f"no preset is called {physics!r}; there are {', '.join(PRESETS)}"
        raise AddressError(address, problem, "physics")
    endpoints = {name: given.pop(name) for name in Endpoints.model_fields if name in given}
    options: dict[str, object] = {"simulator": parts.netloc, "endpoints": endpoints, **given}
    if given.get("teams", "both") not in ("both", *Team):
        raise AddressError(address, f"is blue, yellow or both, not {given['teams']!r}", "teams")
    if "teams" in given:
        options["teams"] = ["blue", "yellow"] if given["teams"] == "both" else [given["teams"]]
    try:
        return Connection.model_validate(options), physics
    except ValidationError as error:
        field, problem = first_problem(error, Connection)
        raise AddressError(address, problem, field.removeprefix("endpoints.")) from error


class LeagueFactory:
    """Makes the world of each match on one connection, after closing the previous one.

    Args:
        address: see :func:`parse_address`.
        settings: returns the settings of a scenario's simulator, with the preset of the physics there
            in place of its own if one is given.

    Attributes:
        address: the address as given, which is stored with results.
    """

    def __init__(self, address: str, settings: Callable[[Scenario, str | None], SimSettings]) -> None:
        self.address = address
        self._connection, physics = parse_address(address)
        self._physics = physics or _PHYSICS.get(self._connection.simulator)
        self._settings = settings
        self._known = KnownField(self._connection.speed)
        self._world: LeagueWorld | None = None

    def __call__(self, scenario: Scenario) -> LeagueWorld:
        """Return the world with the scenario's robots."""
        self.close()
        settings = self._settings(scenario, self._physics)
        robots = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
        self._world = LeagueWorld(
            scenario.field, robots, settings, scenario.period, self._connection, known=self._known
        )
        return self._world

    def close(self) -> None:
        """Stop the robots and release all ports."""
        if self._world is not None:
            self._world.close()
            self._world = None
