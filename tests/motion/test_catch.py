from __future__ import annotations

from math import hypot, pi

import pytest

from robobt.motion.catch import catch
from robobt.skills.base import Skill
from robobt.testing import Trial, blue, robot
from robobt.tree import Status
from robobt.world import BallState
from robobt.world.rules import CARRY_DISTANCE, has_ball
from tests.skills.fixed_world import moved


class Catch(Skill):
    """Catches the ball; once it has it, it keeps its speed."""

    def on_running(self) -> Status:
        me = self.me
        if not me.ball_contact:
            self.store.command = catch(me, self.ball, me.limits, self.frame.period)
        else:
            self.store.command.vx = -me.speed
            self.store.command.dribbler = True
        return Status.RUNNING


@pytest.mark.parametrize("speed", [1.5, 2.2, 3.0])
@pytest.mark.parametrize("aside", [-0.15, 0.0, 0.1])
def test_a_rolling_ball_is_held_at_its_first_contact(speed: float, aside: float) -> None:
    trial = Trial({blue(1): Catch()}, {blue(1): (2.0, aside, pi)}, (0.0, 0.0, speed, 0.0))
    contacts = []
    while len(contacts) < 12 and trial.world.time < 3.0:
        frame = trial.tick()
        me = frame.robot(1)
        assert me is not None
        if contacts or me.ball_contact:
            contacts.append(has_ball(me, frame.ball))
    assert len(contacts) == 12
    assert all(contacts)


def test_it_gives_way_only_as_the_ball_comes_near() -> None:
    me = robot(2.0, 0.0, pi)
    for x, gives_way in ((0.0, False), (1.75, True)):
        trial = Trial({blue(1): Catch()}, {blue(1): (me.x, me.y, pi)}, (x, 0.0, 2.5, 0.0))
        trial.tick()
        command = trial.stores[blue(1)].command
        # Backwards in its own frame: away from the ball, which it faces.
        assert (command.vx < -0.04) is gives_way


def test_it_gives_way_no_faster_than_it_can_stop_with_the_ball_within_the_rules() -> None:
    me, fastest = robot(1.0, 0.0, pi), 0.0
    for tick in range(60):
        ball = BallState(tick * 6.0 / 60, 0.0, 6.0, 0.0)
        me = moved(me, catch(me, ball, me.limits, 1 / 60), 1 / 60)
        fastest = max(fastest, hypot(me.vx, me.vy))
    assert fastest > 1.0
    assert fastest**2 / (2.0 * me.limits.hold_acceleration) < CARRY_DISTANCE
