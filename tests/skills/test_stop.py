from __future__ import annotations

from robobt.skills import Stop
from robobt.testing import alone, blue, eventually, frame, robot, succeeds
from robobt.tree import Status
from robobt.world import RobotCommand
from tests.skills.fixed_world import Alone


def test_it_asks_for_no_velocity_until_the_robot_stands() -> None:
    alone = Alone(Stop())
    assert alone.tick(frame(robot(velocity=(1.0, 0.0, 0.0)))) is Status.RUNNING
    assert alone.command == RobotCommand()
    assert alone.tick(frame(robot(velocity=(0.0, 0.0, 1.0)))) is Status.RUNNING
    assert alone.tick(frame(robot())) is Status.SUCCESS


def test_the_dribbler_may_go_on_turning() -> None:
    alone = Alone(Stop(dribbler=True))
    alone.tick(frame(robot()))
    assert alone.command == RobotCommand(dribbler=True)


def test_a_driving_robot_comes_to_rest() -> None:
    stop = Stop()
    trial = alone(stop, (0.0, 2.0, 0.0))
    for _ in range(30):
        trial.world.act({blue(0): RobotCommand(vx=1.0, omega=2.0)})
    trial.run(0.5, eventually("it stands", succeeds(stop)))
    assert trial.frames[-1].own[0].speed < 0.01
