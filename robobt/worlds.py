"""World factories: from a scenario to the world it is played in.

Above ``match``, which knows no world, and ``sim``, which knows no scenario.
"""

from __future__ import annotations

from pydantic import ValidationError

from robobt.match.loop import WorldFactory
from robobt.match.problems import first_problem, message_of
from robobt.match.scenario import Scenario
from robobt.sim import SimSettings, SimWorld, settings_from


def sim_world(scenario: Scenario) -> SimWorld:
    """The scenario's field and robots in the built-in simulator.

    Raises:
        ScenarioError: the simulator's settings in the scenario are wrong.
    """
    try:
        settings = settings_from(scenario.simulator)
    except ValidationError as error:
        field, problem = first_problem(error, SimSettings, scenario.simulator)
        raise scenario.error(problem, f"simulator.{field}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise scenario.error(message_of(error), "simulator") from error
    limits = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    return SimWorld(scenario.field, limits, settings, scenario.period)


SIM = "sim"
"""The name of the built-in simulator as a world."""


def world_from(address: str) -> WorldFactory:
    """What makes the worlds of an address: "sim", or one of the league like ``league://grsim``.

    The league's options are told by :func:`robobt.league.factory.parse_address`.

    Raises:
        robobt.league.factory.AddressError: it is neither.
    """
    if address == SIM:
        return sim_world
    from robobt.league.factory import LeagueFactory  # protobuf and sockets, for those who play over a network

    return LeagueFactory(address)
