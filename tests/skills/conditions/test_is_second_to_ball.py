from __future__ import annotations

from robobt.skills.conditions.is_second_to_ball import IsSecondToBall
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import RobotState
from tests.skills.fixed_world import Alone

THEIRS = robot(0.0, 0.0, number=6, contact=True)
OURS = tuple(robot(-distance, 0.3, number=number) for number, distance in enumerate((0.5, 1.0, 2.5), 1))


def tells(me: RobotState, theirs: RobotState = THEIRS) -> Status:
    """Return what the condition says once possession has been seen for a while."""
    alone = Alone(IsSecondToBall())
    alone.store.team.plan.players.update(one.id for one in OURS)
    mates = tuple(one for one in OURS if one.id != me.id)
    status = Status.INVALID
    for step in range(40):
        view = frame(me, held(theirs), mates, (theirs,), 0.1 * step)
        status = alone.tick(view, me.id)
    return status


def test_only_the_robot_next_after_the_attacker_is_second() -> None:
    assert [tells(one) for one in OURS] == [Status.FAILURE, Status.SUCCESS, Status.FAILURE]


def test_nobody_is_second_while_the_own_team_has_the_ball() -> None:
    me, mine = OURS[1], OURS[0]
    alone = Alone(IsSecondToBall())
    alone.store.team.plan.players.update(one.id for one in OURS)
    for step in range(40):
        view = frame(me, held(mine), (mine, OURS[2]), (robot(3.0, 0.0, number=6),), 0.1 * step)
        status = alone.tick(view, me.id)
    assert status is Status.FAILURE
