"""Noise, latency, differenced velocities and domain randomisation do what their settings say."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from robobt.learning.envs import GoToBallSettings, GoToBallTask, ShootSettings, ShootTask

N = 400
SAME = np.tile([0.0, 0, 0, 0, 0, 0, 2.0, 0, 0, 0], (N, 1))
AHEAD = np.tile([1.0, 0, 0], (N, 1))


def task(n: int = N, **changes: Any) -> GoToBallTask:
    made = GoToBallTask(GoToBallSettings.model_validate(changes), n)
    made.reset_to(SAME[:n], seed=1)
    return made


def test_noise_has_the_spread_that_was_asked_for_and_leaves_the_reward_alone() -> None:
    noise = {
        "robot_position": 0.01,
        "ball_position": 0.02,
        "heading": 0.03,
        "velocity": 0.1,
        "turn_rate": 0.2,
    }
    made, clean = task(noise=noise), task()
    result, true = made.step(AHEAD), clean.step(AHEAD)
    error = result.observation - true.observation
    assert error[:, 2].std() == pytest.approx(np.hypot(0.01, 0.02), rel=0.15)
    assert error[:, 0].std() == pytest.approx(np.hypot(0.03, np.hypot(0.01, 0.02) / 2), rel=0.15)
    assert error[:, 3].std() == pytest.approx(0.1, rel=0.15)
    assert error[:, 5].std() == pytest.approx(0.2, rel=0.15)
    assert np.abs(error[:, 5]).max() <= 4 * 0.2
    np.testing.assert_array_equal(result.reward, true.reward)


def test_noise_does_not_change_the_starts() -> None:
    clean = GoToBallTask(n=3, seed=4)
    noisy = GoToBallTask(GoToBallSettings.model_validate({"noise": {"heading": 0.1}}), 3, 4)
    clean.reset()
    noisy.reset()
    np.testing.assert_array_equal(clean.arenas.robots, noisy.arenas.robots)


@pytest.mark.parametrize("latency", [1, 3])
def test_what_is_seen_is_as_old_as_the_latency(latency: int) -> None:
    late, now = task(2, latency=latency), task(2)
    first = now.observe(now.arenas.robots, now.arenas.balls)
    truth = [first] * latency
    for _ in range(12):
        truth.append(now.step(AHEAD[:2]).observation)
        np.testing.assert_array_equal(late.step(AHEAD[:2]).observation, truth[-1 - latency])


def test_a_new_episode_is_not_seen_through_the_old_ones_latency() -> None:
    made = GoToBallTask(GoToBallSettings(latency=3))
    made.reset_to([[0, 0, 0, 0, 0, 0, 0.19, 0, 0, 0], [0, 0, 0, 0, 0, 0, 3.0, 0, 0, 0]], seed=0)
    result = made.step(np.zeros((1, 3)))
    assert result.terminated[0]
    assert result.observation[0, 2] == pytest.approx(3.0)
    assert made.step(np.zeros((1, 3))).observation[0, 2] == pytest.approx(3.0)


def test_differenced_velocities_start_at_zero_and_are_the_last_ticks_mean() -> None:
    made = GoToBallTask(GoToBallSettings(velocities="finite_difference"))
    start = [0, 0, 3.1, 0.5, 0, 2.0, 2.0, 0, 0, 0]
    seen = made.reset_to([start], seed=0)
    assert (seen[0, 3:] == 0).all()
    for _ in range(5):
        before = made.arenas.robots[0, 0, :3].copy()
        seen = made.step(np.array([[0.3, 0.8, 1.0]])).observation
        after = made.arenas.robots[0, 0, :3]
        moved = (after[:2] - before[:2]) / 0.03
        c, s = np.cos(after[2]), np.sin(after[2])
        expected = [c * moved[0] + s * moved[1], c * moved[1] - s * moved[0]]
        np.testing.assert_allclose(seen[0, 3:5], expected, atol=1e-12)
        turned = (after[2] - before[2] + np.pi) % (2 * np.pi) - np.pi
        assert seen[0, 5] == pytest.approx(turned / 0.03)


def test_the_balls_velocity_is_differenced_too() -> None:
    made = ShootTask(ShootSettings(velocities="finite_difference"))
    made.reset_to([[3.0, 0, 0, 0, 0, 0, 3.097, 0, 0, 0]], seed=0)
    before = made.arenas.balls[0, 0]
    seen = made.step(np.array([[0.0, 1.0]])).observation
    assert seen[0, 2] == pytest.approx((made.arenas.balls[0, 0] - before) / 0.03)


@pytest.mark.integration
def test_parameters_are_drawn_evenly_from_their_ranges_for_each_episode() -> None:
    ranges = {
        "friction": (0.5, 2.0),
        "acceleration": (0.8, 1.2),
        "mass": (0.5, 1.5),
        "kick_speed": (0.9, 1.1),
        "dribbler": (0.3, 1.0),
    }
    made = task(randomisation=ranges)
    plain = task()
    own, drawn = plain.arenas.arena_parameters, made.arenas.arena_parameters
    for part, names, name in (
        ("ball", ("slide_deceleration", "roll_deceleration"), "friction"),
        ("dribbler", ("pull", "side"), "dribbler"),
    ):
        low, high = ranges[name]
        for each in names:
            factor = drawn[part][each] / own[part][each]
            assert low <= factor.min() < low + 0.1 * (high - low)
            assert high - 0.1 * (high - low) < factor.max() <= high
    assert (drawn["body"]["face"] == own["body"]["face"]).all()
    limits, usual = made.arenas.robot_parameters[:, 0], plain.arenas.robot_parameters[:, 0]
    assert 0.8 <= (limits["acceleration"] / usual["acceleration"]).min() < 0.84
    assert (limits["max_speed"] == usual["max_speed"]).all()
    before = drawn["ball"]["roll_deceleration"].copy()
    made.restart()
    assert (made.arenas.arena_parameters["ball"]["roll_deceleration"] != before).all()


def test_how_robots_answer_is_drawn_for_each_episode() -> None:
    ranges = {"lag": (0.02, 0.05), "gain": (0.7, 1.0), "touch_kept": (0.2, 0.8), "touch_returned": (0.0, 0.5)}
    drawn = task(randomisation=ranges).arenas.robot_parameters[:, 0]
    for name, (low, high) in ranges.items():
        assert low <= drawn[name].min() < low + 0.1 * (high - low)
        assert high - 0.1 * (high - low) < drawn[name].max() <= high
    # The axes differ.
    assert abs(np.corrcoef(drawn["gain"], drawn["side_gain"])[0, 1]) < 0.5


@pytest.mark.integration
def test_acceleration_changes_how_fast_robots_get_and_their_optimum() -> None:
    made = task(randomisation={"acceleration": (0.5, 1.5)})
    factor = made.arenas.robot_parameters["acceleration"][:, 0] / 3.0
    for _ in range(4):
        made.step(AHEAD)
    np.testing.assert_allclose(made.arenas.robots[:, 0, 3], 0.12 * 3.0 * factor, rtol=1e-9)
    while made.ended is None:
        made.step(AHEAD)
    assert made.ended.time[0] == pytest.approx(made.ended.optimum[0], abs=0.06)


def test_a_heavier_robot_gives_way_less() -> None:
    slow = {"kind": "drive", "max_speed": 1.5, "max_turn": 1.0}
    speeds = []
    for mass in (0.2, 5.0):
        made = GoToBallTask(
            GoToBallSettings.model_validate(
                {"randomisation": {"mass": (mass, mass)}, "contact": {"distance": 0.06}, "action": slow}
            )
        )
        # A fast ball rolls onto the back of a robot that stands.
        made.reset_to([[0, 0, np.pi, 0, 0, 0, 0.5, 0, -5.0, 0]], seed=0)
        push = 0.0
        for _ in range(6):
            made.step(np.zeros((1, 3)))
            push = min(push, float(made.arenas.robots[0, 0, 0]))
        speeds.append(-push)
    assert speeds[0] > 3 * speeds[1] > 0


def test_kicks_are_faster_or_slower() -> None:
    made = ShootTask(ShootSettings.model_validate({"randomisation": {"kick_speed": (0.6, 1.2)}}), n=N)
    made.reset_to(np.tile([2.0, 0, 0, 0, 0, 0, 2.097, 0, 0, 0], (N, 1)), seed=0)
    made.step(np.tile([0.0, 1.0], (N, 1)))
    speeds = made.arenas.balls[:, 2]
    assert speeds.min() == pytest.approx(5.0 * 0.6, abs=0.15)
    assert speeds.max() == pytest.approx(5.0 * 1.2, abs=0.15)


@pytest.mark.parametrize(("delay", "sub_steps"), [(0.0075, 1), (0.0225, 3), (0.03, 4), (0.0525, 7)])
def test_commands_take_effect_after_the_delay(delay: float, sub_steps: int) -> None:
    made = task(3, randomisation={"control_delay": (delay, delay)})
    plain = task(3)
    for tick in range(1, 8):
        made.step(AHEAD[:3])
        plain.step(AHEAD[:3])
        # 3 m/s^2 from the sub-step on in which the first command arrives.
        under_way = max(0, 4 * tick - sub_steps)
        np.testing.assert_allclose(made.arenas.robots[:, 0, 3], 3.0 * 0.0075 * under_way, atol=1e-9)
        np.testing.assert_allclose(plain.arenas.robots[:, 0, 3], 3.0 * 0.03 * tick, atol=1e-9)


def test_delays_differ_between_arenas_and_add_to_the_simulators_own() -> None:
    made = task(
        randomisation={"control_delay": (0.0, 0.06)},
        simulator={"realism": {"command_delay": 0.0375}},
    )
    for _ in range(6):
        made.step(AHEAD)
    delay = 0.18 - made.arenas.robots[:, 0, 3] / 3.0
    assert delay.min() == pytest.approx(0.0375, abs=0.004)
    assert delay.max() == pytest.approx(0.0975, abs=0.004)
    np.testing.assert_allclose(delay / 0.0075, np.rint(delay / 0.0075), atol=1e-6)


def test_a_new_episode_does_not_obey_the_old_ones_commands() -> None:
    made = task(1, randomisation={"control_delay": (0.06, 0.06)})
    for _ in range(4):
        made.step(AHEAD[:1])
    made.restart()
    for _ in range(6):
        made.step(np.zeros((1, 3)))
        assert (made.arenas.robots[0, 0, 3:] == 0.0).all()


@pytest.mark.parametrize("answer", [{}, {"lag": (0.05, 0.05), "gain": (0.8, 0.8)}])
def test_a_late_robot_moves_on_until_its_first_command_arrives(answer: dict[str, Any]) -> None:
    made = task(1, randomisation={"control_delay": (0.09, 0.09), **answer})
    made.reset_to([[0.0, 0, 0.4, 1.5, 0.5, 0.0, 2.0, 0, 0, 0]])
    for _ in range(3):
        made.step(np.zeros((1, 3)))
        np.testing.assert_allclose(made.arenas.robots[0, 0, 3:], (1.5, 0.5, 0.0), atol=1e-9)
    made.step(np.zeros((1, 3)))
    assert made.arenas.robots[0, 0, 3] < 1.5


def test_what_a_robot_did_before_its_start_changes_nothing_without_delay() -> None:
    moving = [[0.0, 0, 0.4, 1.5, 0.5, 1.0, 2.0, 0, 0, 0]]
    made = task(1)
    made.reset_to(moving)
    made.step(np.zeros((1, 3)))
    bare = task(1)
    bare.reset_to(moving)
    bare.arenas.follow_before(np.array([0]), np.zeros((1, 1, 7)))
    bare.step(np.zeros((1, 3)))
    np.testing.assert_array_equal(made.arenas.robots, bare.arenas.robots)
