from __future__ import annotations

from robobt.skills import GoToPose, IsClosestToBall
from robobt.testing import Trial, blue, eventually, frame, robot, succeeds
from robobt.tree import Sequence, Status
from robobt.world import RobotState
from tests.skills.fixed_world import Alone

MATE = robot(0.0, 1.0, number=1)
OPPONENT = robot(0.0, 0.5)


def tick(me: RobotState, margin: float = 0.0, of_all: bool = False) -> Status:
    world = frame(me, ball=(0.0, 0.0), mates=(MATE,), opponents=(OPPONENT,))
    return Alone(IsClosestToBall(margin=margin, of_all=of_all)).tick(world)


def test_the_nearest_of_the_team_is_closest() -> None:
    assert tick(robot(0.9, 0.0)) is Status.SUCCESS
    assert tick(robot(1.1, 0.0)) is Status.FAILURE


def test_a_margin_lets_the_second_count_too() -> None:
    assert tick(robot(1.1, 0.0), margin=0.2) is Status.SUCCESS
    assert tick(robot(1.3, 0.0), margin=0.2) is Status.FAILURE


def test_opponents_count_when_asked() -> None:
    assert tick(robot(0.9, 0.0), of_all=True) is Status.FAILURE
    assert tick(robot(0.4, 0.0), of_all=True) is Status.SUCCESS


def test_a_robot_that_comes_up_becomes_the_closest() -> None:
    closest = IsClosestToBall()
    tree = Sequence("come", memory=True, children=[GoToPose(target=(0.5, 0.0)), closest])
    trial = Trial({blue(0): tree}, {blue(0): (3.0, 0.0, 0.0), blue(1): (-1.0, 0.0, 0.0)})
    trial.run(4.0, eventually("it is the closest", succeeds(closest)))
