"""The dribbling challenge as a task: its gates, its posts, and the challenge's own judge."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.challenges.dribbling import GateJudge
from robobt.learning import TASKS
from robobt.learning.envs import run_starts
from robobt.learning.envs.dribbling.task import POSTS, DribblingSettings, DribblingTask
from robobt.learning.envs.starts import start_parts
from robobt.skills.challenges.carry_along import GATES
from robobt.world.game import OPEN_PLAY
from robobt.world.state import BALL_RADIUS, BallState, Frame, RobotState


def made(n: int, seed: int, **settings: object) -> DribblingTask:
    task = TASKS["dribbling"](DribblingSettings.model_validate(settings), n=n, seed=seed)
    assert isinstance(task, DribblingTask)
    return task


def test_an_episode_starts_with_the_ball_and_clear_of_the_posts() -> None:
    task = made(8, 4)
    robots, balls, rest = start_parts(task.sample_starts(1, 200), task.robots)
    assert set(rest[:, 0]) == set(range(len(GATES)))
    me = robots[:, 0]
    gaps = np.hypot(POSTS[:, 0] - me["x"][:, None], POSTS[:, 1] - me["y"][:, None])
    assert gaps.min() > 0.2
    ahead = task.settings.simulator.body.face + BALL_RADIUS
    assert np.hypot(balls["x"] - me["x"], balls["y"] - me["y"]) == pytest.approx(ahead, abs=1e-3)
    task.reset(seed=4)
    assert task.arenas.contact[:, 0].all()


def test_the_point_beyond_the_gate_is_on_its_other_side_and_its_posts_are_right_and_left() -> None:
    task = made(32, 4)
    seen = task.reset(seed=4)
    beyond, right, left = seen[:, 7:9], seen[:, 9:11], seen[:, 11:13]
    middle = 0.5 * (right + left)
    assert (np.linalg.norm(beyond, axis=1) > np.linalg.norm(middle, axis=1)).all()
    # Turned to the point, the robot has the right post on its right.
    assert (beyond[:, 0] * right[:, 1] - beyond[:, 1] * right[:, 0] < 0.0).all()
    assert (beyond[:, 0] * left[:, 1] - beyond[:, 1] * left[:, 0] > 0.0).all()


@pytest.mark.integration
def test_gates_and_touches_are_those_of_the_challenge() -> None:
    task = made(6, 4, first=[0, 0], gates=9, time_limit=4000)
    observation, policy = task.reset(seed=4), task.script()
    judges, over = [GateJudge() for _ in range(6)], np.zeros(6, dtype=np.bool_)
    for tick in range(400):
        result = task.advance(policy(observation))
        observation = result.observation
        for arena in np.flatnonzero(~over):
            states = task.arenas.robots[arena]
            robots = [RobotState(number, float(x), float(y)) for number, (x, y) in enumerate(states[:, :2])]
            posts = tuple(RobotState(number, one.x, one.y) for number, one in enumerate(robots[1:]))
            ball = BallState(*task.arenas.balls[arena, :2].tolist())
            frame = Frame(0.03 * tick, task.settings.field, ball, (robots[0],), posts)
            over[arena] = judges[arena].see(frame, OPEN_PLAY)
            assert judges[arena].passed == task.passed[arena]
            assert over[arena] == result.terminated[arena]
    assert max(judge.passed for judge in judges) >= 3


@pytest.mark.integration
def test_the_script_passes_most_gates() -> None:
    task = made(48, 4)
    assert run_starts(task, task.script(), task.sample_starts(5, 96), seed=5).success.mean() > 0.75
