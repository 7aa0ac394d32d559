"""Kick the ball at the chosen target as RoboBulls does."""

from __future__ import annotations

from dataclasses import field
from math import radians

from robobt.motion.path_planner import TARGETS
from robobt.motion.pilot import ROBOBULLS_LIMITS
from robobt.skills.base import Skill, skill
from robobt.skills.robobulls.kick import ROBOBULLS_KICK_SPEED, RobobullsKick
from robobt.skills.store import Pass
from robobt.tree import Status
from robobt.world.limits import RobotLimits

_TOLERANCE = {"shot": radians(1.0), "pass": radians(5.0)}


@skill
class KickAsRobobulls(Skill):
    """Kick the ball at ``store.shot``, else at ``store.pass_``: get behind it, line up, creep forward, kick.

    Running until the ball has left, then succeeding. Fails without a target. A pass is noted in the
    team's store as its kick goes out.

    Args:
        kick_speed: speed of the kick [m/s]; a pass is as fast as a shot.
        limits: how to drive.
        goalkeeper: may enter the own defence area.
    """

    reads = ("shot", "pass_")
    writes = ("team",)

    kick_speed: float = ROBOBULLS_KICK_SPEED
    limits: RobotLimits = ROBOBULLS_LIMITS
    goalkeeper: bool = False
    _kick: RobobullsKick = field(init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._kick = RobobullsKick(kick_speed=self.kick_speed, goalkeeper=self.goalkeeper, limits=self.limits)

    def needs(self) -> list[tuple[str, ...]]:
        """Require a shot or a pass."""
        return [("shot", "pass_")]

    def on_start(self) -> None:
        """Forget the last kick."""
        self._kick.start()

    def on_running(self) -> Status:
        """Get on with the kick for one tick."""
        shot, pass_ = self.store.shot, self.store.pass_
        order = pass_ if shot is None else shot
        if order is None:
            return self.fail("no target")
        self.draw.line(TARGETS, self.ball.position, order.target)
        passing = order if isinstance(order, Pass) else None
        self._kick.tolerance = _TOLERANCE["shot" if passing is None else "pass"]
        status = self._kick.tick(self.store, order.target)
        if passing is not None and self.store.command.kick_speed > 0.0:
            team = self.store.team
            team.passer, team.receiver = self.me.id, passing.receiver
            team.pass_target, team.pass_time = passing.target, self.frame.time
        return self.succeed("kicked") if status is Status.SUCCESS else self.run(self._kick.stage.value)
