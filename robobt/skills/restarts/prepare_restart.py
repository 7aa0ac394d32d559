"""Wait behind the ball until the restart may be taken."""

from __future__ import annotations

from math import hypot

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.game import Restart
from robobt.world.geometry import Point
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS

_STOP_GAP = STOP_DISTANCE + ROBOT_RADIUS + 0.08

IN_OWN_HALF = ROBOT_RADIUS + 0.03
"""A robot whose centre is this far from the half-way line is in its half as a whole [m]."""


@skill
class PrepareRestart(Skill):
    """Stand behind the ball of the own restart, facing the kick's target.

    The target is that of ``shot``, else of ``pass_``, else the opponent's goal. During a stop the robot keeps
    the distance that the rules ask for. SUCCESS once the restart may be taken, FAILURE while the own team has
    none.

    Args:
        gap: distance from the ball to the robot's centre [m].
        stay: keep running there even once the restart may be taken.
    """

    reads = ("shot", "pass_")
    optional = ("shot", "pass_")

    gap: float = 0.25
    stay: bool = False

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame, game = self.frame, self.frame.game
        if game.restart is None or game.restart_team is not frame.team:
            return self.fail("no restart of ours")
        may_take = game.may_touch and not game.stopped
        if may_take and not self.stay:
            return self.succeed("it may be taken")
        spot = game.placement or frame.ball.position
        x, y = _before(spot, self._aim(), -(_STOP_GAP if game.stopped else self.gap))
        if game.restart is Restart.KICKOFF and x > -IN_OWN_HALF:
            # The robot stays in its own half, even if the ball is to be kicked back.
            x, y = _before(spot, frame.field.their_goal, -(_STOP_GAP if game.stopped else self.gap))
        if game.stopped and not frame.field.contains(x, y):
            x, y = _before(spot, (0.0, 0.0), _STOP_GAP)
        self.drive_to((x, y), spot, avoid_ball=True)
        return self.run("waiting for a chance" if may_take else "waiting for the whistle")

    def _aim(self) -> Point:
        store = self.store
        if store.shot is not None:
            return store.shot.target
        return self.frame.field.their_goal if store.pass_ is None else store.pass_.target


def _before(spot: Point, point: Point, gap: float) -> Point:
    """Return the point ``gap`` metres from ``spot`` towards ``point``, or towards +x if both are equal."""
    (x, y), (point_x, point_y) = spot, point
    dx, dy = point_x - x, point_y - y
    length = hypot(dx, dy)
    if length == 0.0:
        return (x + gap, y)
    return (x + gap * dx / length, y + gap * dy / length)
