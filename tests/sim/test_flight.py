"""A chipped ball flies, hops and rolls; over what it is higher than, against everything else."""

from __future__ import annotations

from math import cos, hypot, pi, sin, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.sim import Arenas, SimSettings, SimWorld, preset
from robobt.sim.robot_settings import KickerSettings
from robobt.world import BALL_RADIUS, DIVISION_B, ROBOT_RADIUS, Placement, RobotCommand
from robobt.world.ball_model import GRAVITY, BallModel
from robobt.world.command import CHIP_ANGLE
from robobt.world.geometry import FloatArray
from robobt.world.state import RECEIVED_HEIGHT, ROBOT_HEIGHT
from tests.sim.rig import HUGE, IT, ME, holding

PERIOD = 0.01
HULL = ROBOT_RADIUS + BALL_RADIUS
POST, LINE = DIVISION_B.goal_width / 2, DIVISION_B.half_length
speeds = st.floats(1.5, 8.0)


def chipper(
    speed: float = 5.0, settings: SimSettings | str = "default", angle: float = CHIP_ANGLE
) -> SimWorld:
    """A world in which a robot at the origin has just been told to chip."""
    world = holding(settings, period=PERIOD)
    world.act({ME: RobotCommand(kick_speed=speed, kick_angle=angle)})
    while not world.kicks:
        world.act({})
    return world


def touch_downs(world: SimWorld) -> list[tuple[float, float]]:
    """When the ball touches down, and how far from where it lay; its last one is where it begins to roll."""
    start = world.settings.body.face + BALL_RADIUS
    found = []
    before = world.truth()
    kicked = before.time - before.ball.x / before.ball.vx + start / before.ball.vx
    while before.ball.z > 0.0:
        world.act({})
        now = world.truth()
        if now.ball.vz > before.ball.vz or now.ball.z == 0.0:
            # From where it was, it fell the rest of the way.
            rise, z = before.ball.vz, before.ball.z
            left = (rise + sqrt(rise * rise + 2.0 * GRAVITY * z)) / GRAVITY
            found.append((before.time + left - kicked, before.ball.x + left * before.ball.vx - start))
        before = now
    return found


def thrown(
    ball: tuple[float, ...], robots: list[tuple[float, float, float]], changes: SimSettings | None = None
) -> Arenas:
    """Division B with the ball at x, y, vx, vy, z, vz among robots at rest."""
    arenas = Arenas(DIVISION_B, [None] * len(robots), changes or preset("default"), PERIOD)
    arenas.place(np.array([robots]), np.zeros((1, 4)))
    x, y, vx, vy, z, vz = ball
    arenas.place_ball(0, x, y, vx, vy, z=z, vz=vz)
    return arenas


def seen(arenas: Arenas, seconds: float) -> FloatArray:
    """x, y, vx, vy, z, vz of the ball after every tick."""
    rows = []
    for _ in range(round(seconds / PERIOD)):
        arenas.step(np.zeros((1, arenas.contact.shape[1], 6)))
        rows.append(np.concatenate([arenas.balls[0], arenas.flight[0, :2]]))
    return np.array(rows)


# In the open.


@pytest.mark.parametrize("speed", [2.0, 4.0, 6.0])
def test_it_flies_along_a_parabola(speed: float) -> None:
    world = chipper(speed)
    start, along = world.settings.body.face + BALL_RADIUS + 0.0003, speed * cos(CHIP_ANGLE)
    while (ball := world.truth().ball).vz > -along + 0.2:
        time = (ball.x - start) / along
        assert ball.z == pytest.approx(along * time - GRAVITY * time * time / 2, rel=0.01, abs=1e-4)
        assert (ball.vx, ball.vz) == pytest.approx((along, along - GRAVITY * time), rel=0.01, abs=0.01)
        world.act({})


@pytest.mark.parametrize("name", ["default", "grsim", "erforce"])
@pytest.mark.parametrize("speed", [3.0, 5.0])
def test_it_hops_as_the_closed_form_says(name: str, speed: float) -> None:
    found = touch_downs(chipper(speed, name))
    expected = preset(name).ball.touch_downs(speed * preset(name).kicker.chip_yield)
    assert len(found) == len(expected)
    for (time, way), (closed_time, closed_way) in zip(found, expected, strict=True):
        # It is seen to leave within a tick of the kick.
        assert time == pytest.approx(closed_time, rel=0.01, abs=0.005)
        assert way == pytest.approx(closed_way, rel=0.01)


@pytest.mark.parametrize(("speed", "ways"), [(3.0, (0.92, 1.26, 1.40)), (5.0, (2.55, 3.51, 3.89))])
def test_it_touches_down_where_sumatras_chip_does(speed: float, ways: tuple[float, ...]) -> None:
    found = touch_downs(chipper(speed))
    assert [way for _, way in found] == pytest.approx(ways, rel=0.01)


