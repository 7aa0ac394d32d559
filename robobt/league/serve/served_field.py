"""The field that is served: any robots of either team, teleports, and a timeout on commands.

No sockets and no clock: the server decides when a period has passed.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite

import numpy as np

from robobt.league.serve.round_trips import TripWatch
from robobt.league.wire.commands import BallTeleport, Teleport, clamp_command
from robobt.match.scenario.scenario import Scenario
from robobt.sim.arenas import Arenas
from robobt.sim.realism import realism_level
from robobt.sim.records import COMMAND, size
from robobt.sim.settings import SimSettings, preset, settings_from
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

TEAM_SIZE = 16
"""Most robots on a team, numbered from 0; those not on the field stand beside it, invisible."""

COMMAND_TIMEOUT = 0.1
"""A robot that gets no command for this long stops [s]. Source: ER-Force's standby time."""

_ABSENT_ROBOT_DISTANCE = 1.5
"""Distance from the walls to the robots that are not on the field [m]."""

_MAX_TELEPORT_SPEED = 20.0
"""Fastest velocity that a teleport may give [m/s, rad/s]."""

_MAX_TELEPORT_HEIGHT = 3.0
"""Greatest height that a teleport may give, below the cameras [m]."""


class ServedField:
    """A simulated field for 16 robots a team, of which some are present.

    Of ``settings`` the delay and loss of commands take effect, which ``seed`` decides on; noise and latency
    of the vision are up to the cameras. ``limits`` are those of individual robots, where they differ from the
    settings'.

    Attributes:
        period: between two frames [s].
        command_loss: share of the commands that get lost.
        kicked: who kicked during the last step.
        chipped: who of them chipped.
        trips: round trips, and how late the robots obey.

    Raises:
        ValueError: the placement does not fit the field.
    """

    period = 1 / 60

    def __init__(
        self,
        field: FieldGeometry,
        placement: Placement,
        settings: SimSettings | None = None,
        limits: Mapping[RobotId, RobotLimits] | None = None,
        seed: int = 0,
    ) -> None:
        self.field = field
        self.settings = settings or SimSettings()
        self._ball_model = self.settings.ball.model
        self.command_loss = self.settings.realism.command_loss
        self._ids = [RobotId(team, number) for team in Team for number in range(TEAM_SIZE)]
        self._index = {robot: i for i, robot in enumerate(self._ids)}
        given = limits or {}
        self._limits = [given.get(robot, self.settings.limits) for robot in self._ids]
        self.trips = TripWatch(self.settings, given)
        self._present = np.zeros(len(self._ids), dtype=np.bool_)
        self._commands = np.zeros((1, len(self._ids), size(COMMAND)))
        self._last_command = np.full(len(self._ids), -np.inf)
        self._rng = np.random.default_rng(seed)
        self._ticks = 0
        self.kicked: list[RobotId] = []
        self.chipped: list[RobotId] = []
        self._arenas = Arenas(field, self._limits, self.settings, self.period, solver="pymunk")
        self._arenas.seed((seed,))
        self._start(placement)

    @property
    def time(self) -> float:
        """Simulated seconds since the start."""
        return self._ticks * self.period

    def command(self, robot: RobotId, command: RobotCommand) -> bool:
        """Give a robot a command, in force until the next one or its timeout.

        Return False, without effect, for an absent robot or a command that is not finite.
        """
        i = self._index.get(robot)
        if i is None or not self._present[i] or not command.finite():
            return False
        lost = self.command_loss > 0.0 and self._rng.random() < self.command_loss
        self.trips.commanded(robot, command, self.time, lost)
        if lost:
            return True
        command = clamp_command(command, self._limits[i], self.settings.kicker)
        self._commands[0, i] = (
            command.vx,
            command.vy,
            command.omega,
            command.kick_speed,
            1.0,
            bool(command.dribbler),
            command.kick_angle,
        )
        self._last_command[i] = self.time
        return True

    def draw(self) -> float:
        """Return a number from 0 to 1 of the field's own generator, as the loss of commands draws them."""
        return float(self._rng.random())

    def limit(self, robot: RobotId, limits: RobotLimits) -> bool:
        """Set the limits of a robot's commands; return False for an impossible number."""
        i = self._index.get(robot)
        if i is None:
            return False
        self._limits[i] = limits
        return True

    def driven(self) -> bool:
        """Return whether any robot is commanded to move."""
        return bool(self._commands[0, :, :3].any())

    def step(self) -> None:
        """Simulate one period; robots whose last command has timed out are commanded to stop."""
        late = self._last_command < self.time - COMMAND_TIMEOUT + 1e-9
        for i in (late & self._commands[0, :, :3].any(axis=1)).nonzero()[0]:
            self.trips.stopped(self._ids[i], self.time)
        self._commands[0, late] = 0.0
        self._arenas.step(self._commands)
        self._ticks += 1
        fired = self._arenas.kicked[0]
        self.kicked = [self._ids[i] for i in fired.nonzero()[0]]
        commands = self._commands.view(COMMAND)[0, :, 0]
        self.chipped = [self._ids[i] for i in (fired & (commands["kick_angle"] > 0.0)).nonzero()[0]]
        # A kick fires once; the next one takes another command.
        commands["kick_speed"][fired] = 0.0

    def teleport(self, robot: Teleport) -> str | None:
        """Put a robot somewhere, take it off the field or bring it back; say why if it cannot be done."""
        i = self._index.get(robot.robot)
        if i is None:
            return f"there is no robot {robot.robot}; a team has numbers 0 to {TEAM_SIZE - 1}"
        if robot.present is False:
            self._park(i)
            return None
        state = self._arenas.robots[0, i].copy()
        given = (robot.x, robot.y, robot.heading)
        if None in given and not self._present[i]:
            return f"{robot.robot} is not on the field and needs a full pose"
        state[:3] = [old if new is None else new for new, old in zip(given, state[:3], strict=True)]
        state[3:] = robot.vx, robot.vy, robot.omega
        if not self._inside(state[0], state[1]) or not np.isfinite(state).all():
            return f"{robot.robot} cannot be put at ({state[0]:g}, {state[1]:g}), outside the walls"
        state[2] = wrap_angle(float(state[2]))
        state[3:] = np.clip(state[3:], -_MAX_TELEPORT_SPEED, _MAX_TELEPORT_SPEED)
        self._present[i] = True
        self._commands[0, i] = 0.0
        self._arenas.place_robot(0, i, state)
        return None

    def teleport_ball(self, ball: BallTeleport) -> str | None:
        """Put the ball somewhere; say why if it cannot be done."""
        old = self._arenas.balls[0].tolist()
        given = (ball.x, ball.y, ball.vx, ball.vy)
        x, y, vx, vy = (before if new is None else new for new, before in zip(given, old, strict=True))
        if not self._inside(x, y) or not (isfinite(vx) and isfinite(vy)):
            return f"the ball cannot be put at ({x:g}, {y:g}), outside the walls"
        vx, vy, vz = (
            min(max(speed, -_MAX_TELEPORT_SPEED), _MAX_TELEPORT_SPEED) for speed in (vx, vy, ball.vz)
        )
        self._arenas.place_ball(0, x, y, vx, vy, ball.rolls, min(max(ball.z, 0.0), _MAX_TELEPORT_HEIGHT), vz)
        return None

    def place_ball(self, x: float, y: float) -> None:
        """Put the ball down at rest (the referee's hand); a place outside the walls is ignored."""
        self.teleport_ball(BallTeleport(x, y, 0.0, 0.0))

    def truth(self) -> Frame:
        """Return the simulated state, seen from blue's side."""
        teams: dict[Team, list[RobotState]] = {team: [] for team in Team}
        rows, contacts = self._arenas.robots[0].tolist(), self._arenas.contact[0].tolist()
        for i, robot in enumerate(self._ids):
            if self._present[i]:
                x, y, heading, vx, vy, omega = rows[i]
                heading = wrap_angle(heading)
                teams[robot.team].append(
                    RobotState(robot.number, x, y, heading, vx, vy, omega, contacts[i], self._limits[i])
                )
        touch = int(self._arenas.touch[0])
        return Frame(
            self.time,
            self.field,
            BallState(*self._arenas.balls[0].tolist(), *self._arenas.flight[0, :2].tolist()),
            tuple(teams[Team.BLUE]),
            tuple(teams[Team.YELLOW]),
            period=self.period,
            last_touch=self._ids[touch] if touch >= 0 else None,
            ball_model=self._ball_model,
        )

    def _start(self, placement: Placement) -> None:
        for i in range(len(self._ids)):
            self._park(i)
        x, y, vx, vy = placement.ball
        problems = [self.teleport(Teleport(robot, *pose)) for robot, pose in placement.robots.items()]
        problems.append(self.teleport_ball(BallTeleport(x, y, vx, vy, rolls=True)))
        for problem in problems:
            if problem is not None:
                raise ValueError(problem)

    def _park(self, i: int) -> None:
        """Put a robot beside the field, out of everybody's way."""
        beside = self.field.outer[1] + _ABSENT_ROBOT_DISTANCE
        x = (i % TEAM_SIZE - TEAM_SIZE / 2) * 3 * ROBOT_RADIUS
        y = beside if self._ids[i].team is Team.BLUE else -beside
        self._present[i] = False
        self._commands[0, i] = 0.0
        self._arenas.place_robot(0, i, (x, y, 0.0, 0.0, 0.0, 0.0))

    def _inside(self, x: float, y: float) -> bool:
        most_x, most_y = self.field.outer
        return abs(x) <= most_x and abs(y) <= most_y


