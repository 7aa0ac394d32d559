"""Over the network each robot's delay is measured, and reckoned with where that is asked for."""

from __future__ import annotations

from functools import cache
from math import hypot
from typing import Any

import numpy as np
import pytest

from robobt.league.known_field import KnownField
from robobt.league.serve.served_field import served_scenario
from robobt.league.serve.server import SimServer
from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.sim import settings_from
from robobt.sim.realism import RealismSettings
from robobt.world.state import RobotId
from tests.league.lockstep import LockstepWorld
from tests.league.served import free_endpoints

pytestmark = pytest.mark.integration

LATE = RealismSettings(
    robot_noise=0.0013, heading_noise=0.01, vision_delay=0.035, processing_time=0.01, command_delay=0.05
)


def played(seconds: float, expected_delay: float = 0.0, **options: Any) -> tuple[LockstepWorld, list[float]]:
    """Play three against three on a late field, of whose commands the world expects a delay [s].

    Return the world, and how far each robot was shown from where the next command found it [m].
    """
    scenario = load_scenario("three_v_three").lasting(seconds)
    settings = settings_from(scenario.simulator)
    realism = settings.realism.model_copy(update={"command_delay": expected_delay})
    settings = settings.model_copy(update={"realism": realism})
    served = served_scenario(scenario)
    late = served.settings.model_copy(update={"realism": LATE})
    served = type(served)(scenario.field, scenario.place(np.random.default_rng(1)), late)
    endpoints = free_endpoints()
    shown: list[tuple[float, dict[RobotId, tuple[float, float]]]] = []
    real: list[tuple[float, dict[RobotId, tuple[float, float]]]] = []
    with (
        SimServer(served, endpoints) as server,
        LockstepWorld(
            server,
            field=scenario.field,
            robots={robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots},
            settings=settings,
            period=scenario.period,
            simulator="protocol",
            endpoints=endpoints,
            **options,
        ) as world,
    ):
        match = MatchLoop(scenario, 1, lambda _: world)
        while match.tick():
            now = served.time
            shown.append((now, {r: (s.x, s.y) for r, s in world.observe().robots().items()}))
            real.append((now, {r: (s.x, s.y) for r, s in served.truth().robots().items()}))
        late_by = LATE.command_delay
        misses = []
        for now, places in shown[len(shown) // 2 :]:
            then = min(real, key=lambda one: abs(one[0] - now - late_by))
            if then[0] >= now + late_by - 0.01:
                misses += [hypot(p[0] - then[1][r][0], p[1] - then[1][r][1]) for r, p in places.items()]
    return world, misses


@cache
def measured() -> tuple[LockstepWorld, list[float]]:
    return played(8.0, delay="measured")


def test_each_delay_is_measured_and_reckoned_with() -> None:
    world, misses = measured()
    for found in world.delays().values():
        assert found is not None
        # Beside what the field delays, commands wait for its next step.
        assert found.seconds == pytest.approx(0.088, abs=0.006)
    _, unaware = played(8.0)
    assert np.median(misses) < 0.2 * np.median(unaware)


def test_what_is_measured_holds_the_delay_that_was_expected() -> None:
    _, misses = measured()
    _, expecting = played(8.0, LATE.command_delay, delay="measured")
    assert np.median(expecting) == pytest.approx(np.median(misses), abs=0.005)


def test_delays_stay_known_from_one_match_to_the_next() -> None:
    known = KnownField()
    world, _ = played(4.0, known=known)
    assert known.delays is not None
    assert set(known.delays.measured()) == set(world.delays())
