from __future__ import annotations

from math import pi

from robobt.skills import DribbleTo, OpponentHasBall
from robobt.testing import Trial, always, blue, frame, held, robot, succeeds, yellow
from robobt.tree import Status
from tests.skills.fixed_world import Alone


def test_it_holds_for_opponents_only() -> None:
    me, opponent = robot(), robot(1.0, 0.0, pi, number=7)
    ticks = [
        Alone(OpponentHasBall()).tick(frame(me, ball, opponents=(opponent,)))
        for ball in (held(opponent), held(me), (0.0, 2.0))
    ]
    assert ticks == [Status.SUCCESS, Status.FAILURE, Status.FAILURE]


def test_it_holds_while_an_opponent_carries_the_ball() -> None:
    watcher = OpponentHasBall()
    trial = Trial(
        {blue(0): watcher, yellow(1): DribbleTo(target=(1.5, 0.0))},
        {blue(0): (0.0, 2.0, 0.0), yellow(1): (0.0, 0.0, pi)},
        (-0.0975, 0.0),
    )
    trial.run(1.0, always("they have the ball", succeeds(watcher)))
