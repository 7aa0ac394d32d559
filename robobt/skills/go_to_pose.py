"""Drive to a pose."""

from __future__ import annotations

from dataclasses import field
from math import hypot, radians

from robobt.motion.path_planner import allowed_target, travel
from robobt.motion.pilot import roughly
from robobt.motion.scene import BALL_GAP
from robobt.skills.ball.learned_control import PolicyError
from robobt.skills.base import KICKER_GAP, skill
from robobt.skills.driving import DrivingSkill
from robobt.skills.learned_way import LearnedWay
from robobt.tree import Status
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point, direction, wrap_angle

_HEADING_SHARE = 0.9
_ARRIVED_SPEED = 0.1
"""Speed below which a robot counts as arrived [m/s]."""


@skill
class GoToPose(DrivingSkill):
    """Drive to a pose round all obstacles, and stop there.

    Succeeds when the robot stands within the tolerances, and holds the pose for as long as it is ticked. A
    target where the robot may not stand (outside the walls, in a defence area, too near the ball during a
    stop) is replaced by the nearest allowed point. Fails without a target.

    With ``policy`` a trained policy drives while the ball is in play and chooses speed and heading itself;
    the planner drives the last half metre and round defence areas. If the policy's answer is not a valid
    action, the skill fails and the robot stops.

    Args:
        target: point to drive to [m]; None takes ``store.target``.
        heading: final heading [rad]; None keeps the present heading.
        face_ball: turn to the ball instead of to ``heading``, within ``heading_tolerance``.
        tolerance: distance that counts as there [m].
        heading_tolerance: angle that counts as there [rad].
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
        avoid_robots, avoid_ball: what the way must avoid.
        goalkeeper: may enter the own defence area.
        policy: name or file of a model for GoToBall that sees the robots in its way
            (``robobt train go_to_ball_among_robots``); empty for the planner alone.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    reads = ("target",)

    target: Point | None = None
    heading: float | None = None
    face_ball: bool = False
    tolerance: float = 0.01
    heading_tolerance: float = radians(2.0)
    avoid_robots: bool = True
    avoid_ball: bool = False
    goalkeeper: bool = False
    policy: str = ""
    _kept_heading: float = field(default=0.0, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._learned = LearnedWay(self.policy) if self.policy else None

    def on_start(self) -> None:
        """Remember the heading to keep."""
        self._kept_heading = self.me.heading
        if self._learned is not None:
            self._learned.restart()

    def on_running(self) -> Status:
        """Drive one tick."""
        target = self.store.target if self.target is None else self.target
        if target is None:
            return self.fail("no target")
        me, frame = self.me, self.frame
        if self._learned is not None and self.avoid_robots:
            try:
                command = self._learned.command(
                    frame,
                    me,
                    target,
                    self.drive_limits,
                    self.draw,
                    avoid_ball=self.avoid_ball or self.has_kicked,
                    ball_gap=KICKER_GAP if self.has_kicked else BALL_GAP,
                    goalkeeper=self.goalkeeper,
                )
            except PolicyError as error:
                self.store.command = RobotCommand()
                return self.fail(str(error))
            if command is not None:
                self.store.command = command
                return self.run("driving as learned")
        heading = self._heading()
        self.store.command = travel(
            frame,
            me,
            target,
            heading,
            self.drive_limits,
            avoid_robots=self.avoid_robots,
            avoid_ball=self.avoid_ball or self.has_kicked,
            ball_gap=KICKER_GAP if self.has_kicked else BALL_GAP,
            goalkeeper=self.goalkeeper,
            sketch=self.draw,
        )
        x, y = allowed_target(frame, me, target, goalkeeper=self.goalkeeper)
        gap = hypot(x - me.x, y - me.y)
        there = gap <= self.tolerance and abs(wrap_angle(heading - me.heading)) <= self.heading_tolerance
        if there and me.speed < _ARRIVED_SPEED:
            return self.succeed("there")
        return self.run("driving")

    def _heading(self) -> float:
        if self.face_ball:
            wanted = direction(self.me.position, self.ball.position)
            return roughly(self.me.heading, wanted, _HEADING_SHARE * self.heading_tolerance)
        return self._kept_heading if self.heading is None else self.heading
