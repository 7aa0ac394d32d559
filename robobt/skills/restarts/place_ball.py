"""Bring the ball to where the referee wants it."""

from __future__ import annotations

from dataclasses import field
from math import cos, hypot, sin

from robobt.motion.dribbling import dribbling_limits
from robobt.motion.path_planner import travel
from robobt.motion.pilot import drive
from robobt.skills.ball.fetch_ball import pull
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.skills.restarts.keep_distance import way_out
from robobt.tree import Status
from robobt.world.command import RobotCommand
from robobt.world.game import RefereeCommand
from robobt.world.geometry import direction, distance
from robobt.world.rules import STOP_DISTANCE, has_ball
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_PULL = dribbling_limits(max_speed=1.0, max_turn=1.0, max_acceleration=0.8)
"""With the ball, backwards: 8 m in 10 s, of the 30 s that the rules give."""

_HELD = ROBOT_RADIUS
"""From the robot's centre to that of a ball in its mouth [m]."""

_PLACED, _STILL_PLACED = 0.06, 0.12
"""The ball is let go this near to the spot, and taken again beyond; the rules ask for 0.15 m [m]."""

_REST = 0.1
"""A ball or robot slower than this is at rest [m/s]."""

_OFF = 0.25
"""From here on a robot may turn without touching the ball [m]."""

_CLEAR = STOP_DISTANCE + ROBOT_RADIUS + BALL_RADIUS + 0.1


@skill
class PlaceBall(DrivingSkill):
    """Pull the ball to the referee's spot, let go of it and back off.

    Never ends by itself: the referee decides when the ball lies well. FAILURE
    while the referee does not ask for it.

    Source of the order of steps: RoboCup SSL rules, chapter "Ball Placement".

    Args:
        limits: how to drive without the ball; None for the robot's own.
        speed: factor on the top speed without the ball.
    """

    _there: bool = field(default=False, init=False)
    _let_go: bool = field(default=False, init=False)

    def on_start(self) -> None:
        """Begin with a ball that is not in its place."""
        self._there = self._let_go = False

    def on_running(self) -> Status:
        """Drive for one tick."""
        frame, me, ball, game = self.frame, self.me, self.ball, self.frame.game
        spot = game.placement
        if game.halted or game.command not in _ASKED:
            return self.fail("no ball placement")
        if spot is None:
            return self.run("the referee has named no spot")
        gap = distance(ball.position, spot)
        if gap > (_STILL_PLACED if self._there else _PLACED):
            self._there = self._let_go = False
            outwards = direction(spot, ball.position)
            place = (spot[0] - _HELD * cos(outwards), spot[1] - _HELD * sin(outwards))
            self.store.command, doing = pull(frame, me, has_ball(me, ball), place, self.drive_limits, _PULL)
            return self.run(doing)
        self._there = True
        if not self._let_go and has_ball(me, ball) and hypot(me.vx, me.vy) > _REST:
            self.store.command = RobotCommand(dribbler=True)
            return self.run("stopping with it")
        self._let_go = True
        gap = distance(me.position, ball.position)
        if gap >= _CLEAR:
            return self.run("clear of it")
        if gap < _OFF:
            # Straight back and at once: a robot that turns or creeps drags the ball along.
            away = direction(ball.position, me.position)
            place = (ball.x + _CLEAR * cos(away), ball.y + _CLEAR * sin(away))
            self.store.command = drive(me, place, me.heading, me.limits, frame.period)
        else:
            place = way_out(frame, me, ball.position, _CLEAR * 1.1)
            self.store.command = travel(frame, me, place, me.heading, me.limits, avoid_ball=True)
        return self.run("backing off")


_ASKED = frozenset({RefereeCommand.BALL_PLACEMENT_BLUE, RefereeCommand.BALL_PLACEMENT_YELLOW})
