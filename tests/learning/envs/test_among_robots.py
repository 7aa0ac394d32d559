"""Go-To-Ball among robots: who is in the way, what is seen of them, and how it ends."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from robobt.learning.envs import GoToBallAmongRobotsSettings, GoToBallTask, run_starts
from robobt.learning.envs.scripted import freest_way, straight_drive_among
from robobt.learning.opponents.patrols import PATROL_TRAITS, Patrols
from robobt.learning.training.teachers import playing, skill
from robobt.sim.records import COMMAND, size
from robobt.world import BallState, Frame, RobotState
from robobt.world.avoiding import (
    AHEAD,
    FIRST_WAY,
    LAG,
    MARGIN,
    SLOW_WAYS,
    WAY_SPEED,
    WAYS,
    among_robots_of,
    among_robots_rows,
)
from robobt.world.field import DIVISION_B
from robobt.world.limits import RobotLimits

STAY = np.zeros((1, 3))


def _cross(a: Any, b: Any) -> Any:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def task(n: int = 1, **changes: Any) -> GoToBallTask:
    return GoToBallTask(GoToBallAmongRobotsSettings.model_validate(changes), n, seed=0)


def alone_with(robot: list[float], other: list[float], ball: list[float], to: list[float]) -> GoToBallTask:
    """One robot in the way, which drives from where it is to ``to`` at 1 m/s."""
    made = task(others={"count": 1})
    made.reset_to([*robot, 0, 0, 0, *other, 0, 0, 0, *ball, 0, 0, *other[:2], *to, 1.0], seed=0)
    return made


def test_a_robot_that_is_run_into_ends_the_episode_without_success() -> None:
    made = alone_with([0, 0, 0], [1.5, 0, np.pi], [3, 0], [-3, 0])
    for _ in range(40):
        result = made.advance(STAY)
        if made.ended is not None:
            break
    assert result.terminated[0]
    assert not result.success[0]
    assert result.reward[0] < -made.settings.reward.touched
    assert np.hypot(*(made.arenas.robots[0, 1, :2] - made.arenas.robots[0, 0, :2])) < 0.185


def test_the_ball_is_reached_past_a_robot_that_is_elsewhere() -> None:
    made = alone_with([0, 0, 0], [0, 2, 0], [1, 0], [3, 2])
    episodes = run_starts(
        made, straight_drive_among, [[0, 0, 0, 0, 0, 0, 0, 2, *[0] * 4, 1, *[0] * 3, 0, 2, 3, 2, 1]]
    )
    assert episodes.success.all()
    assert episodes.time[0] == pytest.approx(episodes.optimum[0], abs=0.07)
    assert episodes.total_reward[0] == pytest.approx(5 + 0.8 * 0.5 - 0.005 * episodes.ticks[0], abs=0.05)


def test_starts_are_what_the_specification_says() -> None:
    made = task()
    rows, others = made.sample_starts(3, 400), made.settings.others
    states, traits = rows[:, 6:36].reshape(-1, 5, 6), rows[:, 40:].reshape(-1, 5, len(PATROL_TRAITS))
    at, first, last = states[..., :2], traits[..., :2], traits[..., 2:4]
    way, robot, ball = last - first, rows[:, None, :2], rows[:, None, 36:38]
    length = np.linalg.norm(way, axis=-1)
    assert length.min() >= others.way
    assert (np.abs(rows[:, 36:38]) <= [4.4, 2.9]).all()
    assert np.linalg.norm(at - robot, axis=-1).min() >= others.apart
    # On the way, and driving along it.
    across = _cross(way, at - first) / length
    np.testing.assert_allclose(across, 0.0, atol=1e-9)
    np.testing.assert_allclose(states[..., 3:5], way / length[..., None] * traits[..., 4:], atol=1e-9)
    share = np.clip(((ball - first) * way).sum(-1) / length**2, 0.0, 1.0)[..., None]
    assert np.linalg.norm(first + share * way - ball, axis=-1).min() >= others.from_ball - 1e-9
    apart = np.linalg.norm(at[:, :, None] - at[:, None], axis=-1) + 9.0 * np.eye(5)
    assert apart.min() >= 0.27
    # Six of ten cross the way to the ball, and some of the others.
    to_ball = (ball - robot)[:, 0]
    sides = [np.sign(_cross(to_ball[:, None], end - robot)) for end in (first, last)]
    of_robot = np.sign(_cross(way, robot - first)) != np.sign(_cross(way, ball - first))
    assert 0.6 < ((sides[0] != sides[1]) & of_robot).mean() < 0.8


def test_starts_that_cannot_be_are_refused() -> None:
    with pytest.raises(ValueError, match=r"others: no way of 9\.9 m"):
        task(others={"count": 1, "way": 9.9, "from_ball": 3.0}).sample_starts(0, 50)
    with pytest.raises(ValueError, match="to_shoot: not together with others"):
        task(to_shoot=True)


def test_a_patrol_goes_to_and_fro_and_turns_round_where_it_is_held_up() -> None:
    made = task(others={"count": 1})
    start = [-4, -2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, -4, 2, 0, 0, 0, 2, 1.5, 2, 1.0]
    made.reset_to([start], seed=0)
    xs = []
    for _ in range(120):
        made.advance(STAY)
        xs.append(float(made.arenas.robots[0, 1, 0]))
    assert max(xs) == pytest.approx(1.5, abs=0.12)
    assert min(xs[60:]) == pytest.approx(0.0, abs=0.15)
    patrols = Patrols(RobotLimits(), 0.03, 1, 1)
    patrols.restart(np.array([0]), np.array([[[0.0, 0.0, 2.0, 0.0, 1.0]]]))
    commands, held = np.zeros((1, 2, size(COMMAND))), np.array([[[9.0] * 6, [1.0, 0, 0, 0, 0, 0]]])
    ahead = []
    for _ in range(14):
        patrols.decide(held, commands)
        ahead.append(commands.view(COMMAND)["vx"][0, 1, 0])
    assert ahead[0] == pytest.approx(1.0)
    assert ahead[-1] == pytest.approx(-1.0)


def test_a_way_is_free_until_two_that_go_on_come_near() -> None:
    rng = np.random.default_rng(4)
    robots = rng.uniform(-2.0, 2.0, (50, 4, 6))
    ball = rng.uniform(-3, 3, (50, 4))
    free = among_robots_rows(robots, ball)[:, FIRST_WAY:]
    times = np.linspace(0.0, AHEAD, 2001)
    to_ball = np.arctan2(ball[:, 1] - robots[:, 0, 1], ball[:, 0] - robots[:, 0, 0])
    for way in range(WAYS + SLOW_WAYS + 1):
        speed, angle = 0.0, 0.0
        if way < WAYS:
            speed, angle = WAY_SPEED, 2 * np.pi * way / WAYS
        elif way < WAYS + SLOW_WAYS:
            speed, angle = WAY_SPEED / 2, 2 * np.pi * (way - WAYS) / SLOW_WAYS
        velocity = speed * np.column_stack((np.cos(to_ball + angle), np.sin(to_ball + angle)))
        # Half the lag is driven as before.
        begins = robots[:, 0, :2] + LAG / 2 * (robots[:, 0, 3:5] - velocity)
        away = robots[:, 1:, :2] - begins[:, None]
        against = robots[:, 1:, 3:5] - velocity[:, None]
        gaps = np.linalg.norm(away[:, :, None] + times[:, None] * against[:, :, None], axis=-1) - 0.18
        closing = (away * against).sum(-1) < 0.0
        near = (gaps < MARGIN) & closing[..., None]
        expected = np.where(near.any(-1), times[near.argmax(-1)], AHEAD).min(-1)
        np.testing.assert_allclose(free[:, way], expected, atol=2e-3)


def test_the_freest_way_touches_hardly_anybody() -> None:
    made = task(30)
    episodes = run_starts(made, freest_way, made.sample_starts(6, 60))
    assert episodes.success.sum() >= 58


def test_it_is_seen_likewise_in_a_match() -> None:
    rng = np.random.default_rng(5)
    robots, ball = rng.uniform(-1.0, 1.0, (4, 6)), rng.uniform(-1.0, 1.0, 4)
    own = tuple(RobotState(number, *robots[number].tolist()) for number in range(2))
    opponents = tuple(RobotState(number, *robots[2 + number].tolist()) for number in range(2))
    frame = Frame(0.0, DIVISION_B, BallState(*ball.tolist()), own, opponents)
    order = robots[[1, 0, 2, 3]]
    np.testing.assert_array_equal(
        among_robots_of(frame, own[1]), among_robots_rows(order[None], ball[None])[0]
    )
    alone = Frame(0.0, DIVISION_B, BallState(*ball.tolist()), own[1:], ())
    np.testing.assert_array_equal(among_robots_of(alone, own[1])[FIRST_WAY:], AHEAD)


@pytest.mark.integration
def test_the_hand_written_planner_gets_through_as_well_as_a_script_that_sees_when_ways_are_free() -> None:
    made = task(30)
    starts = made.sample_starts(6, 60)
    assert run_starts(made, playing(made, skill(made)), starts).success.sum() >= 58
