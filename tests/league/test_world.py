"""A league world over the loopback: one contract with the simulated one, whatever the protocol."""

from __future__ import annotations

import threading
import time
from math import nan, pi

import pytest

from robobt.league.connection import Connection, LeagueError
from robobt.league.factory import LeagueFactory
from robobt.league.serve.served_field import ServedField, line_up
from robobt.league.wire.commands import Teleport
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.league.wire.sockets import Sender
from robobt.league.world import LeagueWorld
from robobt.match import load_scenario, run_trials_in
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.sim.realism import REALISM
from robobt.sim.settings import SimSettings, preset
from robobt.world import World
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.field import DIVISION_A, DIVISION_B
from robobt.world.game import GameState, RefereeCommand, Team
from robobt.world.protocol import Placement
from robobt.world.state import Frame, RobotId
from robobt.worlds import world_from
from tests.league.served import drive, free_endpoints, poses, served
from tests.waiting import soon

pytestmark = pytest.mark.integration

ME, HER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 1)
START = Placement({ME: (-1.0, 0.5, 0.3), HER: (2.0, -1.0, pi - 0.2)}, (0.5, 0.25, 0.0, 0.0))
SPEED = 3.0


def field(robots: int = 2) -> ServedField:
    return ServedField(DIVISION_B, line_up(DIVISION_B, robots))


def connect(endpoints: Endpoints, simulator: str = "grsim", **more: object) -> LeagueWorld:
    robots = dict.fromkeys((ME, HER))
    return LeagueWorld(robots=robots, simulator=simulator, endpoints=endpoints, speed=SPEED, **more)  # type: ignore[arg-type]


def still(frame: Frame) -> bool:
    return frame.own[0].speed < 0.03


@pytest.mark.parametrize("group", ["224.5.23.2", "127.0.0.1"], ids=["multicast", "unicast"])
@pytest.mark.parametrize("simulator", ["grsim", "protocol"])
def test_it_puts_sees_drives_and_stops_robots(simulator: str, group: str) -> None:
    endpoints = free_endpoints(group)
    with served(field(), endpoints, SPEED) as server, connect(endpoints, simulator) as world:
        assert isinstance(world, World)
        world.reset(START, 0)
        # Who does not play was taken off the field.
        assert set(poses(server.field)) == {ME, HER}
        frame = world.observe()
        assert frame.own[0].position == pytest.approx((-1.0, 0.5), abs=0.01)
        assert frame.opponents[0].heading == pytest.approx(pi - 0.2, abs=0.03)
        assert frame.ball.position == pytest.approx((0.5, 0.25), abs=0.01)
        times: list[float] = []

        def as_commanded(frame: Frame) -> bool:
            times.append(frame.time)
            (me,), (her,) = frame.own, frame.opponents
            # The field has gone on since; how far depends on this machine.
            there = poses(server.field)[ME][:2] == pytest.approx(me.position, abs=0.2)
            return there and (me.speed, me.omega / 2.0, her.speed) == pytest.approx((0.5, 0.5, 0.4), abs=0.05)

        frame = drive(world, {ME: RobotCommand(0.5, 0.0, 1.0), HER: RobotCommand(0.0, 0.4)}, as_commanded)
        assert times == sorted(set(times))
        assert world.truth().time == frame.time
        seen = world.detections()
        assert ME in seen[-1].robots
        assert frame.time - 0.5 < seen[-1].captured <= frame.time + 0.05
        assert world.detections() == []
        drive(world, {}, still)


def test_an_immediate_kick_is_sent_once_however_often_the_command_is_repeated() -> None:
    endpoints = free_endpoints()
    with served(field(), endpoints, SPEED), connect(endpoints, period=0.2) as world:
        world.reset(START, 0)
        kicks: list[float] = []
        world._link.send = lambda commands, _: kicks.append(commands[ME].kick_speed)  # type: ignore[method-assign]
        world.act({ME: RobotCommand(0.5, kick_speed=3.0, kick_trigger=KickTrigger.NOW)})
        assert len(kicks) > 2
        assert kicks[0] == 3.0
        assert not any(kicks[1:])


