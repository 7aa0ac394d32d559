"""N independent fields in one pymunk space, stepped and read together."""

from __future__ import annotations

from collections.abc import Sequence
from math import acos, ceil, cos, isqrt, pi, sin

import numpy as np
import pymunk
from numpy.typing import ArrayLike, NDArray

from robobt.sim import kernels as k
from robobt.sim.chipmunk import BodyBuffer
from robobt.sim.settings import SimSettings
from robobt.world.field import FieldGeometry
from robobt.world.limits import RobotLimits
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_WALL = 0.02
"""Thickness of a goal's walls in the rules [m]."""

_BEYOND = 0.5
"""Thickness of the walls around the field [m]."""

_HULL_CORNERS = 24
_PLATE = 0.006
"""Thickness of the plate that forms a robot's flat front [m]."""

# Collision categories: robots meet robots as discs and the ball with their hull.
_DISC, _HULL, _BALL, _STATIC = 1, 2, 4, 8


class Arenas:
    """The physics core: ``n`` copies of a field with ``len(limits)`` robots each and a ball.

    A match is one arena; vectorised training is hundreds. All arrays are views
    that stay valid, in coordinates of each arena with its centre as origin.

    Args:
        field: dimensions.
        limits: of each robot; None takes the settings' own.
        settings: of the simulator.
        period: control period [s].
        n: number of arenas.

    Attributes:
        robots: (n, R, 6) x, y, heading, vx, vy, omega [m, rad, m/s, rad/s].
        balls: (n, 4) x, y, vx, vy [m, m/s].
        contact: (n, R) whether the ball lies in the robot's mouth.
        kicked: (n, R) whether the robot kicked during the last step.
        touch: (n,) index of the last robot to touch the ball, -1 before the first.
        history: (sub_steps, n, R + 1, 6) states after every sub-step in space
            coordinates, the ball's last; empty unless ``keep_history``.
        sub_steps: physics steps a control period.
        arena_parameters, robot_parameters: what the kernels use; columns are
            named in :mod:`robobt.sim.kernels`. Writing to them randomises arenas.
        switch: (n,) sub-step of a period from which a command is in force, the
            part of the command delay that is no whole period; also to be written to.
    """

    def __init__(
        self,
        field: FieldGeometry,
        limits: Sequence[RobotLimits | None],
        settings: SimSettings,
        period: float,
        n: int = 1,
        keep_history: bool = False,
    ) -> None:
        self.field = field
        self.settings = settings
        self.period = period
        self.sub_steps = max(1, ceil(period / settings.sub_step - 1e-9))
        self.dt = period / self.sub_steps
        count = len(limits)
        pitch_x = field.length + 2 * (field.margin + _BEYOND) + 1.0
        pitch_y = field.width + 2 * (field.margin + _BEYOND) + 1.0
        columns = isqrt(n - 1) + 1
        self.origins = np.array(
            [((i % columns) * pitch_x, (i // columns) * pitch_y) for i in range(n)], dtype=np.float64
        )
        walls = _walls(field)
        self._walls = np.array([box for box, _ in walls])
        self._space = pymunk.Space()
        # Chipmunk's default slop is made for pixels; ours is a tenth of a millimetre.
        self._space.collision_slop = 1e-4
        self._bodies = _fill(self._space, settings, self.origins, count, walls)
        self._buffer = BodyBuffer(self._space, n * (count + 1))
        self.robots = np.zeros((n, count, 6))
        self.balls = np.zeros((n, 4))
        self.contact: NDArray[np.bool_] = np.zeros((n, count), dtype=np.bool_)
        self.kicked: NDArray[np.bool_] = np.zeros((n, count), dtype=np.bool_)
        self.touch: NDArray[np.int64] = np.full(n, -1, dtype=np.int64)
        self.history = np.zeros((self.sub_steps if keep_history else 0, n, count + 1, 6))
        self.arena_parameters = np.tile(_arena_row(settings), (n, 1))
        self.robot_parameters = np.tile(
            np.array([_robot_row(own or settings.limits) for own in limits]).reshape(
                1, count, k.ROBOT_PARAMETERS
            ),
            (n, 1, 1),
        )
        self._velocity = np.zeros((n, 2))
        self._spin = np.zeros((n, 2))
        self._cooldown = np.zeros((n, count))
        delay = round(settings.realism.command_delay / self.dt)
        self.switch: NDArray[np.int64] = np.full(n, delay % self.sub_steps, dtype=np.int64)
        # The command in force before the switch, the one after it, and those still on their way.
        self._pipeline = [np.zeros((n, count, k.COMMAND)) for _ in range(delay // self.sub_steps + 2)]

    def place(self, robots: ArrayLike, balls: ArrayLike, arenas: ArrayLike | None = None) -> None:
        """Set arenas up anew: positions and velocities, no command on its way.

        Args:
            robots: (m, R, 3) x, y, heading, at rest, or (m, R, 6) with vx, vy, omega.
            balls: (m, 4) x, y, vx, vy; a moving ball rolls.
            arenas: indices of the m arenas; all of them without.
        """
        which = np.arange(len(self.origins)) if arenas is None else np.atleast_1d(np.asarray(arenas))
        count = self.contact.shape[1]
        poses = np.asarray(robots, dtype=np.float64)
        poses = poses.reshape(len(which), count, poses.shape[-1])
        ball = np.asarray(balls, dtype=np.float64).reshape(len(which), 4)
        rows = self._buffer.rows.reshape(len(self.origins), count + 1, 6)
        self._buffer.read()
        origin = self.origins[which]
        rows[which] = 0.0
        rows[which, :count, : poses.shape[-1]] = poses
        rows[which, :count, :2] += origin[:, None, :]
        rows[which, count, :2] = ball[:, :2] + origin
        rows[which, count, 3:5] = ball[:, 2:]
        self._velocity[which] = ball[:, 2:]
        self._spin[which] = ball[:, 2:]
        self._cooldown[which] = 0.0
        self.touch[which] = -1
        self.kicked[which] = False
        for commands in self._pipeline:
            commands[which] = 0.0
        self._buffer.write()
        self._refresh()

    def place_ball(
        self, arena: int, x: float, y: float, vx: float = 0.0, vy: float = 0.0, rolls: bool = True
    ) -> None:
        """Put one arena's ball somewhere; the robots go on as they were.

        Args:
            x, y: where [m]; vx, vy: its velocity, at rest by default [m/s].
            rolls: whether a moving ball rolls; one that does not slides, as after a kick.
        """
        count = self.contact.shape[1]
        self._buffer.read()
        row = self._buffer.rows[arena * (count + 1) + count]
        row[:] = 0.0
        row[:2] = self.origins[arena] + (x, y)
        row[3:5] = vx, vy
        self._velocity[arena] = vx, vy
        self._spin[arena] = (vx, vy) if rolls else (0.0, 0.0)
        self._buffer.write()
        self._refresh()

    def place_robot(self, arena: int, robot: int, state: ArrayLike) -> None:
        """Put one robot of an arena somewhere; the ball and the others go on as they were.

        Args:
            state: (6,) x, y, heading, vx, vy, omega [m, rad, m/s, rad/s].
        """
        count = self.contact.shape[1]
        self._buffer.read()
        row = self._buffer.rows[arena * (count + 1) + robot]
        row[:] = state
        row[:2] += self.origins[arena]
        self._cooldown[arena, robot] = 0.0
        self._buffer.write()
        self._refresh()

    def weigh(self, arena: int, mass: float) -> None:
        """Give the robots of one arena another mass [kg]."""
        count = self.contact.shape[1]
        for body in self._bodies[arena * (count + 1) : arena * (count + 1) + count]:
            body.mass = mass
            body.moment = _moment(mass)

    def step(self, commands: NDArray[np.float64]) -> None:
        """Let one control period pass under ``commands``.

        Args:
            commands: (n, R, 6) vx, vy, omega in the robots' frames, kick speed
                (0 none), 1 to kick on contact or 0 for now only, 1 for the
                dribbler. Must be finite.
        """
        oldest = self._pipeline.pop(0)
        np.copyto(oldest, commands)
        self._pipeline.append(oldest)
        buffer = self._buffer
        k.control_tick(
            buffer.handles,
            buffer.cursor,
            buffer.rows,
            self.origins,
            self._walls,
            self.arena_parameters,
            self.robot_parameters,
            self._pipeline[0],
            self._pipeline[1],
            self.switch,
            self.sub_steps,
            self.dt,
            self._velocity,
            self._spin,
            self._cooldown,
            self.contact,
            self.touch,
            self.kicked,
            self.robots,
            self.balls,
            self.history,
        )

    def step_bare(self) -> None:
        """Step the space alone, by pymunk's own call: what benchmarks compare with."""
        for _ in range(self.sub_steps):
            self._space.step(self.dt)

    def _refresh(self) -> None:
        k.report(
            self._buffer.rows,
            self.origins,
            self.arena_parameters,
            self._velocity,
            self.contact,
            self.robots,
            self.balls,
        )


def _arena_row(settings: SimSettings) -> NDArray[np.float64]:
    ball, dribbler, kicker, body = settings.ball, settings.dribbler, settings.kicker, settings.body
    row = np.zeros(k.ARENA_PARAMETERS)
    row[k.SLIDE] = ball.slide_deceleration
    # Spin gained per speed lost, so that a ball without spin rolls at switch_share of its speed.
    row[k.SPIN_GAIN] = ball.switch_share / (1.0 - ball.switch_share)
    row[k.ROLL] = ball.roll_deceleration
    row[k.STOP_SPEED] = ball.stop_speed
    row[k.FACE] = body.face
    row[k.HALF_MOUTH] = body.mouth_width / 2
    row[k.SENSOR] = body.sensor_depth
    row[k.GLUE] = float(dribbler.kind == "glue")
    row[k.PULL] = dribbler.pull
    row[k.SIDE] = dribbler.side
    row[k.REACH] = dribbler.reach
    row[k.CENTRING] = dribbler.centring
    row[k.IDLE_HOLD] = dribbler.idle_hold
    row[k.KICK_MAX] = kicker.max_speed
    row[k.KICK_DAMPING] = kicker.damping
    row[k.RECHARGE] = kicker.recharge
    row[k.BALL_R] = BALL_RADIUS
    row[k.ROBOT_R] = ROBOT_RADIUS
    return row


def _robot_row(limits: RobotLimits) -> NDArray[np.float64]:
    row = np.zeros(k.ROBOT_PARAMETERS)
    row[k.MAX_SPEED] = limits.max_speed
    row[k.FORWARD_UP] = limits.acceleration
    row[k.FORWARD_DOWN] = limits.braking
    row[k.SIDE_UP] = limits.lateral_acceleration
    row[k.SIDE_DOWN] = limits.lateral_braking
    row[k.MAX_TURN] = limits.max_turn
    row[k.TURN_RATE] = limits.turn_acceleration
    return row


_Box = tuple[float, float, float, float]


def _walls(field: FieldGeometry) -> list[tuple[_Box, str]]:
    """The static boxes of a field: surrounding walls, and per goal two sides and a back."""
    outer_x, outer_y = field.half_length + field.margin, field.half_width + field.margin
    far_x, far_y = outer_x + _BEYOND, outer_y + _BEYOND
    boxes: list[tuple[_Box, str]] = [
        ((-far_x, outer_y, far_x, far_y), "wall"),
        ((-far_x, -far_y, far_x, -outer_y), "wall"),
        ((outer_x, -far_y, far_x, far_y), "wall"),
        ((-far_x, -far_y, -outer_x, far_y), "wall"),
    ]
    post, line = field.goal_width / 2, field.half_length
    back = line + field.goal_depth
    for sign in (1.0, -1.0):
        # The rules prolong the sides to the wall, so nothing gets behind a goal.
        ends = sorted((sign * line, sign * (outer_x + _BEYOND)))
        boxes.append(((ends[0], post, ends[1], post + _WALL), "goal"))
        boxes.append(((ends[0], -post - _WALL, ends[1], -post), "goal"))
        ends = sorted((sign * back, sign * max(back + _WALL, outer_x + _BEYOND)))
        boxes.append(((ends[0], -post - _WALL, ends[1], post + _WALL), "goal_back"))
    return boxes


def _fill(
    space: pymunk.Space,
    settings: SimSettings,
    origins: NDArray[np.float64],
    robots: int,
    walls: Sequence[tuple[_Box, str]],
) -> list[pymunk.Body]:
    contact, body = settings.contact, settings.body
    material = {
        "wall": (contact.wall_restitution, contact.wall_friction),
        "goal": (contact.goal_restitution, contact.goal_friction),
        "goal_back": (contact.goal_back_restitution, contact.goal_friction),
    }
    hull = _hull(body.face - _PLATE)
    plate = _plate(body.face)
    bodies = []
    for origin_x, origin_y in origins:
        for (x0, y0, x1, y1), kind in walls:
            corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
            box = pymunk.Poly(space.static_body, [(origin_x + x, origin_y + y) for x, y in corners])
            _finish(box, *material[kind], _STATIC, _DISC | _BALL)
            space.add(box)
        for i in range(robots):
            robot = pymunk.Body(body.mass, _moment(body.mass))
            # Somewhere of their own until placed, so that no two start inside each other.
            robot.position = (origin_x, origin_y + 3 * ROBOT_RADIUS * (i + 1))
            disc = pymunk.Circle(robot, ROBOT_RADIUS)
            shell = pymunk.Poly(robot, hull)
            front = pymunk.Poly(robot, plate)
            # Chipmunk multiplies the two shapes' values: robots share theirs evenly.
            share = contact.robot_restitution**0.5, contact.robot_friction**0.5
            _finish(disc, *share, _DISC, _DISC | _STATIC)
            _finish(shell, contact.hull_restitution, contact.hull_friction, _HULL, _BALL)
            _finish(front, contact.front_restitution, contact.front_friction, _HULL, _BALL)
            space.add(robot, disc, shell, front)
            bodies.append(robot)
        # Spin about the vertical axis matters to nobody: the ball cannot turn.
        ball = pymunk.Body(settings.ball.mass, float("inf"))
        ball.position = (origin_x, origin_y)
        round_ = pymunk.Circle(ball, BALL_RADIUS)
        _finish(round_, 1.0, 1.0, _BALL, _HULL | _STATIC)
        space.add(ball, round_)
        bodies.append(ball)
    return bodies


def _moment(mass: float) -> float:
    """Moment of inertia of a robot, as of a disc [kg m^2]."""
    return 0.5 * mass * ROBOT_RADIUS**2


def _finish(shape: pymunk.Shape, restitution: float, friction: float, category: int, mask: int) -> None:
    shape.elasticity = restitution
    shape.friction = friction
    shape.filter = pymunk.ShapeFilter(categories=category, mask=mask)


def _hull(chord: float) -> list[tuple[float, float]]:
    """The round part of a robot: a polygon around the disc, cut flat ``chord`` ahead of the centre.

    Its edges touch the disc, so that a ball that has come to the disc meets it.
    """
    opening = acos(chord / ROBOT_RADIUS)
    step = (2 * pi - 2 * opening) / _HULL_CORNERS
    radius = ROBOT_RADIUS / cos(step / 2)
    angles = [opening + step * (i + 0.5) for i in range(_HULL_CORNERS)]
    ends = [(chord, radius * sin(opening)), (chord, -radius * sin(opening))]
    return [ends[0], *[(radius * cos(angle), radius * sin(angle)) for angle in angles], ends[1]]


def _plate(face: float) -> list[tuple[float, float]]:
    """The flat front as a thin box, so that it can be of another material than the hull."""
    half = (ROBOT_RADIUS**2 - face**2) ** 0.5
    return [(face - 2 * _PLATE, -half), (face, -half), (face, half), (face - 2 * _PLATE, half)]
