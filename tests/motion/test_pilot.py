"""The trapezoid pilot, on kinematics alone and in the simulator."""

from __future__ import annotations

from collections import deque
from itertools import pairwise
from math import cos, hypot, inf, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.motion.pilot import (
    ROBOBULLS_LIMITS,
    along,
    approach_speed,
    command,
    drive,
    roughly,
    travel_time,
    turn_rate,
)
from robobt.sim import SimWorld, preset
from robobt.sim.realism import RealismSettings
from robobt.skills import GoToPose
from robobt.testing import Trial, alone, blue, eventually, robot
from robobt.world import DIVISION_B, Placement, RobotCommand, RobotLimits, RobotState
from robobt.world.answer import compensated
from robobt.world.geometry import Point, wrap_angle
from robobt.world.prediction import PredictedWorld
from tests.skills.fixed_world import moved

PERIODS = (1 / 60, 0.025, 0.03)
SKEWED = RobotLimits(acceleration=6.6, braking=8.2, side_acceleration=4.5, side_braking=6.0)


def driven(
    me: RobotState,
    target: Point,
    heading: float = 0.0,
    limits: RobotLimits | None = None,
    period: float = 1 / 60,
    most: float = 12.0,
) -> tuple[float, float, RobotState]:
    """Time until it stands within 5 mm, how far it ever was past the target, and the end."""
    time = past = 0.0
    start = hypot(target[0] - me.x, target[1] - me.y)
    ux, uy = (target[0] - me.x) / start, (target[1] - me.y) / start
    while time < most:
        me = moved(me, drive(me, target, heading, limits or me.limits, period), period)
        time += period
        past = max(past, (me.x - target[0]) * ux + (me.y - target[1]) * uy)
        if hypot(me.x - target[0], me.y - target[1]) < 0.005 and me.speed < 0.05:
            break
    return time, past, me


@pytest.mark.parametrize("name", ["default", "grsim", "rsim", "erforce"])
@pytest.mark.parametrize("distance", [1.0, 3.0, 5.0])
def test_from_rest_to_rest_is_within_3_percent_of_the_trapezoid(name: str, distance: float) -> None:
    for period in PERIODS:
        trial = Trial(
            {blue(0): GoToPose(target=(distance - 2.5, -1.0), heading=0.0)},
            {blue(0): (-2.5, -1.0, 0.0)},
            ball=(0.0, 2.5),
            # Where frames are predicted over the delay of commands, only the robots' own reaction is left.
            settings=preset(name, realism=RealismSettings()),
            period=period,
        )
        limits = trial.frames[0].own[0].limits
        frame = trial.run(
            6.0,
            eventually(
                "the robot stands there",
                lambda f: (
                    hypot(f.own[0].x + 2.5 - distance, f.own[0].y + 1.0) < 0.005 and f.own[0].speed < 0.05
                ),
            ),
        )
        # grSim's wheels follow a command one to four of its frames late, and their motors give out.
        late = {"grsim": 0.08, "erforce": 0.08}.get(name, 0.0)
        assert frame.time <= 1.03 * travel_time(distance, 0.0, limits) + late
        trial.run(0.3)
        past = max(frame.own[0].x for frame in trial.frames) - (distance - 2.5)
        assert past < (0.007 if name == "grsim" else 0.005)


@pytest.mark.parametrize(
    "limits", [ROBOBULLS_LIMITS, RobotLimits(max_speed=1.5, acceleration=1.5, braking=1.5)]
)
@pytest.mark.parametrize("period", PERIODS)
def test_gentler_limits_than_the_robots_own_are_kept(limits: RobotLimits, period: float) -> None:
    time, past, _ = driven(robot(), (3.0, 0.0), limits=limits, period=period)
    assert time == pytest.approx(travel_time(3.0, 0.0, limits), rel=0.03)
    assert past < 0.005


