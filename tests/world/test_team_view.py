"""What a robot of a team observes, by hand."""

from __future__ import annotations

from math import pi

import pytest

from robobt.world import DIVISION_B, BallState, Frame, RobotState
from robobt.world.team_view import team_view, team_view_of


def seen(me: RobotState, *others: RobotState) -> dict[str, float]:
    """The entries by name of a robot that has the ball before it; the others are opponents."""
    ball = BallState(me.x, me.y)
    entries = team_view(1, 2).entries
    row = team_view_of(Frame(0.0, DIVISION_B, ball, (me,), others), me, 1, 2)
    return {entry.name: value for entry, value in zip(entries, row, strict=True)}


def test_the_aim_is_where_a_kick_crosses_the_goal_line() -> None:
    assert seen(RobotState(1, 3.5, 0.2))["aim"] == pytest.approx(0.2)
    assert seen(RobotState(1, 4.0, 0.2, pi / 4))["aim"] == pytest.approx(0.7)


@pytest.mark.parametrize("heading", [pi / 2, pi - 0.3])
def test_a_kick_that_leads_away_from_the_goal_passes_it_by_far(heading: float) -> None:
    assert seen(RobotState(1, 3.5, 0.0, heading))["aim"] == 1.0
    assert seen(RobotState(1, 3.5, 0.0, -heading))["aim"] == -1.0


def test_the_lane_is_how_far_beside_the_shot_the_nearest_opponent_ahead_is() -> None:
    me = RobotState(1, 2.0, 0.0)
    assert seen(me)["lane"] == 0.5
    assert seen(me, RobotState(0, 4.0, 0.2), RobotState(1, 3.0, -0.3))["lane"] == pytest.approx(0.2)
    assert seen(me, RobotState(0, 4.0, 0.2), RobotState(1, 3.0, -0.1))["lane"] == pytest.approx(-0.1)
    # Who stands behind the ball is not in its way.
    assert seen(me, RobotState(0, 4.0, 0.2), RobotState(1, 1.0, 0.0))["lane"] == pytest.approx(0.2)


def test_a_robot_is_not_its_own_mate() -> None:
    assert seen(RobotState(1, 2.0, 0.0))["mate_0_x"] == -5.0
