"""What goes wrong on a field is told, or ends the match with a message; nothing goes on in silence."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest

from robobt.league.connection import Connection, LeagueError
from robobt.league.serve.served_field import ServedField, line_up
from robobt.league.serve.server import SimServer
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.vision import CameraFrame
from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.world import DIVISION_A, DIVISION_B, RobotCommand, RobotId, Team
from robobt.world.field import FieldGeometry
from robobt.worlds import world_from
from tests.conftest import StartPython
from tests.league.lockstep import LockstepWorld
from tests.league.served import free_endpoints

pytestmark = pytest.mark.integration

ME, HER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)
START = line_up(DIVISION_B, 6)


@contextmanager
def played(
    field: FieldGeometry = DIVISION_B,
    expected: FieldGeometry | None = None,
    robots: int = 6,
    **options: object,
) -> Iterator[tuple[LockstepWorld, SimServer]]:
    endpoints = free_endpoints()
    with (
        SimServer(ServedField(field, line_up(field, robots)), endpoints) as server,
        LockstepWorld(
            server,
            field=expected,
            robots={RobotId(team, number): None for team in Team for number in range(robots)},
            endpoints=endpoints,
            **options,
        ) as world,
    ):
        yield world, server


def act(world: LockstepWorld, seconds: float) -> None:
    for _ in range(round(seconds * 60)):
        world.act({ME: RobotCommand(0.3)})


def start_and_act(world: LockstepWorld, seconds: float) -> None:
    world.reset(START, 0)
    act(world, seconds)


def silence(server: SimServer) -> None:
    """Let the server send no more."""
    server.send_due = lambda time: None  # type: ignore[method-assign]


def restart(world: LockstepWorld) -> None:
    """Let the frames' clock begin at 0 again, as that of a simulator that was restarted."""
    first: list[float] = []
    add = world._feed.add

    def added(frame: CameraFrame, arrived: float, *, waited: bool = False) -> None:
        first.append(frame.captured)
        frame.captured -= first[0]
        frame.sent -= first[0]
        add(frame, arrived, waited=waited)

    world._feed.add = added  # type: ignore[method-assign]


def test_a_field_of_another_size_is_refused() -> None:
    with played(DIVISION_A, DIVISION_B) as (world, _):
        with pytest.raises(LeagueError) as caught:
            start_and_act(world, 5.0)
        assert "length 12 m instead of 9 m, width 9 m instead of 6 m" in str(caught.value)
        assert "geometry=seen" in str(caught.value)


def test_a_field_of_another_size_is_played_on_if_one_asks_for_it() -> None:
    scenario = load_scenario("six_v_six")
    with played(DIVISION_A, DIVISION_B, geometry="seen") as (world, _):
        with MatchLoop(scenario, 1, lambda _: world) as match:
            assert match.tick()
        assert world.observe().field.length == DIVISION_A.length


def test_a_field_of_the_same_size_is_no_other() -> None:
    near = DIVISION_B.model_copy(update={"margin": 0.5, "length": 9.01})
    with played(near, DIVISION_B) as (world, _):
        world.reset(START, 0)
        act(world, 3.0)
        assert world.observe().field.length == 9.01


def test_a_simulator_that_dies_ends_the_match(caplog: pytest.LogCaptureFixture) -> None:
    with played() as (world, server):
        world.reset(START, 0)
        act(world, 1.0)
        silence(server)
        act(world, 2.0)
        (told,) = caplog.messages
        assert "for 1 s" in told
        assert "robots are stopped" in told
        with pytest.raises(LeagueError, match="for 4 s: start the simulator again"):
            act(world, 4.0)


def test_a_simulator_that_is_restarted_ends_the_match() -> None:
    with played() as (world, _):
        world.reset(START, 0)
        act(world, 1.0)
        restart(world)
        with pytest.raises(LeagueError, match="restarted during the match"):
            act(world, 1.0)


