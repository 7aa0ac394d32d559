"""A published match is the same match, and everybody hears it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from robobt.league.serve.publishing import PublishedWorld, PublishingFactory
from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.sockets import Receiver
from robobt.league.wire.tracker import read_tracked
from robobt.league.wire.vision import read_vision
from robobt.match import MatchLoop, Scenario, load_scenario
from robobt.sim import SimWorld
from robobt.world import RobotId, Team, World
from robobt.worlds import sim_world
from tests.league.served import free_endpoints


@pytest.mark.integration
def test_a_published_match_is_heard_and_plays_as_if_it_were_not() -> None:
    endpoints = free_endpoints()
    scenario = load_scenario("three_v_three").lasting(0.8)
    factory = PublishingFactory(sim_world, endpoints)
    follower = RefereeFollower()
    with (
        Receiver(*endpoints.vision) as vision,
        Receiver(*endpoints.tracker) as tracker,
        Receiver(*endpoints.referee) as referee,
    ):
        match = MatchLoop(scenario, 1, factory)
        result = match.play()
        factory.close()
        seen = [read_vision(packet.data, PacketCounts()) for packet in vision.receive()]
        tracked = [read_tracked(packet.data, scenario.field, PacketCounts()) for packet in tracker.receive()]
        words = [follower.read(packet.data) for packet in referee.receive()]
    assert len(seen) == len(tracked) == len(words) == result.ticks - 1
    assert all(words)
    assert follower.game == match.game
    first = seen[0]
    assert first is not None
    assert first.field == scenario.field
    assert first.frame is not None
    assert len(first.frame.robots) == 6
    assert result.trace == MatchLoop(scenario, 1, sim_world).play().trace


def test_kicks_that_a_world_saw_are_counted_in_a_published_match_too() -> None:
    scenario = load_scenario("striker_vs_goalkeeper").lasting(0.1)
    striker = RobotId(Team.BLUE, 0)

    class Seeing(SimWorld):
        def seen_kicks(self) -> list[tuple[RobotId, float]]:
            return [(striker, self.time)]

    def world(scenario: Scenario) -> PublishedWorld:
        simulated = sim_world(scenario)
        simulated.__class__ = Seeing
        return PublishedWorld(simulated, endpoints=free_endpoints())

    match = MatchLoop(scenario, 1, world)
    result = match.play()
    match.world.close()  # type: ignore[attr-defined]
    assert result.robots["blue 0"].kicks == result.ticks


def test_it_waits_for_the_clock_and_no_longer(monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = load_scenario("striker_vs_goalkeeper").lasting(0.5)
    now = [0.0]
    naps: list[float] = []

    def nap(seconds: float) -> None:
        naps.append(seconds)
        now[0] += seconds

    clock = SimpleNamespace(monotonic=lambda: now[0], sleep=nap)
    monkeypatch.setattr("robobt.league.serve.publishing.time", clock)

    def world(scenario: object) -> PublishedWorld:
        return PublishedWorld(sim_world(scenario), endpoints=free_endpoints())  # type: ignore[arg-type]

    match = MatchLoop(scenario, 1, world)
    assert isinstance(match.world, World)
    match.play()
    match.world.close()  # type: ignore[attr-defined]
    assert sum(naps) == pytest.approx(0.5, abs=0.03)
