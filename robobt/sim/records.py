"""Records by which compiled code accesses the simulator's arrays.

The arrays themselves hold plain numbers: numba takes twice as long to look at the type of a record array
when Python calls it. ``numbers.view(BODY)[..., 0]`` sees the last axis as records, in numpy as in compiled
code, and shares the memory. A class here tells readers and mypy what a record's fields are;
:func:`~robobt.world.compiled.record_dtype` makes numpy's type of it.
"""

from __future__ import annotations

from typing import (
    Annotated,
    NamedTuple,
    Protocol,
    TypeVar,
    overload,
)

import numpy as np
from numpy.typing import NDArray

from robobt.sim.robot_settings import BodySettings, DribblerSettings, KickerSettings
from robobt.sim.settings import BallSettings, ContactSettings
from robobt.world.compiled import Index, record_dtype
from robobt.world.records import BALL, ROBOT, Limits, Robot

BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]
RecordArray = NDArray[np.void]
Record = TypeVar("Record", covariant=True)

Body = Robot
"""What the solver moves: a robot, or the ball along the ground."""


class Records(Protocol[Record]):
    """An array of records."""

    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int) -> Record: ...
    @overload
    def __getitem__(self, index: slice) -> Records[Record]: ...


def size(kind: np.dtype[np.void]) -> int:
    """Return how many numbers an array of floats has for a record."""
    return kind.itemsize // np.dtype(np.float64).itemsize


def filled(kind: np.dtype[np.void], source: object, **others: object) -> RecordArray:
    """Return a record: each field from ``others``, or from what ``source`` calls the same."""
    names = kind.names or ()
    return np.array(
        tuple([others[name] if name in others else getattr(source, name) for name in names]), kind
    )


class Command:
    """A robot's command, as :class:`robobt.world.RobotCommand` [m/s, rad/s, rad]; flags are 0 or 1."""

    vx: float
    vy: float
    omega: float
    kick_speed: float
    on_contact: float
    dribbler: float
    kick_angle: float


class Flight:
    """A ball's height above where it lies, how fast it rises, its touch-downs since the kick [m, m/s]."""

    z: float
    vz: float
    hops: float


class Touch:
    """The last robot to touch a ball, -1 before the first."""

    robot: Index


class SimulatedBall:
    """How a ball moves, and what dribblers and kickers do with it in a step.

    Velocity, spin as the velocity at which it would roll, turning about the vertical [m/s, rad/s]; mean
    velocity in the step [m/s], the dribblers' pull [m/s^2]; the robot that carries it and the last that
    kicked it in the step, -1 for none; whether any dribbler holds it, and whether several carry it.
    """

    vx: float
    vy: float
    spin_x: float
    spin_y: float
    twist: float
    move_x: float
    move_y: float
    pull_x: float
    pull_y: float
    carrier: Index
    kicker: Index
    held: Index
    shared: Index


class Rim:
    """A wheel's state: speed, where it is to go, what comes after the next frame [m/s], impulses [N s].

    They are those of the last step: along the inner and the outer edge of the rim, and across it.
    """

    speed: float
    target: float
    next: float
    along: Annotated[list[float], 2]
    across: float


class Hinge:
    """Whether a robot's dribbler holds the ball (0 or 1), and where in the robot's frame [m]."""

    held: float
    ahead: float
    aside: float


class Followed:
    """The velocity that a robot's controller follows, in the robot's frame [m/s, rad/s]."""

    vx: float
    vy: float
    omega: float


class Kept:
    """What is kept of a robot beside its body.

    Its limits, the time until dribbler and kicker are ready and until the kicker is charged [s], the sub-step
    of a period from which a command is in force, and the velocity that it follows.
    """

    limits: Limits
    cooldown: float
    charging: float
    switch: Index
    followed: Followed


class WheelDrive:
    """What is kept of a robot with wheels.

    The acceleration that the loads follow [m/s^2], the time to the next frame [s], the robot's velocity and
    heading when the frame began [m/s, rad, rad/s], and how it holds the ball.
    """

    lean_ahead: float
    lean_aside: float
    clock: float
    vx: float
    vy: float
    heading: float
    omega: float
    hinge: Hinge
    rims: Annotated[Records[Rim], 4]


class Wheel:
    """Where a wheel is, and the load on it [N] at rest and by acceleration ahead and aside [kg]."""

    cos: float
    sin: float
    load_rest: float
    load_ahead: float
    load_aside: float


class Wheels:
    """Parameters of a robot's wheels, as :class:`~robobt.sim.robot_settings.WheelSettings`.

    A mass of 0 means that it has none. ``rim_mass`` is what a wheel adds to the inertia along its rim [kg],
    ``motor`` the most its motor pushes with [N], ``gyro_ahead`` and ``gyro_aside`` how much it resists
    being turned.
    """

    mass: float
    inertia: float
    inner_edge: float
    outer_edge: float
    command_radius: float
    tangent_friction: float
    axial_friction: float
    acceleration: float
    frame: float
    load_lag: float
    centre: float
    rim_mass: float
    motor: float
    gyro_ahead: float
    gyro_aside: float
    motor_ahead: float
    motor_aside: float
    each: Annotated[Records[Wheel], 4]


