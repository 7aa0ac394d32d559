from robobt.skills.aim.aim_at_goal_point import AimAtGoalPoint
from robobt.skills.store import Shot
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import DIVISION_A
from tests.skills.fixed_world import Alone


def test_the_shot_is_at_that_point_of_this_fields_goal_line():
    alone = Alone(AimAtGoalPoint(y=0.3, tolerance=0.01))
    assert alone.tick(frame(robot(), field=DIVISION_A)) is Status.SUCCESS
    assert alone.store.shot == Shot((6.0, 0.3), 0.01, 0.0)
