from __future__ import annotations

import pytest

from robobt.plays.challenges.pass_player import pass_player
from robobt.skills import GoToKickoffPosition, ShowForPass
from robobt.testing import frame, robot
from robobt.tree import Behaviour
from robobt.world.game import Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import kickoff


@pytest.mark.parametrize(("may_touch", "does"), [(False, GoToKickoffPosition), (True, ShowForPass)])
def test_robots_lined_up_too_near_for_a_pass_leave_at_the_whistle(
    may_touch: bool, does: type[Behaviour]
) -> None:
    player = Alone(pass_player())
    player.store.team.plan.players.update((1, 2, 3))
    taker, near, nearer = robot(-0.25, 0.0, number=1), robot(-0.8, 0.1, number=2), robot(-0.8, -0.1, number=3)
    player.tick(frame(near, (0.0, 0.0), (taker, nearer), game=kickoff(Team.BLUE, may_touch)), 2)
    assert isinstance(player.tree.tip(), does)