def test_robobulls_turns_slowly_and_brakes_its_turn_more_slowly_still() -> None:
    me, rates, time = robot(), [0.0], 0.0
    while abs(wrap_angle(pi / 2 - me.heading)) > 0.01 or abs(me.omega) > 0.05:
        rate = turn_rate(me, pi / 2, ROBOBULLS_LIMITS, 0.03)
        me = moved(me, command(me, 0.0, 0.0, rate, ROBOBULLS_LIMITS, 0.03), 0.03)
        rates.append(me.omega)
        time += 0.03
        assert time < 5.0
    changes = [(b - a) / 0.03 for a, b in pairwise(rates)]
    assert max(rates) == pytest.approx(ROBOBULLS_LIMITS.max_turn, rel=1e-6)
    assert max(changes) == pytest.approx(ROBOBULLS_LIMITS.turn_acceleration, rel=0.01)
    assert min(changes) == pytest.approx(-ROBOBULLS_LIMITS.angular_braking, rel=0.1)


@settings(max_examples=40)
@given(
    distance=st.floats(0.01, 3.0),
    speed=st.floats(0.0, 2.5),
    course=st.floats(-pi, pi),
    heading=st.floats(-pi, pi),
    period=st.sampled_from(PERIODS),
    limits=st.sampled_from([RobotLimits(), SKEWED]),
)
def test_a_moving_robot_reaches_its_target_and_does_not_circle_it(
    distance: float, speed: float, course: float, heading: float, period: float, limits: RobotLimits
) -> None:
    me = robot(velocity=(speed * cos(course), speed * sin(course), 0.0), limits=limits)
    slow = min(limits.braking, limits.lateral_braking)
    # Stop first, drive back, and drive the rest from standing: no good pilot is slower.
    patience = speed / slow + travel_time(distance + speed * speed / (2 * slow), 0.0, limits) * 1.3
    time, _, _ = driven(me, (distance, 0.0), heading, period=period)
    assert time < patience + 0.2


@settings(max_examples=60)
@given(turn=st.floats(-pi, pi), omega=st.floats(-10.0, 10.0), period=st.sampled_from(PERIODS))
def test_it_turns_to_any_heading_the_short_way(turn: float, omega: float, period: float) -> None:
    me = robot(velocity=(0.0, 0.0, omega))
    for _ in range(round(1.5 / period)):
        me = moved(
            me, command(me, 0.0, 0.0, turn_rate(me, turn, me.limits, period), me.limits, period), period
        )
    assert abs(wrap_angle(turn - me.heading)) < 0.01
    assert abs(me.omega) < 0.05


@given(heading=st.floats(-pi, pi), vx=st.floats(-2, 2), vy=st.floats(-2, 2), omega=st.floats(-9, 9))
def test_a_command_points_where_it_should_in_the_middle_of_the_period(
    heading: float, vx: float, vy: float, omega: float
) -> None:
    me = robot(heading=heading)
    order = command(me, vx, vy, omega, me.limits, 0.02)
    middle = heading + omega * 0.01
    assert cos(middle) * order.vx - sin(middle) * order.vy == pytest.approx(vx, abs=1e-9)
    assert sin(middle) * order.vx + cos(middle) * order.vy == pytest.approx(vy, abs=1e-9)


def test_a_command_is_never_faster_than_the_limits() -> None:
    order = command(robot(), 4.0, 3.0, 0.0, RobotLimits(max_speed=2.0), 0.02)
    assert hypot(order.vx, order.vy) == pytest.approx(2.0)
    assert order.vy / order.vx == pytest.approx(0.75)


def test_a_way_point_may_be_passed_at_speed() -> None:
    me = robot(velocity=(2.0, 0.0, 0.0))
    assert drive(me, (0.3, 0.0), 0.0, me.limits, 1 / 60).vx < 2.0
    assert drive(me, (0.3, 0.0), 0.0, me.limits, 1 / 60, final_speed=2.0).vx >= 2.0


