"""Files with something changed in them."""

from __future__ import annotations

import random


def mutated(data: bytes, rng: random.Random) -> bytes:
    """Flip, set, insert, remove, repeat or cut off a few bytes."""
    changed = bytearray(data)
    for _ in range(rng.randrange(1, 5)):
        place, length = rng.randrange(len(changed) + 1), rng.randrange(1, 40)
        kind = rng.randrange(8)
        if kind < 3 and changed:
            changed[place % len(changed)] ^= 1 << rng.randrange(8)
        elif kind == 3 and changed:
            changed[place % len(changed)] = rng.choice([0, 0x7F, 0x80, 0xFF])
        elif kind == 4:
            changed[place:place] = rng.randbytes(length)
        elif kind == 5:
            del changed[place : place + length]
        elif kind == 6:
            changed[place:place] = changed[place : place + length]
        elif rng.random() < 0.2:
            del changed[place:]
    return bytes(changed)
