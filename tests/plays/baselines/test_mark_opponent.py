from __future__ import annotations

from robobt.plays.baselines.mark_opponent import MarkOpponent
from robobt.skills.store import TeamStore
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import RobotState
from robobt.world.geometry import distance, segment_distance
from tests.skills.fixed_world import Alone
from tests.skills.refereed import OPEN, Drive


def test_it_stands_beside_the_opponent_towards_the_ball() -> None:
    opponent = robot(-2.0, 1.0, number=4)
    end = Drive(MarkOpponent(), robot(-3.0, 0.0, number=1), OPEN, (0.0, 0.0), opponents=(opponent,)).end
    assert abs(distance(end.position, opponent.position) - 0.25) < 0.03
    assert segment_distance(end.position, opponent.position, (0.0, 0.0)) < 0.03


def test_it_looks_only_roughly_at_the_ball() -> None:
    opponent = robot(-2.0, 0.0, number=4)
    for ball, turns in (((0.0, 0.3), False), ((0.0, -0.3), False), ((-1.0, 1.5), True)):
        alone = Alone(MarkOpponent())
        alone.tick(frame(robot(-1.75, 0.0, number=1), ball, opponents=(opponent,), game=OPEN), 1)
        assert (alone.command.omega != 0.0) == turns


def test_opponents_far_from_the_own_half_are_left_alone() -> None:
    far = robot(3.0, 1.0, number=4)
    drive = Drive(MarkOpponent(), robot(0, 0), OPEN, (0.0, 0.0), opponents=(far,), seconds=0.1)
    assert drive.status is Status.FAILURE


def test_the_holder_of_the_ball_is_not_marked() -> None:
    holder = robot(-2.0, 0.0, number=4, contact=True)
    drive = Drive(MarkOpponent(), robot(0, 0), OPEN, held(holder), opponents=(holder,), seconds=0.1)
    assert drive.status is Status.FAILURE


class Markers:
    """Robots 1 and 2 of one team, both marking."""

    def __init__(self) -> None:
        team = TeamStore()
        self.alone = {number: Alone(MarkOpponent()) for number in (1, 2)}
        for alone in self.alone.values():
            alone.store.team = team

    def marks(self, own: tuple[RobotState, ...], opponents: tuple[RobotState, ...]) -> dict[int, int]:
        for _ in range(2):
            view = frame(own[0], (2.0, 0.0), own[1:], opponents, game=OPEN)
            for number in (1, 2):
                self.alone[number].tick(view, number)
        return self.alone[1].store.team.marks


OWN = (robot(-2.0, 1.0, number=1), robot(-2.0, -1.0, number=2))


def test_two_robots_mark_two_opponents_each_the_nearer_one() -> None:
    opponents = (robot(-3.0, -1.0, number=7), robot(-1.0, 1.5, number=8))
    assert Markers().marks(OWN, opponents) == {1: 8, 2: 7}


def test_the_most_dangerous_opponents_are_marked_first() -> None:
    opponents = (robot(0.2, 1.0, number=7), robot(-3.0, 1.2, number=8), robot(-3.0, -1.2, number=9))
    assert Markers().marks(OWN, opponents) == {1: 8, 2: 9}


def test_marks_are_kept_while_two_opponents_cross() -> None:
    markers = Markers()
    near = (robot(-2.5, 0.2, number=7), robot(-2.5, -0.2, number=8))
    crossed = (robot(-2.5, -0.05, number=7), robot(-2.5, 0.05, number=8))
    assert markers.marks(OWN, near) == {1: 7, 2: 8}
    assert markers.marks(OWN, crossed) == {1: 7, 2: 8}
