"""The simulator as a World: one arena, frames and commands, noise and delays."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import numpy as np

from robobt.sim.arenas import Arenas
from robobt.sim.bodies import before_fronts
from robobt.sim.records import COMMAND, size
from robobt.sim.settings import SimSettings
from robobt.sim.sight import Sight
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.detections import Detections
from robobt.world.field import FieldGeometry
from robobt.world.frame_numbers import FrameNumbers
from robobt.world.game import Team
from robobt.world.geometry import FloatArray, wrap_angles
from robobt.world.limits import RobotLimits
from robobt.world.placement import check_inside, check_placement
from robobt.world.protocol import Placement, World
from robobt.world.state import BallState, Frame, RobotId, RobotState


class SimWorld(World):
    """A simulated field that implements :class:`robobt.world.World`.

    Args:
        field: dimensions.
        robots: each robot's limits; None takes the settings' own.
        settings: of the simulator.
        period: control period [s].

    Attributes:
        kicks: who kicked during the last ``act``.
    """

    def __init__(
        self,
        field: FieldGeometry,
        robots: Mapping[RobotId, RobotLimits | None],
        settings: SimSettings | None = None,
        period: float = 0.025,
    ) -> None:
        self.field = field
        self.settings = SimSettings() if settings is None else settings
        self._ball_model = self.settings.ball.model
        self.period = period
        self._ids = sorted(robots)
        self._index = {robot: i for i, robot in enumerate(self._ids)}
        self._limits = [robots[robot] or self.settings.limits for robot in self._ids]
        blue = sum(robot.team is Team.BLUE for robot in self._ids)
        self._blue = [(robot.number, self._limits[i]) for i, robot in enumerate(self._ids) if i < blue]
        self._yellow = [(robot.number, self._limits[i]) for i, robot in enumerate(self._ids) if i >= blue]
        self._numbers = FrameNumbers(self._blue, self._yellow)
        realism = self.settings.realism
        self._delayed = realism.vision_delay > 0.0
        self._noisy = any((realism.ball_noise, realism.robot_noise, realism.heading_noise))
        self._lossy = any((realism.missing_ball, realism.missing_robot))
        systematic = any((realism.object_offset, realism.camera_error, realism.hidden_below))
        self._sight = Sight(field, realism, self.settings.body.face) if systematic else None
        self._arenas = self._make_arenas()
        self._commands = np.zeros((1, len(self._ids), size(COMMAND)))
        self._rng = np.random.default_rng(0)
        self._ticks = 0
        self.kicks: list[RobotId] = []
        self._taken: set[RobotId] = set()
        # Robots' rows and the ball's, newest last; long enough to look back by the vision's delay.
        self._past: deque[FloatArray] = deque(maxlen=round(realism.vision_delay / self._arenas.dt) + 1)
        self._seen: FloatArray | None = None
        self._felt: list[bool] | None = None
        self._gone: list[bool] = [False] * (len(self._ids) + 1)
        self._report: FloatArray = self._rows()

    @property
    def time(self) -> float:
        """Simulated seconds since the reset."""
        return self._ticks * self.period

    def reset(self, placement: Placement, seed: int) -> None:
        """See :meth:`robobt.world.World.reset`; every robot needs a pose.

        A ball placed inside a robot's mouth starts before its front.
        """
        check_placement(placement, self.field, self._ids)
        still = (0.0, 0.0)
        turning = placement.turning
        poses = np.array(
            [
                (*placement.robots[robot], *placement.velocities.get(robot, still), turning.get(robot, 0.0))
                for robot in self._ids
            ],
            dtype=float,
        ).reshape(-1, 6)
        # A new space: the old one remembers the contacts of its last steps and would act on them.
        self._arenas = self._make_arenas()
        self._arenas.seed((seed,))
        ball = before_fronts(placement.ball, poses.tolist(), self.settings.body)
        self._arenas.place(poses[None], np.array([ball]))
        if placement.slides or placement.flight != (0.0, 0.0):
            x, y, vx, vy = ball
            z, vz = placement.flight
            self._arenas.place_ball(0, x, y, vx, vy, not placement.slides, z, vz)
        if placement.commands:
            at_rest = RobotCommand()
            before = [command_row(placement.commands.get(robot, at_rest)) for robot in self._ids]
            self._arenas.follow_before(np.arange(1), np.array(before).reshape(self._commands.shape))
        self._commands[:] = 0.0
        self._rng = np.random.default_rng(seed)
        self._ticks = round(placement.begin / self.period)
        self.kicks = []
        self._taken.clear()
        self._seen = None
        self._felt = None
        self._past.clear()
        self._past.append(self._rows())
        self._report = self._perceive()

    @property
    def shows_truth(self) -> bool:
        """Whether :meth:`observe` always returns what :meth:`truth` does."""
        return self.cameras_show_truth and self.settings.realism.response_loss == 0.0

    @property
    def cameras_show_truth(self) -> bool:
        """See :attr:`robobt.world.World.cameras_show_truth`."""
        return not (self._delayed or self._noisy or self._lossy or self._sight is not None)

    def observe(self) -> Frame:
        """Return what the cameras report: late, shifted, noisy and with gaps, as the settings define.

        Velocities carry no noise of their own; a missing detection repeats the last one. Four cameras hang
        over the field, and each thing is reported by the nearest one that sees it.
        """
        if self.shows_truth:
            return self.truth()
        rows = self._report
        robots = rows.tolist()
        x, y, z, vx, vy, vz = robots.pop()
        return self._frame(robots, [x, y, vx, vy, z, vz], self._felt)

    def truth(self) -> Frame:
        """Return the simulated state itself."""
        arenas = self._arenas
        z, vz, _ = arenas.flight[0].tolist()
        frame = self._frame(arenas.robots[0].tolist(), [*arenas.balls[0].tolist(), z, vz])
        if not self._taken:
            self._numbers.give(frame, arenas.robots[0], arenas.contact[0])
        return frame

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Send the commands and simulate one control period.

        Raises:
            KeyError: a command for a robot that is not part of this world.
            ValueError: a command that is not finite.
        """
        rows = self._commands[0]
        loss = self.settings.realism.command_loss
        lost = self._rng.random(len(self._ids)) < loss if loss > 0.0 else None
        sent: list[tuple[float, ...]] = [_ZERO_COMMAND] * len(self._ids)
        for robot, command in commands.items():
            i = self._index[robot]
            if not command.finite():
                raise ValueError(f"the command for {robot} is not finite: {command}")
            sent[i] = command_row(command)
        if lost is None:
            rows[:] = np.array(sent).reshape(rows.shape)
        elif lost.size:
            # A lost command is not sent twice: the robot drives on but does not kick again.
            rows.view(COMMAND)["kick_speed"][lost] = 0.0
            rows[~lost] = np.array(sent)[~lost]
        self._arenas.step(self._commands)
        self._ticks += 1
        self.kicks = [self._ids[i] for i in self._arenas.kicked[0].nonzero()[0].tolist()]
        if self._delayed:
            for rows in self._arenas.history[:, 0]:
                self._past.append(rows.copy())
        if not self.cameras_show_truth:
            self._report = self._perceive()
        if self.settings.realism.response_loss > 0.0:
            self._felt = self._responses()

    def detections(self) -> list[Detections]:
        """See :meth:`robobt.world.World.detections`; the cameras together, at the time that they claim."""
        if self.cameras_show_truth:
            return []
        realism = self.settings.realism
        age = realism.vision_delay if realism.processing_time is None else realism.processing_time
        seen = [row for row, gone in zip(self._report.tolist(), self._gone, strict=True) if not gone]
        ball = None if self._gone[-1] else (seen[-1][0], seen[-1][1])
        numbers = [robot for robot, gone in zip(self._ids, self._gone[:-1], strict=True) if not gone]
        robots = {
            robot: (x, y, heading)
            for robot, (x, y, heading, *_) in zip(numbers, seen, strict=False)
            if robot not in self._taken
        }
        return [Detections(self.time - age, 0, ball, robots)]

    def seen_kicks(self) -> list[tuple[RobotId, float]] | None:
        """See :meth:`robobt.world.World.seen_kicks`; a kick ticks after its command is reported."""
        return [(robot, self.time) for robot in self.kicks] if self._arenas.late else None

    def step_bare(self) -> None:
        """Step the physics engine through one period without frames or commands, for benchmarks."""
        self._arenas.step_bare()

    def place_ball(self, x: float, y: float) -> None:
        """See :meth:`robobt.world.World.place_ball`."""
        check_inside("the ball", (x, y), self.field)
        self._arenas.place_ball(0, x, y)

    def carry_robot(self, robot: RobotId, x: float, y: float) -> None:
        """See :meth:`robobt.world.World.carry_robot`; also to behind the walls."""
        index = self._index[robot]
        heading = self._arenas.robots[0, index, 2]
        self._arenas.place_robot(0, index, (x, y, heading, 0.0, 0.0, 0.0))

    @property
    def movable(self) -> bool:
        """See :attr:`robobt.world.World.movable`."""
        return True

    def put_ball(self, x: float, y: float, vx: float, vy: float) -> None:
        """See :meth:`robobt.world.World.put_ball`."""
        check_inside("the ball", (x, y, vx, vy), self.field)
        self._arenas.place_ball(0, x, y, vx, vy)

    def put_robot(self, robot: RobotId, x: float, y: float, heading: float) -> None:
        """See :meth:`robobt.world.World.put_robot`."""
        check_inside(str(robot), (x, y, heading), self.field)
        self._arenas.place_robot(0, self._index[robot], (x, y, heading, 0.0, 0.0, 0.0))
        self._taken.discard(robot)

    def take_robot(self, robot: RobotId) -> None:
        """See :meth:`robobt.world.World.take_robot`; its body lies far behind the walls."""
        index = self._index[robot]
        x, y = self.field.outer[0] + 1.0 + 0.5 * index, self.field.outer[1] + 1.0
        self._arenas.place_robot(0, index, (x, y, 0.0, 0.0, 0.0, 0.0))
        self._taken.add(robot)

    def _make_arenas(self) -> Arenas:
        return Arenas(
            self.field, self._limits, self.settings, self.period, keep_history=self._delayed, solver="pymunk"
        )

    def _rows(self) -> FloatArray:
        """Return robots (x, y, heading, vx, vy, omega) and, last, the ball (x, y, z, vx, vy, vz)."""
        rows = np.zeros((len(self._ids) + 1, 6))
        rows[:-1] = self._arenas.robots[0]
        rows[-1, :2] = self._arenas.balls[0, :2]
        rows[-1, 3:5] = self._arenas.balls[0, 2:]
        rows[-1, 2::3] = self._arenas.flight[0, :2]
        return rows

    def _perceive(self) -> FloatArray:
        realism, rng = self.settings.realism, self._rng
        rows = self._past[0].copy() if self._delayed else self._rows()
        robots = len(self._ids)
        rows[:robots, 2] = wrap_angles(rows[:robots, 2])
        hidden = self._sight is not None and not self._sight.look(rows)
        if self._noisy:
            rows[:robots, :2] += rng.normal(0.0, realism.robot_noise, (robots, 2))
            rows[:robots, 2] = wrap_angles(rows[:robots, 2] + rng.normal(0.0, realism.heading_noise, robots))
            rows[robots, :2] += rng.normal(0.0, realism.ball_noise, 2)
        if self._lossy or self._sight is not None:
            gone = np.zeros(robots + 1, dtype=np.bool_)
            if self._lossy:
                chance = np.full(robots + 1, realism.missing_robot)
                chance[robots] = realism.missing_ball
                gone = rng.random(robots + 1) < chance
            gone[robots] |= hidden
            if self._seen is not None:
                rows[gone] = self._seen[gone]
            self._seen = rows
            self._gone = gone.tolist()
        return rows

    def _responses(self) -> list[bool]:
        """Return which robots have reported the ball at their dribbler; a lost report leaves the last."""
        told: list[bool] = self._arenas.contact[0].tolist()
        last = self._felt or [False] * len(told)
        lost = self._rng.random(len(told)) < self.settings.realism.response_loss
        return [before if gone else now for now, before, gone in zip(told, last, lost, strict=True)]

    def _frame(self, robots: list[list[float]], ball: list[float], felt: list[bool] | None = None) -> Frame:
        contact = felt or self._arenas.contact[0].tolist()
        blue = len(self._blue)
        touch = int(self._arenas.touch[0])
        own = robot_states(self._blue, robots[:blue], contact[:blue])
        opponents = robot_states(self._yellow, robots[blue:], contact[blue:])
        if self._taken:
            own = tuple([it for it in own if RobotId(Team.BLUE, it.id) not in self._taken])
            opponents = tuple([it for it in opponents if RobotId(Team.YELLOW, it.id) not in self._taken])
        return Frame(
            self._ticks * self.period,
            self.field,
            BallState(*ball),
            own,
            opponents,
            Team.BLUE,
            self.period,
            last_touch=self._ids[touch] if touch >= 0 else None,
            ball_model=self._ball_model,
        )


_ZERO_COMMAND = (0.0,) * size(COMMAND)


def command_row(command: RobotCommand) -> tuple[float, ...]:
    """Return a command as :meth:`robobt.sim.arenas.Arenas.step` takes it."""
    return (
        command.vx,
        command.vy,
        command.omega,
        command.kick_speed,
        command.kick_trigger == KickTrigger.ON_CONTACT,
        bool(command.dribbler),
        command.kick_angle,
    )


def robot_states(
    known: list[tuple[int, RobotLimits]], rows: list[list[float]], contact: list[bool]
) -> tuple[RobotState, ...]:
    """Return robots by their numbers and limits, rows of x, y, heading, vx, vy, omega and mouths."""
    return tuple(
        [
            RobotState(number, x, y, heading, vx, vy, omega, touching, limits)
            for (number, limits), (x, y, heading, vx, vy, omega), touching in zip(
                known, rows, contact, strict=True
            )
        ]
    )
