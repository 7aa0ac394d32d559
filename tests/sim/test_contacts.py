"""Balls and robots bounce off what they hit, and nothing passes through anything."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.sim import SimWorld, preset
from robobt.world import DIVISION_B, Placement, RobotCommand, RobotId, Team
from tests.sim.rig import IT, ME, one_robot

MARGIN = DIVISION_B.margin


@pytest.mark.integration
@settings(max_examples=30, deadline=None)
@given(
    x=st.floats(-4.4, 4.4),
    y=st.floats(-2.9, 2.9),
    angle=st.floats(-pi, pi),
    speed=st.floats(0.1, 15.0),
)
def test_no_ball_ever_leaves_the_walls(x: float, y: float, angle: float, speed: float) -> None:
    world = one_robot(
        "grsim", pose=(4.6, 3.1, 0), ball=(x, y, speed * cos(angle), speed * sin(angle)), field=DIVISION_B
    )
    for _ in range(300):
        world.act({})
        ball = world.truth().ball
        assert abs(ball.x) <= 4.5 + MARGIN
        assert abs(ball.y) <= 3.0 + MARGIN


@pytest.mark.integration
@settings(max_examples=40, deadline=None)
@given(speed=st.floats(2.0, 15.0), aim=st.floats(-0.45, 0.45), distance=st.floats(0.3, 3.0))
def test_a_shot_between_the_posts_stays_in_the_goal(speed: float, aim: float, distance: float) -> None:
    world = one_robot(pose=(-3, 2, 0), ball=(4.5 - distance, aim, speed, 0), field=DIVISION_B, period=0.005)
    deepest = 0.0
    for _ in range(1000):
        world.act({})
        ball = world.truth().ball
        deepest = max(deepest, ball.x)
        # Never through the back nor through the sides.
        assert ball.x <= 4.5 + DIVISION_B.goal_depth
        if ball.x > 4.5 + 0.03:
            assert abs(ball.y) <= DIVISION_B.goal_width / 2
    assert deepest > 4.5 + 0.0215


def test_a_ball_beside_the_goal_stays_out_of_it() -> None:
    world = one_robot(pose=(-3, 2, 0), ball=(4.0, 0.7, 8.0, -0.9), field=DIVISION_B)
    for _ in range(400):
        world.act({})
        ball = world.truth().ball
        assert not (ball.x > 4.55 and abs(ball.y) < 0.5)


@pytest.mark.parametrize("speed", [1.0, 3.0, 6.5, 12.0])
@pytest.mark.parametrize("offset", [0.0, 0.05, -0.08])
def test_no_ball_passes_through_a_robot(speed: float, offset: float) -> None:
    # The robot shows its back, which has no mouth to catch it.
    world = one_robot(pose=(0, 0, 0), ball=(-1.0, offset, speed, 0), field=DIVISION_B)
    for _ in range(400):
        world.act({})
        frame = world.truth()
        me, ball = frame.own[0], frame.ball
        gap = ((ball.x - me.x) ** 2 + (ball.y - me.y) ** 2) ** 0.5
        assert gap > 0.09 + 0.0215 - 0.002
        assert not (ball.x > me.x and abs(ball.y - me.y) < 0.05)


def test_the_wall_gives_back_its_share_of_the_speed() -> None:
    world = one_robot("grsim", pose=(0, 2, 0), ball=(0.0, -2.5, 0.0, -4.0), field=DIVISION_B)
    before = 0.0
    while world.truth().ball.vy < 0.0:
        before = -world.truth().ball.vy
        world.act({})
    after = world.truth().ball.vy
    assert after / before == pytest.approx(preset("grsim").contact.wall_restitution, abs=0.05)


@pytest.mark.parametrize(("speed", "most"), [(2.0, 0.5), (4.0, 0.5), (6.0, 0.6)])
def test_a_ball_arriving_at_grsims_mouth_without_dribbler_hardly_rebounds(speed: float, most: float) -> None:
    world = one_robot("grsim", ball=(1.0, 0, -speed, 0))
    rebound = 0.0
    for _ in range(300):
        world.act({})
        rebound = max(rebound, world.truth().ball.vx)
    assert rebound < most


def test_robots_do_not_pass_through_each_other() -> None:
    world = SimWorld(DIVISION_B, {ME: None, IT: None}, preset("default"), 0.02)
    world.reset(Placement({ME: (-1, 0, 0), IT: (1, 0.03, pi)}, (0, 2, 0, 0)), 0)
    closest = 9.0
    for _ in range(150):
        world.act({ME: RobotCommand(vx=3), IT: RobotCommand(vx=3)})
        frame = world.truth()
        a, b = frame.own[0], frame.opponents[0]
        closest = min(closest, ((a.x - b.x) ** 2 + (a.y - b.y) ** 2) ** 0.5)
    assert 0.16 < closest < 0.19


def test_a_collision_conserves_momentum() -> None:
    world = SimWorld(DIVISION_B, {ME: None, IT: None}, preset("default"), 0.005)
    world.reset(Placement({ME: (-0.5, 0, 0), IT: (0.0, 0.02, 0)}, (0, 2, 0, 0)), 0)
    while True:
        world.act({ME: RobotCommand(vx=1.5), IT: RobotCommand()})
        frame = world.truth()
        if frame.opponents[0].vx > 0.05:
            break
        speed = frame.own[0].vx
    # Equal masses: what one lost, the other has, but for what the motors add or brake within the step.
    total = frame.own[0].vx + frame.opponents[0].vx
    motors = 2 * world.settings.limits.braking * world.period
    assert total == pytest.approx(speed, abs=motors)


def test_a_robot_cannot_leave_through_the_wall() -> None:
    world = one_robot(pose=(4, 0.9, 0), field=DIVISION_B, ball=(0, 0, 0, 0))
    for _ in range(500):
        world.act({ME: RobotCommand(vx=3)})
    assert world.truth().own[0].x <= 4.5 + MARGIN - 0.08


def test_eleven_robots_a_team_fit() -> None:
    ids = [RobotId(team, n) for team in Team for n in range(11)]
    world = SimWorld(DIVISION_B, dict.fromkeys(ids), preset("default"), 1 / 60)
    poses = {robot: ((-1 if robot.team is Team.BLUE else 1), 0.4 * robot.number - 2, 0) for robot in ids}
    world.reset(Placement(poses), 0)
    world.act({})
    frame = world.observe()
    assert [robot.id for robot in frame.own] == list(range(11))
    assert [robot.id for robot in frame.opponents] == list(range(11))


@pytest.mark.integration
@settings(max_examples=30, deadline=None)
@given(
    heading=st.floats(-pi, pi),
    bearing=st.floats(-0.9, 0.9),
    offset=st.floats(-0.12, 0.12),
    speed=st.floats(2.0, 12.0),
)
def test_a_ball_at_the_front_corners_bounces_or_passes_but_never_sticks(
    heading: float, bearing: float, offset: float, speed: float
) -> None:
    """What the ball reports as its velocity is what it moves by, but for a few steps of contact."""
    way = heading + pi + bearing
    x = -0.5 * cos(way) - offset * sin(way)
    y = -0.5 * sin(way) + offset * cos(way)
    world = one_robot(pose=(0, 0, heading), ball=(x, y, speed * cos(way), speed * sin(way)), field=DIVISION_B)
    stuck = 0
    for _ in range(60):
        before = world.truth().ball
        world.act({})
        ball = world.truth().ball
        moved = ((ball.x - before.x) ** 2 + (ball.y - before.y) ** 2) ** 0.5
        stuck = stuck + 1 if before.speed > 1.0 and moved < 0.5 * before.speed * world.period else 0
        assert stuck <= 3


@pytest.mark.parametrize("kind", ["default", "sumatra"])
@pytest.mark.parametrize("heading", [0.0, pi])
@pytest.mark.parametrize("away", [0.5, 1.3, 2.0])
def test_a_ball_bounces_off_a_robot_that_drives_away_from_it(kind: str, heading: float, away: float) -> None:
    contact = preset(kind).contact
    world = one_robot(kind, ball=(0.5, 0, 0, 0), field=DIVISION_B)
    world.reset(Placement({ME: (0, 0, heading)}, (0.5, 0, -3.3, 0), {ME: (-away, 0)}), seed=0)
    bounce = contact.front_restitution if heading == 0.0 else contact.hull_restitution
    while world.truth().ball.vx < -3.0:
        world.act({ME: RobotCommand(vx=-away * cos(heading))})
        assert world.time < 1.0, "the ball flies on"
    assert world.truth().ball.vx == pytest.approx(-away + bounce * (3.25 - away), abs=0.15)


@pytest.mark.integration
@settings(max_examples=60, deadline=None)
@given(
    kind=st.sampled_from(["default", "sumatra", "erforce"]),
    heading=st.floats(-pi, pi),
    drives=st.tuples(st.floats(0.0, 2.0), st.floats(-pi, pi)),
    bearing=st.floats(-pi, pi),
    offset=st.floats(-0.09, 0.09),
    closing=st.floats(0.5, 6.0),
    period=st.sampled_from([0.005, 1 / 60]),
)
def test_no_ball_leaves_a_robot_that_drives_faster_than_it_came(
    kind: str,
    heading: float,
    drives: tuple[float, float],
    bearing: float,
    offset: float,
    closing: float,
    period: float,
) -> None:
    """As the robot sees it: whichever way it drives and wherever it is hit, nothing adds energy."""
    vx, vy = drives[0] * cos(drives[1]), drives[0] * sin(drives[1])
    c, s = cos(bearing), sin(bearing)
    ball = (0.4 * c - offset * s, 0.4 * s + offset * c, vx - closing * c, vy - closing * s)
    world = one_robot(kind, ball=(4.0, 2.5, 0.0, 0.0), period=period, field=DIVISION_B)
    world.reset(Placement({ME: (0, 0, heading)}, ball, {ME: (vx, vy)}), seed=0)
    ahead = cos(heading) * vx + sin(heading) * vy
    left = cos(heading) * vy - sin(heading) * vx
    came = closing
    while world.time < 0.6:
        world.act({ME: RobotCommand(vx=ahead, vy=left)})
        frame = world.truth()
        me, seen = frame.own[0], frame.ball
        speed = hypot(seen.vx - me.vx, seen.vy - me.vy)
        if frame.last_touch is None:
            came = speed
        assert speed < came + 0.25
        assert hypot(seen.x - me.x, seen.y - me.y) > preset(kind).body.face + 0.0215 - 0.004
