from __future__ import annotations

import pytest

from robobt.skills.conditions.under_pressure import UnderPressure
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone


@pytest.mark.parametrize(("gap", "pressed"), [(0.29, True), (0.31, False)])
def test_pressure_is_an_opponent_near_the_ball(gap: float, pressed: bool) -> None:
    view = frame(robot(), (1.0, 0.0), opponents=(robot(1.0, gap, number=1),))
    assert Alone(UnderPressure(distance=0.3)).tick(view) is (Status.SUCCESS if pressed else Status.FAILURE)


def test_a_team_mate_is_no_pressure() -> None:
    view = frame(robot(), (1.0, 0.0), mates=(robot(1.0, 0.2, number=1),))
    assert Alone(UnderPressure()).tick(view) is Status.FAILURE
