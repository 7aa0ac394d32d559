"""Shoot rewards, ends and is solved as specified."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from robobt.config.validation import first_problem
from robobt.learning.envs import ShootReward, ShootSettings, ShootTask, run_starts
from robobt.learning.envs.scripted import turn_and_kick
from robobt.world.geometry import wrap_angle
from robobt.world.state import BALL_RADIUS

HOLD, KICK = [0.0, -1.0], [0.0, 1.0]


def start(x: float = 2.0, y: float = 0.0, heading: float = 0.0, ahead: float = 0.097) -> list[float]:
    ball = x + ahead * cos(heading), y + ahead * sin(heading)
    return [x, y, heading, 0.0, 0.0, 0.0, *ball, 0.0, 0.0]


def task(starts: list[list[float]], **changes: Any) -> ShootTask:
    made = ShootTask(ShootSettings.model_validate(changes), len(starts))
    made.reset_to(starts, seed=0)
    return made


def shaping(made: ShootTask, arena: int, reward: ShootReward) -> tuple[float, bool]:
    """Eq. 12 and whether the robot faces the goal, written as on paper."""
    x, y, heading = made.arenas.robots[arena, 0, :3].tolist()
    vx, vy = made.arenas.balls[arena, 2:].tolist()
    field = made.settings.field
    posts = [atan2(side * field.goal_width / 2 - y, field.half_length - x) for side in (1, -1)]
    alpha = wrap_angle(posts[0] - posts[1])
    beta = max(abs(wrap_angle(post - heading)) for post in posts)
    speed = hypot(vx, vy)
    if alpha >= beta:
        return 0.05 * (alpha - beta) * speed * reward.face_goal, True
    return (alpha - beta) * speed * reward.face_goal, False


def test_every_step_is_rewarded_by_the_papers_equations() -> None:
    made = ShootTask(ShootSettings.model_validate({"starts": {"heading": (-1.5, 1.5)}}), n=32, seed=4)
    made.reset()
    rng = np.random.default_rng(0)
    pressed = np.zeros(32, dtype=bool)
    seen = {"facing kick": 0, "idle kick": 0, "waiting": 0, "facing": 0}
    for _ in range(100):
        actions = rng.uniform(-1, 1, (32, 2))
        actions[:, 1] -= 0.9
        result = made.advance(actions)
        for i in range(32):
            value, facing = shaping(made, i, made.settings.reward)
            first = actions[i, 1] > 0 and not pressed[i]
            pressed[i] |= actions[i, 1] > 0
            if facing:
                value += 10.0 * first - 0.25 * (not pressed[i])
            else:
                value -= 0.25
            if not (result.terminated[i] or result.truncated[i]):
                assert result.reward[i] == pytest.approx(value, abs=1e-9)
                seen["facing kick"] += first and facing
                seen["idle kick"] += first and not facing
                seen["waiting"] += not pressed[i]
                seen["facing"] += facing
        if made.ended is not None:
            made.restart()
            pressed[:] = False
    assert min(seen.values()) > 5


def test_the_kick_is_paid_for_the_action_even_without_the_ball() -> None:
    away = [2.0, 0, 0, 0, 0, 0, 2.5, 0, 0, 0]
    made = task([away, start()])
    rewards = [made.step(np.array([KICK, HOLD])).reward for _ in range(2)]
    assert rewards[0][0] == pytest.approx(10.0)
    assert rewards[1][0] == pytest.approx(0.0)
    fired = task([away, start()], reward={"kick_counts": "fired"})
    # Without the ball nothing fires; with it the ball is on its way, and the bonus comes with Eq. 12.
    reward = fired.step(np.array([KICK, KICK])).reward
    assert reward[0] == pytest.approx(-0.25)
    assert reward[1] > 10.0


def test_a_goal_pays_twenty_and_nothing_else() -> None:
    made = task([start(3.4)])
    rewards = [made.step(np.array([KICK]))]
    while not rewards[-1].terminated[0]:
        rewards.append(made.step(np.array([HOLD])))
    assert rewards[-1].reward[0] == 20.0
    assert rewards[-1].success[0]
    assert len(rewards) == pytest.approx(1.0 / 5.0 / 0.03, abs=2)


def test_a_goal_is_a_goal_only_when_the_whole_ball_is_over_the_line() -> None:
    made = task([[2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.48, 0.2, 0.5, 0.0]])
    places = []
    for _ in range(10):
        result = made.advance(np.array([HOLD]))
        places.append(made.arenas.balls[0, 0] - 4.5)
        if result.terminated[0]:
            break
    assert result.success[0]
    assert places[-1] > BALL_RADIUS >= places[-2] > 0.0


@pytest.mark.parametrize(
    ("where", "kick"),
    [
        ([2.0, 2.9, pi / 2, 0, 0, 0, 2.0, 2.997, 0, 0], True),
        ([0.15, 0.0, pi, 0, 0, 0, 0.053, 0, 0, 0], True),
        ([3.4, 1.5, 0.0, 0, 0, 0, 3.497, 1.5, 0, 0], True),
        ([3.6, 0.0, 0.0, 0, 0, 0, 3.697, 0, 0, 0], False),
        ([-0.25, 0.0, 0.0, 0, 0, 0, 0.5, 0, 0, 0], False),
        ([2.0, 3.05, 0.0, 0, 0, 0, 2.0, 0, 0, 0], False),
    ],
    ids=["over the touch line", "behind the halfway line", "beside the goal", "in the area", "back", "side"],
)
def test_out_of_play_ends_without_reward(where: list[float], kick: bool) -> None:
    made = task([where])
    result = made.step(np.array([KICK if kick else HOLD]))
    for _ in range(20):
        if result.terminated[0]:
            break
        result = made.step(np.array([HOLD]))
    assert result.terminated[0]
    assert not result.success[0]
    assert result.reward[0] == 0.0


def test_the_time_limit_truncates_after_three_seconds() -> None:
    made = task([start()])
    for tick in range(1, 101):
        result = made.step(np.array([HOLD]))
        assert bool(result.truncated[0]) == (tick == 100)
        assert not result.terminated[0]


def test_a_lost_ball_ends_the_episode_where_that_is_asked_for() -> None:
    away = [2.0, 0, 0, 0, 0, 0, 2.5, 0, 0, 0]
    assert not task([away]).step(np.array([HOLD])).terminated[0]
    assert task([away], lost_distance=0.3).step(np.array([HOLD])).terminated[0]
    kicked = task([start()], lost_distance=0.3)
    results = [kicked.step(np.array([KICK])) for _ in range(4)]
    assert kicked.arenas.balls[0, 0] > 2.4
    assert not results[-1].terminated[0]


@pytest.mark.parametrize(
    ("name", "facing", "turned"), [("printed", 10.0, -0.25), ("cmu", 0.0, 0.0), ("sparse", -0.05, -0.05)]
)
def test_named_rewards(name: str, facing: float, turned: float) -> None:
    # A press without the ball's motion: Eq. 12 is nothing at rest.
    still = task([[2.0, 0, 0, 0, 0, 0, 2.5, 0, 0, 0], [2.0, 0, pi, 0, 0, 0, 2.5, 0, 0, 0]], reward=name)
    np.testing.assert_allclose(still.step(np.array([KICK, KICK])).reward, [facing, turned], atol=1e-9)
    goal = {"printed": 0.0, "cmu": 20.0, "sparse": 20.0}[name]
    scored = task([start(3.4)], reward=name)
    result = scored.step(np.array([KICK]))
    while not result.terminated[0]:
        result = scored.step(np.array([HOLD]))
    assert result.reward[0] == goal


@pytest.mark.parametrize("rate", [2.0, 6.0])
def test_turning_with_the_ball_costs_the_same_at_any_rate(rate: float) -> None:
    """The sum of Eq. 12 over a turn is -(L / dt) times the integral of beta - alpha over beta."""
    made = task([start(heading=pi)], simulator="rsim", reward={"waiting": 0, "kick": 0})
    action = np.array([[rate / made.action.max_turn, -1.0]])
    total, alpha = 0.0, 2 * atan2(0.5, 2.5)
    for _ in range(70):
        result = made.step(action)
        heading = made.arenas.robots[0, 0, 2]
        beta = max(abs(wrap_angle(side * alpha / 2 - heading)) for side in (1, -1))
        if beta <= alpha:
            break
        total += float(result.reward[0])
    held = hypot(made.arenas.balls[0, 0] - 2.0, made.arenas.balls[0, 1])
    # Facing away, beta is pi - alpha / 2; it rises to pi first.
    expected = -held / 0.03 * ((pi - alpha) ** 2 / 2 + alpha / 2 * (pi - 1.25 * alpha))
    assert total == pytest.approx(expected, rel=0.02)


def test_turning_gently_and_kicking_scores_from_every_start() -> None:
    made = ShootTask(n=128, seed=0)
    episodes = run_starts(made, turn_and_kick, made.sample_starts(21, 512))
    assert episodes.success.mean() >= 0.99
    assert np.isfinite(episodes.kick_time).all()
    assert episodes.kick_time.mean() < 1.2


def test_random_actions_hardly_ever_score() -> None:
    made, rng = ShootTask(n=128, seed=0), np.random.default_rng(4)
    episodes = run_starts(made, lambda seen: rng.uniform(-1, 1, (len(seen), 2)), made.sample_starts(22, 512))
    assert episodes.success.mean() <= 0.10


def test_left_is_as_good_as_right() -> None:
    left = start(2.0, 0.7, 1.1)
    signs = np.array([1, -1, -1, 1, -1, -1, 1, -1, 1, -1])
    one, other = task([left], simulator="rsim"), task([(signs * left).tolist()], simulator="rsim")
    rng = np.random.default_rng(6)
    for tick in range(25):
        action = rng.uniform(-1, 1, (1, 2))
        action[0, 1] = 1.0 if tick == 10 else -1.0
        a, b = one.step(action), other.step(action * [-1, 1])
        mirrored = b.observation[:, [0, 1, 2, 3, 4, 5, 8, 9, 6, 7]] * [1, -1, 1, -1, -1, 1, -1, 1, -1, 1]
        np.testing.assert_allclose(a.observation, mirrored, rtol=0, atol=1e-9)
        np.testing.assert_allclose(a.reward, b.reward, rtol=0, atol=1e-9)


@pytest.mark.parametrize("simulator", ["default", "grsim", "rsim", "erforce", "sumatra", "robobulls"])
def test_the_ball_is_held_from_the_start(simulator: str) -> None:
    made = ShootTask(ShootSettings.model_validate({"simulator": simulator}), n=32, seed=1)
    made.reset()
    assert made.arenas.contact.all()
    before = made.arenas.balls.copy()
    made.step(np.tile(HOLD, (32, 1)))
    assert made.arenas.contact.all()
    assert np.abs(made.arenas.balls[:, :2] - before[:, :2]).max() < 5e-4


def test_starts_are_where_the_authors_put_them() -> None:
    made = ShootTask()
    starts = made.sample_starts(5, 2000)
    assert 0.3 <= starts[:, 0].min() < 0.4
    assert 3.1 < starts[:, 0].max() <= 3.2
    assert 2.85 < np.abs(starts[:, 1]).max() <= 2.9
    assert starts[:, 2].min() < -3.1 < 3.1 < starts[:, 2].max()
    gap = np.hypot(starts[:, 6] - starts[:, 0], starts[:, 7] - starts[:, 1])
    np.testing.assert_allclose(gap, gap[0], atol=1e-9)


def test_a_ball_taken_aside_and_a_robot_that_turns() -> None:
    settings = ShootSettings.model_validate(
        {"starts": {"ball_aside": (-0.03, 0.03), "robot_turn": (1, 2), "heading": (0, 0), "warm_up": 1}}
    )
    starts = ShootTask(settings).sample_starts(5, 300)
    aside = starts[:, 7] - starts[:, 1]
    assert aside.min() < -0.01
    assert aside.max() > 0.01
    ahead = starts[:, 6] - starts[:, 0]
    np.testing.assert_allclose(starts[:, 8], -starts[:, 5] * aside, atol=1e-12)
    np.testing.assert_allclose(starts[:, 9], starts[:, 5] * ahead, atol=1e-12)


def test_the_warm_up_draws_the_ball_to_the_middle() -> None:
    def spread(ticks: int) -> float:
        settings = ShootSettings.model_validate(
            {"starts": {"ball_aside": (-0.03, 0.03), "heading": (0, 0), "warm_up": ticks}}
        )
        starts = ShootTask(settings).sample_starts(5, 300)
        return float(np.ptp(starts[:, 7] - starts[:, 1]))

    assert spread(20) < 0.3 * spread(0)


def test_the_time_to_the_kick_is_when_it_fired() -> None:
    made = task([start(3.4)])
    for tick in range(30):
        made.step(np.array([KICK if tick == 4 else HOLD]))
        if made.ended is not None:
            break
    assert made.ended is not None
    assert made.ended.kick_time[0] == pytest.approx(0.15)


def test_robots_may_start_while_they_drive_with_the_ball() -> None:
    changes = {"simulator": "rsim", "starts": {"robot_speed": (1.0, 3.0)}}
    made = ShootTask(ShootSettings.model_validate(changes), n=64, seed=1)
    starts = made.sample_starts(5, 200)
    speed = np.hypot(starts[:, 3], starts[:, 4])
    assert 1.0 <= speed.min() < 1.2
    assert 2.0 < speed.max() <= 3.0
    assert starts[:, 8:10] == pytest.approx(starts[:, 3:5])
    made.reset_to(starts[:64], seed=0)
    for _ in range(100):
        made.advance(np.tile(HOLD, (64, 1)))
    robots, balls = made.arenas.robots[:, 0], made.arenas.balls
    assert made.arenas.contact.all()
    assert np.hypot(robots[:, 3], robots[:, 4]).max() == pytest.approx(0.0, abs=1e-9)
    # They come to rest where the field still is, with the ball.
    assert robots[:, 0].min() > 0.0
    assert np.abs(robots[:, 1]).max() < 3.0
    assert np.hypot(balls[:, 0] - robots[:, 0], balls[:, 1] - robots[:, 1]).max() < 0.12


def test_a_speed_at_which_no_robot_stops_in_time_is_an_error() -> None:
    starts = {"robot_speed": (9.0, 10.0), "robot_x": (1.0, 1.1), "robot_y": (0.0, 0.1)}
    with pytest.raises(ValueError, match="do not stop inside"):
        ShootTask(ShootSettings.model_validate({"starts": starts})).reset()


def test_a_gentle_robot_turns_no_faster_than_its_dribbler_holds_the_ball() -> None:
    lost = {}
    for gentle in (False, True):
        task = ShootTask(ShootSettings(gentle=gentle), n=16)
        task.reset(seed=0)
        for _ in range(40):
            task.step(np.tile((1.0, -1.0), (16, 1)))
        lost[gentle] = int((~task.arenas.contact[:, 0]).sum())
    # At 10 rad/s the default dribbler loses every ball, at the 4.6 rad/s that it bears while braking none.
    assert lost == {False: 16, True: 0}


@pytest.mark.parametrize("delay", [0.0, 0.12])
def test_a_gentle_robot_brakes_as_hard_as_its_dribbler_holds_the_ball_however_late(delay: float) -> None:
    made = task(
        [[0.5, 0.0, pi / 2, 0.0, 1.2, 0.0, 0.5, 0.097, 0.0, 1.2]],
        gentle=True, randomisation={"control_delay": (delay, delay)},
    )  # fmt: skip
    held, period = made.settings.robot_limits.hold_acceleration * sqrt(0.5), made.settings.period
    for tick in range(1, 18):
        made.step(np.array([HOLD]))
        expected = max(1.2 - held * max(0.0, tick * period - delay), 0.0)
        assert made.arenas.robots[0, 0, 4] == pytest.approx(expected, abs=1e-6)
        assert made.arenas.contact[0, 0]


@pytest.mark.parametrize("memory", [{"actions": 1}, {"observations": 1}])
def test_a_policy_with_a_memory_is_trained_as_gently_as_the_skill_drives_it(memory: dict[str, int]) -> None:
    """Else it would meet another robot in a match than in training."""
    settings = {"memory": memory}
    with pytest.raises(ValidationError) as caught:
        ShootSettings.model_validate(settings)
    field, problem = first_problem(caught.value, ShootSettings, settings)
    assert field == "gentle"
    assert "true with a memory" in problem


def test_late_robots_start_where_they_can_still_stop() -> None:
    settings = ShootSettings.model_validate(
        {
            "gentle": True,
            "starts": {"robot_speed": (0.0, 3.0)},
            "randomisation": {"control_delay": (0.0, 0.13), "lag": (0.0, 0.05)},
        }
    )
    robots = ShootTask(settings, 1).sample_starts(5, 400)
    speed = np.hypot(robots[:, 3], robots[:, 4])
    way = 0.18 + speed / (2.0 * sqrt(0.5) * settings.robot_limits.hold_acceleration)
    assert (np.abs(robots[:, 1] + way * robots[:, 4]) <= 2.9).all()
    assert (robots[:, 0] + way * robots[:, 3] <= 3.2).all()
    assert speed.max() > 2.0


@pytest.mark.parametrize("delay", [0.0, 0.13])
def test_the_script_that_knows_the_delay_scores(delay: float) -> None:
    settings = ShootSettings.model_validate(
        {"simulator": "rsim", "randomisation": {"control_delay": (delay, delay)}}
    )
    made = ShootTask(settings, 64)
    episodes = run_starts(made, made.script(), made.sample_starts(3, 64))
    assert episodes.success.mean() >= 0.9
