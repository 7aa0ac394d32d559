"""Letting go of the ball before it has been carried too far."""

from __future__ import annotations

from math import hypot, pi

import pytest

from robobt.plays.base import first_of, when
from robobt.skills import CarriedFar, LetGo, Stop
from robobt.skills.base import Skill
from robobt.testing import Trial, always, blue, eventually, frame, held, robot
from robobt.testing.frames import HELD
from robobt.tree import Behaviour, Status
from robobt.world import Frame
from robobt.world.limits import RobotLimits
from robobt.world.rules import CARRY_DISTANCE, keeps_ball
from tests.skills.fixed_world import Alone


class Sideways(Skill):
    """Carry the ball to the left."""

    def on_running(self) -> Status:
        command = self.store.command
        command.vy, command.dribbler = 2.0, True
        return self.run()


class Backwards(Skill):
    """Pull the ball."""

    def on_running(self) -> Status:
        command = self.store.command
        command.vx, command.dribbler = -0.8, True
        return self.run()


def carried(let_go: Behaviour) -> float:
    """How far the robot takes a ball sideways before it has let go of it [m]."""
    ways = [0.0]

    def followed(seen: Frame) -> bool:
        if seen.time > 0.0 and (len(ways) < 2 or ways[-1] > 0.0):
            kept = keeps_ball(seen.own[0], seen.ball)
            ways.append(hypot(seen.ball.x - HELD, seen.ball.y) if kept else 0.0)
        return True

    tree = first_of("carry", when("far", CarriedFar(limit=0.9), let_go), Sideways())
    Trial({blue(1): tree}, {blue(1): (0.0, 0.0, 0.0)}, ball=(HELD, 0.0)).run(1.5, always("seen", followed))
    assert ways[-1] == 0.0
    return max(ways)


def test_a_ball_that_is_carried_sideways_is_let_go_of_in_time() -> None:
    assert carried(LetGo()) < 0.85 < CARRY_DISTANCE < carried(Stop())


@pytest.mark.parametrize(("speed", "kick"), [(0.0, 1.0), (1.5, 2.5), (-1.5, 1.0)])
def test_the_ball_leaves_a_robot_that_drives_at_it(speed: float, kick: float) -> None:
    alone, me = Alone(LetGo()), robot(velocity=(speed, 0.7, 0.0), contact=True)
    assert alone.tick(frame(me, (*held(me), speed, 0.7))) is Status.RUNNING
    assert alone.command.kick_speed == pytest.approx(kick)
    assert (alone.command.vx, alone.command.vy, alone.command.dribbler) == (0.0, 0.0, False)


def test_it_does_not_kick_again_a_ball_that_has_left() -> None:
    alone, me = Alone(LetGo()), robot()
    alone.tick(frame(me, (me.x + 0.2, 0.0, 2.0, 0.0)))
    assert alone.command.kick_speed == 0.0


@pytest.mark.parametrize("limits", [RobotLimits(), RobotLimits(hold_acceleration=0.35, hold_straight=1.0)])
def test_it_backs_away_from_a_ball_that_it_must_not_kick(limits: RobotLimits) -> None:
    alone, me = Alone(LetGo()), robot(-1.0, heading=pi, contact=True, limits=limits)
    alone.tick(frame(me, held(me)))
    assert (alone.command.vx, alone.command.kick_speed) == (-1.0, 0.0)


def test_a_ball_that_is_pulled_out_of_the_own_half_is_let_go_of() -> None:
    tree = first_of("pull", when("far", CarriedFar(limit=0.8), LetGo()), Backwards())
    trial = Trial({blue(1): tree}, {blue(1): (-3.5, 0.0, pi)}, ball=(-3.5 - HELD, 0.0))
    trial.run(2.0, eventually("gone", lambda seen: not keeps_ball(seen.own[0], seen.ball)))


@pytest.mark.parametrize(("x", "kicks"), [(-1.0, False), (1.0, True)])
def test_it_does_not_kick_towards_the_own_goal_near_it(x: float, kicks: bool) -> None:
    alone, me = Alone(LetGo()), robot(x, heading=0.6 * pi, contact=True)
    alone.tick(frame(me, held(me)))
    assert (alone.command.kick_speed > 0.0) is kicks