def test_at_the_target_it_asks_for_nothing() -> None:
    order = drive(robot(1.0, 1.0, 0.5), (1.0, 1.0), 0.5, RobotLimits(), 0.02)
    assert (order.vx, order.vy, order.omega) == (0.0, 0.0, 0.0)


@given(
    distance=st.floats(0.0, 10.0),
    speed=st.floats(0.0, 3.0),
    acceleration=st.floats(0.5, 10.0),
    braking=st.floats(0.5, 10.0),
    period=st.floats(0.005, 0.05),
)
def test_the_approach_speed_can_still_be_stopped_from(
    distance: float, speed: float, acceleration: float, braking: float, period: float
) -> None:
    new = approach_speed(distance, speed, inf, acceleration, braking, period)
    reached = min(new, speed + acceleration * period)
    if reached >= speed:
        way = reached * period - (reached - speed) ** 2 / (2 * acceleration)
    else:
        reached = max(reached, speed - braking * period)
        way = reached * period + (speed - reached) ** 2 / (2 * braking)
    beyond_help = speed * speed / (2 * braking) - distance
    assert way + reached * reached / (2 * braking) <= distance + max(0.0, beyond_help) + 1e-6


def test_travel_time_is_the_trapezoid() -> None:
    limits = RobotLimits(max_speed=3.0, acceleration=3.0, braking=6.0)
    assert travel_time(1.0, 0.0, limits) == pytest.approx(1.0)
    assert travel_time(3.0, 0.0, limits) == pytest.approx(1.0 + 0.5 + 0.75 / 3.0)
    assert travel_time(0.0, 0.0, limits) == 0.0
    assert travel_time(3.0, 3.0, limits) == pytest.approx(0.5 + 2.25 / 3.0)


def test_travel_time_counts_turning_back() -> None:
    limits = RobotLimits(max_speed=3.0, acceleration=3.0, braking=6.0)
    away = 1.0 / 6.0 + travel_time(1.0 + 1.0 / 12.0, 0.0, limits)
    assert travel_time(1.0, -1.0, limits) == pytest.approx(away)
    past = 3.0 / 6.0 + travel_time(0.75 - 0.5, 0.0, limits)
    assert travel_time(0.5, 3.0, limits) == pytest.approx(past)


@given(bearing=st.floats(-pi, pi))
def test_a_limit_between_forward_and_sideways_lies_on_the_ellipse(bearing: float) -> None:
    most = along(6.0, 3.0, bearing)
    assert (most * cos(bearing) / 6.0) ** 2 + (most * sin(bearing) / 3.0) ** 2 == pytest.approx(1.0)


def driven_late(reaction: float, delay: int, seconds: float = 2.0) -> list[RobotState]:
    """States of a robot that is told to turn by 2 rad and to drive 1 m, and obeys ``delay`` periods late."""
    period = 1 / 60
    me = robot(0.0, limits=RobotLimits(turn_acceleration=50.0, reaction=reaction))
    on_the_way = deque([RobotCommand()] * delay)
    states = []
    for _ in range(round(seconds / period)):
        on_the_way.append(drive(me, (1.0, 0.0), 2.0, me.limits, period))
        me = moved(me, on_the_way.popleft(), period)
        states.append(me)
    return states


def reverses(states: list[RobotState]) -> int:
    """How often the robot turns back."""
    turning = [state.omega for state in states if abs(state.omega) > 0.2]
    return sum(before * after < 0.0 for before, after in pairwise(turning))


@pytest.mark.parametrize("delay", [1, 2])
def test_a_robot_that_reacts_late_and_says_so_settles_without_swinging(delay: int) -> None:
    states = driven_late(delay / 60, delay)
    assert reverses(states) <= 1
    end = states[-1]
    assert hypot(end.x - 1.0, end.y) < 0.005
    assert abs(wrap_angle(end.heading - 2.0)) < 0.01
    assert end.speed < 0.01
    assert abs(end.omega) < 0.05


