"""Offences of one robot with the ball: dribbling too far, kicking too fast, double touch."""

from __future__ import annotations

from collections.abc import Iterable
from math import sqrt

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.rules.base import Rule, event
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.world.game import RefereeCommand, Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import HELD_GAP, hull_gap
from robobt.world.state import RobotId

_SPEED_TOLERANCE = 0.01
"""Source: AutoReferee [m/s]."""


class Dribbling(Rule):
    """No robot may carry the ball farther than ``most`` [m], in a straight line, before releasing it."""

    phases = frozenset({PlayPhase.PLAY, PlayPhase.PENALTY})

    def __init__(self, most: float) -> None:
        self._most = most
        self._told: RobotId | None = None

    def enter(self, scene: RefereeScene) -> None:
        """Measure from where the ball comes into play."""
        scene.touches.carry_anew(scene.frame.ball.position)
        self._told = None

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a carry once."""
        touches = scene.touches
        carrier = touches.carrier
        if carrier is None or touches.carried <= self._most:
            self._told = None
            return ()
        if carrier == self._told:
            return ()
        self._told = carrier
        start, end = touches.carry_start, scene.frame.ball.position
        return (event(scene, EventKind.BOT_DRIBBLED_BALL_TOO_FAR, carrier, start, start=start, end=end),)


class BallSpeed(Rule):
    """No robot may kick the ball faster than ``most`` [m/s] in space; this includes restarts."""

    phases = frozenset({PlayPhase.KICK, PlayPhase.PLAY, PlayPhase.PENALTY})

    def __init__(self, most: float) -> None:
        self._most = most + _SPEED_TOLERANCE
        self._fast = False

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report a kick once."""
        ball, last = scene.frame.ball, scene.touches.last
        was_fast = self._fast
        square = ball.vx * ball.vx + ball.vy * ball.vy + ball.vz * ball.vz
        self._fast = square > self._most * self._most
        if was_fast or not self._fast or last is None:
            return ()
        speed, chipped = sqrt(square), ball.z > 0.0
        return (
            event(scene, EventKind.BOT_KICKED_BALL_TOO_FAST, last, initial_ball_speed=speed, chipped=chipped),
        )


class DoubleTouch(Rule):
    """The kicker of a kick-off or free kick may not touch the ball again before another robot has.

    This applies once the ball has moved 0.05 m; until then a pushing robot still counts as touching it. There
    is no offence if a second robot has touched the ball within that distance.
    """

    phases = frozenset({PlayPhase.KICK, PlayPhase.PLAY})

    def __init__(self, in_play_distance: float) -> None:
        self._in_play = in_play_distance
        self._spot: Point = (0.0, 0.0)
        self._team: Team | None = None
        self._kicker: RobotId | None = None
        self._before: RobotId | None = None
        self._touched: set[RobotId] = set()

    def enter(self, scene: RefereeScene) -> None:
        """Note the ball's position and then the kicker."""
        self._kicker = None
        last = scene.touches.last
        if scene.phase is PlayPhase.KICK:
            self._spot, self._team = scene.frame.ball.position, scene.game.restart_team
            self._before, self._touched = last, set()
            return
        moved = distance(self._spot, scene.frame.ball.position) > self._in_play
        taken = moved and scene.game.command is not RefereeCommand.FORCE_START
        alone = self._touched <= {last}
        if taken and alone and last is not None and last.team is self._team:
            self._kicker = last
        self._team = None

    def check(self, scene: RefereeScene) -> Iterable[RefereeEvent]:
        """Report the second touch once."""
        kicker, touches = self._kicker, scene.touches
        if scene.phase is PlayPhase.KICK:
            self._touched.update(touches.now)
            # A kicker may touch the ball between two frames without either showing it.
            self._touched.update(
                robot
                for robot, state in scene.frame.robots().items()
                if robot.team is self._team and hull_gap(state, scene.frame.ball) < HELD_GAP
            )
            if touches.last is not None and touches.last != self._before:
                self._touched.add(touches.last)
            return ()
        if kicker is None:
            return ()
        if touches.last != kicker or any(robot != kicker for robot in touches.now):
            self._kicker = None
        elif kicker in touches.now:
            self._kicker = None
            return (event(scene, EventKind.ATTACKER_DOUBLE_TOUCHED_BALL, kicker, self._spot),)
        return ()
