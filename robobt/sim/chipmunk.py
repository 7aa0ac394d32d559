"""The one place that talks to pymunk's C library: batched reads and writes, and steps.

``pymunk.batch`` reads or writes every body of a space in one C call, but calling
it from Python costs about as much as a few hundred physics steps of a small
space. Here the same C functions are called from compiled code, by address, so a
whole control tick runs without returning to Python. pymunk declares its batch
interface experimental: whatever of it changes is mended here.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np
import pymunk
from llvmlite import ir
from numba import types
from numba.core.typing.templates import Signature
from numba.extending import intrinsic
from numpy.typing import NDArray
from pymunk._chipmunk_cffi import ffi, lib

ROW = 6
"""Numbers of a body's row: x, y, angle, vx, vy, angular velocity."""


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


# numba passes the first argument itself.
call_step = cast(Callable[..., None], _call_step)
call_each_body = cast(Callable[..., None], _call_each_body)


class BodyBuffer:
    """The bodies of equal spaces as rows of one numpy array, shared with the C library.

    Args:
        spaces: of an arena each.
        bodies: how many each of them has.

    Attributes:
        rows: (spaces * stride, 6) x, y, angle, vx, vy, angular velocity of each space's bodies in
            the order in which they were added, then spare rows [m, rad, m/s, rad/s].
        stride: rows of a space.
        calls: addresses for compiled code: step, each-body, the reading and the writing callback.
        handles: (spaces, 2) addresses of each space and its batch descriptor.
        cursors: (spaces, k); where in its rows a space's next batched call starts is the first number of
            a row, to be set to 0 before each.
    """

    def __init__(self, spaces: Sequence[pymunk.Space], bodies: int) -> None:
        # The C side visits the static body last and checks for room after every
        # number it stores: one row for the static body, one spare so that it
        # never reallocates memory that numpy owns.
        self.stride = bodies + 2
        count = len(spaces)
        self.rows: NDArray[np.float64] = np.zeros((count * self.stride, ROW))
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
        self.cursors: NDArray[np.int32] = every.reshape(count, -1)
        self.calls: NDArray[np.uint64] = np.array(
            [
                _address(ffi.addressof(lib, "cpSpaceStep")),
                _address(ffi.addressof(lib, "cpSpaceEachBody")),
                _address(ffi.addressof(lib, "pmSpaceBodyGetIteratorFuncBatched")),
                _address(ffi.addressof(lib, "pmSpaceBodySetIteratorFuncBatched")),
            ],
            dtype=np.uint64,
        )
        self.handles: NDArray[np.uint64] = np.array(
            [[_address(space._space), _address(self._batches + k)] for k, space in enumerate(spaces)],
            dtype=np.uint64,
        )
        self._check_order()

    def read(self) -> None:
        """Fill ``rows`` from the spaces."""
        self._each(ffi.addressof(lib, "pmSpaceBodyGetIteratorFuncBatched"))

    def write(self) -> None:
        """Set the spaces' bodies from ``rows``."""
        self._each(ffi.addressof(lib, "pmSpaceBodySetIteratorFuncBatched"))

    def _each(self, callback: object) -> None:
        self.cursors[:, 0] = 0
        for k, space in enumerate(self._spaces):
            lib.cpSpaceEachBody(space._space, callback, self._batches + k)

    def _check_order(self) -> None:
        self.read()
        rows = self.rows.reshape(len(self._spaces), self.stride, ROW)
        for k, space in enumerate(self._spaces):
            found = self.cursors[k, 0] // ROW
            expected = [tuple(body.position) for body in space.bodies]
            if found != self._bodies + 1 or [tuple(row[:2]) for row in rows[k, : self._bodies]] != expected:
                raise RuntimeError(
                    f"pymunk {pymunk.version} visits {found} bodies in another order than they were added: "
                    "its batch interface has changed"
                )


def _address(pointer: object) -> int:
    return int(ffi.cast("uintptr_t", pointer))
