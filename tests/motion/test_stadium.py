"""Keeping out of the way of a ball that the opponents place."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.motion.stadium import outside_stadium
from robobt.testing import frame, robot
from robobt.world import Frame, GameState, RefereeCommand, Restart, Team
from robobt.world.geometry import Point, segment_distance, segments_distance

BALL, SPOT = (-2.0, 0.0), (2.0, 0.0)
KEEP = 0.5 + 0.09


def placing(x: float, y: float, team: Team = Team.YELLOW, ball: Point = BALL) -> Frame:
    seen = frame(robot(x, y), ball)
    seen.game = GameState(
        RefereeCommand[f"BALL_PLACEMENT_{team.name}"],
        restart=Restart.BALL_PLACEMENT,
        restart_team=team,
        placement=SPOT,
    )
    return seen


@given(x=st.floats(-2.5, 2.5), y=st.floats(0.01, 0.58), target=st.floats(-3.0, 3.0))
def test_a_robot_inside_is_sent_out(x: float, y: float, target: float) -> None:
    seen = placing(x, y)
    goal = outside_stadium(seen, seen.own[0], (target, 0.0))
    inside = segment_distance((x, y), BALL, SPOT) < KEEP
    assert not inside or segment_distance(goal, BALL, SPOT) > KEEP


@given(x=st.floats(-4.0, 4.0), y=st.floats(-2.8, 2.8), to_x=st.floats(-4.0, 4.0), to_y=st.floats(-2.8, 2.8))
def test_no_way_from_outside_leads_through_it(x: float, y: float, to_x: float, to_y: float) -> None:
    seen = placing(x, y)
    goal = outside_stadium(seen, seen.own[0], (to_x, to_y))
    if segment_distance((x, y), BALL, SPOT) > KEEP + 0.1:
        assert segments_distance((x, y), goal, BALL, SPOT) >= KEEP


@pytest.mark.parametrize("target", [(0.0, 2.0), (3.5, 1.5)])
def test_a_free_way_is_taken(target: Point) -> None:
    seen = placing(0.0, 1.0)
    assert outside_stadium(seen, seen.own[0], target) == target


def test_ones_own_placement_keeps_nobody_out() -> None:
    seen = placing(0.0, 1.0, team=Team.BLUE)
    assert outside_stadium(seen, seen.own[0], (0.0, -1.0)) == (0.0, -1.0)
