"""Plays go over the network as they do in process."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import pytest

from robobt.league.serve.served_field import served_scenario
from robobt.league.serve.server import SimServer
from robobt.league.wire.endpoints import Endpoints
from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.match.results.results import MatchResult
from robobt.match.runner import trial_seed
from robobt.match.scenario.scenario import Scenario
from robobt.sim import settings_from
from robobt.statistics import wilson_interval
from robobt.world.state import RobotId
from robobt.worlds import sim_world
from tests.league.lockstep import LockstepWorld
from tests.league.served import free_endpoints

pytestmark = pytest.mark.integration

TRIALS = 100


def over_the_network(
    scenario: Scenario, trials: int, on_kick: Callable[[RobotId], None] | None = None
) -> list[MatchResult]:
    """Play trials against a server; ``on_kick`` is called when a robot kicks there."""
    settings = settings_from(scenario.simulator)
    robots = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    endpoints: Endpoints = free_endpoints()
    with (
        SimServer(served_scenario(scenario), endpoints) as server,
        LockstepWorld(
            server,
            field=scenario.field,
            robots=robots,
            settings=settings,
            period=scenario.period,
            simulator="grsim",
            endpoints=endpoints,
        ) as world,
    ):
        if on_kick is not None:
            server.step = _telling(server, on_kick)  # type: ignore[method-assign]
        return [
            MatchLoop(scenario, trial_seed(scenario.seed, n), lambda _: world).play() for n in range(trials)
        ]


def _telling(server: SimServer, on_kick: Callable[[RobotId], None]) -> Callable[[], None]:
    step = server.step

    def stepped() -> None:
        step()
        for robot in server.field.kicked:
            on_kick(robot)

    return stepped


@pytest.mark.parametrize("name", ["striker_vs_goalkeeper", "table4_trial2_own"])
def test_kicks_are_counted_as_they_were_made(name: str) -> None:
    made: Counter[str] = Counter()
    results = over_the_network(load_scenario(name), 3, lambda robot: made.update([str(robot)]))
    counted: Counter[str] = Counter()
    for result in results:
        counted.update({robot: figures.kicks for robot, figures in result.robots.items()})
        if result.outcome.startswith("goal"):
            assert sum(figures.kicks for figures in result.robots.values()) > 0
    assert made.total() > 2
    assert +counted == made


@pytest.mark.slow
def test_the_attack_scores_as_often_over_the_network_as_in_process() -> None:
    scenario = load_scenario("attack_vs_goalkeeper_motion_full").model_copy(update={"period": 1 / 60})
    here = [MatchLoop(scenario, trial_seed(scenario.seed, n), sim_world).play() for n in range(TRIALS)]
    there = over_the_network(scenario, TRIALS)
    for outcome in ("goal_blue", "saved"):
        one, other = (
            wilson_interval(sum(result.outcome == outcome for result in results), TRIALS)
            for results in (here, there)
        )
        assert one.low <= other.high
        assert other.low <= one.high
    # Every shot is seen to be one.
    assert sum(result.robots["blue 0"].kicks >= 1 for result in there) >= TRIALS - 1
