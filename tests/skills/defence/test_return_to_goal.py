from __future__ import annotations

import pytest

from robobt.skills.defence.return_to_goal import ReturnToGoal
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone, moved


def test_it_goes_home_and_faces_the_field() -> None:
    me = robot(-3.0, 1.0, heading=2.0)
    alone = Alone(ReturnToGoal())
    for _ in range(150):
        assert alone.tick(frame(me, (2.0, 2.0))) is Status.RUNNING
        me = moved(me, alone.command, 1 / 60)
    assert (me.x, me.y, me.heading) == pytest.approx((-4.35, 0.0, 0.0), abs=0.03)
