from __future__ import annotations

from robobt.skills.base import Skill
from robobt.skills.defence.stay_out import StayOut
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import RobotCommand
from tests.skills.fixed_world import Alone
from tests.skills.refereed import OPEN


class Back(Skill):
    def on_running(self) -> Status:
        self.store.command = RobotCommand(-2.0, 0.0)
        return self.run("back")


def test_it_has_its_childs_status_and_keeps_it_out() -> None:
    alone = Alone(StayOut("stay out", Back()))
    assert alone.tick(frame(robot(-3.38, 0.0), (-3.2, 0.0), game=OPEN)) is Status.RUNNING
    assert alone.command.vx > -0.5


def test_far_from_the_areas_it_changes_nothing() -> None:
    alone = Alone(StayOut("stay out", Back()))
    alone.tick(frame(robot(0.0, 0.0), (0.2, 0.0), game=OPEN))
    assert alone.command.vx == -2.0
