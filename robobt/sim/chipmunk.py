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
    """All bodies of a space as rows of one numpy array, shared with the C library.

    Attributes:
        rows: (bodies, 6) x, y, angle, vx, vy, angular velocity of the bodies in
            the order in which they were added [m, rad, m/s, rad/s].
        handles: addresses for compiled code: step, each-body, the reading and
            the writing callback, the space, the batch descriptor.
        cursor: where the next batched call starts in the buffer; to be set to 0
            before each.
    """

    def __init__(self, space: pymunk.Space, bodies: int) -> None:
        # The C side visits the static body last and checks for room after every
        # number it stores: one row for the static body, one spare so that it
        # never reallocates memory that numpy owns.
        self._store: NDArray[np.float64] = np.zeros((bodies + 2, ROW))
        self.rows = self._store[:bodies]
        self._space = space
        self._floats = ffi.new("pmFloatArray *")
        self._ints = ffi.new("pmIntArray *")
        self._memory = ffi.from_buffer("cpFloat[]", self._store)
        self._floats.arr = self._memory
        self._floats.max = self._store.size
        self._floats.num = 0
        self._batch = ffi.new("pmBatchedData *")
        self._batch.fields = lib.POSITION | lib.ANGLE | lib.VELOCITY | lib.ANGULAR_VELOCITY
        self._batch.floatArray = self._floats
        self._batch.intArray = self._ints
        size = ffi.sizeof("int")
        self.cursor: NDArray[np.int32] = np.frombuffer(ffi.buffer(self._floats, size), dtype=np.int32)
        self.handles: NDArray[np.uint64] = np.array(
            [
                _address(ffi.addressof(lib, "cpSpaceStep")),
                _address(ffi.addressof(lib, "cpSpaceEachBody")),
                _address(ffi.addressof(lib, "pmSpaceBodyGetIteratorFuncBatched")),
                _address(ffi.addressof(lib, "pmSpaceBodySetIteratorFuncBatched")),
                _address(space._space),
                _address(self._batch),
            ],
            dtype=np.uint64,
        )
        self._check_order(bodies)

    def read(self) -> None:
        """Fill ``rows`` from the space."""
        self.cursor[0] = 0
        lib.cpSpaceEachBody(
            self._space._space, ffi.addressof(lib, "pmSpaceBodyGetIteratorFuncBatched"), self._batch
        )

    def write(self) -> None:
        """Set the space's bodies from ``rows``."""
        self.cursor[0] = 0
        lib.cpSpaceEachBody(
            self._space._space, ffi.addressof(lib, "pmSpaceBodySetIteratorFuncBatched"), self._batch
        )

    def _check_order(self, bodies: int) -> None:
        self.read()
        found = self.cursor[0] // ROW
        expected = [tuple(body.position) for body in self._space.bodies]
        if found != bodies + 1 or [tuple(row[:2]) for row in self.rows] != expected:
            raise RuntimeError(
                f"pymunk {pymunk.version} visits {found} bodies in another order than they were added: "
                "its batch interface has changed"
            )


def _address(pointer: object) -> int:
    return int(ffi.cast("uintptr_t", pointer))
