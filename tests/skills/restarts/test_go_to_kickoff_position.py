from __future__ import annotations

from math import hypot

import pytest

from robobt.skills.restarts.go_to_kickoff_position import GoToKickoffPosition
from robobt.skills.store import TeamStore
from robobt.testing import frame, robot
from robobt.world import Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import Drive, kickoff


@pytest.mark.parametrize("start", [(2.0, 1.0), (-0.2, 0.1), (-4.0, -2.0)], ids=str)
@pytest.mark.parametrize("team", list(Team), ids=["ours", "theirs"])
def test_robots_wait_in_their_half_outside_the_circle(start: tuple[float, float], team: Team) -> None:
    game = kickoff(team, may_touch=False)
    end = Drive(GoToKickoffPosition(), robot(*start, number=1), game, (0.0, 0.0)).end
    assert end.x < -0.09
    assert hypot(end.x, end.y) > 0.5 + 0.09
    assert end.speed < 0.01


def test_robots_spread_over_the_width_in_order_of_their_numbers() -> None:
    team = TeamStore(attackers={1, 2, 3})
    ends = [
        Drive(
            GoToKickoffPosition(),
            robot(-2.0, 0.0, number=number),
            kickoff(Team.YELLOW, may_touch=False),
            (0.0, 0.0),
            team=team,
        ).end.y
        for number in (1, 2, 3)
    ]
    assert ends[0] - 1.0 > ends[1] > ends[2] + 1.0


def test_the_kicker_leaves_no_gap_in_the_line() -> None:
    kicker, waiting = robot(-0.3, 0.0, number=1), robot(-2.0, 0.0, number=2)
    team = TeamStore(attackers={1, 2}, attacker=1)
    game = kickoff(Team.BLUE, may_touch=False)
    drive = Drive(GoToKickoffPosition(), waiting, game, (0.0, 0.0), mates=(kicker,), team=team)
    assert abs(drive.end.y) < 0.01


@pytest.mark.parametrize("gently", [False, True])
def test_driving_gently_it_looks_only_roughly_at_the_ball(gently: bool) -> None:
    alone = Alone(GoToKickoffPosition(spare_mates=gently))
    alone.tick(frame(robot(-2.0, 0.0, heading=0.2, number=1), game=kickoff(Team.BLUE, may_touch=False)), 1)
    assert (abs(alone.command.omega) > 0.1) is not gently
