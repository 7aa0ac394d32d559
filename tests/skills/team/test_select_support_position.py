import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.skills.aim.pass_rater import PassRater
from robobt.skills.team.select_support_position import SelectSupportPosition
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import DIVISION_A, DIVISION_B, FieldGeometry, Frame, RobotState
from robobt.world.geometry import Point, distance, segment_distance
from robobt.world.rules import in_their_defense_area
from tests.skills.fixed_world import Alone

HOLDER = robot(1.0, 0.0, number=1)
BALL = held(HOLDER)
ME = robot(0.0, 1.0)


def target(here: Frame, skill: SelectSupportPosition | None = None) -> Point:
    alone = Alone(skill or SelectSupportPosition())
    assert alone.tick(here) is Status.SUCCESS
    assert alone.store.target is not None
    return alone.store.target


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B])
def test_it_is_before_the_goal_out_of_the_way_and_away_from_the_ball(field: FieldGeometry) -> None:
    x, y = target(frame(ME, BALL, (HOLDER,), field=field))
    assert distance((x, y), HOLDER.position) > 1.5
    assert not in_their_defense_area(field, x, y, tolerance=0.19)
    assert x > field.half_length / 2
    # Outside the triangle from the ball to 0.6 m beside the posts.
    share = (x - BALL[0]) / (field.half_length - BALL[0])
    assert abs(y) > share * (field.goal_width / 2 + 0.6) - 0.05


def test_it_is_on_the_side_the_robot_is_on() -> None:
    for side in (1.0, -1.0):
        me = robot(2.0, 1.5 * side)
        assert target(frame(me, BALL, (HOLDER,)))[1] * side > 0.0


def test_it_is_not_in_an_opponents_shadow() -> None:
    free = target(frame(ME, BALL, (HOLDER,)))
    between = robot((free[0] + BALL[0]) / 2, (free[1] + BALL[1]) / 2)
    place = target(frame(ME, BALL, (HOLDER,), (between,)))
    assert place != free
    assert segment_distance(between.position, BALL, place) > 0.26


def test_a_ball_can_be_passed_there() -> None:
    opponents = (robot(2.5, 0.9), robot(2.5, -0.9, number=1), robot(4.3, 0.0, number=2))
    place = target(frame(ME, BALL, (HOLDER,), opponents))
    there = frame(HOLDER, BALL, (robot(*place),), opponents)
    assert [p.receiver for p in PassRater().rate_all(there, HOLDER)] == [0]


def test_two_supporters_keep_apart() -> None:
    other = robot(3.2, 1.6, number=2)
    me = robot(2.8, 1.4)
    place = target(frame(me, BALL, (HOLDER, other)))
    assert distance(place, other.position) > 1.5


def test_the_room_for_mates_is_a_parameter() -> None:
    other = robot(3.2, 1.6, number=2)
    me = robot(2.8, 1.4)
    close = target(frame(me, BALL, (HOLDER, other)), SelectSupportPosition(mate_distance=0.3))
    assert distance(close, other.position) < 1.5
    with pytest.raises(ValueError, match="mate_distance"):
        SelectSupportPosition(mate_distance=0.0)


def test_between_looks_the_target_stands() -> None:
    alone = Alone(SelectSupportPosition(every=0.5))
    alone.tick(frame(ME, BALL, (HOLDER,)))
    first = alone.store.target
    me = robot(2.0, -2.0)
    alone.tick(frame(me, BALL, (HOLDER,), time=0.4))
    assert alone.store.target == first
    alone.tick(frame(me, BALL, (HOLDER,), time=0.5))
    assert alone.store.target != first


places = st.builds(lambda x, y: RobotState(0, x, y), st.floats(-4.5, 4.7), st.floats(-3.0, 3.0))


@settings(max_examples=60)
@given(
    opponents=st.lists(places, max_size=6),
    mates=st.lists(places, max_size=4),
    me=places,
    ball=st.tuples(st.floats(-4.5, 4.7), st.floats(-3.2, 3.2)),
)
def test_the_place_is_always_legal(
    opponents: list[RobotState], mates: list[RobotState], me: RobotState, ball: Point
) -> None:
    others = tuple(robot(mate.x, mate.y, number=i + 1) for i, mate in enumerate(mates))
    x, y = target(frame(me, ball, others, tuple(opponents)))
    assert x >= 0.0
    assert DIVISION_B.contains(x, y, tolerance=-0.19)
    assert not in_their_defense_area(DIVISION_B, x, y, tolerance=0.19)
