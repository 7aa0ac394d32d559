"""How much memory and work a network may take, whatever runs it."""

from __future__ import annotations

BATCH = 64
"""Most observations that a network is run on at once; larger batches are cut into such."""

MAX_BYTES = 64 * 2**20
"""What all steps of a network may answer together, for a batch [bytes]."""

ELEMENT = 64
"""Work of an operation on one number: a power takes as long as that many steps of a product of matrices."""

OTHER_TYPE = 32
"""How many times as long a product of matrices takes in other types than single precision."""

_LARGEST_WORK = {1: 2**26, BATCH: 2**30}


def largest_work(batch: int) -> int:
    """Return how many multiplications all steps of a network may take together, for so many observations.

    Loading a file runs it on one observation as often as there are in a batch, and on batches a few times.
    """
    return _LARGEST_WORK[batch]
