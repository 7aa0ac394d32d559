from __future__ import annotations

from robobt.skills import SmallTeam
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone

ME, *MATES = (robot(float(number), number=number) for number in range(4))


def test_a_team_is_small_up_to_its_limit() -> None:
    for mates, expected in ((0, Status.SUCCESS), (2, Status.SUCCESS), (3, Status.FAILURE)):
        assert Alone(SmallTeam()).tick(frame(ME, mates=tuple(MATES[:mates]))) is expected
    assert Alone(SmallTeam(most=2)).tick(frame(ME, mates=tuple(MATES[:2]))) is Status.FAILURE
