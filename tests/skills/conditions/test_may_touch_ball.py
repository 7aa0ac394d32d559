from __future__ import annotations

import pytest

from robobt.plays.baselines.is_attacker import IsAttacker
from robobt.skills.conditions.may_touch_ball import MayTouchBall
from robobt.testing import frame, robot
from robobt.tree import Sequence, Status
from robobt.world import GameState, Restart, RobotId, Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import HALT, OPEN, STOP, free_kick, kickoff, stop_before

SPOT = (1.0, 1.0)


@pytest.mark.parametrize(
    ("game", "allowed"),
    [
        (OPEN, True),
        (free_kick(Team.BLUE, SPOT), True),
        (kickoff(Team.BLUE, True), True),
        (free_kick(Team.YELLOW, SPOT), False),
        (kickoff(Team.BLUE, False), False),
        (kickoff(Team.YELLOW, True), False),
        (stop_before(Restart.FREE_KICK, Team.BLUE, SPOT), False),
        (STOP, False),
        (HALT, False),
    ],
)
def test_the_ball_may_be_touched_when_the_rules_allow_it(game: GameState, allowed: bool) -> None:
    status = Alone(MayTouchBall()).tick(frame(robot(), game=game))
    assert status is (Status.SUCCESS if allowed else Status.FAILURE)


class TestAfterTheKick:
    """Robot 1 has taken a free kick of ours."""

    def setup_method(self) -> None:
        children = [IsAttacker(), MayTouchBall()]
        self.tree = Alone(Sequence("kicker", memory=False, children=children))
        self.touch = Alone(MayTouchBall())
        self.touch.store.team = self.tree.store.team
        self.me = robot(0.8, 1.0, number=1)
        self.mate = robot(-2.0, 0.0, number=2)
        self.tree.tick(frame(self.me, SPOT, (self.mate,), game=free_kick(Team.BLUE, SPOT)), 1)

    def may_touch(self, last_touch: RobotId | None, number: int = 1) -> bool:
        view = frame(self.me, (1.5, 1.0), (self.mate,), game=OPEN, last_touch=last_touch)
        return self.touch.tick(view, number) is Status.SUCCESS

    def test_the_kicker_may_not_touch_again_but_its_mates_may(self) -> None:
        assert not self.may_touch(RobotId(Team.BLUE, 1))
        assert self.may_touch(RobotId(Team.BLUE, 1), number=2)

    @pytest.mark.parametrize("other", [RobotId(Team.BLUE, 2), RobotId(Team.YELLOW, 1)], ids=str)
    def test_the_kicker_may_touch_once_another_robot_has(self, other: RobotId) -> None:
        assert not self.may_touch(RobotId(Team.BLUE, 1))
        assert self.may_touch(other)
        assert self.may_touch(RobotId(Team.BLUE, 1))

    def test_where_nobody_says_who_touched_the_taker_counts_as_the_kicker(self) -> None:
        assert not self.may_touch(None)

    def test_a_new_stop_ends_the_ban(self) -> None:
        assert not self.may_touch(RobotId(Team.BLUE, 1))
        self.touch.tick(frame(self.me, SPOT, (self.mate,), game=STOP), 1)
        assert self.may_touch(RobotId(Team.BLUE, 1))

    def test_the_kicker_is_not_the_attacker_until_then(self) -> None:
        view = frame(self.me, (1.2, 1.0), (self.mate,), game=OPEN, last_touch=RobotId(Team.BLUE, 1))
        attacks = Alone(IsAttacker())
        attacks.store.team = self.tree.store.team
        assert attacks.tick(view, 1) is Status.FAILURE
