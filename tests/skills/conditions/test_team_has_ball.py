from __future__ import annotations

from math import pi

from robobt.skills import DribbleTo, TeamHasBall
from robobt.testing import Trial, always, blue, frame, held, robot, succeeds
from robobt.tree import Status
from tests.skills.fixed_world import Alone

ME = robot(0.0, 0.0, 0.0, number=0)
MATE = robot(1.0, 0.0, 0.0, number=1)
OPPONENT = robot(2.0, 0.0, pi, number=0)


def tick(ball: tuple[float, float], *, others_only: bool = False) -> Status:
    world = frame(ME, ball, mates=(MATE,), opponents=(OPPONENT,))
    return Alone(TeamHasBall(others_only=others_only)).tick(world)


def test_it_holds_for_any_robot_of_the_team() -> None:
    assert tick(held(ME)) is Status.SUCCESS
    assert tick(held(MATE)) is Status.SUCCESS


def test_it_does_not_hold_for_opponents_or_a_free_ball() -> None:
    assert tick(held(OPPONENT)) is Status.FAILURE
    assert tick((0.0, 2.0)) is Status.FAILURE


def test_the_robot_itself_can_be_left_out() -> None:
    assert tick(held(ME), others_only=True) is Status.FAILURE
    assert tick(held(MATE), others_only=True) is Status.SUCCESS


def test_it_holds_while_a_mate_carries_the_ball() -> None:
    watcher = TeamHasBall(others_only=True)
    trial = Trial(
        {blue(0): watcher, blue(1): DribbleTo(target=(1.5, 0.0))},
        {blue(0): (0.0, 2.0, 0.0), blue(1): (0.0, 0.0, 0.0)},
        (0.0975, 0.0),
    )
    trial.run(1.0, always("a mate has the ball", succeeds(watcher)))
