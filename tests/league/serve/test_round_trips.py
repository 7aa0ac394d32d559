"""What a served field finds out about its clients and robots."""

from __future__ import annotations

import pytest

from robobt.cli.shown.round_trips import print_trips, trip_figures
from robobt.league.serve.round_trips import RoundTrips, TripWatch
from robobt.league.serve.served_field import ServedField, line_up
from robobt.league.serve.server import SimServer
from robobt.sim.realism import RealismSettings
from robobt.sim.settings import SimSettings
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.league.served import free_endpoints

ROBOT, OTHER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 1)


def test_round_trips_have_mean_variance_and_maximum() -> None:
    trips = RoundTrips(pictures=4)
    for seconds in (0.002, 0.004, 0.009):
        trips.add(seconds)
    assert trips.mean == pytest.approx(0.005)
    assert trips.variance == pytest.approx(13e-6)
    assert trips.maximum == 0.009
    assert trips.unanswered == 1


def test_a_round_trip_is_from_a_picture_to_the_first_command() -> None:
    now = [0.0]
    watch = TripWatch(SimSettings(), {}, clock=lambda: now[0])

    def command(at: float, robot: RobotId = ROBOT) -> None:
        now[0] = at
        watch.commanded(robot, RobotCommand(), at, lost=False)

    def picture(at: float) -> None:
        now[0] = at
        watch.picture_sent()

    picture(0.0)
    command(0.001)  # of a robot that was not commanded when the picture was sent
    picture(0.1)
    command(0.103)
    command(0.109)
    picture(0.2)
    picture(0.3)
    command(0.301)
    trips = watch.robots[ROBOT]
    assert (trips.commands, trips.pictures, trips.answered, trips.unanswered) == (4, 3, 2, 1)
    assert trips.mean == pytest.approx(0.002)
    assert trips.maximum == pytest.approx(0.003)
    picture(2.0)
    assert trips.pictures == 3


def test_a_robot_whose_only_command_was_lost_is_told_as_not_seen_enough(
    capsys: pytest.CaptureFixture[str],
) -> None:
    served = ServedField(DIVISION_B, line_up(DIVISION_B, 2), SimSettings())
    served.command_loss = 1.0
    with SimServer(served, free_endpoints()) as server:
        served.command(ROBOT, RobotCommand(1.0))
        server.step()
        assert server.delays() == {ROBOT: None}
        assert trip_figures(server)["blue 0"]["delay"] is None
        print_trips(server)
    assert "not seen" in capsys.readouterr().out


def measured(loss: float, seed: int, silent: range = range(0)) -> float:
    """The delay of a robot whose commands take 85 ms to be seen, of which a share gets lost [s]."""
    realism = RealismSettings(command_delay=0.05, vision_delay=0.035, command_loss=loss)
    served = ServedField(DIVISION_B, line_up(DIVISION_B, 2), SimSettings(realism=realism), seed=seed)
    with SimServer(served, free_endpoints()) as server:
        for tick in range(300):
            turn = 3.0 if tick // 20 % 2 else -3.0
            if tick % 40 not in silent:
                served.command(ROBOT, RobotCommand(0.5 * turn / 3.0, 0.0, turn))
            server.step()
        delay = server.delays()[ROBOT]
    assert delay is not None
    return delay.seconds


@pytest.mark.integration
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_lost_commands_make_no_robot_seem_late(seed: int) -> None:
    # Each is 8 ms late on the average at this loss, if it counts as given when it is lost.
    assert measured(0.3, seed) == pytest.approx(measured(0.0, seed), abs=0.001)


@pytest.mark.integration
def test_a_robot_that_is_stopped_for_want_of_commands_does_not_seem_late() -> None:
    assert measured(0.0, 0, silent=range(2, 20)) == pytest.approx(measured(0.0, 0), abs=0.002)


@pytest.mark.integration
def test_a_server_knows_how_late_its_robots_obey_and_what_got_lost(
    capsys: pytest.CaptureFixture[str],
) -> None:
    realism = RealismSettings(command_delay=0.05, vision_delay=0.035, command_loss=0.05)
    served = ServedField(DIVISION_B, line_up(DIVISION_B, 2), SimSettings(realism=realism), seed=1)
    with SimServer(served, free_endpoints()) as server:
        for tick in range(300):
            turn = 3.0 if tick // 20 % 2 else -3.0
            served.command(ROBOT, RobotCommand(0.5 * turn / 3.0, 0.0, turn))
            server.step()
            server.send_due(served.time)
        delays, trips = server.delays(), served.trips.robots[ROBOT]
        figures = trip_figures(server)
        print_trips(server)
    measured = delays[ROBOT]
    assert measured is not None
    assert measured.seconds == pytest.approx(0.085, abs=0.006)
    assert OTHER not in delays
    assert trips.commands == 300
    assert 3 < trips.lost < 40
    assert list(figures) == ["blue 0"]
    told = figures["blue 0"]
    assert told["delay"]["low"] < measured.seconds < told["delay"]["high"]
    assert (told["commands"], told["lost"]) == (300, trips.lost)
    assert told["round_trip"]["count"] + told["round_trip"]["lost"] == trips.pictures
    printed = capsys.readouterr().out
    assert "blue 0" in printed
    assert "ms" in printed
