"""Plays for the dribbling challenge: carry the ball through gates."""

from __future__ import annotations

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.challenges.carry_along import CarryAlong
from robobt.tree import Behaviour


def _run(forwards: bool) -> Behaviour:
    carry = CarryAlong(forwards=forwards)
    return first_of(
        "gates",
        carry,
        when("get the ball", GoToBall(), PickUpBall()),
    )


@PLAYS.register("gate_run")
def gate_run() -> Behaviour:
    """Carry the ball through the gates of the dribbling challenge, ahead and back."""
    return _run(forwards=False)


@PLAYS.register("gate_run_forwards")
def gate_run_forwards() -> Behaviour:
    """Carry the ball along the way of ``gate_run``, but always drive ahead."""
    return _run(forwards=True)
