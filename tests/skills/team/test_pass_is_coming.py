from __future__ import annotations

import pytest

from robobt.skills.team.pass_is_coming import PassIsComing
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import Frame
from tests.skills.fixed_world import Alone

ME = robot(1.0, 1.0, number=0)
BALL = (0.0, 0.0, 3.0, 3.0)


def seen(now: Frame, receiver: int | None = 0, kicked_at: float = 0.0) -> Status:
    alone = Alone(PassIsComing())
    alone.store.team.receiver, alone.store.team.pass_time = receiver, kicked_at
    return alone.tick(now)


def test_a_ball_on_its_way_to_the_receiver_is_a_pass() -> None:
    assert seen(frame(ME, BALL, time=1.0)) is Status.SUCCESS


def test_it_is_one_from_the_kick_on_even_before_the_ball_has_left() -> None:
    passer = robot(0.0, 0.0, number=1)
    assert seen(frame(ME, held(passer), mates=(passer,), time=0.1)) is Status.SUCCESS


@pytest.mark.parametrize("receiver", [None, 1])
def test_a_pass_to_somebody_else_is_none(receiver: int | None) -> None:
    assert seen(frame(ME, BALL, time=1.0), receiver=receiver) is Status.FAILURE


@pytest.mark.parametrize(
    "ball",
    [(2.0, 2.0, 3.0, 3.0), (0.0, 0.0, 0.1, 0.1), (0.0, 0.0)],
    ids=["has gone by", "is too slow", "rests"],
)
def test_a_ball_that_comes_no_nearer_is_none(ball: tuple[float, ...]) -> None:
    assert seen(frame(ME, ball, time=1.0)) is Status.FAILURE


def test_it_is_over_once_somebody_has_the_ball() -> None:
    opponent = robot(0.5, 0.5, heading=-2.4)
    ball = (*held(opponent), 0.3, 0.3)
    assert seen(frame(ME, ball, opponents=(opponent,), time=1.0)) is Status.FAILURE


def test_an_old_pass_is_none() -> None:
    assert seen(frame(ME, BALL, time=5.0)) is Status.FAILURE
    assert seen(frame(ME, BALL, time=1.0), kicked_at=2.0) is Status.FAILURE
