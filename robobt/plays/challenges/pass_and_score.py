"""A play for the cooperation challenge: robot 0 passes, robot 1 shoots the goal."""

from __future__ import annotations

from dataclasses import field

from robobt.plays.base import PLAYS, first_of, when
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.ball.intercept import Intercept
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.ball.pick_up_ball import PickUpBall
from robobt.skills.base import Condition, skill
from robobt.skills.conditions.ball_is_moving import BallIsMoving
from robobt.skills.conditions.has_ball import HasBall
from robobt.skills.stop import Stop
from robobt.tree import Behaviour, Inverter, Status
from robobt.world.geometry import Point, distance

_KICKED_AWAY = 0.3
"""A ball this far from the mate that touched it last has left it [m]."""


@skill
class IsNumber(Condition):
    """Succeeds for the robot with this number.

    Args:
        number: the robot's number.
    """

    number: int = 0

    def on_running(self) -> Status:
        """Compare the number."""
        return self.succeed() if self.me.id == self.number else self.fail(f"it is number {self.me.id}")


@skill
class MateHasKicked(Condition):
    """Succeeds from the moment that a mate has kicked the ball away."""

    _kicked: bool = field(default=False, init=False)

    def on_running(self) -> Status:
        """Look for a ball that has left the mate that touched it last."""
        last = self.frame.last_touch
        if last is not None and last.team is self.frame.team and last.number != self.me.id:
            mate = self.frame.robot(last.number)
            if mate is not None and distance(mate.position, self.ball.position) > _KICKED_AWAY:
                self._kicked = True
        return self.succeed() if self._kicked else self.fail("no mate has kicked yet")


@PLAYS.register("pass_and_score")
def pass_and_score(
    *, pass_to: Point = (0.9, -0.8), pass_speed: float = 3.0, shot_speed: float = 3.2
) -> Behaviour:
    """Robot 0 passes to a point in the attacked half, robot 1 meets the ball there and shoots at the goal.

    Robot 1 stays still until robot 0 has kicked. Source of the order and of the speed limits: the cooperation
    challenge of 2026.

    Args:
        pass_to: where the pass goes [m].
        pass_speed: speed of the pass [m/s].
        shot_speed: speed of the shot [m/s].
    """
    shoot = when("shoot", HasBall(), KickToTarget(target=(4.5, 0.0), kick_speed=shot_speed, take=True))
    return first_of(
        "together",
        when(
            "major",
            IsNumber(number=0),
            first_of(
                "pass",
                when("passed", MajorHasPassed(), Stop()),
                KickToTarget(target=pass_to, kick_speed=pass_speed),
            ),
        ),
        when("wait", Inverter("not yet", MateHasKicked()), Stop()),
        shoot,
        when("meet", BallIsMoving(), Intercept()),
        when("get the ball", GoToBall(), PickUpBall()),
    )


@skill
class MajorHasPassed(Condition):
    """Succeeds once this robot has kicked the ball away."""

    _passed: bool = field(default=False, init=False)

    def on_running(self) -> Status:
        """Look for a ball that has left this robot."""
        last = self.frame.last_touch
        if last is not None and last == (self.frame.team, self.me.id):
            self._passed |= distance(self.me.position, self.ball.position) > _KICKED_AWAY
        return self.succeed() if self._passed else self.fail("not yet")