def test_it_rolls_at_last_as_any_ball_does() -> None:
    world = chipper(3.0)
    downs = touch_downs(world)
    speed = BallModel().along(3.0, len(downs))
    while world.truth().ball.speed > 0.0:
        world.act({})
    rolled = speed * speed / (2 * world.settings.ball.roll_deceleration)
    ends = world.settings.body.face + BALL_RADIUS + downs[-1][1] + rolled
    assert world.truth().ball.x == pytest.approx(ends, rel=0.01)


def test_er_forces_longest_chip_lands_at_three_metres_and_loses_what_it_advertises() -> None:
    first, second, third = (way for _, way in touch_downs(chipper(9.0, "erforce"))[:3])
    assert first == pytest.approx(3.0, rel=0.05)
    assert second - first == pytest.approx(3.0 * 0.715 * 0.566, rel=0.05)
    assert third - second == pytest.approx(3.0 * 0.715 * 0.566**2, rel=0.05)


# Source: touch-downs of the ball in the real grSim, kicked at 45 degrees by its packets.
@pytest.mark.parametrize(
    ("speed", "ways"),
    [
        (3.0, (0.858, 1.108)),
        (4.0, (1.531, 1.970, 2.168)),
        (5.0, (2.394, 3.082, 3.388)),
        (6.0, (3.451, 4.443, 4.880)),
    ],
)
def test_it_touches_down_where_grsims_does(speed: float, ways: tuple[float, ...]) -> None:
    found = [way for _, way in touch_downs(chipper(speed, "grsim"))]
    assert found[: len(ways)] == pytest.approx(ways, rel=0.01)


def test_grsims_robots_chip_at_the_commanded_angle_and_others_at_their_own() -> None:
    for name, angle in (("grsim", pi / 6), ("default", CHIP_ANGLE)):
        ball = chipper(5.0, name, angle=pi / 6).truth().ball
        assert ball.vx == pytest.approx(5.0 * preset(name).kicker.chip_yield * cos(angle), rel=1e-6)


def test_no_chip_is_faster_than_the_presets_cap() -> None:
    ball = chipper(20.0, preset("default", kicker=KickerSettings(max_chip_speed=5.0))).truth().ball
    assert hypot(ball.vx, ball.vz + GRAVITY * PERIOD) == pytest.approx(5.0, rel=0.02)


# Robots.


def test_it_passes_over_a_robot_that_it_is_higher_than() -> None:
    world = SimWorld(HUGE, {ME: None, IT: None}, period=PERIOD)
    for away, over in ((0.13 + HULL, False), (0.4, True), (1.2, True), (1.63 + HULL, False)):
        world.reset(_facing(away), seed=0)
        for tick in range(100):
            world.act({ME: RobotCommand(kick_speed=4.0, kick_angle=CHIP_ANGLE)} if tick == 0 else {})
        ball, robot = world.truth().ball, world.truth().opponents[0]
        assert (ball.x > away + ROBOT_RADIUS) is over
        assert (robot.x == pytest.approx(away, abs=1e-9)) is over
        assert (world.truth().last_touch == ME) is over


def _facing(away: float) -> Placement:
    ahead = preset("default").body.face + BALL_RADIUS + 0.0003
    return Placement({ME: (0.0, 0.0, 0.0), IT: (away, 0.0, pi)}, (ahead, 0.0, 0.0, 0.0))


def test_a_ball_that_falls_on_a_robot_bounces_off_its_top() -> None:
    rows = seen(thrown((0.0, 0.0, 0.3, 0.0, 0.4, 0.0), [(0.0, 0.0, 0.0)]), 2.0)
    on_top = np.abs(rows[:, 0]) < ROBOT_RADIUS
    assert rows[on_top, 4].min() >= ROBOT_HEIGHT
    assert (rows[on_top, 5] > 0.5).any()
    assert rows[-1, 4] == 0.0


def test_a_ball_is_received_only_near_the_ground() -> None:
    for height, received in ((RECEIVED_HEIGHT + 0.02, False), (0.0, True)):
        arenas = thrown((0.0967, 0.0, 0.0, 0.0, height, 0.0), [(0.0, 0.0, 0.0)])
        assert bool(arenas.contact[0, 0]) is received
        commands = np.zeros((1, 1, 7))
        commands[0, 0, 3] = 3.0
        arenas.step(commands)
        assert bool(arenas.kicked[0, 0]) is received


@pytest.mark.parametrize("name", ["default", "grsim", "erforce"])
def test_the_dribbler_takes_a_ball_that_hops_before_it(name: str) -> None:
    arenas = thrown((0.16, 0.0, -0.5, 0.0, 0.03, 0.0), [(0.0, 0.0, 0.0)], preset(name))
    commands = np.zeros((1, 1, 6))
    commands[0, 0, 5] = 1.0
    for _ in range(150):
        arenas.step(commands)
    assert arenas.contact[0, 0]
    assert arenas.flight[0, 0] == 0.0


