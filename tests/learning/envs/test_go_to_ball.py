"""Go-To-Ball rewards, ends and is solved as specified."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin
from typing import Any

import numpy as np
import pytest

from robobt.learning.envs import GoToBallSettings, GoToBallTask, run_starts, straight_line_time
from robobt.learning.envs.scripted import drive_to_shoot, straight_drive
from robobt.world import RobotLimits
from robobt.world.geometry import wrap_angle

LATE = {"contact": {"distance": 0.06}}
"""A contact rule that lets the reward be looked at up close."""

TABLE = [
    (0.1115, 0.381, 0.193),
    (0.2, 0.354, 0.166),
    (0.3, 0.306, 0.118),
    (0.5, 0.159, -0.029),
    (0.663, 0.0, -0.188),
    (1.0, -0.391, -0.579),
    (2.0, -1.331, -1.519),
    (3.0, -1.579, -1.767),
    (4.0, -1.600, -1.788),
]
"""Distance, and reward facing the ball and facing away; to the digits that were given."""


def start(
    x: float = 0.0, y: float = 0.0, heading: float = 0.0, ball: tuple[float, float] = (1.0, 0.0)
) -> list[float]:
    return [x, y, heading, 0.0, 0.0, 0.0, *ball, 0.0, 0.0]


def task(starts: list[list[float]], **changes: Any) -> GoToBallTask:
    made = GoToBallTask(GoToBallSettings.model_validate(changes), len(starts))
    made.reset_to(starts, seed=0)
    return made


def standing(n: int) -> np.ndarray:
    return np.zeros((n, 3))


@pytest.mark.parametrize(("distance", "facing", "away"), TABLE)
def test_the_reward_of_distance_and_orientation(distance: float, facing: float, away: float) -> None:
    made = task([start(ball=(distance, 0)), start(heading=pi, ball=(distance, 0))], **LATE)
    reward = made.step(standing(2)).reward
    np.testing.assert_allclose(reward, [facing, away], rtol=0, atol=6e-4)
    exact = 5 / np.sqrt(2 * pi) * np.exp(-(distance**2) / 2) - 2
    np.testing.assert_allclose(reward, exact + np.exp([0.0, -2 / pi]) / np.sqrt(2 * pi), rtol=0, atol=1e-4)


def test_the_orientation_counts_to_the_first_power() -> None:
    made = task([start(heading=0.5), start(heading=1.0), start(heading=-1.0)], **LATE)
    reward = made.step(standing(3)).reward
    distance = 5 / np.sqrt(2 * pi) * np.exp(-0.5) - 2
    expected = distance + np.exp(-2 * np.array([0.5, 1.0, 1.0]) / pi**2) / np.sqrt(2 * pi)
    np.testing.assert_allclose(reward, expected, rtol=0, atol=1e-9)


def test_contact_is_worth_a_hundred_on_top_and_ends_the_episode() -> None:
    made = task([start(ball=(0.2, 0.0)), start(ball=(0.21, 0.0))])
    result = made.step(standing(2))
    assert result.reward[0] == pytest.approx(100.354, abs=1e-3)
    assert result.terminated.tolist() == [True, False]
    assert result.success.tolist() == [True, False]
    assert not result.truncated.any()


def test_weights_change_the_reward() -> None:
    changes = {"reward": {"contact": 7, "distance": 0, "orientation": 0, "time": 0.5}}
    made = task([start(ball=(0.2, 0.0)), start()], **changes)
    np.testing.assert_allclose(made.step(standing(2)).reward, [6.5, -0.5], atol=1e-12)


def test_the_time_limit_truncates_and_success_goes_before() -> None:
    made = task([start()], time_limit=5)
    results = [made.step(standing(1)) for _ in range(5)]
    assert [bool(result.truncated[0]) for result in results] == [False] * 4 + [True]
    assert not results[-1].terminated[0]
    # The limit falls on the tick of the contact.
    moving = task([start(ball=(0.23, 0))])
    ticks = 1
    while not moving.step(np.array([[1.0, 0, 0]])).terminated[0]:
        ticks += 1
    last = task([start(ball=(0.23, 0))], time_limit=ticks)
    for _ in range(ticks):
        result = last.step(np.array([[1.0, 0, 0]]))
    assert result.terminated[0]
    assert result.success[0]
    assert not result.truncated[0]


def test_facing_is_needed_where_the_rule_says_so() -> None:
    starts = [start(ball=(0.19, 0)), start(heading=0.4, ball=(0.19, 0)), start(heading=0.6, ball=(0.19, 0))]
    made = task(starts, contact={"rule": "distance_facing"})
    assert made.step(standing(3)).success.tolist() == [True, True, False]


def test_infrared_needs_the_ball_in_the_mouth() -> None:
    starts = [start(ball=(0.105, 0)), start(ball=(0.12, 0)), start(heading=pi, ball=(0.12, 0))]
    made = task(starts, contact={"rule": "infrared"})
    assert made.step(standing(3)).success.tolist() == [True, False, False]


def test_held_needs_the_ball_in_the_mouth_for_a_while() -> None:
    dribbling = {"kind": "drive", "max_speed": 1.5, "max_turn": 1.395, "dribbler": True}
    made = task([start(ball=(0.1, 0)), start()], contact={"rule": "held", "ticks": 4}, action=dribbling)
    ends = [made.step(standing(2)).success.tolist() for _ in range(4)]
    assert ends == [[False, False]] * 3 + [[True, False]]


def test_a_robot_that_is_too_fast_has_not_reached_the_ball() -> None:
    fast, slow = ([0.0, 0.0, 0.0, speed, 0, 0, 0.25, 0, 0, 0] for speed in (1.2, 0.3))
    made = task(
        [fast, slow], contact={"max_speed": 0.5}, action={"kind": "drive", "max_speed": 3, "max_turn": 1}
    )
    hold = np.array([[1.0, 0, 0], [0.1, 0, 0]])
    results = [made.step(hold) for _ in range(8)]
    assert not results[2].success[0]
    assert any(result.success[1] for result in results)


@pytest.mark.integration
def test_driving_straight_reaches_every_start_in_the_optimal_time() -> None:
    made = GoToBallTask(n=128, seed=0)
    episodes = run_starts(made, straight_drive, made.sample_starts(11, 512))
    assert episodes.success.all()
    ticks = (episodes.time - episodes.optimum) / made.settings.period
    assert ticks.max() <= 2.0
    # Velocities change at the start of a physics step: a robot is half a step ahead of the formula.
    assert ticks.min() >= -0.5
    assert episodes.time_ratio == pytest.approx(1.0, abs=0.01)


@pytest.mark.integration
def test_random_actions_hardly_ever_reach_the_ball() -> None:
    made, rng = GoToBallTask(n=128, seed=0), np.random.default_rng(4)
    episodes = run_starts(made, lambda seen: rng.uniform(-1, 1, (len(seen), 3)), made.sample_starts(12, 512))
    assert episodes.success.mean() <= 0.03


def test_hovering_beside_the_ball_is_worth_less_than_touching_it() -> None:
    gamma = 0.99

    def worth(policy: Any) -> float:
        made = task([start(ball=(0.6, 0))])
        seen, total, discount = made.observe(made.arenas.robots, made.arenas.balls), 0.0, 1.0
        for _ in range(330):
            result = made.step(policy(seen))
            total += discount * float(result.reward[0])
            discount *= gamma
            seen = result.observation
            if result.terminated[0]:
                return total
        # Cut off by the limit, not ended: what it goes on earning counts.
        return total + discount * float(result.reward[0]) / (1 - gamma)

    def hover(seen: np.ndarray) -> np.ndarray:
        speed = np.clip(6.0 * (seen[:, 2] - 0.22), -1, 1)
        return np.stack((speed * seen[:, 1], speed * seen[:, 0], seen[:, 0]), axis=-1)

    touching, hovering = worth(straight_drive), worth(hover)
    assert hovering > 25.0
    assert touching > 2.0 * hovering


@pytest.mark.parametrize(("dx", "dy", "turn"), [(0.7, -0.4, 2.1), (-0.5, 0.3, -1.2), (0.0, 0.0, pi / 2)])
def test_where_and_which_way_round_does_not_matter(dx: float, dy: float, turn: float) -> None:
    def moved(x: float, y: float) -> tuple[float, float]:
        return dx + cos(turn) * x - sin(turn) * y, dy + sin(turn) * x + cos(turn) * y

    here = start(0.2, -0.3, 0.4, (1.1, 0.6))
    there = start(*moved(0.2, -0.3), wrap_angle(0.4 + turn), moved(1.1, 0.6))
    rng = np.random.default_rng(5)
    one, other = task([here]), task([there])
    for _ in range(40):
        action = rng.uniform(-1, 1, (1, 3))
        a, b = one.step(action), other.step(action)
        np.testing.assert_allclose(a.observation, b.observation, rtol=0, atol=1e-9)
        np.testing.assert_allclose(a.reward, b.reward, rtol=0, atol=1e-9)


def test_left_is_as_good_as_right() -> None:
    left = [0.2, 0.3, 0.4, 0.3, 0.2, 0.5, 1.1, 0.9, 0.3, -0.2]
    signs = np.array([1, -1, -1, 1, -1, -1, 1, -1, 1, -1])
    one, other = task([left]), task([(signs * left).tolist()])
    rng, seen = np.random.default_rng(6), np.array([-1, 1, 1, 1, -1, -1])
    for _ in range(40):
        action = rng.uniform(-1, 1, (1, 3))
        a, b = one.step(action), other.step(action * [1, -1, -1])
        np.testing.assert_allclose(a.observation, b.observation * seen, rtol=0, atol=1e-9)
        np.testing.assert_allclose(a.reward, b.reward, rtol=0, atol=1e-9)


def test_starts_are_inside_the_lines_and_apart() -> None:
    made = GoToBallTask()
    starts = made.sample_starts(3, 2000)
    field = made.settings.field
    for column in (0, 6):
        assert np.abs(starts[:, column]).max() <= field.half_length - 0.1
        assert np.abs(starts[:, column]).max() > field.half_length - 0.2
        assert np.abs(starts[:, column + 1]).max() <= field.half_width - 0.1
    assert np.hypot(starts[:, 6] - starts[:, 0], starts[:, 7] - starts[:, 1]).min() >= 0.2
    assert starts[:, 2].min() < -3.0
    assert starts[:, 2].max() > 3.0
    assert (starts[:, [3, 4, 5, 8, 9]] == 0.0).all()


def test_starts_follow_their_ranges() -> None:
    settings = GoToBallSettings.model_validate(
        {
            "field": "hardware_challenge",
            "starts": {
                "robot_x": (-1, -0.5),
                "ball_y": (0.2, 0.4),
                "ball_speed": (0.5, 1.5),
                "robot_turn": (1, 2),
                "robot_speed": (0.2, 0.3),
                "distance": (0.5, 1.0),
            },
        }
    )
    starts = GoToBallTask(settings).sample_starts(3, 500)
    assert np.abs(starts[:, 1]).max() <= 1.9
    assert ((starts[:, 0] >= -1) & (starts[:, 0] <= -0.5)).all()
    assert ((starts[:, 7] >= 0.2) & (starts[:, 7] <= 0.4)).all()
    speed = np.hypot(starts[:, 8], starts[:, 9])
    assert 0.5 <= speed.min() < 0.6 < 1.4 < speed.max() <= 1.5
    assert ((starts[:, 5] >= 1) & (starts[:, 5] <= 2)).all()
    gap = np.hypot(starts[:, 6] - starts[:, 0], starts[:, 7] - starts[:, 1])
    assert 0.5 <= gap.min() < gap.max() <= 1.0


def test_a_distance_that_cannot_be_is_said() -> None:
    settings = GoToBallSettings.model_validate({"starts": {"distance": (50, 60)}})
    with pytest.raises(ValueError, match="50 m to 60 m apart"):
        GoToBallTask(settings).reset(seed=0)


def test_a_moving_ball_and_robot_start_in_motion() -> None:
    made = task([[0, 0, 0.5, 0.4, -0.3, 1.0, 2.0, 1.0, -0.5, 0.2]])
    seen = made.observe(made.arenas.robots, made.arenas.balls)
    assert hypot(seen[0, 3], seen[0, 4]) == pytest.approx(0.5)
    assert seen[0, 5] == pytest.approx(1.0)
    result = made.step(standing(1))
    assert not result.terminated[0]
    assert atan2(*made.arenas.balls[0, 3:1:-1]) == pytest.approx(atan2(0.2, -0.5))


def test_the_straight_lines_time() -> None:
    # 0.375 m to reach 1.5 m/s at 3 m/s^2.
    np.testing.assert_allclose(
        straight_line_time([0.0, 0.375, 1.875, 0.1, -1.0], 1.5, 3.0), [0, 0.5, 1.5, (0.2 / 3) ** 0.5, 0]
    )


def test_the_robots_own_limits_set_the_optimum() -> None:
    limits = RobotLimits(max_speed=1.0, acceleration=2.0)
    made = GoToBallTask(GoToBallSettings(limits=limits), n=1)
    episodes = run_starts(made, straight_drive, [start(ball=(2.2, 0))])
    assert episodes.optimum[0] == pytest.approx(2.25)
    assert episodes.time[0] == pytest.approx(2.25, abs=0.06)


def test_there_is_no_straight_line_to_a_ball_that_moves() -> None:
    made = GoToBallTask(n=2)
    episodes = run_starts(made, straight_drive, [[0, 0, 0, 0, 0, 0, 1, 0, 0.3, 0], start()])
    assert np.isfinite(episodes.optimum).tolist() == [False, True]
    assert episodes.time_ratio == pytest.approx(episodes.time[1] / episodes.optimum[1])


SHOOTING: dict[str, Any] = {"to_shoot": True, "contact": {"rule": "infrared"}, "simulator": "rsim"}
HELD = 0.1035
"""Distance of a ball in the mouth of that simulator's robot [m]."""


