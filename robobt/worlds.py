"""World factories: from a scenario to the world it is played in.

Above ``match``, which knows no world, and ``sim``, which knows no scenario.
"""

from __future__ import annotations

from pydantic import ValidationError

from robobt.config.errors import message_of
from robobt.config.validation import first_problem
from robobt.match.loop import WorldFactory
from robobt.match.scenario.scenario import Scenario
from robobt.sim import SimSettings, SimWorld, settings_from
from robobt.world.prediction import PredictedWorld
from robobt.world.protocol import World


def sim_world(scenario: Scenario) -> World:
    """Return the scenario's field and robots in the built-in simulator.

    Where its vision or commands are late and the scenario does not say otherwise, the
    frames are predicted to the present (:class:`~robobt.world.prediction.PredictedWorld`).

    Raises:
        ScenarioError: the simulator's settings in the scenario are wrong.
    """
    settings = scenario_settings(scenario)
    limits = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    world = SimWorld(scenario.field, limits, settings, scenario.period)
    realism = settings.realism
    if not scenario.predict or realism.vision_delay + realism.command_delay == 0.0:
        return world
    return PredictedWorld(
        world, realism.vision_delay, realism.command_delay, gaps=realism.missing_robot > 0.0
    )


def scenario_settings(scenario: Scenario) -> SimSettings:
    """Return the settings of a scenario's simulator.

    Raises:
        ScenarioError: they are wrong.
    """
    try:
        return settings_from(scenario.simulator)
    except ValidationError as error:
        field, problem = first_problem(error, SimSettings, scenario.simulator)
        raise scenario.error(problem, f"simulator.{field}") from error
    except (KeyError, TypeError, ValueError) as error:
        raise scenario.error(message_of(error), "simulator") from error


SIM = "sim"
"""The name of the built-in simulator as a world."""


def world_from(address: str) -> WorldFactory:
    """Return the factory of an address: "sim", one of the league like ``league://grsim``, or a league log.

    For the league's options see :func:`robobt.league.factory.parse_address`.
    A log (``*.log``, ``*.log.gz``) is only observed.

    Raises:
        robobt.league.factory.AddressError: the address names none of them.
    """
    if address == SIM:
        return sim_world
    if address.lower().endswith((".log", ".log.gz")) and "://" not in address:
        from robobt.league.log.world import log_factory

        return log_factory(address)
    # Protobuf and sockets are only needed to play over a network.
    from robobt.league.factory import LeagueFactory

    return LeagueFactory(address, scenario_settings)
