from __future__ import annotations

from robobt.skills import BallInOwnHalf
from robobt.testing import Trial, blue, eventually, frame, robot, succeeds, yellow
from robobt.tree import Status
from tests.skills.fixed_world import Alone


def test_the_own_half_ends_at_the_half_way_line() -> None:
    assert Alone(BallInOwnHalf()).tick(frame(robot(), ball=(-0.01, 2.0))) is Status.SUCCESS
    assert Alone(BallInOwnHalf()).tick(frame(robot(), ball=(0.01, 2.0))) is Status.FAILURE


def test_the_line_can_be_moved() -> None:
    assert Alone(BallInOwnHalf(x=1.0)).tick(frame(robot(), ball=(0.9, 0.0))) is Status.SUCCESS


def test_both_teams_see_their_own_half() -> None:
    ours, theirs = BallInOwnHalf(), BallInOwnHalf()
    trial = Trial(
        {blue(0): ours, yellow(0): theirs},
        {blue(0): (0.0, 2.0, 0.0), yellow(0): (0.0, -2.0, 0.0)},
        (-0.5, 0.0, 1.5, 0.0),
    )
    trial.tick()
    assert (ours.status, theirs.status) == (Status.SUCCESS, Status.FAILURE)
    trial.run(2.0, eventually("it has crossed over", succeeds(theirs)))
    assert ours.status is Status.FAILURE
