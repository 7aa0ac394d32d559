"""Who touches the ball, who touched it last and who carries it."""

from __future__ import annotations

import pytest

from robobt.match.referee.touches import Touches
from robobt.world import BALL_RADIUS, DIVISION_B, ROBOT_RADIUS, BallState, Frame, RobotId, RobotState, Team
from robobt.world.rules import KEPT_GAP

HULL = ROBOT_RADIUS + BALL_RADIUS
BLUE, YELLOW = RobotId(Team.BLUE, 1), RobotId(Team.YELLOW, 2)


def see(
    touches: Touches,
    ball: tuple[float, float],
    *,
    blue: tuple[float, float] = (-3.0, 0.0),
    yellow: tuple[float, float] = (3.0, 0.0),
    last_touch: RobotId | None = None,
) -> Touches:
    """Take in a frame; both robots have their backs to the ball where they meet it."""
    own, opponents = (RobotState(1, *blue, heading=3.0),), (RobotState(2, *yellow),)
    touches.watch(Frame(0.0, DIVISION_B, BallState(*ball), own, opponents, last_touch=last_touch))
    return touches


def test_before_any_contact_nobody_has_touched_the_ball() -> None:
    touches = see(Touches(), (0.0, 0.0))
    assert (touches.now, touches.last, touches.carrier) == ([], None, None)


def test_contact_is_seen_where_the_world_does_not_report_it() -> None:
    touches = see(Touches(), (1.0, 0.0), blue=(1.0 - HULL, 0.0))
    assert (touches.now, touches.last, touches.where) == ([BLUE], BLUE, (1.0, 0.0))
    see(touches, (2.0, 0.0))
    assert (touches.now, touches.last, touches.where) == ([], BLUE, (1.0, 0.0))


def test_what_the_world_reports_is_believed_over_the_contact_seen() -> None:
    touches = see(Touches(), (1.0, 0.0), blue=(1.0 - HULL, 0.0), last_touch=YELLOW)
    assert (touches.now, touches.last) == ([BLUE], YELLOW)


def test_a_touch_between_two_frames_happened_where_the_ball_is_now() -> None:
    touches = see(Touches(), (0.5, 0.2), last_touch=BLUE)
    assert (touches.now, touches.last, touches.where) == ([], BLUE, (0.5, 0.2))


def test_of_two_in_contact_the_one_before_stays_the_last() -> None:
    touches = see(Touches(), (1.0, 0.0), yellow=(1.0 + HULL, 0.0))
    see(touches, (1.0, 0.0), blue=(1.0 - HULL, 0.0), yellow=(1.0 + HULL, 0.0))
    assert touches.now == [BLUE, YELLOW]
    assert touches.last == YELLOW


def test_the_ball_is_carried_as_the_crow_flies_from_where_it_was_got() -> None:
    touches = Touches()
    for x, y in ((0.0, 0.0), (0.3, 0.0), (0.3, 0.4), (0.0, 0.4)):
        see(touches, (x, y), blue=(x - HULL, y))
    assert touches.carrier == BLUE
    assert touches.carried == pytest.approx(0.4)


def test_a_carrier_keeps_the_ball_over_a_small_gap_and_loses_it_over_a_larger_one() -> None:
    touches = see(Touches(), (0.0, 0.0), blue=(-HULL, 0.0))
    see(touches, (0.5, 0.0), blue=(0.5 - HULL - KEPT_GAP + 0.001, 0.0))
    assert (touches.carrier, touches.carried) == (BLUE, 0.5)
    see(touches, (0.6, 0.0), blue=(0.6 - HULL - KEPT_GAP - 0.001, 0.0))
    assert (touches.carrier, touches.carried) == (None, 0.0)


def test_another_robots_touch_ends_a_carry() -> None:
    touches = see(Touches(), (0.0, 0.0), blue=(-HULL, 0.0), last_touch=BLUE)
    see(touches, (0.5, 0.0), blue=(0.5 - HULL, 0.0), yellow=(0.5 + HULL, 0.0), last_touch=YELLOW)
    assert (touches.carrier, touches.carried) == (YELLOW, 0.0)
