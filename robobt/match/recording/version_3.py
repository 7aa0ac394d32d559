"""Recordings of version 3, in which no ball could fly: read as today's, with the ball on the ground."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from robobt.match.recording.numbers import BALL_NUMBERS, COMMAND_NUMBERS

BALL_3 = 4
"""Values per ball: x, y, vx, vy."""

COMMAND_3 = 5
"""Values per command: vx, vy, omega, kick speed, flags."""


def from_version_3(batch: pa.RecordBatch, robots: int, schema: pa.Schema) -> pa.RecordBatch:
    """Return a batch of this many robots with the columns of ``schema``, the current one."""
    places = {
        "truth": [BALL_3] * (BALL_NUMBERS - BALL_3),
        "observed": [BALL_3] * (BALL_NUMBERS - BALL_3),
        # In front of the flags.
        "commands": [COMMAND_3 * slot - 1 for slot in range(1, robots + 1)] * (COMMAND_NUMBERS - COMMAND_3),
    }
    columns = [
        _widened(batch[name], places[name], schema.field(name).type) if name in places else batch[name]
        for name in batch.schema.names
    ]
    return pa.RecordBatch.from_arrays(columns, schema=schema)


def _widened(column: pa.FixedSizeListArray, places: list[int], kind: pa.DataType) -> pa.Array:
    """Return a column of lists with an additional 0 in front of each of these places."""
    if column.null_count:
        return pa.nulls(len(column), kind)
    table = column.flatten().to_numpy(zero_copy_only=False).reshape(len(column), column.type.list_size)
    wider = np.insert(table, places, np.float32(0.0), axis=1)
    return pa.FixedSizeListArray.from_arrays(pa.array(wider.reshape(-1), pa.float32()), type=kind)
