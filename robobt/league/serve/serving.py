"""Fields to be served: from a scenario, or with teams lined up."""

from __future__ import annotations

import numpy as np

from robobt.league.serve.served_field import ServedField, line_up
from robobt.match.scenario.scenario import Scenario
from robobt.sim.realism import realism_level
from robobt.sim.settings import SimSettings, preset, settings_from
from robobt.world.field import FieldGeometry


def served_scenario(
    scenario: Scenario, simulator: str | None = None, realism: str | None = None
) -> ServedField:
    """Return the field of a scenario, with everything where its seed puts it.

    A preset of the simulator and a level of realism may replace the scenario's.

    Raises:
        KeyError: no such preset or level.
        ScenarioError: there is no place for everything.
        ValueError: the simulator's settings are wrong.
    """
    settings = settings_from(scenario.simulator) if simulator is None else preset(simulator)
    limits = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    placement = scenario.place(np.random.default_rng(scenario.seed))
    return ServedField(scenario.field, placement, _with(settings, realism), limits, scenario.seed)


def served_line_up(
    field: FieldGeometry, robots: int, simulator: str = "grsim", realism: str | None = None, seed: int = 0
) -> ServedField:
    """Return a field with this many robots per team, lined up in their own halves.

    Raises:
        KeyError: no such preset or level.
        ValueError: more robots than a team can have.
    """
    settings = _with(preset(simulator), realism)
    return ServedField(field, line_up(field, robots), settings, seed=seed)


def _with(settings: SimSettings, realism: str | None) -> SimSettings:
    return settings if realism is None else settings.model_copy(update={"realism": realism_level(realism)})