def test_one_that_does_not_say_so_swings() -> None:
    assert reverses(driven_late(0.0, 2)) > 10


@given(heading=st.floats(-pi, pi), wanted=st.floats(-pi, pi), slack=st.floats(0.0, 1.0))
def test_roughly_there_is_the_nearest_heading_within_the_slack(
    heading: float, wanted: float, slack: float
) -> None:
    error = wrap_angle(wanted - heading)
    rough = roughly(heading, wanted, slack)
    assert abs(wrap_angle(rough - heading)) == pytest.approx(max(0.0, abs(error) - slack), abs=1e-9)
    assert abs(wrap_angle(rough - wanted)) == pytest.approx(min(abs(error), slack), abs=1e-9)


@given(speed=st.floats(0.0, 3.0), course=st.floats(-pi, pi), bearing=st.floats(-pi, pi))
def test_a_robot_that_reacts_late_is_asked_for_no_velocity_far_from_its_own(
    speed: float, course: float, bearing: float
) -> None:
    # Its wheels would slip: grSim takes the direction of a command as it is.
    limits = RobotLimits(acceleration=4.0, braking=4.0, reaction=1 / 60)
    me = robot(0.0, velocity=(speed * cos(course), speed * sin(course), 0.0), limits=limits)
    asked = drive(me, (2.0 * cos(bearing), 2.0 * sin(bearing)), 0.0, limits, 1 / 60)
    assert hypot(asked.vx - me.vx, asked.vy - me.vy) <= 4.0 * 3 / 60 + 1e-9


def test_grsims_robot_keeps_its_heading_when_it_is_sent_elsewhere_on_its_way() -> None:
    places = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.3), (0.5, -1.0)]
    skill = GoToPose(heading=0.0)
    trial = alone(skill, (0.0, 0.0, 0.0), ball=(3.0, 2.5), settings="grsim")
    for k in range(16):
        skill.target = places[k % len(places)]
        trial.run(0.4)
    # With jumps of its command it is 0.1 rad off.
    assert max(abs(frame.own[0].heading) for frame in trial.frames) < 0.05


@settings(max_examples=25, deadline=None)
@given(
    dead_time=st.floats(0.0, 0.13),
    lag=st.floats(0.0, 0.05),
    gain=st.floats(0.6, 1.0),
    side_gain=st.floats(0.6, 1.0),
    target=st.tuples(st.floats(0.3, 2.5), st.floats(-2.0, 2.0)),
    heading=st.floats(-pi, pi),
)
def test_a_robot_that_answers_late_and_in_part_stops_at_its_target_and_stays(
    dead_time: float, lag: float, gain: float, side_gain: float, target: Point, heading: float
) -> None:
    limits = RobotLimits(
        dead_time=dead_time, lag=lag, side_lag=lag, turn_lag=lag, gain=gain, side_gain=side_gain
    )
    me, period = blue(0), 1 / 60
    world = PredictedWorld(SimWorld(DIVISION_B, {me: limits}, preset("default"), period), 0.0)
    world.reset(Placement({me: (0.0, 0.0, 0.0)}, (-3.0, 2.0, 0.0, 0.0)), seed=0)
    headings, past = [], 0.0
    while world.observe().time < travel_time(hypot(*target), 0.0, limits) + 2.5:
        frame = world.observe()
        state, true = frame.own[0], world.truth().own[0]
        along_way = (true.x * target[0] + true.y * target[1]) / hypot(*target)
        past = max(past, along_way - hypot(*target))
        world.act(compensated({me: drive(state, target, heading, limits, period)}, frame))
        headings.append((world.truth().time, wrap_angle(true.heading - heading)))
    end = world.truth().own[0]
    assert past < 0.03
    assert hypot(end.x - target[0], end.y - target[1]) < 0.01
    assert end.speed < 0.05
    # It does not swing about its heading either.
    assert max(abs(off) for time, off in headings if time > headings[-1][0] - 1.0) < 0.03
