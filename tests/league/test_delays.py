"""What is late where, the vision's age, the commands' delay and the robots' dead time, is told apart."""

from __future__ import annotations

from math import cos, hypot, sin

import numpy as np
import pytest

from robobt.league.serve.served_field import ServedField, line_up
from robobt.league.serve.server import SimServer
from robobt.sim.settings import SimSettings
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement
from robobt.world.state import RobotId
from tests.league.lockstep import LockstepWorld
from tests.league.served import free_endpoints, poses

pytestmark = pytest.mark.integration

ME = RobotId(Team.BLUE, 0)
PERIOD = 1 / 60


@pytest.mark.parametrize(
    ("vision", "told", "command", "reaction", "dead"),
    [
        (0.0, 0.0, 0.0, 0.0, 0.0),
        (0.05, 0.01, 0.0, 0.0, 0.0),
        (0.0, 0.0, 0.03, 0.0, 0.0),
        (0.0, 0.0, 0.0, 0.02, 0.0),
        (2 * PERIOD, 0.005, 0.03, 0.02, 0.04),
    ],
)
def test_a_robot_is_where_it_was_predicted_to_be_when_the_command_moves_it(
    vision: float, told: float, command: float, reaction: float, dead: float
) -> None:
    realism = {"vision_delay": vision, "processing_time": told, "command_delay": command}
    settings = SimSettings.model_validate(
        {"realism": realism, "limits": RobotLimits(reaction=reaction, dead_time=dead)}
    )
    endpoints = free_endpoints()
    field = ServedField(DIVISION_B, line_up(DIVISION_B, 1), settings)
    predicted, true = [], []
    with (
        SimServer(field, endpoints) as server,
        LockstepWorld(
            server,
            robots={ME: None},
            settings=settings,
            endpoints=endpoints,
            latency=vision - told,
            simulator="protocol",
        ) as world,
    ):
        world.reset(Placement({ME: (-1.0, 0.0, 0.0)}, (3.0, 2.0, 0.0, 0.0)), 0)
        for tick in range(150):
            true.append((field.time, *poses(field)[ME]))
            me = world.observe().own[0]
            predicted.append((field.time + command + dead, me.x, me.y, me.heading))
            turn = 0.05 * tick
            world.act({ME: RobotCommand(1.5 * cos(turn), 1.5 * sin(turn), 3.0 * (-1) ** (tick // 20))})
    times, *columns = np.array(true).T
    columns[2] = np.unwrap(columns[2])
    far, turned = [], []
    for time, x, y, heading in predicted[40:-12]:
        there = [float(np.interp(time, times, column)) for column in columns]
        far.append(hypot(x - there[0], y - there[1]))
        turned.append(abs(wrap_angle(heading - there[2])))
    # 20 ms of what it drives and turns would be 30 mm and 60 mrad.
    assert max(far) < 0.004
    assert max(turned) < 0.02
    assert np.mean(far) < 0.001
    assert np.mean(turned) < 0.005