def line_up(field: FieldGeometry, robots: int) -> Placement:
    """Return this many robots per team in their own halves, facing the ball in the centre."""
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


def served_scenario(
    scenario: Scenario, simulator: str | None = None, realism: str | None = None
) -> ServedField:
    """Return the field of a scenario, with everything where its seed puts it.

    A preset of the simulator and a level of realism may replace the scenario's.

    Raises:
        KeyError: no such preset or level.
        ScenarioError: there is no place for everything.
        ValueError: the simulator's settings are wrong.
    """
    settings = settings_from(scenario.simulator) if simulator is None else preset(simulator)
    limits = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    placement = scenario.place(np.random.default_rng(scenario.seed))
    return ServedField(scenario.field, placement, _with(settings, realism), limits, scenario.seed)


def served_line_up(
    field: FieldGeometry, robots: int, simulator: str = "grsim", realism: str | None = None, seed: int = 0
) -> ServedField:
    """Return a field with this many robots per team, lined up in their own halves.

    Raises:
        KeyError: no such preset or level.
        ValueError: more robots than a team can have.
    """
    settings = _with(preset(simulator), realism)
    return ServedField(field, line_up(field, robots), settings, seed=seed)


def _with(settings: SimSettings, realism: str | None) -> SimSettings:
    return settings if realism is None else settings.model_copy(update={"realism": realism_level(realism)})
