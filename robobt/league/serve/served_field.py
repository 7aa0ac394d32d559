"""The field that is served: any robots of either team, teleports, and a watchdog on the commands.

No sockets and no clock: whoever serves says when a period has passed.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

import numpy as np

from robobt.league.wire.commands import BallTeleport, Teleport, bounded
from robobt.sim.arenas import Arenas
from robobt.sim.settings import RealismSettings, SimSettings
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

TEAM_SIZE = 16
"""Robots a team can have, numbered from 0; who is not on the field stands beside it, unseen."""

COMMAND_TIMEOUT = 0.1
"""A robot that got no command for so long stops [s]. Source: ER-Force's standby time."""

_PARKED = 1.5
"""From the walls to the robots that are not on the field [m]."""


class ServedField:
    """A simulated field for 16 robots a team, of which some are present.

    Args:
        field: dimensions.
        placement: who stands where at the start.
        settings: of the simulator; its commands' delay and loss are in force, what
            cameras do to what is seen is left to them.
        limits: of single robots, where they differ from the settings'.
        period: between two frames [s].
        seed: of what is lost on the way.

    Attributes:
        time: simulated seconds since the start.
        kicked: who kicked during the last step.

    Raises:
        ValueError: the placement does not fit the field.
    """

    def __init__(
        self,
        field: FieldGeometry,
        placement: Placement,
        settings: SimSettings | None = None,
        limits: Mapping[RobotId, RobotLimits] | None = None,
        period: float = 1 / 60,
        seed: int = 0,
    ) -> None:
        self.field = field
        self.settings = settings or SimSettings()
        self.period = period
        self._ids = [RobotId(team, number) for team in Team for number in range(TEAM_SIZE)]
        self._index = {robot: i for i, robot in enumerate(self._ids)}
        given = limits or {}
        self._limits = [given.get(robot, self.settings.limits) for robot in self._ids]
        self._present = np.zeros(len(self._ids), dtype=np.bool_)
        self._commands = np.zeros((1, len(self._ids), 6))
        self._last_command = np.full(len(self._ids), -np.inf)
        self._rng = np.random.default_rng(seed)
        self._loss = self.settings.realism.command_loss
        self._ticks = 0
        self.kicked: list[RobotId] = []
        self._arenas = Arenas(field, self._limits, self.settings, period)
        self._start(placement)

    @property
    def time(self) -> float:
        """Simulated seconds since the start."""
        return self._ticks * self.period

    def lose_commands(self, realism: RealismSettings) -> None:
        """Lose as many commands as this level of realism says, from now on."""
        self._loss = realism.command_loss

    def command(self, robot: RobotId, command: RobotCommand) -> bool:
        """Give a robot a command, in force until the next or until it is too old.

        Returns:
            False, and nothing changes, for a robot that is not on the field or a
            command that is not finite.
        """
        i = self._index.get(robot)
        if i is None or not self._present[i] or not command.finite():
            return False
        if self._loss > 0.0 and self._rng.random() < self._loss:
            return True
        command = bounded(command, self._limits[i], self.settings.kicker.max_speed)
        self._commands[0, i] = (
            command.vx,
            command.vy,
            command.omega,
            command.kick_speed,
            1.0,
            bool(command.dribbler),
        )
        self._last_command[i] = self.time
        return True

    def limit(self, robot: RobotId, limits: RobotLimits) -> bool:
        """Give a robot other limits for its commands; False for a number that no robot has."""
        i = self._index.get(robot)
        if i is None:
            return False
        self._limits[i] = limits
        return True

    def driven(self) -> bool:
        """Whether any robot is under a command to move."""
        return bool(self._commands[0, :, :3].any())

    def step(self) -> None:
        """Let one period pass; robots whose last command is too old get the command to stand still."""
        late = self._last_command < self.time - COMMAND_TIMEOUT + 1e-9
        self._commands[0, late] = 0.0
        self._arenas.step(self._commands)
        self._ticks += 1
        fired = self._arenas.kicked[0]
        self.kicked = [self._ids[i] for i in fired.nonzero()[0]] if fired.any() else []
        # A kick that has fired is over; whoever wants another says so again.
        self._commands[0, fired, 3] = 0.0

    def teleport(self, robot: Teleport) -> str | None:
        """Put a robot somewhere, take it off the field or bring it back.

        Returns:
            Why it cannot be done, None when it was.
        """
        i = self._index.get(robot.robot)
        if i is None:
            return f"there is no robot {robot.robot}"
        state = self._arenas.robots[0, i].copy()
        if robot.present is False:
            self._park(i)
            return None
        given = (robot.x, robot.y, robot.heading)
        if any(value is None for value in given):
            if not self._present[i]:
                return f"{robot.robot} is not on the field and needs a full pose"
            state[:3] = [old if new is None else new for new, old in zip(given, state[:3], strict=True)]
        else:
            state[:3] = given
        state[3:] = robot.vx, robot.vy, robot.omega
        if not self._inside(state[0], state[1]) or not np.isfinite(state).all():
            return f"{robot.robot} cannot be put at ({state[0]:g}, {state[1]:g})"
        state[2] = wrap_angle(float(state[2]))
        state[3:] = np.clip(state[3:], -20.0, 20.0)
        self._present[i] = True
        self._commands[0, i] = 0.0
        self._arenas.place_robot(0, i, state)
        return None

    def teleport_ball(self, ball: BallTeleport) -> str | None:
        """Put the ball somewhere; the answer is that of :meth:`teleport`."""
        old = self._arenas.balls[0].tolist()
        given = (ball.x, ball.y, ball.vx, ball.vy)
        x, y, vx, vy = (before if new is None else new for new, before in zip(given, old, strict=True))
        if not self._inside(x, y) or not (isfinite(vx) and isfinite(vy)):
            return f"the ball cannot be put at ({x:g}, {y:g})"
        fastest = 20.0
        vx, vy = min(max(vx, -fastest), fastest), min(max(vy, -fastest), fastest)
        self._arenas.place_ball(0, x, y, vx, vy, ball.rolls)
        return None

    def place_ball(self, x: float, y: float) -> None:
        """Put the ball down at rest (the referee's hand); a place outside the walls is refused."""
        self.teleport_ball(BallTeleport(x, y, 0.0, 0.0))

    def poses(self) -> dict[RobotId, tuple[float, float, float]]:
        """x, y, heading of every robot on the field [m, m, rad]."""
        rows = self._arenas.robots[0, :, :3].tolist()
        return {
            robot: (row[0], row[1], wrap_angle(row[2]))
            for robot, row, present in zip(self._ids, rows, self._present.tolist(), strict=True)
            if present
        }

    def ball(self) -> tuple[float, float]:
        """Where the ball is [m]."""
        x, y = self._arenas.balls[0, :2].tolist()
        return x, y

    def contacts(self) -> dict[RobotId, bool]:
        """Whether the ball lies in the mouth of each robot on the field."""
        touching = self._arenas.contact[0].tolist()
        return {robot: touching[self._index[robot]] for robot in self.poses()}

    def truth(self) -> Frame:
        """The simulated state, seen from blue's side."""
        teams: dict[Team, list[RobotState]] = {team: [] for team in Team}
        contact = self._arenas.contact[0].tolist()
        for i, row in enumerate(self._arenas.robots[0].tolist()):
            if self._present[i]:
                robot = self._ids[i]
                x, y, heading, vx, vy, omega = row
                teams[robot.team].append(
                    RobotState(
                        robot.number, x, y, wrap_angle(heading), vx, vy, omega, contact[i], self._limits[i]
                    )
                )
        touch = int(self._arenas.touch[0])
        return Frame(
            self.time,
            self.field,
            BallState(*self._arenas.balls[0].tolist()),
            tuple(teams[Team.BLUE]),
            tuple(teams[Team.YELLOW]),
            Team.BLUE,
            self.period,
            last_touch=self._ids[touch] if touch >= 0 else None,
        )

    def _start(self, placement: Placement) -> None:
        for i in range(len(self._ids)):
            self._park(i)
        for robot, (x, y, heading) in placement.robots.items():
            problem = self.teleport(Teleport(robot, x, y, heading))
            if problem is not None:
                raise ValueError(problem)
        x, y, vx, vy = placement.ball
        problem = self.teleport_ball(BallTeleport(x, y, vx, vy, rolls=True))
        if problem is not None:
            raise ValueError(problem)

    def _park(self, i: int) -> None:
        """Put a robot beside the field, out of everybody's way."""
        beside = self.field.half_width + self.field.margin + _PARKED
        x = (i % TEAM_SIZE - TEAM_SIZE / 2) * 3 * ROBOT_RADIUS
        y = beside if self._ids[i].team is Team.BLUE else -beside
        self._present[i] = False
        self._commands[0, i] = 0.0
        self._arenas.place_robot(0, i, (x, y, 0.0, 0.0, 0.0, 0.0))

    def _inside(self, x: float, y: float) -> bool:
        field = self.field
        return abs(x) <= field.half_length + field.margin and abs(y) <= field.half_width + field.margin


def line_up(field: FieldGeometry, robots: int) -> Placement:
    """So many robots a team in their own halves, facing the ball in the centre.

    Raises:
        ValueError: more than a team can have.
    """
    if not 0 <= robots <= TEAM_SIZE:
        raise ValueError(f"a team has up to {TEAM_SIZE} robots, not {robots}")
    placement = Placement()
    column = 4
    for number in range(robots):
        x = field.half_length * (0.2 + 0.2 * (number // column))
        y = field.width * 0.2 * (number % column - (column - 1) / 2)
        placement.robots[RobotId(Team.BLUE, number)] = (-x, y, 0.0)
        placement.robots[RobotId(Team.YELLOW, number)] = (x, -y, np.pi)
    return placement