def test_where_nothing_was_placed_a_restart_is_told_and_the_match_goes_on(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with played(place=False) as (world, server):
        world.reset(START, 0)
        act(world, 1.0)
        restart(world)
        caplog.clear()
        act(world, 1.0)
        (told,) = caplog.messages
        assert "clock jumped" in told
        silence(server)
        act(world, 6.0)
        assert len(caplog.messages) == 2


def test_a_simulator_restarted_between_two_matches_is_nobodys_business(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with played() as (world, _):
        world.reset(START, 0)
        act(world, 1.0)
        restart(world)
        world.reset(START, 0)
        act(world, 1.0)
    assert caplog.messages == []


def test_plays_too_slow_for_this_machine_are_told_once(caplog: pytest.LogCaptureFixture) -> None:
    with played() as (world, _):
        world.reset(START, 0)
        for _ in range(250):
            # The trees take three periods.
            for _ in range(3):
                world._receive(0.02)
            world.act({})
    (told,) = caplog.messages
    assert "not 60: this machine is too slow" in told


def test_packets_that_waited_tell_nothing_of_the_rate(caplog: pytest.LogCaptureFixture) -> None:
    def load(frames: int) -> None:
        """Do as a process does that loads what it needs, while the field goes on."""
        for _ in range(frames):
            world.machine_time = max(world.machine_time, server.field.time + server.field.period)
            server.step()
            server.send_due(world.machine_time)

    with played() as (world, server):
        load(150)
        world.reset(START, 0)
        load(12)
        for _ in range(600):
            world.act({})
            assert world._feed.rate == pytest.approx(1.0, abs=0.03)
        assert world._feed.rate == pytest.approx(1.0, abs=0.002)
    assert caplog.messages == []


def _address(endpoints: Endpoints, **more: str) -> str:
    ports = {name: str(getattr(endpoints, name)) for name in Endpoints.model_fields}
    return "league://grsim?" + "&".join(f"{name}={value}" for name, value in (ports | more).items())


def test_two_worlds_of_one_process_give_way_to_each_other(caplog: pytest.LogCaptureFixture) -> None:
    scenario, address = load_scenario("striker_vs_goalkeeper"), _address(free_endpoints())
    first, second = world_from(address), world_from(address)
    with ExitStack() as ended:
        for factory in (first, second, first):
            world = factory(scenario)
            ended.callback(world.close)  # type: ignore[attr-defined]
            assert len(world.counts()) == 3  # type: ignore[attr-defined]
    assert caplog.messages == []


def test_two_teams_of_one_process_leave_each_other_alone() -> None:
    scenario, endpoints = load_scenario("striker_vs_goalkeeper"), free_endpoints()
    blue = world_from(_address(endpoints, teams="blue"))(scenario)
    yellow = world_from(_address(endpoints, teams="yellow"))(scenario)
    assert not blue._closed  # type: ignore[attr-defined]
    for world in (blue, yellow):
        world.close()  # type: ignore[attr-defined]


_OTHER = """
import sys
import time
from robobt.league.claims import RobotClaims
from robobt.world import RobotId, Team
claims = RobotClaims(sys.argv[1], [RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 7)], list(Team), lambda: None)
print(claims.taken, flush=True)
time.sleep(60)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other processes are only known on Linux")
def test_two_players_of_one_robot_are_told(
    start_python: StartPython, caplog: pytest.LogCaptureFixture
) -> None:
    scenario, endpoints = load_scenario("striker_vs_goalkeeper"), free_endpoints()
    other = start_python("-c", _OTHER, Connection(endpoints=endpoints).where)
    assert other.stdout is not None
    assert other.stdout.readline() == "[]\n"
    world_from(_address(endpoints))(scenario).close()  # type: ignore[attr-defined]
    (told,) = caplog.messages
    assert "another process commands the same robots there: blue 0;" in told
    other.kill()
    other.wait()
    caplog.clear()
    world_from(_address(endpoints))(scenario).close()  # type: ignore[attr-defined]
    assert caplog.messages == []
