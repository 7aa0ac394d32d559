from __future__ import annotations

from math import hypot

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.motion.arrival import arrival_time, axis_time, meetings, out_of_reach, time_to
from robobt.motion.pilot import drive, travel_time
from robobt.testing import robot
from robobt.world import RobotLimits, RobotState
from robobt.world.records import mover_records, movers
from tests.skills.fixed_world import moved

LIMITS = RobotLimits()
SIZE = (4.5, 3.0)

places = st.floats(-4.0, 4.0)
speeds = st.floats(-2.5, 2.5)


def arrival(me: RobotState, x: float, y: float) -> float:
    return arrival_time(movers([me])[0], x, y, 0.0)


@given(st.floats(0.0, 9.0), speeds)
def test_along_a_line_it_is_the_trapezoid(gap: float, speed: float) -> None:
    limits = (LIMITS.max_speed, LIMITS.acceleration, LIMITS.braking)
    assert axis_time(gap, speed, *limits) == pytest.approx(travel_time(gap, speed, LIMITS), abs=1e-6)
    assert axis_time(-gap, -speed, *limits) == pytest.approx(axis_time(gap, speed, *limits))


@given(places, places, speeds, speeds, places, places)
def test_a_turned_or_mirrored_field_takes_as_long(
    x: float, y: float, vx: float, vy: float, tx: float, ty: float
) -> None:
    time = arrival(robot(x, y, velocity=(vx, vy, 0.0)), tx, ty)
    assert arrival(robot(-x, -y, velocity=(-vx, -vy, 0.0)), -tx, -ty) == pytest.approx(time, abs=1e-6)
    assert arrival(robot(x, -y, velocity=(vx, -vy, 0.0)), tx, -ty) == pytest.approx(time, abs=1e-6)


@given(places, places, st.floats(-3.0, 3.0))
def test_nobody_is_there_sooner_than_at_top_speed(x: float, y: float, vx: float) -> None:
    time = arrival(robot(velocity=(vx, 0.0, 0.0)), x, y)
    assert time >= hypot(x, y) / LIMITS.max_speed - 1e-9


@pytest.mark.parametrize("velocity", [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, -2.0, 0.0)])
def test_the_pilot_takes_little_longer(velocity: tuple[float, float, float]) -> None:
    me, target = robot(velocity=velocity), (1.5, 0.8)
    predicted = arrival(me, *target)
    time = 0.0
    while hypot(target[0] - me.x, target[1] - me.y) > 0.02 or me.speed > 0.1:
        me = moved(me, drive(me, target, 0.0, me.limits, 1 / 60), 1 / 60)
        time += 1 / 60
        assert time < 5.0
    assert predicted - 0.1 <= time <= 1.15 * predicted + 0.1


def meet(me: RobotState, *ball: float) -> tuple[float, float, float]:
    state = np.array(ball)
    rolling, slide, roll = float(np.hypot(*ball[2:])), 3.0, 0.3
    time, x, y = meetings(movers([me]), state, rolling, slide, roll, *SIZE)[0].tolist()
    return time, x, y


def test_a_resting_ball_is_met_where_it_lies() -> None:
    time, x, y = meet(robot(-1.0, 0.0), 0.5, 0.5, 0.0, 0.0)
    assert (x, y) == (0.5, 0.5)
    assert 0.5 < time < 2.0


def test_a_ball_that_comes_is_met_on_its_way_and_in_time() -> None:
    me = robot(1.0, 1.0)
    time, x, y = meet(me, -2.0, 0.0, 3.0, 0.0)
    assert y == 0.0
    assert -2.0 < x < 2.5
    assert arrival_time(movers([me])[0], x, y, 0.1115) <= time + 0.1


def test_a_ball_that_leaves_the_field_first_is_met_outside() -> None:
    time, x, _ = meet(robot(-4.0, 2.5), 3.0, -2.0, 6.0, 0.0)
    assert x > 4.5
    assert time > 1.0


@given(places, places, speeds, speeds, st.floats(0.0, 3.0))
def test_what_is_out_of_reach_by_a_time_is_reached_later(
    x: float, y: float, vx: float, vy: float, time: float
) -> None:
    (one,) = mover_records(movers([robot(velocity=(vx, vy, 0.0))]))
    fastest = max(LIMITS.max_speed, hypot(vx, vy))
    if out_of_reach(one, x, y, fastest, time):
        assert time_to(one, x, y, 0.1115) > time
    assert out_of_reach(one, 12.0, 0.0, fastest, time)
