import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.skills.aim.raters import OpenAngle
from robobt.skills.team.best_field_position import BestFieldPosition
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import DIVISION_A, DIVISION_B, FieldGeometry, Frame, RobotState
from robobt.world.geometry import Point, distance
from robobt.world.rules import in_their_defense_area
from tests.skills.fixed_world import Alone

ME = robot(0.0, 0.0)
TINY = FieldGeometry(length=2.0, width=1.2, goal_width=0.4, defense_width=0.6, defense_depth=0.3)


def target(here: Frame, skill: BestFieldPosition | None = None) -> Point:
    alone = Alone(skill or BestFieldPosition())
    assert alone.tick(here) is Status.SUCCESS
    assert alone.store.target is not None
    return alone.store.target


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B, TINY])
def test_alone_the_best_place_is_straight_before_the_defence_area(field: FieldGeometry) -> None:
    x, y = target(frame(ME, held(ME), field=field))
    assert y == 0.0
    edge = field.half_length - field.defense_depth
    assert edge - 0.35 < x < edge


def test_opponents_that_hide_the_goal_move_it_aside() -> None:
    wall = tuple(robot(3.35, -0.3 + 0.2 * i, number=i) for i in range(4))
    here = frame(ME, held(ME), opponents=wall)
    free, hidden = OpenAngle(), target(frame(ME, held(ME)))
    best = target(here)
    assert best != hidden
    assert free.rate(here, hidden, ME) is None
    shot = free.rate(here, best, ME)
    assert shot is not None
    assert shot.score > 0.2


def test_carrying_the_ball_far_costs_something() -> None:
    left = robot(2.0, 2.0)
    assert target(frame(left, held(left)), BestFieldPosition(travel=0.0))[1] == 0.0
    near = target(frame(left, held(left)), BestFieldPosition(travel=0.3))
    assert near[1] > 0.2
    assert distance(near, held(left)) < distance(target(frame(left, held(left))), held(left))


def test_between_looks_the_target_stands_and_then_follows_the_scene() -> None:
    alone = Alone(BestFieldPosition(every=0.2))
    wall = tuple(robot(3.35, -0.3 + 0.2 * i, number=i) for i in range(4))
    alone.tick(frame(ME, held(ME), time=0.0))
    first = alone.store.target
    alone.store.target = None
    alone.tick(frame(ME, held(ME), opponents=wall, time=0.1))
    assert alone.store.target == first
    alone.tick(frame(ME, held(ME), opponents=wall, time=0.2))
    assert alone.store.target != first


def test_it_stays_where_it_wanted_to_go_while_that_is_nearly_the_best() -> None:
    steady, eager = (BestFieldPosition(travel=0.3, every=0.0, keep=keep) for keep in (0.1, 0.0))
    seen: dict[BestFieldPosition, set[Point]] = {steady: set(), eager: set()}
    for skill, places in seen.items():
        alone = Alone(skill)
        for y in np.linspace(-1.5, 1.5, 7):
            me = robot(2.5, float(y))
            alone.tick(frame(me, held(me)))
            assert alone.store.target is not None
            places.add(alone.store.target)
    assert len(seen[steady]) < len(seen[eager])


places = st.builds(lambda x, y: RobotState(0, x, y), st.floats(-4.5, 4.7), st.floats(-3.0, 3.0))


@settings(max_examples=60)
@given(opponents=st.lists(places, max_size=6), me=places)
def test_the_place_is_always_legal(opponents: list[RobotState], me: RobotState) -> None:
    x, y = target(frame(me, held(me), opponents=tuple(opponents)))
    assert x >= 0.0
    assert DIVISION_B.contains(x, y, tolerance=-0.19)
    assert not in_their_defense_area(DIVISION_B, x, y, tolerance=0.19)


def test_a_field_that_is_all_defence_area_leaves_nowhere_to_go() -> None:
    field = FieldGeometry(length=2.0, width=1.0, goal_width=0.4, defense_width=1.0, defense_depth=1.0)
    alone = Alone(BestFieldPosition())
    assert alone.tick(frame(ME, held(ME), field=field)) is Status.FAILURE
    assert alone.store.target is None


def test_a_grid_without_spacing_is_refused() -> None:
    with pytest.raises(ValueError, match="spacing"):
        BestFieldPosition(spacing=0.0)
