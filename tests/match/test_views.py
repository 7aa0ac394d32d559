"""A team's view stays as it is whatever trees do to it."""

from __future__ import annotations

import pytest

from robobt.match.views import KeptView
from robobt.motion.arrival import movers_of
from robobt.world import RobotState
from tests.skills.fixed_world import frame, robot


def test_what_was_worked_out_of_a_spoilt_view_is_forgotten() -> None:
    view = frame(robot(), opponents=(robot(1.0, 0.0),))
    kept = KeptView(view)
    view.opponents[0].x = 2.0
    assert movers_of(view)[1, 0] == 2.0
    assert kept.mend()
    assert movers_of(view)[1, 0] == 1.0


@pytest.mark.parametrize("attribute", RobotState.__dataclass_fields__)
def test_whatever_of_a_robot_was_changed_is_put_back(attribute: str) -> None:
    view = frame(robot(), opponents=(robot(1.0, 0.0),))
    kept, before = KeptView(view), getattr(view.opponents[0], attribute)
    setattr(view.opponents[0], attribute, "spoilt")
    assert kept.mend()
    assert getattr(view.opponents[0], attribute) == before
