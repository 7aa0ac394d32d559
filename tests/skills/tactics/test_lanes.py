from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.sim import PRESETS, preset
from robobt.skills.tactics.lanes import (
    arrive_chance,
    cannot_pass_by,
    chip_chance,
    chip_speed,
    chip_time,
    flight_time,
    kick_speed,
    lane_margin,
    time_to_pass,
)
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TACTICS, applied
from robobt.testing import robot
from robobt.world import DIVISION_B
from robobt.world.ball_model import DEFAULT_BALL
from tests.skills.tactics.teams import records_of

NOBODY = records_of()
APPLIED = applied(DEFAULT_TACTICS, DIVISION_B, DEFAULT_BALL).view(TACTICS)[0]


@given(st.floats(0.5, 7.0), st.floats(0.5, 4.0))
def test_kick_and_flight_are_those_of_the_ball_model(length: float, arrival: float) -> None:
    least, most = DEFAULT_TACTICS.slowest_pass, DEFAULT_TACTICS.fastest_pass
    speed = kick_speed(length, arrival, APPLIED)
    assert speed == pytest.approx(min(most, max(least, DEFAULT_BALL.kick_speed(length, arrival))))
    assert flight_time(length, speed, APPLIED) == pytest.approx(
        min(10.0, DEFAULT_BALL.time_to(length, speed))
    )


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_passes_reach_their_receiver_with_the_speed_that_was_planned_on_any_carpet(name: str) -> None:
    model = preset(name).ball.model
    row = applied(DEFAULT_TACTICS, DIVISION_B, model).view(TACTICS)[0]
    speed = kick_speed(4.0, 2.2, row)
    time = flight_time(4.0, speed, row)
    slid = (1.0 - model.switch_share) * speed / model.slide_deceleration
    at_end = model.switch_share * speed - model.roll_deceleration * (time - slid)
    assert at_end == pytest.approx(2.2)


def chance(opponent: tuple[float, float], speed: float = 4.0, delay: float = 0.0) -> float:
    return arrive_chance(0.0, 0.0, 3.0, 0.0, speed, delay, records_of(robot(*opponent)), NOBODY, -1, APPLIED)


def test_a_lane_without_opponents_is_safe() -> None:
    assert arrive_chance(0.0, 0.0, 3.0, 0.0, 4.0, 0.0, NOBODY, NOBODY, -1, APPLIED) > 0.99
    assert chance((-2.0, 2.0)) > 0.95


def test_an_opponent_in_the_lane_stops_the_pass() -> None:
    assert chance((1.5, 0.05)) < 0.1


def test_the_nearer_an_opponent_is_to_the_lane_the_worse() -> None:
    chances = [chance((1.5, y)) for y in (0.2, 0.5, 1.0, 2.0)]
    assert chances == sorted(chances)


def test_a_faster_ball_and_an_earlier_kick_are_safer() -> None:
    assert chance((2.0, 0.6), speed=5.5) > chance((2.0, 0.6), speed=3.0)
    assert chance((2.0, 0.6)) > chance((2.0, 0.6), delay=0.3)


def test_a_mate_in_the_lane_blocks_unless_it_is_the_receiver() -> None:
    mates = records_of(robot(1.5, 0.0))
    blocked = arrive_chance(0.0, 0.0, 3.0, 0.0, 4.0, 0.0, NOBODY, mates, -1, APPLIED)
    assert arrive_chance(0.0, 0.0, 3.0, 0.0, 4.0, 0.0, NOBODY, mates, 0, APPLIED) > 5.0 * blocked


@given(st.floats(0.3, 2.7), st.floats(-2.0, 2.0))
def test_both_sides_of_a_lane_are_alike(x: float, y: float) -> None:
    left, right = (
        lane_margin(0.0, 0.0, 3.0, 0.0, 4.0, 0.0, records_of(robot(x, side)), APPLIED) for side in (y, -y)
    )
    assert left == pytest.approx(right)


place, speed_along = st.floats(-4.0, 4.0), st.floats(-3.0, 3.0)


@given(place, place, speed_along, speed_along, st.floats(0.0, 3.0))
def test_whoever_cannot_pass_by_a_time_passes_later(
    x: float, y: float, vx: float, vy: float, time: float
) -> None:
    one = records_of(robot(0.0, 0.0, velocity=(vx, vy, 0.0)))[0]
    if cannot_pass_by(one, x, y, time, APPLIED):
        assert time_to_pass(one, x, y, APPLIED) > time
    # Far enough off nobody can, so that it tells something.
    assert cannot_pass_by(one, 40.0, 0.0, time, APPLIED)


@given(st.floats(1.4, DEFAULT_TACTICS.longest_chip))
def test_a_chipped_pass_rolls_at_its_target(length: float) -> None:
    speed = chip_speed(length, APPLIED)
    assert speed == pytest.approx(DEFAULT_BALL.chip_speed(length, DEFAULT_TACTICS.chip_touch_downs))
    time, way = DEFAULT_BALL.touch_downs(speed)[-1]
    assert way == pytest.approx(length, rel=0.05)
    assert chip_time(length, APPLIED) == pytest.approx(time, rel=0.1)


def chipped(opponent: tuple[float, float]) -> float:
    return chip_chance(0.0, 0.0, 3.0, 0.0, 0.0, records_of(robot(*opponent)), NOBODY, -1, APPLIED)


def test_a_chip_flies_over_whoever_stands_in_the_lane() -> None:
    assert chance((0.8, 0.0)) < 0.1
    assert chipped((0.8, 0.0)) > 0.5


@pytest.mark.parametrize("opponent", [(0.12, 0.0), (0.25, 0.1), (2.2, 0.0), (3.0, 0.0)])
def test_a_chip_is_stopped_where_it_rises_and_where_it_comes_down(opponent: tuple[float, float]) -> None:
    assert chipped(opponent) < 0.1


def test_a_mate_where_a_chip_comes_down_blocks_it_unless_it_is_the_receiver() -> None:
    mates = records_of(robot(2.5, 0.0))
    blocked = chip_chance(0.0, 0.0, 3.0, 0.0, 0.0, NOBODY, mates, -1, APPLIED)
    assert blocked < 0.2 < chip_chance(0.0, 0.0, 3.0, 0.0, 0.0, NOBODY, mates, 0, APPLIED)
