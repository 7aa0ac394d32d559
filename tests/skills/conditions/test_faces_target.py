from __future__ import annotations

from math import radians

from py_trees.common import ParallelPolicy

from robobt.skills import FacesTarget, GoToPose
from robobt.testing import alone, eventually, frame, robot, succeeds
from robobt.tree import Parallel, Status
from tests.skills.fixed_world import Alone


def test_without_a_target_it_fails() -> None:
    assert Alone(FacesTarget()).tick(frame(robot())) is Status.FAILURE


def test_the_target_comes_from_the_parameter_or_the_store() -> None:
    assert Alone(FacesTarget(), target=(1.0, 0.0)).tick(frame(robot())) is Status.SUCCESS
    assert Alone(FacesTarget(target=(0.0, 1.0)), target=(1.0, 0.0)).tick(frame(robot())) is Status.FAILURE


def test_the_tolerance_is_an_angle_either_way_round() -> None:
    for heading, expected in ((4.0, Status.SUCCESS), (-4.0, Status.SUCCESS), (6.0, Status.FAILURE)):
        alone = Alone(FacesTarget(target=(-1.0, 0.0), tolerance=radians(5.0)))
        assert alone.tick(frame(robot(heading=radians(180.0 - heading)))) is expected


def test_a_robot_that_turns_comes_to_face_it() -> None:
    faces = FacesTarget(target=(0.0, 2.0))
    turn = GoToPose(target=(0.0, 0.0), heading=radians(90.0))
    tree = Parallel("turn", policy=ParallelPolicy.SuccessOnOne(), children=[turn, faces])
    trial = alone(tree, (0.0, 0.0, 0.0), (2.0, 0.0))
    trial.run(2.0, eventually("it faces the target", succeeds(faces)))
