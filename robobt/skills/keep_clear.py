"""Drive to a point and touch nothing, not even lines and areas that move."""

from __future__ import annotations

from dataclasses import field

import numpy as np

from robobt.motion.clear_way import CAPSULE_COLUMNS, Ground, clear_velocity_of, time_map
from robobt.motion.pilot import command
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.skills.rate_limit import RateLimit
from robobt.tree import Status
from robobt.world.game import Restart
from robobt.world.geometry import FloatArray, Point, distance
from robobt.world.rules import AREA_DISTANCE, STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS

_MAP_EVERY = 0.1
"""Time between two maps of the way [s]."""

_OVER_LINES = 0.2
"""How far the robot's centre may leave the field [m]."""


@skill
class KeepClear(DrivingSkill):
    """Drive to a point as quickly as possible without touching a robot, a line or an area.

    It keeps ``margin`` from other robots, 0.2 m from the opponents' defence area, 0.5 m from the way of a
    ball that the opponents place, and from the line between two opponents if ``line`` names them. What moves
    is expected to go on as it moves now. Succeeds within ``tolerance`` of the target, at any speed.

    Use it where a touch costs more than time; :class:`~robobt.skills.go_to_pose.GoToPose` plans more cheaply
    and waits until a placed ball has passed.

    Args:
        target: point to drive to [m]; None takes ``store.target``.
        tolerance: distance that counts as there [m].
        margin: distance to keep from everything beyond what the rules ask [m].
        line: numbers of two opponents between which there is a line, if both are on the field.
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
    """

    reads = ("target",)

    target: Point | None = None
    tolerance: float = 0.05
    margin: float = 0.05
    line: tuple[int, int] | None = None
    _way: FloatArray | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._look = RateLimit(_MAP_EVERY)

    def on_start(self) -> None:
        """Forget the last map."""
        self._way = None

    def on_running(self) -> Status:
        """Drive one tick."""
        frame, me, limits = self.frame, self.me, self.drive_limits
        target = self.store.target if self.target is None else self.target
        if target is None:
            return self.fail("no target")
        if distance(me.position, target) <= self.tolerance:
            return self.succeed("there")
        pitch = frame.field
        ground = Ground(
            pitch.half_length + _OVER_LINES,
            pitch.half_width + _OVER_LINES,
            pitch.half_length - pitch.defense_depth,
            pitch.defense_width / 2.0,
            AREA_DISTANCE + ROBOT_RADIUS + self.margin,
        )
        obstacles = self._obstacles()
        if self._look.due(frame.time) or self._way is None:
            self._way = time_map(me.position, target, 0.7 * limits.max_speed, obstacles, ground)
        acceleration = min(limits.acceleration, limits.lateral_acceleration)
        pace = limits.max_speed, acceleration, min(limits.braking, limits.lateral_braking)
        state = me.x, me.y, me.vx, me.vy
        vx, vy = clear_velocity_of(state, target, pace, frame.period, self._way, obstacles, ground)
        self.store.command = command(me, vx, vy, 0.0, limits, frame.period)
        return self.run("on its way")

    def _obstacles(self) -> FloatArray:
        frame, me = self.frame, self.me
        rows = [
            (r.x, r.y, r.vx, r.vy, r.x, r.y, r.vx, r.vy, 2.0 * ROBOT_RADIUS + self.margin)
            for r in frame.others(me.id)
        ]
        game, ball = frame.game, frame.ball
        if game.restart is Restart.BALL_PLACEMENT and game.restart_team is not frame.team:
            x, y = game.placement or ball.position
            radius = STOP_DISTANCE + ROBOT_RADIUS + self.margin
            rows.append((ball.x, ball.y, ball.vx, ball.vy, x, y, 0.0, 0.0, radius))
        ends = [] if self.line is None else [r for r in frame.opponents if r.id in self.line]
        if len(ends) == 2:
            a, b = ends
            rows.append((a.x, a.y, a.vx, a.vy, b.x, b.y, b.vx, b.vy, ROBOT_RADIUS + self.margin))
        return np.array(rows, dtype=np.float64).reshape(-1, CAPSULE_COLUMNS)
