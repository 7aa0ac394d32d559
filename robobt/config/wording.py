"""Numbers in sentences."""

from __future__ import annotations


def counted(count: int, noun: str, plural: str = "") -> str:
    """Return a number with its noun: "1 trial", "2 trials".

    Args:
        count: the number.
        noun: for a single one.
        plural: for several; by default the noun with an s.
    """
    return f"{count} {noun if count == 1 else plural or noun + 's'}"
