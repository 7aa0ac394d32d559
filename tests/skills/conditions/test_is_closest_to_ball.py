from __future__ import annotations

from robobt.skills import GoToPose, IsClosestToBall
from robobt.testing import Trial, blue, eventually, frame, robot, succeeds
from robobt.tree import Sequence, Status
from robobt.world import RobotState
from tests.skills.fixed_world import Alone

MATE = robot(0.0, 1.0, number=1)
OPPONENT = robot(0.0, 0.5)


def tick(me: RobotState) -> Status:
    return Alone(IsClosestToBall()).tick(frame(me, ball=(0.0, 0.0), mates=(MATE,), opponents=(OPPONENT,)))


def test_the_nearest_of_the_team_is_closest() -> None:
    assert tick(robot(0.9, 0.0)) is Status.SUCCESS
    assert tick(robot(1.1, 0.0)) is Status.FAILURE


def test_a_robot_that_comes_up_becomes_the_closest() -> None:
    closest = IsClosestToBall()
    tree = Sequence("come", memory=True, children=[GoToPose(target=(0.5, 0.0)), closest])
    trial = Trial({blue(0): tree}, {blue(0): (3.0, 0.0, 0.0), blue(1): (-1.0, 0.0, 0.0)})
    trial.run(4.0, eventually("it is the closest", succeeds(closest)))
