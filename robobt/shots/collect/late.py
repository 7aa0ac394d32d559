"""A world that delays one robot's commands, and in which robots move at the start."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import replace

from robobt.world.command import RobotCommand
from robobt.world.geometry import to_robot_frame
from robobt.world.protocol import Placement, World, WrappedWorld
from robobt.world.state import RobotId


class LateWorld(WrappedWorld):
    """Holds back the commands of one robot, and starts with robots on their way.

    Args:
        world: where the commands go.
        robot: whose commands are held back.
        delay: how late they take effect [s]; between two commands, in proportion.
        period: control period [s].
        velocities: (vx, vy) at the start of the robots that are not at rest [m/s].
    """

    def __init__(
        self,
        world: World,
        robot: RobotId,
        delay: float,
        period: float,
        velocities: Mapping[RobotId, tuple[float, float]],
    ) -> None:
        super().__init__(world)
        self._robot = robot
        self._velocities = dict(velocities)
        ticks = delay / period
        self._share = ticks % 1.0
        self._held: deque[RobotCommand] = deque(maxlen=int(ticks) + 2)

    def reset(self, placement: Placement, seed: int) -> None:
        """See :meth:`World.reset`; the robot goes on as it moves until its first command is due."""
        vx, vy = to_robot_frame(
            *self._velocities.get(self._robot, (0.0, 0.0)), placement.robots[self._robot][2]
        )
        self._held.clear()
        self._held.extend(RobotCommand(vx, vy) for _ in range(int(self._held.maxlen or 0)))
        self.world.reset(replace(placement, velocities=self._velocities), seed)

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """See :meth:`World.act`."""
        newest = commands.get(self._robot, RobotCommand())
        self._held.append(newest)
        older, newer = self._held[0], self._held[1]
        late = RobotCommand(
            older.vx * self._share + newer.vx * (1.0 - self._share),
            older.vy * self._share + newer.vy * (1.0 - self._share),
            older.omega * self._share + newer.omega * (1.0 - self._share),
            newest.kick_speed,
            newest.kick_trigger,
            newest.dribbler,
        )
        self.world.act({**commands, self._robot: late})
