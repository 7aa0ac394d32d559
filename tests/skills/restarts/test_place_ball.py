from __future__ import annotations

from math import hypot, pi

import pytest

from robobt.motion.catch import MOUTH
from robobt.skills.restarts.place_ball import PlaceBall
from robobt.testing import Trial, blue, frame, robot
from robobt.tree import Status
from robobt.world import GameState, RefereeCommand, Restart, Team
from robobt.world.geometry import Point
from robobt.world.state import Frame
from tests.skills.fixed_world import Alone
from tests.skills.refereed import STOP, Drive, free_kick, placement


def place(ball: Point, spot: Point, seconds: float, settings: str) -> Trial:
    trial = Trial({blue(1): PlaceBall()}, {blue(1): (-1.0, 0.5, 0.0)}, ball, settings)
    observe = trial.world.observe

    def observe_placement() -> Frame:
        frame = observe()
        frame.game = placement(spot, Team.BLUE)
        return frame

    trial.world.observe = observe_placement  # type: ignore[method-assign]
    trial.run(seconds)
    return trial


@pytest.mark.integration
@pytest.mark.parametrize("settings", ["default", "grsim"])
@pytest.mark.parametrize(
    ("ball", "spot"),
    [
        ((1.0, 1.0), (-1.0, -1.0)),
        ((4.55, 1.5), (4.3, 2.8)),
        ((0.0, 3.1), (0.0, 2.8)),
        ((0.5, 0.0), (0.6, 0.0)),
        ((4.66, 0.09), (4.15, -2.6)),
        ((-4.778, -0.541), (-4.3, -2.8)),
        ((4.77, 0.56), (1.0, -2.0)),
        ((4.1, 0.4), (-1.4, 1.2)),
        ((1.1, -1.7), (4.0, 2.75)),
        ((4.49, -0.37), (4.3, -2.8)),
    ],
    ids=[
        "across the field",
        "corner",
        "over the touch line",
        "a hand's breadth",
        "out of the goal",
        "from beside the goal",
        "from beside their goal",
        "out of their area",
        "towards a corner",
        "on the goal line by a post",
    ],
)
def test_the_ball_comes_to_rest_on_the_spot_and_the_robot_leaves_it(
    ball: Point, spot: Point, settings: str
) -> None:
    last = place(ball, spot, 20.0, settings).frames[-1]
    assert hypot(last.ball.x - spot[0], last.ball.y - spot[1]) < 0.15
    assert last.ball.speed < 0.2
    (me,) = last.own
    # A kick by the opponents may be next: half a metre from the hull.
    assert hypot(me.x - last.ball.x, me.y - last.ball.y) > 0.5 + 0.09


@pytest.mark.integration
@pytest.mark.parametrize(
    ("ball", "spot"),
    [
        ((1.0, 1.0), (-1.0, -1.0)),
        ((4.66, 0.09), (4.15, -2.6)),
        ((1.1, -1.7), (4.0, 2.75)),
        ((4.49, -0.37), (4.3, -2.8)),
    ],
)
def test_a_dribbler_that_holds_little_and_spins_the_ball_places_it_at_once(ball: Point, spot: Point) -> None:
    # It holds against 0.35 m/s^2; released in motion, or with the ball still spinning, the ball rolls off.
    frames = place(ball, spot, 14.0, "erforce").frames
    assert hypot(frames[-1].ball.x - spot[0], frames[-1].ball.y - spot[1]) < 0.05
    taken = [frame.own[0].ball_contact for frame in frames]
    lost = sum(before and not any(taken[i : i + 30]) for i, before in enumerate(taken, 1))
    assert lost == 1


@pytest.mark.integration
@pytest.mark.parametrize("ball", [(4.778, 3.278), (-4.778, 3.278)])
def test_a_ball_in_a_corner_that_the_hull_keeps_from_the_mouth_is_got_out(ball: Point) -> None:
    last = place(ball, (0.9 * ball[0], 2.8), 12.0, "erforce").frames[-1]
    assert hypot(last.ball.x - 0.9 * ball[0], last.ball.y - 2.8) < 0.05


def test_a_ball_that_lies_before_the_mouth_is_taken_before_it_is_pulled() -> None:
    alone, me = Alone(PlaceBall()), robot()
    for step in range(12):
        seen = frame(me, ball=(MOUTH + 0.012, 0.004), time=step / 60)
        seen.game = placement((-2.0, 0.0), Team.BLUE)
        alone.tick(seen)
        assert alone.command.vx > 0.0


def test_the_ball_is_never_kicked() -> None:
    trial = place((1.0, 1.0), (-1.0, -1.0), 15.0, "default")
    assert trial.kicks == []
    assert max(frame.ball.speed for frame in trial.frames) < 1.5


def test_without_a_spot_it_waits() -> None:
    game = GameState(
        RefereeCommand.BALL_PLACEMENT_BLUE, restart=Restart.BALL_PLACEMENT, restart_team=Team.BLUE
    )
    drive = Drive(PlaceBall(), robot(1.0, 0.0, heading=pi, number=1), game, (0.0, 0.0), seconds=0.2)
    assert drive.status is Status.RUNNING
    assert drive.end.position == (1.0, 0.0)


@pytest.mark.parametrize("game", [STOP, free_kick(Team.BLUE, (0.0, 0.0))], ids=["stop", "free kick"])
def test_it_fails_when_no_placement_is_asked_for(game: GameState) -> None:
    assert Drive(PlaceBall(), robot(1.0, number=1), game, (0.0, 0.0), seconds=0.1).status is Status.FAILURE
