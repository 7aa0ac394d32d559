"""The obstacle challenge as a task: its courses, its obstacles, and the challenge's own judge."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.challenges.obstacles import ObstacleJudge, PlacementState
from robobt.challenges.touching import CourseTouch
from robobt.learning import TASKS
from robobt.learning.envs.obstacle_course.task import ObstacleCourseTask
from robobt.learning.envs.starts import start_parts
from robobt.world.state import BallState, Frame, RobotState


@pytest.fixture(scope="module")
def task() -> ObstacleCourseTask:
    made = TASKS["obstacle_course"](n=8, seed=4)
    assert isinstance(made, ObstacleCourseTask)
    made.reset()
    return made


def test_the_observation_begins_with_the_target_as_the_robot_sees_it(task: ObstacleCourseTask) -> None:
    seen = task.reset(seed=4)
    me = task.now.me
    ahead = np.cos(me["heading"]) * (4.35 - me["x"]) + np.sin(me["heading"]) * (1.35 - me["y"])
    assert seen[:, 0] == pytest.approx(ahead)
    gaps = np.hypot(seen[:, 6::4], seen[:, 7::4])
    assert (np.diff(gaps, axis=1) >= 0.0).all()


def test_obstacles_drive_to_and_fro_at_their_speed(task: ObstacleCourseTask) -> None:
    task.reset(seed=4)
    homes, ends, paces = task._homes.copy(), task._ends.copy(), task._paces.copy()
    moving = paces > 0.0
    assert moving.any()
    farthest, fastest = np.zeros_like(paces), np.zeros_like(paces)
    for _ in range(60):
        task.advance(np.zeros((8, task.action.size)))
        if task.ended is not None:
            break
        others = task.now.opponents
        here = np.stack((others["x"], others["y"]), axis=-1)
        farthest = np.maximum(farthest, np.linalg.norm(here - homes, axis=2))
        fastest = np.maximum(fastest, np.hypot(others["vx"], others["vy"]))
    assert (farthest[~moving] < 0.05).all()
    assert (farthest[moving] > 0.3).all()
    assert (fastest[moving] < paces[moving] + 0.05).all()
    assert (farthest <= np.linalg.norm(ends - homes, axis=2) + 0.05).all()


def test_a_touch_is_what_the_challenge_calls_one(task: ObstacleCourseTask) -> None:
    task.reset(seed=4)
    me, other = task.arenas.robots[0, 0], task.arenas.robots[0, 1]
    me[1] = other[1]
    for gap, touch in ((0.19, CourseTouch.NOTHING), (0.181, CourseTouch.ROBOT)):
        me[0] = other[0] + gap
        tick = type("Tick", (), {"now": task.now})()
        judge = ObstacleJudge()
        robots = [
            RobotState(number, float(x), float(y))
            for number, (x, y) in enumerate(task.arenas.robots[0, :, :2])
        ]
        others = tuple(RobotState(10 + robot.id, robot.x, robot.y) for robot in robots[1:])
        frame = Frame(1.0, task.settings.field, BallState(-4.3, 2.8), (robots[0],), others)
        judge.see(frame, PlacementState((-4.3, 2.8)).update(frame).game)
        assert task.touches(tick)[0] == judge.touched == touch


def test_a_start_has_the_course_of_its_seed() -> None:
    task = TASKS["obstacle_course"](n=1, seed=0)
    first, again = task.sample_starts(3, 4), task.sample_starts(3, 4)
    assert (first == again).all()
    robots, _, _ = start_parts(first, task.robots)
    assert len(np.unique(robots["x"][:, 0])) == 4
