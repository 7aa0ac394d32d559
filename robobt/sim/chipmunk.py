"""The one place that talks to pymunk's C library: batched reads and writes, and steps.

``pymunk.batch`` reads or writes every body of a space in one C call, but calling
it from Python costs about as much as a few hundred physics steps of a small
space. Here the same C functions are called from compiled code, by address, so a
whole control tick runs without returning to Python. Within it even the batch costs
more than it has to: it computes each body's rotation, which the step does again. :func:`load_bodies` and
:func:`store_bodies` therefore read and write the numbers where Chipmunk has them. pymunk declares its batch
interface experimental, and Chipmunk its structures private: whatever of them changes is found when arenas are
made, and mended here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, cast

import numpy as np
import pymunk
from llvmlite import ir
from numba import types
from numba.core.typing.templates import Signature
from numba.extending import intrinsic
from numpy.typing import NDArray
from pymunk._chipmunk_cffi import ffi, lib

from robobt.sim.records import BODY, Body, IntArray, Records, size
from robobt.world.compiled import Index, compiled_merged, record_dtype

ROW = size(BODY)
"""Numbers of a body's row: x, y, angle, vx, vy, angular velocity."""

_X_OFFSET, _Y_OFFSET, _ANGLE_OFFSET, _VX_OFFSET, _VY_OFFSET, _OMEGA_OFFSET = _BODY_OFFSETS = (
    64,
    72,
    112,
    80,
    88,
    120,
)
"""Where in a ``cpBody`` the numbers of its row lie [bytes]."""


Generated = tuple[Signature, Callable[..., ir.Value]]
"""What numba wants of an intrinsic: its signature, and the function that writes its code."""