def test_closing_it_stops_the_robots() -> None:
    endpoints = free_endpoints()
    with served(field(), endpoints, SPEED) as server:
        with connect(endpoints) as world:
            world.reset(START, 0)
            for _ in range(20):
                world.act({ME: RobotCommand(0.5)})
            assert server.field.driven()
        end = server.field.time + 0.5
        while server.field.driven() and server.field.time < end:
            pass
        assert server.field.time < end


def test_the_field_is_the_one_the_vision_tells() -> None:
    endpoints = free_endpoints()
    big = ServedField(DIVISION_A, line_up(DIVISION_A, 2))
    with served(big, endpoints, SPEED), connect(endpoints) as world:
        world.reset(START, 0)
        drive(world, {}, lambda frame: frame.field == DIVISION_A, ticks=0)


def test_a_team_that_defends_the_other_side_sees_itself_on_its_own() -> None:
    endpoints = free_endpoints()
    turned = connect(endpoints, blue_on_positive_half=True)
    with served(field(), endpoints, SPEED) as server, turned as world:
        world.reset(START, 0)
        assert poses(server.field)[ME][:2] == pytest.approx((1.0, -0.5), abs=1e-3)
        assert world.observe().own[0].position == pytest.approx((-1.0, 0.5), abs=0.01)
        heads = pytest.approx(0.5 * 0.955, abs=0.05)
        drive(world, {ME: RobotCommand(0.5)}, lambda frame: frame.own[0].vx == heads)


def test_the_ball_is_put_down_and_its_motion_starts_with_the_reset() -> None:
    endpoints = free_endpoints()
    with served(field(), endpoints, SPEED), connect(endpoints, "protocol") as world:
        world.reset(Placement(START.robots, (-2.0, -2.0, 1.0, 0.0)), 0)
        assert world.observe().ball.vx == pytest.approx(0.95, abs=0.1)
        world.place_ball(1.0, 2.0)
        place = pytest.approx((1.0, 2.0), abs=0.01)
        drive(world, {}, lambda frame: frame.ball.position == place and frame.ball.speed < 0.03)


def test_without_a_simulator_it_says_so_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robobt.league.placing.TIMEOUT", 0.1)
    endpoints = free_endpoints()
    with (
        connect(endpoints) as world,
        pytest.raises(LeagueError, match=r"^no vision at 239\.254\..*:\d+ for 0\.1 s: start the simulator$"),
    ):
        world.reset(START, 0)


def test_an_observer_plays_with_what_is_there_and_commands_nobody() -> None:
    endpoints = free_endpoints()
    with connect(endpoints, "observer") as world, served(field(1), endpoints, SPEED) as server:
        world.reset(START, 0)
        assert list(world.observe().robots()) == [ME, RobotId(Team.YELLOW, 0)]
        for _ in range(5):
            world.act({ME: RobotCommand(1.0)})
        assert world.observe().own[0].speed < 0.03
        assert server.counts["grsim"].accepted == server.counts["blue"].accepted == 0


def test_a_robot_that_is_not_there_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robobt.league.placing.TIMEOUT", 0.2)
    endpoints = free_endpoints()
    ghost = RobotId(Team.BLUE, 20)
    world = LeagueWorld(robots={ghost: None}, endpoints=endpoints)
    with (
        served(field(), endpoints),
        world,
        pytest.raises(LeagueError, match=r"not seen where put .*: blue 20;"),
    ):
        world.reset(Placement({ghost: (0.0, 1.0, 0.0)}), 0)


