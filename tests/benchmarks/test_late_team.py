"""A late team knows its own commands and none of its opponents'."""

from __future__ import annotations

from math import pi

import pytest

from benchmarks.late_team import _world
from robobt.match.scenario.scenario import load_scenario
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import BallState, RobotId

BLUE, YELLOW = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)


def shown(arm: str, kick_speed: float) -> list[BallState]:
    """What blue is shown of a ball that rolls to a yellow robot, until that has it."""
    world = _world(load_scenario("striker_vs_goalkeeper"), arm, 0.1)
    world.reset(Placement({BLUE: (-2.0, 0.0, 0.0), YELLOW: (1.0, 0.0, pi)}, (0.0, 2.0, 0.0, 0.0)), 1)
    for tick in range(300):
        world.observe()
        # So that its delay is known.
        turn = 3.0 if tick // 20 % 2 else -3.0
        world.act({BLUE: RobotCommand(turn / 6.0, 0.0, turn), YELLOW: RobotCommand()})
    world.put_ball(0.4, 0.0, 1.5, 0.0)
    balls = []
    while world.truth().ball.vx > 0.5:
        balls.append(world.observe().ball)
        world.act({BLUE: RobotCommand(), YELLOW: RobotCommand(kick_speed=kick_speed, dribbler=True)})
    return balls


@pytest.mark.parametrize("arm", ["known", "measured"])
def test_a_late_team_does_not_foresee_what_opponents_will_kick(arm: str) -> None:
    with_kick, without = shown(arm, 4.0), shown(arm, 0.0)
    both = min(len(with_kick), len(without))
    assert both > 10
    assert with_kick[:both] == without[:both]
