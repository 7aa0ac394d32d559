from math import inf

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from robobt.sim import SimSettings
from robobt.world.ball_model import BallModel

BALL = BallModel()


def rolled(model: BallModel, speed: float, time: float) -> tuple[float, float]:
    """Distance and speed after ``time``, integrated in small steps."""
    steps = 20_000
    dt = time / steps
    at = np.arange(steps) * dt
    v = speed - model.slide_deceleration * at
    switch = model.switch_share * speed
    sliding = v > switch
    start = at[sliding][-1] + dt if sliding.any() else 0.0
    v = np.where(sliding, v, np.maximum(0.0, switch - model.roll_deceleration * (at - start)))
    return float(v.sum() * dt), float(v[-1])


@pytest.mark.parametrize("speed", [1.0, 3.0, 6.5])
@pytest.mark.parametrize("time", [0.1, 0.6, 1.5])
def test_travel_time_inverts_the_integrated_motion(speed: float, time: float) -> None:
    distance, _ = rolled(BALL, speed, time)
    assert BALL.time_to(distance, speed) == pytest.approx(time, rel=2e-3)


@given(distance=st.floats(0.0, 12.0), arrival=st.floats(0.2, 5.0))
def test_a_ball_kicked_for_an_arrival_speed_arrives_with_it(distance: float, arrival: float) -> None:
    speed = BALL.kick_speed(distance, arrival)
    _, end_speed = rolled(BALL, speed, BALL.time_to(distance, speed))
    assert end_speed == pytest.approx(arrival, rel=5e-3, abs=2e-3)


def test_a_ball_never_passes_the_point_where_it_rests() -> None:
    reach = BALL.kick_speed(3.0, 0.0)
    assert BALL.time_to(2.999, reach) < inf
    assert BALL.time_to(3.001, reach) == inf
    assert BALL.time_to(1.0, 0.0) == inf


def test_no_distance_takes_no_time() -> None:
    assert BALL.time_to(0.0, 0.0) == 0.0


def test_without_more_knowledge_the_ball_is_that_of_the_default_simulator() -> None:
    assert SimSettings().ball.model == BallModel()


@given(time=st.floats(0.01, 3.0), speed=st.floats(2.0, 7.0), share=st.floats(0.6, 1.0))
def test_the_time_for_a_way_inverts_the_way_in_a_time(time: float, speed: float, share: float) -> None:
    rolling = share * speed
    assert BALL.time_for(BALL.way_in(time, speed, rolling), speed, rolling) == pytest.approx(time, rel=1e-5)


def test_a_way_longer_than_the_ball_rolls_takes_for_ever() -> None:
    assert BALL.time_for(0.0, 0.0) == 0.0
    assert BALL.time_for(2.0, 1.0) == inf


# Chips.


@given(distance=st.floats(0.1, 4.0), touch_downs=st.integers(1, 3))
def test_a_chip_for_a_distance_touches_down_there(distance: float, touch_downs: int) -> None:
    speed = BALL.chip_speed(distance, touch_downs)
    # Weak chips roll before they have touched down so often.
    assume(len(BALL.touch_downs(speed)) >= touch_downs)
    assert BALL.touch_downs(speed)[touch_downs - 1][1] == pytest.approx(distance)


# Source: a table worked out from Sumatra's constants.
@pytest.mark.parametrize(
    ("speed", "over", "downs", "rolls"),
    [
        (3.0, (0.19, 0.73), (0.92, 1.26, 1.40), 1.2),
        (4.0, (0.17, 1.46), (1.63, 2.24, 2.49), 1.6),
        (5.0, (0.16, 2.39), (2.55, 3.51, 3.89), 2.0),
        (6.2, (0.16, 3.76), (3.92, 5.39, 5.98, 6.22), 2.2),
    ],
)
def test_chips_go_as_far_as_sumatras(
    speed: float, over: tuple[float, float], downs: tuple[float, ...], rolls: float
) -> None:
    found = BALL.touch_downs(speed)
    assert [way for _, way in found] == pytest.approx(downs, abs=0.01)
    assert BALL.along(speed, len(found)) == pytest.approx(rolls, abs=0.05)