def test_commands_that_cannot_be_are_refused_as_by_the_simulated_world() -> None:
    with connect(free_endpoints()) as world:
        with pytest.raises(ValueError, match="is not finite"):
            world.act({ME: RobotCommand(nan)})
        with pytest.raises(KeyError):
            world.act({RobotId(Team.BLUE, 9): RobotCommand()})
        with pytest.raises(ValueError, match="has no pose for yellow 1"):
            world.reset(Placement({ME: (0.0, 0.0, 0.0)}), 0)
        with pytest.raises(ValueError, match="outside the walls"):
            world.reset(Placement({**START.robots, ME: (99.0, 0.0, 0.0)}), 0)
        with pytest.raises(ValueError, match="blue 9 is not part of this world"):
            world.reset(Placement({**START.robots, RobotId(Team.BLUE, 9): (0.0, 0.0, 0.0)}), 0)


def test_when_the_vision_stops_commands_go_on_but_robots_stop() -> None:
    endpoints = free_endpoints()
    with connect(endpoints) as world:
        with served(field(), endpoints, SPEED):
            world.reset(START, 0)
        sent = len(world.send_times)
        ticks = 30
        for _ in range(ticks):
            world.act({ME: RobotCommand(1.0)})
        assert len(world.send_times) - sent >= ticks
        # The filter was told what was really sent.
        assert world._feed.filter._sent[ME][-1][1].vx == 0.0


def test_somebodys_tracked_frames_will_do_as_well() -> None:
    endpoints = free_endpoints()
    with served(field(), endpoints, SPEED), connect(endpoints, source="tracker") as world:
        world.reset(START, 0)
        rolls = pytest.approx(0.5, abs=0.05)
        frame = drive(world, {ME: RobotCommand(0.5)}, lambda frame: frame.own[0].speed == rolls, ticks=30)
        assert frame.ball.position == pytest.approx((0.5, 0.25), abs=0.01)
        assert world.counts()["tracker"].accepted > 30


def test_whoever_is_always_late_still_sees_what_comes() -> None:
    endpoints = free_endpoints()
    with served(field(), endpoints, SPEED), connect(endpoints, "protocol") as world:
        world.reset(START, 0)
        world.place_ball(1.0, 1.0)
        for _ in range(10):
            time.sleep(2.5 * world.period / SPEED)
            world.act({})
        place = pytest.approx((1.0, 1.0), abs=0.01)
        drive(world, {}, lambda frame: frame.ball.position == place, ticks=0)


def test_a_scenario_is_played_over_the_network_as_in_the_process() -> None:
    endpoints = free_endpoints()
    scenario = load_scenario("striker_vs_goalkeeper").lasting(2.0)
    served_field = ServedField(scenario.field, Placement(), preset("default", realism=REALISM["none"]))
    # Nobody is on the field yet: the match puts its robots there.
    served_field.teleport(Teleport(RobotId(Team.BLUE, 11), 0.0, 2.0, 0.0))
    ports = {name: getattr(endpoints, name) for name in ("grsim", "control", "blue", "yellow")}
    ports |= {"blue_status": endpoints.blue_status, "yellow_status": endpoints.yellow_status}
    options = "&".join(f"{name}={port}" for name, port in ports.items())
    factory = world_from(f"league://protocol?vision={endpoints.vision}&speed=2&{options}")
    assert isinstance(factory, LeagueFactory)
    with served(served_field, endpoints, 2.0):
        (result,) = run_trials_in(scenario, factory, trials=1).results
        factory.close()
    assert result.ticks > 20
    assert not any(robot.errors for robot in result.robots.values())


def test_only_the_own_teams_robots_are_commanded() -> None:
    endpoints = free_endpoints()
    with served(field(), endpoints, SPEED), connect(endpoints, teams=("blue",)) as world:
        world.reset(START, 0)
        commands = {ME: RobotCommand(0.5), HER: RobotCommand(0.5)}
        frame = drive(world, commands, lambda frame: frame.own[0].speed > 0.4)
        assert frame.opponents[0].speed < 0.03


