"""The cooperation challenge as a task: who may move, what counts as a goal, and the challenge's points."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.challenges.cooperation import BALL_START, PLACES, CooperationJudge
from robobt.challenges.handover import JUNIOR_ROW, MAJOR_ROW
from robobt.learning import TASKS
from robobt.learning.envs import run_starts
from robobt.learning.envs.cooperation.task import CooperationSettings, CooperationTask
from robobt.learning.envs.starts import places_of, start_parts
from robobt.learning.training.teachers import script
from robobt.world.game import OPEN_PLAY, Team
from robobt.world.state import BallState, Frame, RobotId, RobotState


def made(n: int, **settings: object) -> CooperationTask:
    task = TASKS["cooperation"](CooperationSettings.model_validate(settings), n=n, seed=4)
    assert isinstance(task, CooperationTask)
    return task


def begun(ball: tuple[float, float, float, float]) -> CooperationTask:
    """Return a task whose ball begins at a place with a velocity."""
    task = made(1)
    start = task.sample_starts(1, 1)
    _, balls, _ = start_parts(start, task.robots)
    for name, value in zip(("x", "y", "vx", "vy"), ball, strict=True):
        balls[name] = value
    task.reset_to(start, seed=1)
    return task


STILL = np.tile([0.0, 0.0, 0.0, -1.0], 2)[None]


def test_without_spread_all_start_at_the_challenges_places() -> None:
    robots, balls, _ = start_parts(made(1, spread=0.0, held=0.0).sample_starts(1, 3), 2)
    assert places_of(robots).tolist() == [[list(place) for place in PLACES]] * 3
    assert places_of(balls).tolist() == [list(BALL_START)] * 3


def test_a_start_may_have_the_ball_in_the_first_robots_mouth() -> None:
    task = made(8, held=1.0)
    task.reset(seed=4)
    assert task.arenas.contact[:, MAJOR_ROW].all()


def test_only_the_robot_whose_turn_it_is_drives() -> None:
    task = made(4, held=1.0)
    task.reset(seed=4)
    drive = np.tile([1.0, 0.0, 0.0, -1.0], (4, 2))
    task.advance(drive)
    assert np.hypot(*task.arenas.robots[:, JUNIOR_ROW, 3:5].T) == pytest.approx(0.0)
    drive[:, 3] = 1.0
    for _ in range(20):
        task.advance(drive)
    speeds = np.hypot(*np.moveaxis(task.arenas.robots[..., 3:5], -1, 0))
    assert speeds[:, JUNIOR_ROW].min() > 0.2
    assert speeds[:, MAJOR_ROW] == pytest.approx(0.0, abs=1e-6)


def test_a_goal_that_the_second_robot_has_not_shot_is_no_success() -> None:
    task = begun((4.2, 0.0, 3.0, 0.0))
    results = [task.advance(STILL) for _ in range(5)]
    ended = [bool(result.terminated[0]) for result in results]
    assert any(ended)
    assert not any(result.success[0] for result in results)
    assert task._terms["goal"][0] == 0.0


def test_a_ball_that_is_too_fast_ends_the_episode() -> None:
    result = begun((0.0, 0.0, 4.0, 0.0)).advance(STILL)
    assert (result.terminated[0], result.success[0]) == (True, False)
    assert result.reward[0] < -0.2


def frame_of(task: CooperationTask, arena: int, tick: int) -> Frame:
    states, contact = task.arenas.robots[arena].tolist(), task.arenas.contact[arena].tolist()
    robots = tuple(
        RobotState(number, *state, ball_contact=contact[number]) for number, state in enumerate(states)
    )
    touch = int(task.arenas.touch[arena])
    last = None if touch < 0 else RobotId(Team.BLUE, touch)
    ball = BallState(*task.arenas.balls[arena].tolist())
    return Frame(0.03 * tick, task.settings.field, ball, robots, last_touch=last, period=0.03)


@pytest.mark.integration
def test_points_and_goals_are_those_of_the_challenge() -> None:
    task = made(6, decide_every=1)
    observation, policy = task.reset(seed=4), task.script()
    judges, over, goals = [CooperationJudge() for _ in range(6)], np.zeros(6, dtype=np.bool_), 0
    for arena, judge in enumerate(judges):
        judge.see(frame_of(task, arena, 0), OPEN_PLAY)
    for tick in range(1, 501):
        result = task.advance(policy(observation))
        observation = result.observation
        for arena in np.flatnonzero(~over):
            judges[arena].see(frame_of(task, arena, tick), OPEN_PLAY)
            told = judges[arena].figures()
            assert told["points"] == pytest.approx(task.points[arena])
            assert result.success[arena] == (told["goals"] == 1.0)
        goals += int(result.success[~over].sum())
        over |= result.terminated
    assert goals >= 4


def test_the_script_decides_for_both_robots_in_an_evaluation() -> None:
    task = made(3)
    observation = task.reset(seed=4)
    assert script(task).act(observation) == pytest.approx(task.script()(observation))


@pytest.mark.integration
def test_the_script_scores() -> None:
    task = made(32)
    assert run_starts(task, task.script(), task.sample_starts(5, 32), seed=5).success.mean() > 0.8


@pytest.mark.parametrize(
    "teams",
    [
        {"blue": ["learner"]},
        {"blue": ["learner"] * 3},
        {"blue": ["challenge", "learner"]},
        {"yellow": ["goalkeeper"]},
    ],
)
def test_other_teams_than_the_challenges_pair_are_refused(teams: dict[str, list[str]]) -> None:
    with pytest.raises(ValueError, match="two learners"):
        CooperationSettings.model_validate(teams)
