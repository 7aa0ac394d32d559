from __future__ import annotations

from collections.abc import Sequence

import pytest

from robobt.skills import AssignRoles, HasRole
from robobt.skills.store import TeamStore
from robobt.skills.team.roles import ROLES
from robobt.tree import Status
from robobt.world import GameState, RefereeCommand, RobotState, Team
from tests.skills.fixed_world import Alone, frame, held, robot
from tests.skills.refereed import OPEN, free_kick


class Sharing:
    """Robots of one team that share roles."""

    def __init__(
        self, numbers: Sequence[int] = (1, 2, 3), roles: tuple[str, ...] = (), margin: float = 0.5
    ) -> None:
        self.team = TeamStore()
        self.trees = {}
        for number in numbers:
            leaf = AssignRoles(roles=roles or ("attacker", "defender", "supporter"), margin=margin)
            self.trees[number] = Alone(leaf)
            self.trees[number].store.team = self.team

    def roles(
        self,
        robots: Sequence[RobotState],
        ball: tuple[float, ...] = (0.0, 0.0),
        game: GameState = OPEN,
    ) -> dict[int, str]:
        """Who plays what, asked twice so that all have entered themselves."""
        found = {}
        for _ in range(2):
            view = frame(robots[0], ball, tuple(robots[1:]), game=game)
            statuses = {one.id: self.trees[one.id].tick(view, one.id) for one in robots}
            found = {
                number: self.trees[number].tree.feedback_message
                for number, status in statuses.items()
                if status is Status.SUCCESS
            }
        assert found == self.team.roles
        return found


THREE = (robot(-0.5, 0.0, number=1), robot(-2.5, 0.0, number=2), robot(-0.5, 1.5, number=3))


def test_each_robot_plays_what_lies_nearest() -> None:
    assert Sharing().roles(THREE) == {1: "attacker", 2: "defender", 3: "supporter"}


def test_all_ways_together_are_shortest_not_each() -> None:
    # Robot 1 is nearest to both places.
    robots = (robot(-1.0, 0.0, number=1), robot(1.1, 0.0, number=2))
    assert Sharing((1, 2), ("attacker", "defender")).roles(robots) == {1: "defender", 2: "attacker"}


def test_with_fewer_robots_than_roles_the_last_roles_stay_open() -> None:
    assert Sharing().roles(THREE[1:2]) == {2: "attacker"}
    assert set(Sharing().roles(THREE[1:]).values()) == {"attacker", "defender"}


def test_with_fewer_roles_than_robots_some_have_none() -> None:
    sharing = Sharing(roles=("attacker",))
    assert sharing.roles(THREE) == {1: "attacker"}
    assert sharing.trees[2].tree.feedback_message == "no role left"


def swapped(gain: float) -> tuple[RobotState, RobotState]:
    """Two robots for which changing roles shortens their ways by ``gain``, attacker first."""
    return robot(-1.0 - gain / 2, 0.0, number=1), robot(-1.0, 0.0, number=2)


@pytest.mark.parametrize(("gain", "changes"), [(0.3, False), (0.8, True)])
def test_roles_change_only_for_a_clear_gain(gain: float, changes: bool) -> None:
    sharing = Sharing((1, 2), ("attacker",), margin=0.25)
    assert sharing.roles((robot(-0.5, 0.0, number=1), robot(-1.0, 0.0, number=2))) == {1: "attacker"}
    assert sharing.roles(swapped(gain)) == {2 if changes else 1: "attacker"}


def test_two_robots_alike_do_not_take_turns() -> None:
    sharing = Sharing((1, 2), ("attacker", "defender"))
    first = sharing.roles((robot(-1.0, 0.5, number=1), robot(-1.0, -0.5, number=2)))
    for step in range(20):
        shift = 0.05 if step % 2 else -0.05
        robots = (robot(-1.0 + shift, 0.5, number=1), robot(-1.0 - shift, -0.5, number=2))
        assert sharing.roles(robots) == first


def test_a_robot_that_has_left_the_field_leaves_its_role_to_another() -> None:
    sharing = Sharing()
    assert sharing.roles(THREE)[1] == "attacker"
    assert sharing.roles(THREE[1:]) == {2: "defender", 3: "attacker"}


def test_the_robot_with_the_ball_attacks() -> None:
    holder = robot(0.0, 0.0, 2.0, number=1, contact=True)
    ball = held(holder)
    rival = robot(ball[0] - 0.08, ball[1], 3.0, number=2)
    sharing = Sharing((1, 2), ("attacker",), margin=0.0)
    assert sharing.roles((holder, rival), ball) == {1: "attacker"}


def test_a_robot_that_joins_shares_the_roles_of_the_same_frame() -> None:
    sharing = Sharing((1, 2))
    view = frame(THREE[1], mates=(THREE[0],))
    sharing.trees[2].tick(view, 2)
    assert sharing.team.roles == {2: "attacker"}
    sharing.trees[1].tick(view, 1)
    assert sharing.team.roles == {1: "attacker", 2: "defender"}


def test_a_kicker_that_may_not_touch_the_ball_again_does_not_attack() -> None:
    sharing = Sharing((1, 2), ("attacker", "defender"))
    kicker = robot(-0.12, 0.0, number=1, contact=True)
    robots = (kicker, robot(-1.0, 0.0, number=2))
    ball = (0.0, 0.0)
    assert sharing.roles(robots, ball, free_kick(Team.BLUE, ball))[1] == "attacker"
    assert sharing.roles(robots, ball, GameState(RefereeCommand.NORMAL_START))[2] == "attacker"


def test_a_robot_that_does_not_ask_gets_no_role() -> None:
    sharing = Sharing((1,), ("attacker", "defender"))
    view = frame(THREE[0], mates=THREE[1:])
    sharing.trees[1].tick(view, 1)
    assert sharing.team.roles == {1: "attacker"}


def test_has_role_asks_for_the_own_role() -> None:
    sharing = Sharing()
    sharing.roles(THREE)
    view = frame(THREE[0], mates=THREE[1:])
    for role in ("attacker", "defender", "supporter"):
        asking = Alone(HasRole(role=role))
        asking.store.team = sharing.team
        assert (asking.tick(view, 2) is Status.SUCCESS) is (role == "defender")


def test_without_roles_nobody_has_one() -> None:
    asking = Alone(HasRole(role="attacker"))
    assert asking.tick(frame(robot(number=1)), 1) is Status.FAILURE
    assert asking.tree.feedback_message == "no role"


def test_unknown_and_repeated_roles_are_errors() -> None:
    with pytest.raises(
        ValueError, match="no role is called 'libero'; there are attacker, defender, supporter"
    ):
        AssignRoles(roles=("attacker", "libero"))
    with pytest.raises(ValueError, match="a role is named twice: attacker, attacker"):
        AssignRoles(roles=("attacker", "attacker"))
    assert list(ROLES) == ["attacker", "defender", "supporter"]
