from __future__ import annotations

from robobt.skills.base import Skill
from robobt.skills.defence.avoid_crash import AvoidCrash
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import RobotCommand
from tests.skills.fixed_world import Alone
from tests.skills.refereed import OPEN, STOP


class Ahead(Skill):
    def on_running(self) -> Status:
        self.store.command = RobotCommand(3.0, 0.0, dribbler=True)
        return self.run("ahead")


def test_it_has_its_childs_status_and_brakes_before_an_opponent() -> None:
    alone = Alone(AvoidCrash("no crash", Ahead()))
    assert alone.tick(frame(robot(), (2.0, 2.0), opponents=(robot(0.2, 0.0),), game=OPEN)) is Status.RUNNING
    assert alone.command.vx < 1.5
    assert alone.command.dribbler


def test_nothing_is_changed_where_nobody_is_in_the_way() -> None:
    alone = Alone(AvoidCrash("no crash", Ahead()))
    alone.tick(frame(robot(), (2.0, 2.0), opponents=(robot(0.5, 1.0), robot(-0.3, 0.0)), game=OPEN))
    assert alone.command.vx == 3.0


def test_while_the_ball_is_dead_skills_give_way_themselves() -> None:
    alone = Alone(AvoidCrash("no crash", Ahead()))
    alone.tick(frame(robot(), (2.0, 2.0), opponents=(robot(0.2, 0.0),), game=STOP))
    assert alone.command.vx == 3.0