def test_noise_and_delay_of_the_server_are_bridged() -> None:
    endpoints = free_endpoints()
    noisy = ServedField(DIVISION_B, line_up(DIVISION_B, 2), SimSettings(realism=REALISM["realistic"]))
    with served(noisy, endpoints, 1.0, cameras=4) as server:
        robots = dict.fromkeys((ME, HER))
        with LeagueWorld(robots=robots, endpoints=endpoints, settings=noisy.settings) as world:
            world.reset(START, 0)

            def as_commanded(frame: Frame) -> bool:
                (me,) = frame.own
                x, y, _ = poses(server.field)[ME]
                # Some periods of the server and one of ours lie between the two looks.
                return abs(me.x - x) + abs(me.y - y) < 0.2 and me.speed == pytest.approx(1.0, abs=0.1)

            drive(world, {ME: RobotCommand(1.0)}, as_commanded, ticks=40)


@pytest.mark.parametrize(
    ("options", "places"),
    [
        ({}, True),
        ({"teams": (Team.BLUE,)}, False),
        ({"host": "192.168.1.20"}, False),
        ({"teams": (Team.BLUE,), "place": True}, True),
        ({"place": False}, False),
        ({"simulator": "observer"}, False),
    ],
    ids=["both teams here", "one team", "another machine", "asked for", "refused", "observer"],
)
def test_only_a_field_that_is_all_ours_is_set_up(options: dict[str, object], places: bool) -> None:
    assert Connection.model_validate(options).places is places


def test_where_nothing_may_be_placed_nothing_is_moved() -> None:
    endpoints = free_endpoints()
    with served(field(), endpoints, SPEED) as server, connect(endpoints, place=False) as world:
        before = poses(server.field)
        ball = server.field.truth().ball.position
        world.reset(START, 0)
        world.place_ball(1.0, 1.0)
        world.act({})
        for robot, pose in poses(server.field).items():
            assert pose == pytest.approx(before[robot], abs=1e-6)
        assert server.field.truth().ball.position == ball


def test_where_nothing_may_be_placed_it_waits_for_the_robots(caplog: pytest.LogCaptureFixture) -> None:
    endpoints = free_endpoints()
    with served(field(1), endpoints, SPEED) as server, connect(endpoints, place=False) as world:

        def come_late() -> None:
            soon(lambda: any("waiting until" in text for text in caplog.messages))
            server.field.teleport(Teleport(HER, 2.0, -1.0, 0.0))

        late = threading.Thread(target=come_late)
        late.start()
        world.reset(START, 0)
        late.join()
        assert HER in world.observe().robots()
    assert [record.getMessage() for record in caplog.records if "waiting until" in record.getMessage()] == [
        "waiting until these robots are seen on the field: yellow 1"
    ]


def test_a_game_controller_decides_score_and_end() -> None:
    endpoints = free_endpoints()
    with connect(endpoints, follow_referee=True) as world:
        assert world.refereed
        assert not world.scenario_ends
    with connect(free_endpoints(), follow_referee=True, ends=True) as world:
        assert world.scenario_ends
    with connect(free_endpoints()) as world:
        assert not world.refereed
        assert world.scenario_ends


@pytest.mark.parametrize(("turned", "x"), [(False, 1.0), (True, -1.0)])
def test_what_a_game_controller_reports_is_told_once_from_our_side(turned: bool, x: float) -> None:
    endpoints = free_endpoints()
    event = RefereeEvent(3.0, EventKind.BOT_CRASH_UNIQUE, Team.BLUE, ME, 1.0, 0.5)
    packet = RefereePublisher().write(
        GameState(RefereeCommand.HALT, events=(event.kind,)), 5.0, [write_event(event, 0.0, "referee")]
    )
    options: dict[str, object] = {"follow_referee": True, "blue_on_positive_half": turned}
    with served(field(), endpoints, SPEED), connect(endpoints, **options) as world:
        world.reset(START, 0)
        with Sender(*endpoints.referee) as sender:
            heard: list[RefereeEvent] = []
            for _ in range(30):
                sender.send(packet)
                world.act({})
                heard += world.reported()
    assert [(event.kind, event.robot, event.x) for event in heard] == [("bot_crash_unique", ME, x)]
