"""What differs between the branches of one moment: errors of the start and of execution."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np

from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.geometry import wrap_angle
from robobt.world.protocol import Placement
from robobt.world.state import RobotId


@dataclass(slots=True, frozen=True)
class ErrorSizes:
    """Standard deviations of what differs between branches.

    Attributes:
        place: of robots' and the ball's places at the start, along each axis [m].
        heading: of robots' headings at the start [rad].
        speed: of robots' and the ball's velocities at the start, along each axis [m/s].
        drive: of the factor by which a robot drives faster or slower than commanded throughout a branch.
        kick: of the share by which each kick is weaker than commanded.
    """

    place: float = 0.005
    heading: float = 0.02
    speed: float = 0.03
    drive: float = 0.02
    kick: float = 0.03


NO_ERRORS = ErrorSizes(0.0, 0.0, 0.0, 0.0, 0.0)
"""All branches start as logged, and commands are carried out as given."""


class BranchErrors:
    """The errors of one branch.

    Args:
        sizes: how large they are.
        generator: draws them.
        robots: the robots.
    """

    def __init__(self, sizes: ErrorSizes, generator: np.random.Generator, robots: list[RobotId]) -> None:
        self._sizes, self._generator = sizes, generator
        self._factors = dict(
            zip(robots, (1.0 + generator.normal(0.0, sizes.drive, len(robots))).tolist(), strict=True)
        )

    def start(self, placement: Placement, holder: RobotId | None, field: FieldGeometry) -> Placement:
        """Return a placement with errors; a ball that ``holder`` has moves with that robot."""
        sizes, draw = self._sizes, self._generator.normal
        robots, velocities = {}, {}
        moved = (0.0, 0.0, 0.0)
        for robot, (x, y, heading) in placement.robots.items():
            dx, dy = draw(0.0, sizes.place, 2).tolist()
            turn = float(draw(0.0, sizes.heading))
            vx, vy = draw(0.0, sizes.speed, 2).tolist()
            known = placement.velocities.get(robot, (0.0, 0.0))
            robots[robot] = (*_inside(x + dx, y + dy, field), wrap_angle(heading + turn))
            velocities[robot] = (known[0] + vx, known[1] + vy)
            if robot == holder:
                moved = (robots[robot][0] - x, robots[robot][1] - y, turn)
        bx, by, bvx, bvy = placement.ball
        if holder is None:
            dx, dy = draw(0.0, sizes.place, 2).tolist()
            dvx, dvy = draw(0.0, sizes.speed, 2).tolist()
            ball = (*_inside(bx + dx, by + dy, field), bvx + dvx, bvy + dvy)
        else:
            hx, hy, _ = placement.robots[holder]
            c, s = cos(moved[2]), sin(moved[2])
            rx, ry = bx - hx, by - hy
            at = _inside(hx + moved[0] + c * rx - s * ry, hy + moved[1] + s * rx + c * ry, field)
            ball = (*at, bvx, bvy)
        return replace(placement, robots=robots, velocities=velocities, ball=ball)

    def execute(self, commands: Mapping[RobotId, RobotCommand]) -> Mapping[RobotId, RobotCommand]:
        """Return the commands as they are carried out."""
        if self._sizes.drive == 0.0 and self._sizes.kick == 0.0:
            return commands
        done = {}
        for robot, given in commands.items():
            factor, kick = self._factors[robot], given.kick_speed
            if kick > 0.0:
                # Never stronger, because a kick that is too fast is a foul.
                kick *= 1.0 - min(0.5, abs(float(self._generator.normal(0.0, self._sizes.kick))))
            done[robot] = command = given.copy()
            command.vx, command.vy, command.omega = factor * given.vx, factor * given.vy, factor * given.omega
            command.kick_speed = kick
        return done


def _inside(x: float, y: float, field: FieldGeometry) -> tuple[float, float]:
    """Return the point, or the nearest one within the walls."""
    most_x, most_y = field.outer
    return min(max(x, -most_x), most_x), min(max(y, -most_y), most_y)
