"""Ball placement as a task: starts, what is observed and paid, and the referee's own rule."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.challenges.ball_placement import PLACEMENTS
from robobt.learning import TASKS
from robobt.learning.envs import run_starts
from robobt.learning.envs.ball_placement.task import BallPlacementSettings, BallPlacementTask
from robobt.learning.envs.starts import places_of, start_parts
from robobt.match.referee.automatic import AutomaticReferee
from robobt.match.referee.events import EventKind
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from robobt.world.state import BallState, Frame, RobotState


def made(n: int, seed: int, **settings: object) -> BallPlacementTask:
    task = TASKS["ball_placement"](BallPlacementSettings.model_validate(settings), n=n, seed=seed)
    assert isinstance(task, BallPlacementTask)
    return task


def test_published_starts_are_the_challenges_own() -> None:
    task = made(1, 4, published=1.0)
    _, balls, spots = start_parts(task.sample_starts(1, 100), 1)
    drawn = {(*ball, *spot) for ball, spot in zip(places_of(balls).tolist(), spots.tolist(), strict=True)}
    assert drawn == {(*start, *spot) for start, spot, _ in PLACEMENTS}


def test_other_starts_lie_as_far_from_the_lines_as_the_challenges_do() -> None:
    task = made(1, 4, published=0.0, longest=2.0)
    robots, balls, spots = start_parts(task.sample_starts(1, 400), 1)
    lines = np.array([task.settings.field.half_length, task.settings.field.half_width])
    beyond = np.abs(places_of(balls)) - lines
    assert 0.1 < beyond.max() <= 0.15
    assert (lines - np.abs(spots)).min() >= 0.2
    way = np.linalg.norm(places_of(balls) - spots, axis=1)
    assert (way.min() > 0.15, way.max() <= 2.0) == (True, True)
    assert np.linalg.norm(places_of(balls) - places_of(robots)[:, 0], axis=1).min() >= 0.3


def test_the_robot_sees_the_way_from_the_ball_to_the_spot() -> None:
    task = made(1, 4)
    start = task.sample_starts(1, 1)
    robots, balls, spots = start_parts(start, 1)
    robots["x"], robots["y"], robots["heading"] = 0.0, 0.0, np.pi / 2.0
    balls["x"], balls["y"], spots[:] = 1.0, 0.5, (1.0, 2.5)
    seen = task.reset_to(start, seed=1)[0]
    assert seen[:2] == pytest.approx([0.5, -1.0])
    assert seen[-2:] == pytest.approx([2.0, 0.0])


def test_the_ball_is_paid_for_every_metre_that_it_gets_nearer() -> None:
    task = made(4, 4)
    observation, policy = task.reset(seed=4), task.script()
    way = np.linalg.norm(places_of(task.now.balls) - task._spots, axis=1)
    for _ in range(60):
        observation = task.advance(policy(observation)).observation
    left = np.linalg.norm(places_of(task.now.balls) - task._spots, axis=1)
    assert (left < way).any()
    assert task._terms["nearer"] == pytest.approx(way - left)


@pytest.mark.integration
def test_an_episode_succeeds_in_the_tick_in_which_the_referee_sees_the_ball_placed() -> None:
    task = made(4, 4, decide_every=1)
    observation, policy = task.reset(seed=5), task.script()
    referees = [AutomaticReferee(task.settings.field) for _ in range(4)]
    placed, ended = np.zeros(4), np.zeros(4)
    for tick in range(800):
        for arena in np.flatnonzero(placed == 0.0):
            spot = tuple(task._spots[arena].tolist())
            game = GameState(
                RefereeCommand.BALL_PLACEMENT_BLUE,
                restart=Restart.BALL_PLACEMENT,
                restart_team=Team.BLUE,
                placement=spot,
                upcoming=RefereeCommand.DIRECT_FREE_BLUE,
            )
            me = RobotState(0, *task.arenas.robots[arena, 0, :3].tolist())
            ball = BallState(*task.arenas.balls[arena].tolist())
            frame = Frame(0.03 * tick, task.settings.field, ball, (me,), period=0.03)
            events = referees[arena].watch(frame, game)
            if any(event.kind is EventKind.PLACEMENT_SUCCEEDED for event in events):
                placed[arena] = tick
        result = task.advance(policy(observation))
        observation = result.observation
        ended[result.success & (ended == 0.0)] = tick + 1
    assert (placed > 0.0).sum() >= 3
    assert placed == pytest.approx(ended)


@pytest.mark.integration
def test_the_script_places_nearly_every_ball() -> None:
    task = made(48, 4)
    assert run_starts(task, task.script(), task.sample_starts(5, 48), seed=5).success.mean() > 0.9


@pytest.mark.parametrize("field", ["hardware_challenge", {"width": 5.0}])
def test_the_challenges_scenarios_need_its_field(field: object) -> None:
    with pytest.raises(ValueError, match="division B"):
        made(1, 4, field=field)
    robots, balls, _ = start_parts(
        made(1, 4, field="hardware_challenge", published=0.0).sample_starts(1, 50), 1
    )
    assert max(np.abs(robots["x"]).max(), np.abs(balls["x"]).max()) <= 3.15


def test_a_ball_in_a_corner_has_a_spot_that_is_near_enough() -> None:
    with pytest.raises(ValueError, match="longest"):
        made(1, 4, longest=0.5)
    task = made(1, 4, longest=0.6)
    lines = np.array([task.settings.field.half_length, task.settings.field.half_width])
    spot = task._spot(np.random.default_rng(1), lines + 0.15, lines - 0.2)
    assert np.linalg.norm(lines + 0.15 - spot) < 0.6


def test_an_action_that_does_not_switch_the_dribbler_is_refused() -> None:
    with pytest.raises(ValueError, match="drive_and_hold"):
        made(1, 4, action={"kind": "drive", "max_speed": 1.5, "max_turn": 3.0})