class Parameters:
    """Parameters of an arena: settings, and what follows from them.

    ``spin_gain`` is the spin that a sliding ball gains per speed lost; ``glue`` whether the dribbler is one
    (0 or 1); ``roller`` how fast its roller's surface moves, 0 for another dribbler [m/s]; ``kicker_angle``
    that of every chip, 0 for the one commanded [rad]. ``front`` is the foremost of the body, ``half_opening``
    and ``rounding`` of its jaws [m]. ``core`` and the others are 0 for robots without a shell [m].
    """

    ball: BallSettings
    body: BodySettings
    dribbler: DribblerSettings
    kicker: KickerSettings
    contact: ContactSettings
    spin_gain: float
    half_mouth: float
    glue: float
    roller: float
    kicker_angle: float
    front: float
    half_opening: float
    rounding: float
    core: float
    solid: float
    half_wheel: float
    softness: float


class ArenaState:
    """What is kept of an arena; ``chance`` is the state of its random numbers."""

    chance: Index
    ball: SimulatedBall
    parameters: Parameters
    wheels: Wheels


class WallBox:
    """A box, its restitution and friction."""

    x0: float
    y0: float
    x1: float
    y1: float
    bounce: float
    friction: float


class Edge:
    """An edge of a hull, from one point to another in the robot's frame [m]."""

    x0: float
    y0: float
    x1: float
    y1: float


class HullPart:
    """A part of a hull: its edges, the radius of its rounded corners [m], restitution and friction."""

    first: float
    last: float
    rounding: float
    bounce: float
    friction: float


class Solver:
    """The solver's numbers.

    Passes, bias, overlap that is allowed [m], steps for which a contact is remembered, restitution and
    friction of two robots, how far from the centre of the field the nearest wall is along either axis, and
    how far a hull reaches [m].
    """

    iterations: float
    bias: float
    allowed: float
    persistence: float
    bounce: float
    friction: float
    clear_x: float
    clear_y: float
    reach: float


class Masses:
    """Inverse masses and moment of inertia of an arena's bodies [1/kg, 1/(kg m^2)], and its steps so far."""

    robot: float
    robot_turn: float
    ball: float
    clock: Index


class Bias:
    """A velocity that lasts for a step and undoes overlap [m/s, rad/s]."""

    vx: float
    vy: float
    omega: float


class ContactMemory:
    """What is remembered of a pair: impulses along and across the normal [N s], and its last contact."""

    along: float
    across: float
    when: float


class Contact:
    """A contact of two bodies, and the index of their pair.

    Normal, its place seen from either body, mass along and across the normal, the velocities that overlap and
    bounce ask for, friction, the impulses so far, and whether those are of the last step. Where a contact is
    found, its gap and restitution stand where those velocities will.
    """

    nx: float
    ny: float
    r1x: float
    r1y: float
    r2x: float
    r2y: float
    normal_mass: float
    tangent_mass: float
    push: float
    back: float
    friction: float
    normal: float
    tangent: float
    lift: float
    warm: float
    one: Index
    other: Index
    pair: Index


class Moving:
    """A body while contacts are solved: velocity, the one that undoes overlap, inverse mass and inertia."""

    vx: float
    vy: float
    omega: float
    bias_vx: float
    bias_vy: float
    bias_omega: float
    mass: float
    inertia: float


class Halfway:
    """An arena within a physics step.

    Number of contacts, and of those whose impulses may still change, the largest change in the last pass
    [N s], whether the ball flies high (0 or 1), and where it is [m].
    """

    contacts: Index
    unsettled: Index
    most: float
    high: Index
    x: float
    y: float


class Rub:
    """A ball's contact with a robot's roller or jaw, for the length of a step.

    Whether there is one, its normal towards the ball, the robot's velocity there, the least speed of parting,
    friction, how fast the surface moves down, impulses per mass of the ball.
    """

    near: float
    nx: float
    ny: float
    vx: float
    vy: float
    part: float
    friction: float
    down: float
    press: float
    aside: float
    lift: float


class Front:
    """A robot's roller and two jaws, and whether the roller turns (0 or 1)."""

    driven: float
    rubs: Annotated[Records[Rub], 3]


COMMAND = record_dtype(Command)
BODY, SEEN_BALL = ROBOT, BALL
FLIGHT = record_dtype(Flight)
TOUCH = record_dtype(Touch)
KEPT = record_dtype(Kept)
WHEEL_DRIVE = record_dtype(WheelDrive)
WHEELS = record_dtype(Wheels)
PARAMETERS = record_dtype(Parameters)
ARENA = record_dtype(ArenaState)
WALL = record_dtype(WallBox)
EDGE = record_dtype(Edge)
PART = record_dtype(HullPart)
SOLVER = record_dtype(Solver)
MASSES = record_dtype(Masses)
BIAS = record_dtype(Bias)
CONTACT_MEMORY = record_dtype(ContactMemory)
CONTACT = record_dtype(Contact)
MOVING = record_dtype(Moving)
HALFWAY = record_dtype(Halfway)
FRONT = record_dtype(Front)


class Arena(NamedTuple):
    """One arena with R robots as the kernels see it."""

    bodies: Records[Body]  # (R + 1,), the ball's last
    robots: Records[Body]  # (R,) of those bodies
    body: Body  # the ball's
    ball: SimulatedBall
    air: Flight
    touch: Touch
    parameters: Parameters
    wheels: Wheels
    state: ArenaState
    kept: Records[Kept]  # (R,)
    drives: Records[WheelDrive]  # (R,)
    kicked: BoolArray  # (R,) who kicked in this period
    fronts: Records[Front]  # (R,) scratch
    walls: Records[WallBox]  # (W,) relative to the arena's centre
