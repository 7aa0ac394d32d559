"""A served field in the live page."""

from time import perf_counter

import pytest

from robobt.league.serve.served_field import ServedField
from robobt.league.serve.server import SimServer
from robobt.league.serve.watched import WatchedField
from robobt.league.wire.commands import Teleport
from robobt.live.messages import Act, MoveBall, MoveRobot, Pause, TakeOff
from robobt.live.server import Server
from robobt.sim.realism import RealismSettings
from robobt.world import DIVISION_B, Placement, RobotCommand, RobotId, Team
from tests.league.served import free_endpoints
from tests.live.test_stream import decoded

BLUE_3, YELLOW_5 = RobotId(Team.BLUE, 3), RobotId(Team.YELLOW, 5)


def test_robots_and_ball_of_a_served_field_can_be_moved() -> None:
    field = ServedField(DIVISION_B, Placement({BLUE_3: (-1.0, 0.0, 0.0)}, (0.0, 0.0, 0.0, 0.0)))
    server = Server()
    watched = WatchedField(server, "served", None, dict)

    def step(*acts: Act) -> None:
        for act in acts:
            server.inbox.put((act, perf_counter()))
        field.step()
        watched(field)

    step()
    stream = server.audience.stream
    assert stream is not None
    assert stream.header["scenario"] == "served"
    step(
        MoveBall(do="ball", x=1.0, y=0.5, vx=0.0, vy=2.0),
        MoveRobot(do="robot", robot="blue 3", x=2.0, y=-1.0, heading=1.5),
        Pause(do="pause", on=True),
    )
    truth = field.truth()
    assert (truth.ball.x, truth.ball.vy) == pytest.approx((1.0, 2.0))
    assert truth.robots()[BLUE_3].position == pytest.approx((2.0, -1.0))
    assert "only robots and ball" in server.audience.state["said"][1]
    step(MoveBall(do="ball", x=15.0, y=0.5))
    assert "outside the walls" in server.audience.state["said"][1]
    step(TakeOff(do="off", robot="blue 3"))
    step()
    assert stream.advance()
    chunk = decoded(stream.messages(0, 2**20)[0][0])
    assert chunk["frames"] == 5
    # A robot that comes later begins another stream, in which it is told of.
    field.teleport(Teleport(YELLOW_5, 1.0, 1.0, 0.0, present=True))
    step()
    assert server.audience.stream is not stream
    assert server.audience.stream is not None
    assert [robot["number"] for robot in server.audience.stream.header["robots"]] == [3, 5]


@pytest.mark.integration
def test_delays_follow_a_client_that_makes_the_pictures_older() -> None:
    field = ServedField(DIVISION_B, Placement({BLUE_3: (-1.0, 0.0, 0.0)}, (0.0, 0.0, 0.0, 0.0)))
    page = Server()
    with SimServer(field, free_endpoints()) as server:
        watched = WatchedField(page, "served", None, server.delays)
        server.ports.set_realism(RealismSettings(vision_delay=0.2))
        for tick in range(120):
            field.command(BLUE_3, RobotCommand(omega=3.0 if tick // 20 % 2 else -3.0))
            server.step()
            watched(field)
        measured = server.delays()[BLUE_3]
    assert measured is not None
    told = page.audience.state["delays"]["blue 3"]
    assert told[0] == pytest.approx(measured.seconds, abs=1e-3)
    assert told[0] > 0.19