# What holds always.

robots = st.lists(
    st.tuples(st.floats(-4.0, 4.0), st.floats(-2.5, 2.5), st.floats(-3.1, 3.1)), min_size=1, max_size=4
)


@st.composite
def throws(draw: st.DrawFn) -> tuple[float, ...]:
    """Balls thrown at up to 8 m/s, anywhere, in any direction upwards."""
    speed, elevation, bearing = draw(speeds), draw(st.floats(0.0, 1.4)), draw(st.floats(-3.1, 3.1))
    along = speed * cos(elevation)
    x, y = draw(st.floats(-4.0, 4.0)), draw(st.floats(-2.5, 2.5))
    return x, y, along * cos(bearing), along * sin(bearing), 0.3, speed * sin(elevation)


@pytest.mark.parametrize("name", ["default", "erforce", "grsim"])
@settings(max_examples=40)
@given(ball=throws(), robots=robots)
def test_energy_never_grows(
    name: str, ball: tuple[float, ...], robots: list[tuple[float, float, float]]
) -> None:
    rows = seen(thrown(ball, robots, preset(name)), 3.0)
    energy = (rows[:, 2] ** 2 + rows[:, 3] ** 2 + rows[:, 5] ** 2) / 2 + GRAVITY * rows[:, 4]
    # On the ground, the spin of a ball that bounced off a wall drives it back.
    in_the_air = rows[:-1, 4] > 0.0
    # A ball that has got into one of grSim's soft robots is pushed out again, on the ground as above it.
    assert name == "grsim" or (np.diff(energy)[in_the_air] <= 1e-6).all()
    assert energy.max() <= energy[0] + 1e-6


@settings(max_examples=40)
@given(ball=throws(), robots=robots)
def test_left_and_right_are_alike(ball: tuple[float, ...], robots: list[tuple[float, float, float]]) -> None:
    x, y, vx, vy, z, vz = ball
    one = seen(thrown(ball, robots), 1.0)
    other = seen(thrown((x, -y, vx, -vy, z, vz), [(x, -y, -heading) for x, y, heading in robots]), 1.0)
    np.testing.assert_allclose(other * (1, -1, 1, -1, 1, 1), one, atol=1e-6)


@pytest.mark.parametrize("name", ["default", "erforce", "grsim"])
@settings(max_examples=40)
@given(
    speed=st.floats(1.0, 8.0),
    elevation=st.floats(0.0, 0.15),
    aside=st.floats(-0.1, 0.1),
    away=st.floats(0.3, 1.0),
)
def test_no_low_ball_tunnels_through_a_robot(
    name: str, speed: float, elevation: float, aside: float, away: float
) -> None:
    along, up = speed * cos(elevation), speed * sin(elevation)
    rows = seen(thrown((-away, aside, along, 0.0, 0.0, up), [(0.0, 0.0, 0.0)], preset(name)), 0.6)
    low, behind = rows[:, 4] < ROBOT_HEIGHT - 0.01, np.hypot(rows[:, 0], rows[:, 1]) < 0.6 * ROBOT_RADIUS
    assert not (low & behind).any()
    # Farther out, the wheels of grSim's robot may send it around.
    if abs(aside) < preset(name).body.mouth_width / 2 and up * up < 2 * GRAVITY * ROBOT_HEIGHT:
        assert rows[:, 0].max() < 0.0


@settings(max_examples=60)
@given(
    speed=st.floats(1.0, 8.0),
    elevation=st.floats(0.0, 0.2),
    bearing=st.floats(-1.2, 1.2),
    y=st.floats(-0.4, 0.4),
)
def test_no_low_ball_leaves_a_goal_through_its_walls(
    speed: float, elevation: float, bearing: float, y: float
) -> None:
    along, up = speed * cos(elevation), speed * sin(elevation)
    start = (LINE - 0.05, y, along * cos(bearing), along * sin(bearing), 0.0, up)
    rows = seen(thrown(start, [(0.0, 0.0, 0.0)]), 1.0)
    if rows[:, 4].max() < ROBOT_HEIGHT:
        inside = rows[:, 0] > LINE + BALL_RADIUS
        assert (np.abs(rows[inside, 1]) <= POST - BALL_RADIUS + 0.01).all()
        assert (rows[:, 0] <= LINE + DIVISION_B.goal_depth - BALL_RADIUS + 0.01).all()


@settings(max_examples=60)
@given(ball=throws())
def test_no_ball_leaves_the_walls_around_the_field(ball: tuple[float, ...]) -> None:
    rows = seen(thrown(ball, [(0.0, 0.0, 0.0)]), 4.0)
    assert (np.abs(rows[:, 0]) <= DIVISION_B.outer[0] - BALL_RADIUS + 0.005).all()
    assert (np.abs(rows[:, 1]) <= DIVISION_B.outer[1] - BALL_RADIUS + 0.005).all()
