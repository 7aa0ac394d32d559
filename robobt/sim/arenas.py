"""N independent fields, stepped and read together."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import ceil
from typing import Literal, get_args

import numpy as np
import pymunk
from numpy.typing import ArrayLike

from robobt.sim.arrays import arena_arrays
from robobt.sim.bodies import SLOP, fill, moment_of_inertia, until_placed, walls_of
from robobt.sim.chance import seeded
from robobt.sim.chipmunk import NO_CALLS, ROW, BodyBuffer
from robobt.sim.contacts.solver import contact_arrays
from robobt.sim.kernels import control_tick
from robobt.sim.parameters import rolling_speeds
from robobt.sim.records import ARENA, COMMAND, KEPT, WHEEL_DRIVE, BoolArray, IntArray, RecordArray, size
from robobt.sim.reports import report
from robobt.sim.settings import SimSettings
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits

Solver = Literal["compiled", "pymunk"]
"""The solver that moves the bodies and resolves contacts."""


class Arenas:
    """The physics core: ``n`` copies of a field with ``len(limits)`` robots each and a ball.

    A match is one arena; vectorised training is hundreds. All arrays are views
    that stay valid. Each arena is independent of the others, bit for bit.

    Args:
        field: dimensions.
        limits: of each robot; None takes the settings' own.
        settings: of the simulator.
        period: control period [s].
        n: number of arenas.
        keep_history: whether to fill ``history``.
        solver: ``pymunk`` has a space for each arena, in which a match is played; ``compiled`` does the same
            over arrays (:mod:`robobt.sim.contacts.solver`), for hundreds of arenas.

    Raises:
        ValueError: no such solver.

    Attributes:
        robots: (n, R, 6) x, y, heading, vx, vy, omega [m, rad, m/s, rad/s].
        balls: (n, 4) x, y, vx, vy [m, m/s].
        flight: (n, 3) the balls' heights [m], 0 on the ground, vertical speeds [m/s], and numbers of
            touch-downs since the kick.
        contact: (n, R) whether the ball is in the robot's mouth.
        kicked: (n, R) whether the robot kicked during the last step.
        touch: (n,) index of the last robot to touch the ball, -1 before the first.
        history: (sub_steps, n, R + 1, 6) states after every sub-step, the
            ball's last, with z and vz for heading and omega; empty unless
            ``keep_history``.
        sub_steps: physics steps per control period.
        late: whether a robot obeys a command only after the period in which it was given.
    """

    def __init__(
        self,
        field: FieldGeometry,
        limits: Sequence[RobotLimits | None],
        settings: SimSettings,
        period: float,
        n: int = 1,
        keep_history: bool = False,
        solver: Solver = "compiled",
    ) -> None:
        if solver not in get_args(Solver):
            raise ValueError(f"solver must be one of {', '.join(get_args(Solver))}, not {solver!r}")
        self.field = field
        self.settings = settings
        self.period = period
        self.sub_steps = max(1, ceil(period / settings.sub_step - 1e-9))
        self.dt = period / self.sub_steps
        count = len(limits)
        walls = walls_of(field)
        self._spaces: list[pymunk.Space] = []
        self._bodies: list[list[pymunk.Body]] = []
        if solver == "pymunk":
            self._spaces = [pymunk.Space() for _ in range(n)]
            for space in self._spaces:
                space.collision_slop = SLOP
            self._bodies = [fill(space, settings, count, walls) for space in self._spaces]
        self._buffer = BodyBuffer(self._spaces, count + 1) if self._spaces else None
        self._arrays = arena_arrays(
            settings,
            limits,
            self.sub_steps if keep_history else 0,
            np.zeros((n, count + 1, ROW)) if self._buffer is None else self._buffer.rows,
            contact_arrays(settings, count, walls, n),
            NO_CALLS if self._buffer is None else self._buffer.calls,
        )
        # These arrays themselves: in a copy, or unpickled, a view of them would be an array of its own.
        self._passed = self._arrays.plain()
        self.robots: FloatArray = self._arrays.robots
        self.balls: FloatArray = self._arrays.balls
        self.flight: FloatArray = self._arrays.flight
        self.contact: BoolArray = self._arrays.contact
        self.kicked: BoolArray = self._arrays.kicked
        self.touch: IntArray = self._arrays.touch
        self.history: FloatArray = self._arrays.history
        self._arrays.bodies[:, :count, :2] = np.array(until_placed(count)).reshape(count, 2)
        # Commands in force before a robot's switch, those after it, and those still on their way.
        self._old, self._new = (np.zeros((n, count, size(COMMAND))) for _ in range(2))
        self._waiting = np.zeros((1, n, count, size(COMMAND)))
        self._newest = 0
        self._periods: IntArray = np.zeros((n, count), dtype=np.int64)
        self._arena_index, self._robot_index = np.ogrid[:n, :count]
        self._delays = np.array([settings.holds_back(own or settings.limits) for own in limits])
        self.delay_commands(np.arange(n), 0.0)
        self.seed(range(n))
        self.late = bool(self._periods.any())

    @property
    def _states(self) -> RecordArray:
        return self._arrays.states.view(ARENA)[..., 0]

    @property
    def arena_parameters(self) -> RecordArray:
        """(n,) :class:`~robobt.sim.records.Parameters`; writing to them randomises arenas."""
        parameters: RecordArray = self._states["parameters"]
        return parameters

    @property
    def wheel_parameters(self) -> RecordArray:
        """(n,) :class:`~robobt.sim.records.Wheels`; may be written to as well."""
        wheels: RecordArray = self._states["wheels"]
        return wheels

    @property
    def robot_parameters(self) -> RecordArray:
        """(n, R) :class:`~robobt.world.records.Limits`; may be written to as well."""
        limits: RecordArray = self._arrays.kept.view(KEPT)["limits"][..., 0]
        return limits

    def delay_commands(self, arenas: IntArray, extra: FloatArray | float) -> None:
        """Let robots obey later than they do by themselves; commands on their way to them are lost.

        Args:
            arenas: indices of the m arenas.
            extra: delay beyond the settings' and the robots' own [s], to the sub-step; (m,) for each arena
                its own.
        """
        extra = np.broadcast_to(np.asarray(extra, dtype=np.float64), (len(arenas),))
        sub_steps = np.rint((extra[:, None] + self._delays) / self.dt).astype(np.int64)
        self._arrays.kept.view(KEPT)["switch"][arenas, :, 0] = sub_steps % self.sub_steps
        self._periods[arenas] = sub_steps // self.sub_steps
        longest = int(self._periods.max(initial=0)) + 1
        if longest > len(self._waiting):
            # In their order, the oldest first, behind others that nobody reads.
            kept = np.roll(self._waiting, -self._newest - 1, axis=0)
            self._waiting = np.zeros((longest, *kept.shape[1:]))
            self._waiting[longest - len(kept) :] = kept
            self._newest = longest - 1
        self._forget_commands(arenas)

    def seed(self, seeds: Iterable[int]) -> None:
        """Seed the random numbers by which the speeds of kicks vary.

        Args:
            seeds: of each arena, at least 0.
        """
        self._states["chance"] = seeded(seeds)

    def _forget_commands(self, arenas: IntArray) -> None:
        self._old[arenas] = self._new[arenas] = 0.0
        self._waiting[:, arenas] = 0.0

    def follow_before(self, arenas: IntArray, commands: FloatArray) -> None:
        """Let robots that were just placed follow these commands until the next ones reach them.

        Args:
            arenas: indices of the m arenas.
            commands: (m, R, 7), see :meth:`step`.
        """
        self._old[arenas] = self._new[arenas] = commands
        self._waiting[:, arenas] = commands
        given, followed = commands.view(COMMAND)[..., 0], self._arrays.kept.view(KEPT)["followed"]
        for axis in ("vx", "vy", "omega"):
            followed[axis][arenas, :, 0] = given[axis]

    def place(self, robots: ArrayLike, balls: ArrayLike, arenas: ArrayLike | None = None) -> None:
        """Reset arenas: set positions and velocities, and drop commands on their way.

        Args:
            robots: (m, R, 3) x, y, heading, at rest, or (m, R, 6) with vx, vy, omega.
            balls: (m, 4) x, y, vx, vy; a moving ball rolls, or slides if the settings have it so.
            arenas: indices of the m arenas; all of them without.
        """
        which = np.arange(len(self.balls)) if arenas is None else np.atleast_1d(np.asarray(arenas))
        count = self.contact.shape[1]
        poses = np.asarray(robots, dtype=np.float64)
        poses = poses.reshape(len(which), count, poses.shape[-1])
        ball = np.asarray(balls, dtype=np.float64).reshape(len(which), 4)
        rows = self._arrays.bodies
        self._read()
        rows[which] = 0.0
        rows[which, :count, : poses.shape[-1]] = poses
        rows[which, count, :2] = ball[:, :2]
        rows[which, count, 3:5] = ball[:, 2:]
        self._set_ball(which, ball[:, 2], ball[:, 3], self.settings.ball.placed_rolls)
        self.flight[which] = 0.0
        kept = self._arrays.kept.view(KEPT)
        kept["cooldown"][which] = kept["charging"][which] = 0.0
        for axis in ("vx", "vy", "omega"):
            kept["followed"][axis][which] = 0.0
        self._drive_anew((which, slice(None)), rows[which, :count])
        self.touch[which] = -1
        self.kicked[which] = False
        self._forget_commands(which)
        self._arrays.contacts.forget(which)
        self._write()

    def _drive_anew(self, which: tuple[int | IntArray, int | IntArray | slice], robots: FloatArray) -> None:
        """Let the wheels of robots that were just placed roll at the robots' speeds."""
        self._arrays.drives[which] = 0.0
        if self.settings.wheels is not None:
            rims = self._arrays.drives.view(WHEEL_DRIVE)["rims"]
            speeds = rolling_speeds(self.settings.wheels, robots)
            for kind in ("speed", "target", "next"):
                rims[kind][(*which, 0)] = speeds

    def place_ball(
        self,
        arena: int,
        x: float,
        y: float,
        vx: float = 0.0,
        vy: float = 0.0,
        rolls: bool = True,
        z: float = 0.0,
        vz: float = 0.0,
    ) -> None:
        """Place one arena's ball; the robots continue unchanged.

        Args:
            arena: its index.
            x: x coordinate of the place [m].
            y: y coordinate of the place [m].
            vx: velocity along x, at rest by default [m/s].
            vy: velocity along y, at rest by default [m/s].
            rolls: whether a moving ball rolls; otherwise it slides, as after a kick.
            z: height above the ground [m].
            vz: vertical speed [m/s].
        """
        count = self.contact.shape[1]
        self._arrays.drives.view(WHEEL_DRIVE)["hinge"]["held"][arena] = 0.0
        self._read()
        row = self._arrays.bodies[arena, count]
        row[:] = 0.0
        row[:2] = x, y
        row[3:5] = vx, vy
        self._set_ball(arena, vx, vy, rolls)
        self.flight[arena] = z, vz, 0.0
        self._arrays.contacts.forget(arena)
        self._write()

    def place_robot(self, arena: int | IntArray, robot: int | IntArray, state: ArrayLike) -> None:
        """Place one robot of an arena; the ball and the other robots continue unchanged.

        Args:
            arena: index of the arena; (m,) to place m robots.
            robot: index of the robot in the arena; (m,) to place m robots.
            state: (6,) x, y, heading, vx, vy, omega [m, rad, m/s, rad/s]; (m, 6) to place m robots.
        """
        self._read()
        self._arrays.bodies[arena, robot] = state
        kept = self._arrays.kept.view(KEPT)
        kept["cooldown"][arena, robot] = kept["charging"][arena, robot] = 0.0
        self._drive_anew((arena, robot), np.asarray(state, dtype=np.float64))
        self._arrays.contacts.forget(arena)
        self._write()

    def weigh(self, arena: int, mass: float) -> None:
        """Give the robots of one arena another mass [kg]."""
        self._arrays.contacts.weigh(arena, mass)
        if self._bodies:
            for body in self._bodies[arena][:-1]:
                body.mass = mass
                body.moment = moment_of_inertia(mass)

    def step(self, commands: FloatArray) -> None:
        """Advance one control period with ``commands``.

        Args:
            commands: (n, R, 6) vx, vy, omega in the robots' frames, kick speed
                (0 none), 1 to kick on contact or 0 for now only, 1 for the
                dribbler; or (n, R, 7) with the kick's angle from the ground [rad],
                0 for a flat one. Must be finite.
        """
        self._old, self._new = self._new, self._old
        given = self._new
        if len(self._waiting) > 1:
            self._newest = (self._newest + 1) % len(self._waiting)
            given = self._waiting[self._newest]
        if commands.shape[-1] == given.shape[-1]:
            np.copyto(given, commands)
        else:
            given[..., :-1] = commands
            given[..., -1] = 0.0
        if len(self._waiting) > 1:
            then = (self._newest - self._periods) % len(self._waiting)
            self._new[:] = self._waiting[then, self._arena_index, self._robot_index]
        control_tick(self._passed, self._old, self._new, self.sub_steps, self.dt)

    def step_bare(self) -> None:
        """Step only pymunk's spaces, by pymunk's own call, as a reference for benchmarks."""
        for space in self._spaces:
            for _ in range(self.sub_steps):
                space.step(self.dt)

    def _read(self) -> None:
        if self._buffer is not None:
            self._buffer.read()

    def _write(self) -> None:
        if self._buffer is not None:
            self._buffer.write()
        arrays = self._arrays
        report(arrays.states, arrays.bodies, self.flight, self.contact, self.robots, self.balls)

    def _set_ball(
        self, arenas: IntArray | int, vx: FloatArray | float, vy: FloatArray | float, rolls: bool
    ) -> None:
        balls = self._states["ball"]
        balls["vx"][arenas], balls["vy"][arenas], balls["twist"][arenas] = vx, vy, 0.0
        balls["spin_x"][arenas], balls["spin_y"][arenas] = (vx, vy) if rolls else (0.0, 0.0)