def test_a_robot_that_is_to_shoot_has_reached_the_ball_only_facing_the_goal() -> None:
    """At rest 4.4 m from the goal: its posts lie 6.5 degrees to each side, of which 0.15 m do not count."""
    angles = np.radians([0.0, 3.0, -3.0, 6.5, -30.0, 180.0])
    starts = [start(0, 0, angle, (HELD * cos(angle), HELD * sin(angle))) for angle in angles]
    result = task(starts, **SHOOTING).step(standing(len(angles)))
    assert result.success.tolist() == [True, True, True, False, False, False]
    assert result.observation.shape == (len(angles), 8)


def test_a_ball_that_moves_sideways_with_the_robot_misses_the_goal() -> None:
    """Kicked at 6 m/s with 1.5 m/s sideways it leaves 14 degrees off the heading."""
    row = start(0, 0, 0.0, (HELD, 0.0))
    row[4] = row[9] = 1.5
    drive = np.array([[0.0, 1.0, 0.0]])
    assert not task([row], **SHOOTING).step(drive).success[0]
    row[2] = -atan2(1.5, 6.0)
    row[6:8] = [HELD * cos(row[2]), HELD * sin(row[2])]
    made = task([row], **SHOOTING, action={"kind": "drive", "max_speed": 1.5, "max_turn": 1.0})
    assert made.step(np.array([[sin(row[2]), cos(row[2]), 0.0]])).success[0]


