"""Plays go over the network as they do in process."""

from __future__ import annotations

import pytest

from robobt.league.serve.server import SimServer
from robobt.league.serve.serving import served_scenario
from robobt.league.wire.endpoints import Endpoints
from robobt.match import load_scenario
from robobt.match.loop import play_match
from robobt.match.results.results import MatchResult
from robobt.match.runner import trial_seed
from robobt.match.scenario.scenario import Scenario
from robobt.sim import settings_from
from robobt.statistics import wilson_interval
from robobt.worlds import sim_world
from tests.league.lockstep import LockstepWorld
from tests.league.served import free_endpoints

TRIALS = 100


def over_the_network(scenario: Scenario, trials: int) -> list[MatchResult]:
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
        return [play_match(scenario, trial_seed(scenario.seed, n), lambda _: world) for n in range(trials)]


@pytest.mark.slow
def test_the_attack_scores_as_often_over_the_network_as_in_process() -> None:
    scenario = load_scenario("attack_vs_goalkeeper_motion_full").model_copy(update={"period": 1 / 60})
    here = [play_match(scenario, trial_seed(scenario.seed, n), sim_world) for n in range(TRIALS)]
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
