"""A robot's motion between detections is predicted by the law that the simulator drives by."""

from __future__ import annotations

from math import hypot

import pytest

from robobt.league.estimate.robot_track import RobotMotion, Sent, predict_robot
from robobt.sim import SimSettings, SimWorld
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement
from robobt.world.state import RobotId

ME = RobotId(Team.BLUE, 0)
LIMITS = RobotLimits(
    max_speed=2.0, max_turn=4.0, side_acceleration=2.0, lag=0.03, side_lag=0.05, side_gain=0.8
)


@pytest.mark.parametrize("seconds", [0.1, 0.3, 0.5])
def test_it_is_predicted_as_the_simulator_drives_it(seconds: float) -> None:
    # More than it can do, so that each limit is met.
    command = RobotCommand(3.0, 2.0, 9.0)
    sim = SimWorld(DIVISION_B, {ME: LIMITS}, SimSettings(), 1 / 60)
    sim.reset(Placement({ME: (0.0, 0.0, 0.0)}, (4.0, 2.0, 0.0, 0.0)), 0)
    for _ in range(round(60 * seconds)):
        sim.act({ME: command})
    real = sim.truth().own[0]
    found = predict_robot(RobotMotion(0.0, 0.0, 0.0), 0.0, seconds, [Sent(0.0, command)], LIMITS)
    assert hypot(found.vx - real.vx, found.vy - real.vy) < 0.02
    assert found.omega == pytest.approx(real.omega)
    assert hypot(found.x - real.x, found.y - real.y) < 0.01