@intrinsic
def _call_step(_context: object, _function: object, _space: object, _dt: object) -> Generated:
    """Call ``cpSpaceStep(space, dt)`` by address, from compiled code."""
    signature = types.void(types.uint64, types.uint64, types.float64)

    def generate(
        context: Any, builder: ir.IRBuilder, _signature: object, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        prototype = ir.FunctionType(ir.VoidType(), [ir.IntType(64), ir.DoubleType()])
        call = builder.inttoptr(arguments[0], prototype.as_pointer())
        builder.call(call, [arguments[1], arguments[2]])
        return context.get_dummy_value()

    return signature, generate


@intrinsic
def _call_each_body(
    _context: object, _function: object, _space: object, _callback: object, _data: object
) -> Generated:
    """Call ``cpSpaceEachBody(space, callback, data)`` by address, from compiled code."""
    signature = types.void(types.uint64, types.uint64, types.uint64, types.uint64)

    def generate(
        context: Any, builder: ir.IRBuilder, _signature: object, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        word = ir.IntType(64)
        prototype = ir.FunctionType(ir.VoidType(), [word, word, word])
        call = builder.inttoptr(arguments[0], prototype.as_pointer())
        builder.call(call, [arguments[1], arguments[2], arguments[3]])
        return context.get_dummy_value()

    return signature, generate


@intrinsic
def _load(_context: object, _address: object) -> Generated:
    """Return the number at an address, in compiled code."""
    signature = types.float64(types.uint64)

    def generate(
        _context: Any, builder: ir.IRBuilder, _signature: object, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        return builder.load(builder.inttoptr(arguments[0], ir.DoubleType().as_pointer()))

    return signature, generate


@intrinsic
def _store(_context: object, _address: object, _number: object) -> Generated:
    """Write a number to an address, from compiled code."""
    signature = types.void(types.uint64, types.float64)

    def generate(
        context: Any, builder: ir.IRBuilder, _signature: object, arguments: Sequence[ir.Value]
    ) -> ir.Value:
        builder.store(arguments[1], builder.inttoptr(arguments[0], ir.DoubleType().as_pointer()))
        return context.get_dummy_value()

    return signature, generate


# numba passes the first argument itself.
load = cast(Callable[[np.uint64], float], _load)
store = cast(Callable[[np.uint64, float], None], _store)
call_step = cast(Callable[..., None], _call_step)
call_each_body = cast(Callable[..., None], _call_each_body)


@compiled_merged
def load_bodies(places: NDArray[np.uint64], bodies: Records[Body]) -> None:
    """Fill ``bodies`` (k,) from those at the addresses ``places`` (k,), after a step."""
    for i in range(places.shape[0]):
        place, body = places[i], bodies[i]
        # As ``cpBodyGetPosition``, which knows no negative zero.
        body.x = load(place + np.uint64(_X_OFFSET)) + 0.0
        body.y = load(place + np.uint64(_Y_OFFSET)) + 0.0
        body.heading = load(place + np.uint64(_ANGLE_OFFSET))
        body.vx = load(place + np.uint64(_VX_OFFSET))
        body.vy = load(place + np.uint64(_VY_OFFSET))
        body.omega = load(place + np.uint64(_OMEGA_OFFSET))


@compiled_merged
def store_bodies(places: NDArray[np.uint64], bodies: Records[Body]) -> None:
    """Set the bodies at the addresses ``places`` (k,) from ``bodies`` (k,), right before a step.

    The step computes what follows from them; without one, ``cpSpaceEachBody`` has to write them.
    """
    for i in range(places.shape[0]):
        place, body = places[i], bodies[i]
        store(place + np.uint64(_X_OFFSET), body.x)
        store(place + np.uint64(_Y_OFFSET), body.y)
        store(place + np.uint64(_ANGLE_OFFSET), body.heading)
        store(place + np.uint64(_VX_OFFSET), body.vx)
        store(place + np.uint64(_VY_OFFSET), body.vy)
        store(place + np.uint64(_OMEGA_OFFSET), body.omega)


class Functions:
    """Addresses of the C library's functions: a step, a visit of each body, what writes a visited one."""

    step: Index
    each: Index
    write: Index


class Handle:
    """Addresses of a space and of its batch descriptor."""

    space: Index
    batch: Index


FUNCTIONS, HANDLE = record_dtype(Functions), record_dtype(Handle)


class Calls(NamedTuple):
    """What compiled code needs to call pymunk."""

    functions: IntArray  # (1, size(FUNCTIONS))
    handles: IntArray  # (spaces, size(HANDLE))
    places: NDArray[np.uint64]  # (spaces, bodies) addresses of the bodies
    # (spaces, k): where in its rows a space's next batched call starts is the first number of a row, to be
    # set to 0 before each.
    cursors: NDArray[np.int32]


NO_CALLS = Calls(
    np.zeros((1, size(FUNCTIONS)), dtype=np.int64),
    np.zeros((0, size(HANDLE)), dtype=np.int64),
    np.zeros((0, 0), dtype=np.uint64),
    np.zeros((0, 1), dtype=np.int32),
)
"""The same where there is no space to step."""


class BodyBuffer:
    """The bodies of equal spaces as rows of one numpy array, shared with the C library.

    Args:
        spaces: of an arena each.
        bodies: how many each of them has.

    Attributes:
        rows: (spaces, stride, 6) x, y, angle, vx, vy, angular velocity of each space's bodies in
            the order in which they were added, then spare rows [m, rad, m/s, rad/s].
        stride: rows of a space.
        calls: what compiled code needs to call pymunk.
    """

    def __init__(self, spaces: Sequence[pymunk.Space], bodies: int) -> None:
        # The C side visits the static body last and checks for room after every
        # number it stores: one row for the static body, one spare so that it
        # never reallocates memory that numpy owns.
        self.stride = bodies + 2
        count = len(spaces)
        self.rows: NDArray[np.float64] = np.zeros((count, self.stride, ROW))
        self._spaces, self._bodies = list(spaces), bodies
        self._floats = ffi.new("pmFloatArray[]", count)
        self._ints = ffi.new("pmIntArray *")
        self._memory = ffi.from_buffer("cpFloat[]", self.rows)
        self._batches = ffi.new("pmBatchedData[]", count)
        for k in range(count):
            floats, batch = self._floats[k], self._batches[k]
            floats.arr = self._memory + k * self.stride * ROW
            floats.max = self.stride * ROW
            floats.num = 0
            batch.fields = lib.POSITION | lib.ANGLE | lib.VELOCITY | lib.ANGULAR_VELOCITY
            batch.floatArray = self._floats + k
            batch.intArray = self._ints
        every = np.frombuffer(ffi.buffer(self._floats), dtype=np.int32)
        self._cursors: NDArray[np.int32] = every.reshape(count, -1)
        names = "cpSpaceStep", "cpSpaceEachBody", "pmSpaceBodySetIteratorFuncBatched"
        functions: IntArray = np.array([[_address(ffi.addressof(lib, name)) for name in names]])
        places: NDArray[np.uint64] = np.array(
            [[_address(body._body) for body in space.bodies] for space in spaces], dtype=np.uint64
        )
        handles: IntArray = np.array(
            [[_address(space._space), _address(self._batches + k)] for k, space in enumerate(spaces)]
        )
        self.calls = Calls(functions, handles, places, self._cursors)
        self._check_order()
        _check_places()

    def read(self) -> None:
        """Fill ``rows`` from the spaces."""
        self._each(ffi.addressof(lib, "pmSpaceBodyGetIteratorFuncBatched"))

    def write(self) -> None:
        """Set the spaces' bodies from ``rows``."""
        self._each(ffi.addressof(lib, "pmSpaceBodySetIteratorFuncBatched"))

    def _each(self, callback: object) -> None:
        self._cursors[:, 0] = 0
        for k, space in enumerate(self._spaces):
            lib.cpSpaceEachBody(space._space, callback, self._batches + k)

    def _check_order(self) -> None:
        self.read()
        for k, space in enumerate(self._spaces):
            found = self._cursors[k, 0] // ROW
            expected = [list(body.position) for body in space.bodies]
            if found != self._bodies + 1 or self.rows[k, : self._bodies, :2].tolist() != expected:
                raise RuntimeError(
                    f"pymunk {pymunk.version} visits {found} bodies in another order than they were added: "
                    "its batch interface has changed"
                )


def _check_places() -> None:
    body = pymunk.Body(1.0, 1.0)
    body.position, body.angle, body.velocity, body.angular_velocity = (1.5, 2.5), 3.5, (4.5, 5.5), 6.5
    numbers = ffi.cast("double *", body._body)
    if [numbers[place // 8] for place in _BODY_OFFSETS] != [1.5, 2.5, 3.5, 4.5, 5.5, 6.5]:
        raise RuntimeError(
            f"pymunk {pymunk.version} keeps a body's state in other places: its structures have changed"
        )


def _address(pointer: object) -> int:
    return int(ffi.cast("uintptr_t", pointer))
