"""What the ready predicates hold of, on frames made by hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi

import pytest

from robobt.testing import (
    Predicate,
    ball_leaves_the_field,
    ball_near,
    blue,
    dribbles_too_far,
    frame,
    goal_for,
    has_ball,
    held,
    inside_the_field,
    leaves_the_field,
    robot,
    touches_a_robot,
    touches_inside_area,
    touches_the_ball,
    yellow,
)
from robobt.world import ROBOT_RADIUS, Frame, RobotState, Team


def told(holds: Predicate, frames: Sequence[Frame]) -> list[bool]:
    return [holds(seen) for seen in frames]


def carried(me: RobotState, xs: Sequence[float]) -> list[Frame]:
    """The robot with the ball at these places, as a world that knows who touched it last shows them."""
    return [frame(there := replace(me, x=x), held(there), last_touch=blue(me.id)) for x in xs]


@pytest.mark.parametrize(("team", "side"), [(Team.BLUE, 1.0), (Team.YELLOW, -1.0)])
def test_a_goal_is_told_at_the_frame_in_which_it_is_scored(team: Team, side: float) -> None:
    balls = [(4.0 * side, 0.0), (4.55 * side, 0.0), (4.6 * side, 0.0)]
    frames = [frame(robot(), ball) for ball in balls]
    assert told(goal_for(team), frames) == [False, True, False]
    assert told(goal_for(team.other), frames) == [False, False, False]


def test_a_ball_in_a_goal_from_the_start_is_no_goal() -> None:
    assert told(goal_for(Team.BLUE), [frame(robot(), (4.6, 0.0))] * 2) == [False, False]


def test_has_ball_is_the_contact_of_that_robot() -> None:
    seen = frame(robot(number=1, contact=True), mates=(robot(1.0),), opponents=(robot(2.0, number=1),))
    assert (has_ball(blue(1))(seen), has_ball(blue(0))(seen), has_ball(yellow(1))(seen)) == (
        True,
        False,
        False,
    )


def test_of_a_robot_that_is_not_there_nothing_is_said() -> None:
    for holds in (has_ball(yellow(1)), leaves_the_field(yellow(1)), touches_the_ball(yellow(1))):
        with pytest.raises(ValueError, match="yellow 1 is not on the field"):
            holds(frame(robot()))


def test_where_the_ball_is() -> None:
    near = ball_near((1.0, 0.0), 0.5)
    assert [near(frame(robot(), (x, 0.0))) for x in (0.49, 0.51, 1.49, 1.51)] == [False, True, True, False]
    assert [ball_leaves_the_field(frame(robot(), (0.0, y))) for y in (2.9, 3.1)] == [False, True]
    assert ball_leaves_the_field(frame(robot(), (4.6, 0.0)))


def test_a_robot_leaves_the_field_when_all_of_it_is_out() -> None:
    leaves = leaves_the_field(yellow(4))
    seen = [frame(robot(), opponents=(robot(0.0, y, number=4),)) for y in (3.0 + ROBOT_RADIUS - 0.01, 3.1)]
    assert told(leaves, seen) == [False, True]


def test_inside_the_field_is_inside_the_walls_and_of_all_robots() -> None:
    there = frame(robot(0.0, 3.2))
    assert inside_the_field(there)
    assert not inside_the_field(replace(there, opponents=(robot(0.0, 3.25),)))


def test_robots_touch_when_their_hulls_do() -> None:
    for gap, touching in ((0.001, False), (-0.001, True)):
        place = 2.0 * ROBOT_RADIUS + gap
        mate = frame(robot(), mates=(robot(place, number=1),))
        opponent = frame(robot(), opponents=(robot(place),))
        assert told(touches_a_robot(blue(0)), [mate, opponent]) == [touching, touching]
        assert not touches_a_robot(blue(0))(replace(mate, own=mate.own[:1]))


def test_dribbling_too_far_is_counted_from_where_the_robot_got_the_ball() -> None:
    me = robot(number=2)
    frames = carried(me, [0.0, 0.5, 0.99, 1.01])
    assert told(dribbles_too_far(blue(2)), frames) == [False, False, False, True]
    assert told(dribbles_too_far(blue(2), most=0.4), frames) == [False, True, True, True]
    assert not any(told(dribbles_too_far(blue(1)), frames))


def test_letting_the_ball_go_begins_another_dribble() -> None:
    me = robot()
    first, second = carried(me, [0.0, 0.6]), carried(me, [0.8, 1.4])
    free = frame(robot(0.6), (1.5, 0.0), last_touch=blue(0))
    assert not any(told(dribbles_too_far(blue(0)), [*first, free, *second]))
    assert told(dribbles_too_far(blue(0)), [*first, *second])[-1]


def test_touching_inside_an_area_takes_both() -> None:
    inside, outside = robot(3.7, 0.0), robot(3.0, 0.0)
    edge = robot(3.5 - ROBOT_RADIUS + 0.01, 0.0, pi)
    touching = [frame(there, held(there)) for there in (inside, edge, outside)]
    assert told(touches_inside_area(blue(0), Team.YELLOW), touching) == [True, True, False]
    assert told(touches_inside_area(blue(0), Team.BLUE), touching) == [False, False, False]
    assert told(touches_the_ball(blue(0)), touching) == [True, True, True]
    away = frame(inside, (3.7, 0.3))
    assert not touches_inside_area(blue(0), Team.YELLOW)(away)
    assert not touches_the_ball(blue(0))(away)
