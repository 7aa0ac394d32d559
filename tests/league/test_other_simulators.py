"""What is peculiar about grSim and ER-Force's simulator is lived with."""

from __future__ import annotations

from math import degrees, pi

import pytest

from robobt.league.wire.endpoints import Endpoints
from robobt.league.world import LeagueWorld
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_A
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import Frame, RobotId
from tests.league.fakes import FakeSimulator, running
from tests.league.served import drive, free_endpoints

pytestmark = pytest.mark.integration

ME, HER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 1)
START = Placement({ME: (-1.0, 0.5, 0.3), HER: (2.0, -1.0, pi - 0.2)}, (0.5, 0.25, 0.0, 0.0))


@pytest.fixture
def endpoints() -> Endpoints:
    return free_endpoints()


def grsim(endpoints: Endpoints, **more: object) -> FakeSimulator:
    return FakeSimulator(endpoints, rate=58.5, cameras=4, watchdog=0.5, **more)  # type: ignore[arg-type]


def erforce(endpoints: Endpoints, **more: object) -> FakeSimulator:
    return FakeSimulator(endpoints, rate=66.0, delay=0.035, told_delay=0.005, occludes=True, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("form", "teams"),
    [
        ("grsim", ("blue", "yellow")),
        pytest.param("grsim", ("blue",), marks=pytest.mark.slow),
        pytest.param("protocol", ("blue", "yellow"), marks=pytest.mark.slow),
        ("protocol", ("yellow",)),
    ],
    ids=str,
)
def test_grsim_never_takes_a_command_back(endpoints: Endpoints, form: str, teams: tuple[str, ...]) -> None:
    with (
        running(grsim(endpoints)) as simulator,
        LeagueWorld(
            robots=dict.fromkeys((ME, HER)), simulator=form, endpoints=endpoints, teams=teams, place=True
        ) as world,
    ):
        world.reset(START, 0)
        simulator.zeroed = 0
        wanted = pytest.approx([0.5 if team.value in teams else 0.0 for team in Team], abs=0.05)
        commands = {ME: RobotCommand(0.5), HER: RobotCommand(0.5)}
        drive(world, commands, lambda seen: [seen.own[0].speed, seen.opponents[0].speed] == wanted, ticks=45)
        assert simulator.zeroed == 0
    assert not simulator.errors


def test_grsim_turns_robots_in_degrees(endpoints: Endpoints) -> None:
    with (
        running(grsim(endpoints)) as simulator,
        LeagueWorld(robots=dict.fromkeys((ME, HER)), endpoints=endpoints) as world,
    ):
        world.reset(START, 0)
        assert degrees(0.3) == pytest.approx(simulator.directions[0])
        assert world.observe().own[0].heading == pytest.approx(0.3, abs=0.02)


def test_a_ball_that_a_robot_hides_from_the_start_lies_where_it_was_put(endpoints: Endpoints) -> None:
    placement = Placement({ME: (0.0, 0.0, 0.0), HER: (2.0, 1.0, pi)}, (0.1, 0.0, 0.0, 0.0))
    with (
        running(erforce(endpoints)),
        LeagueWorld(robots=dict.fromkeys((ME, HER)), simulator="protocol", endpoints=endpoints) as world,
    ):
        world.reset(placement, 0)
        place = pytest.approx((0.1, 0.0), abs=0.01)
        drive(world, {}, lambda frame: frame.ball.position == place)


def test_vision_that_is_later_than_it_tells_can_be_reckoned_with(endpoints: Endpoints) -> None:
    with (
        running(erforce(endpoints)) as simulator,
        LeagueWorld(
            robots=dict.fromkeys((ME, HER)), simulator="protocol", endpoints=endpoints, latency=0.03
        ) as world,
    ):
        world.reset(START, 0)
        errors = []
        for _ in range(60):
            world.act({ME: RobotCommand(1.5)})
            me, robot = world.observe().own[0], simulator.robots[ME]
            errors.append(abs(me.x - robot.x) + abs(me.y - robot.y))
        # Two thirds of what the delay alone would make it, for a quarter of the time at least: on a busy
        # machine threads do not keep time well.
        assert sorted(errors[30:])[7] < 0.035


def test_vision_that_is_started_anew_is_played_on_with_where_people_place_the_robots(
    endpoints: Endpoints,
) -> None:
    times: list[float] = []

    def as_commanded(frame: Frame) -> bool:
        times.append(frame.time)
        drives = frame.own[0].speed == pytest.approx(0.5, abs=0.05)
        return drives and {robot.id for robot in frame.own} == {0, 1}

    with LeagueWorld(robots=dict.fromkeys((ME, HER)), endpoints=endpoints, place=False) as world:
        with running(grsim(endpoints, clock_from=5000.0)):
            world.reset(START, 0)
            for _ in range(10):
                world.act({ME: RobotCommand(0.5)})
        for _ in range(10):
            world.act({ME: RobotCommand(0.5)})
        for clock in (0.0, 9e5):
            with running(grsim(endpoints, clock_from=clock)):
                for _ in range(30):
                    world.act({ME: RobotCommand(0.5)})
                times.clear()
                drive(world, {ME: RobotCommand(0.5)}, as_commanded, ticks=30)
                assert times == sorted(set(times))


def test_without_geometry_the_field_is_the_one_that_was_named(endpoints: Endpoints) -> None:
    with (
        running(grsim(endpoints, geometry=None)),
        LeagueWorld(DIVISION_A, dict.fromkeys((ME, HER)), endpoints=endpoints) as world,
    ):
        world.reset(START, 0)
        world.act({})
        assert world.observe().field == DIVISION_A
