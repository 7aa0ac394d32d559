import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.skills.aim.raters import MovingHorizon, OpenAngle
from robobt.skills.aim.raters.moving_horizon import extent
from robobt.testing import frame, robot
from robobt.world import RobotLimits, RobotState

ME, BALL = robot(1.9, 0.0), (2.0, 0.0)


def score(rater: MovingHorizon, *opponents: RobotState, delay: float = 0.0) -> float:
    shot = rater.rate(frame(ME, BALL, opponents=opponents), BALL, ME, delay=delay)
    return shot.score if shot else 0.0


def integrated(speed: float, time: float, way: float, limits: RobotLimits) -> float:
    """Distance after ``time`` of a robot that accelerates towards ``way`` (+1 or -1), in small steps."""
    steps, at = 4000, 0.0
    dt = time / steps
    for _ in range(steps):
        rate = limits.braking if speed * way < 0.0 else limits.acceleration
        top = max(limits.max_speed, speed * way)
        speed = min(top, speed * way + rate * dt) * way
        at += speed * dt
    return at


@settings(max_examples=25)
@given(speed=st.floats(0.0, 3.0), time=st.floats(0.01, 2.0))
def test_the_extent_is_what_full_acceleration_either_way_reaches(speed: float, time: float) -> None:
    limits = RobotLimits(max_speed=2.0, acceleration=2.5, braking=4.0)
    ahead, back = extent(speed, time, limits)
    assert ahead == pytest.approx(integrated(speed, time, 1.0, limits), abs=5e-3)
    assert back == pytest.approx(integrated(speed, time, -1.0, limits), abs=5e-3)


def test_a_robot_too_near_to_react_hides_only_itself() -> None:
    near = robot(2.4, 0.0)
    centre, radius = MovingHorizon().reach(near, BALL)
    assert centre == near.position
    assert radius == pytest.approx(0.1115)


def test_robots_without_time_are_rated_as_if_they_stood() -> None:
    keeper = robot(4.3, 0.1, velocity=(0.0, 0.4, 0.0))
    here = frame(ME, BALL, opponents=(keeper,))
    moving = MovingHorizon(reaction=2.0, reacting_speed=20.0, goal_share=1.0).rate_all(here, BALL, ME)
    # The same discs; the mouth differs by the ball's radius at either post.
    still = OpenAngle(full_angle=0.3).rate_all(here, BALL, ME)
    assert len(moving) == len(still) == 2
    for a, b in zip(moving, still, strict=True):
        assert a.score == pytest.approx(b.score, abs=0.03)


def test_a_goalkeeper_moving_left_opens_the_right() -> None:
    keeper = robot(4.3, 0.0, velocity=(0.0, 1.0, 0.0))
    shots = MovingHorizon().rate_all(frame(ME, BALL, opponents=(keeper,)), BALL, ME)
    assert shots[0].target[1] < 0.0
    assert shots[0].score > score(MovingHorizon(), robot(4.3, 0.0))


def test_a_slower_kick_a_longer_wait_and_a_stronger_robot_leave_less() -> None:
    keeper = robot(4.3, 0.2)
    best = score(MovingHorizon(), keeper)
    assert score(MovingHorizon(kick_speed=5.0), keeper) < best
    assert score(MovingHorizon(), keeper, delay=1.0) < best
    strong = robot(4.3, 0.2, limits=RobotLimits(acceleration=6.0))
    assert score(MovingHorizon(), strong) < best


def test_a_robot_already_moving_needs_no_time_to_react() -> None:
    rater = MovingHorizon()
    slow, fast = (rater.reach(robot(4.3, 0.0, velocity=(0.0, v, 0.0)), BALL)[1] for v in (0.01, 1.5))
    standing = rater.reach(robot(4.3, 0.0), BALL)[1]
    assert slow == pytest.approx(standing, abs=0.02)
    assert fast > standing


def test_a_ball_that_never_gets_there_gives_all_the_time_allowed() -> None:
    rater = MovingHorizon(kick_speed=0.5, longest=0.5)
    _, radius = rater.reach(robot(4.3, 0.0), BALL)
    assert radius == pytest.approx(0.1115 + 0.5 * 3.0 * 0.5**2)
