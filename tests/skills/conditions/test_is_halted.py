from __future__ import annotations

import pytest

from robobt.skills.conditions.is_halted import IsHalted
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import GameState, RefereeCommand
from tests.skills.fixed_world import Alone

HALTED = {RefereeCommand.HALT, RefereeCommand.TIMEOUT_BLUE, RefereeCommand.TIMEOUT_YELLOW}


@pytest.mark.parametrize("command", list(RefereeCommand), ids=[command.name for command in RefereeCommand])
def test_halt_and_time_outs_halt_the_robots_and_nothing_else(command: RefereeCommand) -> None:
    status = Alone(IsHalted()).tick(frame(robot(), game=GameState(command)))
    assert status is (Status.SUCCESS if command in HALTED else Status.FAILURE)
