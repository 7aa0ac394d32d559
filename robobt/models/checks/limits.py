"""Limits of a network's memory and work, for every runtime."""

from __future__ import annotations

LARGEST_BATCH = 64
"""Largest number of observations per run of a network; larger batches are split."""

MAX_OUTPUT_BYTES = 64 * 2**20
"""Largest total output of all steps of a network, for a batch [bytes]."""

ELEMENT = 64
"""Work of an operation on one number: a power takes as long as that many steps of a product of matrices."""

OTHER_TYPE = 32
"""How many times as long a product of matrices takes in other types than single precision."""

RECURRENT_GATES = 8
"""How many times its output a step of a recurrent layer computes at most."""

DEEPEST_NESTING = 40
"""How deep names and objects in an archive may be nested."""


_LARGEST_WORK = {1: 2**26, LARGEST_BATCH: 2**30}


def largest_work(batch: int) -> int:
    """Return the number of multiplications allowed for all steps of a network, for this many observations.

    Loading a file runs it on one observation as often as there are in a batch, and on batches a few times.
    """
    return _LARGEST_WORK[batch]
