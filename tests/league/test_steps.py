"""A world that lets the field go on itself plays the same match twice, over TCP and on a busy machine."""

from __future__ import annotations

import threading

import pytest

from robobt.league.serve.served_field import served_scenario
from robobt.league.serve.server import SimServer
from robobt.league.serve.synchronous import StepServer
from robobt.league.wire.stream import StreamError
from robobt.league.world import LeagueWorld
from robobt.match import MatchLoop, load_scenario
from robobt.sim import settings_from
from tests.league.served import free_endpoints

pytestmark = pytest.mark.integration


def trace(period: float = 1 / 60) -> tuple[str, int]:
    scenario = load_scenario("striker_vs_goalkeeper").lasting(2.0).model_copy(update={"period": period})
    settings = settings_from(scenario.simulator)
    robots = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    endpoints, over = free_endpoints(), threading.Event()
    with SimServer(served_scenario(scenario), endpoints) as server, StepServer(server) as steps:
        playing = threading.Thread(target=steps.run, args=(None, over.is_set))
        playing.start()
        try:
            there = endpoints.model_copy(update={team: steps.ports[team] for team in ("blue", "yellow")})
            with LeagueWorld(
                scenario.field, robots, settings, scenario.period, simulator="steps", endpoints=there
            ) as world:
                result = MatchLoop(scenario, 1, lambda _: world).play()
        finally:
            over.set()
            playing.join()
    return result.trace, sum(robot.kicks for robot in result.robots.values())


def test_two_matches_over_steps_are_the_same_bit_for_bit() -> None:
    first, second = trace(), trace()
    assert first == second


def test_a_step_that_the_simulator_cannot_make_is_told() -> None:
    with pytest.raises(StreamError, match=r"the simulator makes no step of 0\.025 s: a step is a"):
        trace(0.025)


def test_where_nobody_listens_it_is_told() -> None:
    with pytest.raises(StreamError, match=r"the simulator at 127\.0\.0\.1:\d+ cannot be reached"):
        LeagueWorld(simulator="steps", endpoints=free_endpoints())