def test_it_is_rewarded_for_the_speed_towards_the_place_behind_the_ball() -> None:
    """The place lies 0.1 m behind the ball on the line to the goal."""
    weights = {"contact": 0, "distance": 0, "orientation": 0, "closing": 2.0}
    row = start(0, 0, 0.0, (1.0, 0.0))
    row[3] = 1.0
    made = task([row], **SHOOTING, reward=weights)
    reward = made.step(np.array([[1.0, 0.0, 0.0]])).reward[0]
    assert reward == pytest.approx(2.0 * made.arenas.robots[0, 0, 3], abs=1e-9)
    assert reward > 2.0


def test_top_speeds_differ_from_episode_to_episode() -> None:
    starts = [start(-2.0, 0.0, 0.0, (2.0, 0.0))] * 40
    made = task(starts, randomisation={"top_speed": (0.5, 1.0)}, limits={"max_speed": 1.0})
    for _ in range(40):
        made.step(np.tile([1.0, 0.0, 0.0], (40, 1)))
    speeds = np.hypot(made.arenas.robots[:, 0, 3], made.arenas.robots[:, 0, 4])
    assert 0.45 < speeds.min() < 0.6
    assert 0.9 < speeds.max() <= 1.0 + 1e-9


def test_the_script_that_is_to_shoot_comes_from_behind() -> None:
    starts = [start(-2.0, 0.2, 0.3, (0.0, 0.0)), start(-1.0, -0.5, -2.0, (0.5, 0.0))]
    made = task(starts, **SHOOTING)
    episodes = run_starts(made, lambda seen: drive_to_shoot(seen, made.action.max_turn), np.array(starts), 0)
    assert episodes.success.all()
    assert episodes.time_ratio < 1.15
