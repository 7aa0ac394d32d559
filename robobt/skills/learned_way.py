"""Driving among moving robots with a trained policy."""

from __future__ import annotations

from dataclasses import replace

from robobt.motion.path_planner import TARGETS, allowed_target, next_waypoint
from robobt.motion.scene import BALL_GAP
from robobt.skills.ball.learned_control import PacedControl
from robobt.world.avoiding import GO_TO_BALL_AMONG_ROBOTS
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point, distance, limit_norm
from robobt.world.limits import RobotLimits
from robobt.world.sketch import Sketch
from robobt.world.state import BallState, Frame, RobotState

NEAR = 0.5
"""Distance from which a robot at the policy's speed can still brake and turn to its final heading [m]."""

_HANDBACK_DISTANCE = 0.7
"""Hysteresis: the planner keeps control until the target is this far away again [m]."""


class LearnedWay:
    """Drives by a policy for Go-To-Ball-Among-Robots, which is given the target in place of the ball.

    The policy sees only robots. The planner's next waypoint leads it round defence areas and, if asked, round
    the ball. It was trained to arrive at any speed and heading while the ball is in play, so the planner
    drives near a waypoint and whenever the ball is not in play.

    Args:
        model: name or file of a model for GoToBall that sees the robots in the way.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    def __init__(self, model: str) -> None:
        self._control = PacedControl(model, skill="GoToBall", observation=GO_TO_BALL_AMONG_ROBOTS)
        self._near = False

    def restart(self) -> None:
        """Forget the last decision."""
        self._control.restart()
        self._near = False

    def command(
        self,
        frame: Frame,
        me: RobotState,
        target: Point,
        limits: RobotLimits,
        sketch: Sketch,
        *,
        avoid_ball: bool = False,
        ball_gap: float = BALL_GAP,
        goalkeeper: bool = False,
    ) -> RobotCommand | None:
        """Return the command of one tick; None if the planner is to drive.

        Arguments as for :func:`robobt.motion.path_planner.travel`.

        Raises:
            PolicyError: the policy's answer is not a valid action.
        """
        goal = allowed_target(frame, me, target, goalkeeper=goalkeeper)
        place, _ = next_waypoint(
            frame,
            me,
            goal,
            avoid_robots=False,
            avoid_ball=avoid_ball,
            goalkeeper=goalkeeper,
            ball_gap=ball_gap,
        )
        self._near = distance(me.position, place) < (_HANDBACK_DISTANCE if self._near else NEAR)
        if self._near or not frame.game.in_play:
            self._control.restart()
            return None
        sketch.point(TARGETS, place)
        command = self._control.decide(replace(frame, ball=BallState(*place)), me, sketch)
        command.vx, command.vy = limit_norm(command.vx, command.vy, limits.max_speed)
        command.omega = min(limits.max_turn, max(-limits.max_turn, command.omega))
        return command
