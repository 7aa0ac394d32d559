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
    """The scenario's field and robots in the built-in simulator.

    Where its vision or commands are late and the scenario does not say otherwise, the
    frames are brought up to now (:class:`~robobt.world.prediction.PredictedWorld`).

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
    world = SimWorld(scenario.field, limits, settings, scenario.period)
    realism = settings.realism
    if not scenario.predict or realism.vision_delay + realism.command_delay == 0.0:
        return world
    return PredictedWorld(
        world, realism.vision_delay, realism.command_delay, gaps=realism.missing_robot > 0.0
    )


SIM = "sim"
"""The name of the built-in simulator as a world."""


def world_from(address: str) -> WorldFactory:
    """What makes the worlds of an address: "sim", one of the league like ``league://grsim``, or a league log.

    The league's options are told by :func:`robobt.league.factory.parse_address`.
    A log (``*.log``, ``*.log.gz``) is only observed.

    Raises:
        robobt.league.factory.AddressError: it is none of them.
    """
    if address == SIM:
        return sim_world
    if address.lower().endswith((".log", ".log.gz")) and "://" not in address:
        from robobt.league.log.world import LogFactory

        return LogFactory(address)
    from robobt.league.factory import LeagueFactory  # protobuf and sockets, for those who play over a network

    return LeagueFactory(address)
