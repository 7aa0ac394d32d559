"""What a page shows while a match stands still and viewers move things."""

from __future__ import annotations

from robobt.live.standing import standing
from robobt.testing import frame, robot
from robobt.world import BallState, RobotState


def packed(ball: BallState, *robots: RobotState) -> bytes:
    """A frame whose first robot is ours, the others theirs."""
    made = frame(robots[0], opponents=robots[1:])
    made.ball = ball
    return made.packed()


FLYING, LANDED = BallState(2.0, 0.0, z=0.1, vz=1.0), BallState(-1.0, 0.0)
ME, OTHER = robot(0.0, 0.0), robot(1.0, 0.0, number=1)
SHOWN = packed(FLYING, ME, OTHER)
# The world is a tick ahead of what was shown.
LATER = BallState(2.05, 0.0, z=0.13, vz=0.7), robot(0.03, 0.0), robot(1.03, 0.0, number=1)
BEFORE = packed(*LATER)
ELSEWHERE = robot(-2.0, 1.0, number=1)


def test_as_long_as_nothing_is_moved_it_is_what_was_shown() -> None:
    assert standing(SHOWN, BEFORE, BEFORE) == SHOWN


def test_what_is_moved_is_where_it_is_and_all_else_where_it_was_shown() -> None:
    assert standing(SHOWN, BEFORE, packed(*LATER[:2], ELSEWHERE)) == packed(FLYING, ME, ELSEWHERE)


def test_a_ball_that_is_put_down_is_no_longer_in_the_air() -> None:
    assert standing(SHOWN, BEFORE, packed(LANDED, *LATER[1:])) == packed(LANDED, ME, OTHER)


def test_a_robot_that_was_taken_off_is_not_shown() -> None:
    assert standing(SHOWN, BEFORE, packed(*LATER[:2])) == packed(FLYING, ME)
