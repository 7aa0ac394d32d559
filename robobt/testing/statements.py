"""Statements about a trial: what eventually, always or never holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from robobt.world import Frame

Predicate = Callable[[Frame], bool]
"""Says of a frame, the true one as blue sees it, whether something holds; it is asked of each in turn."""


@dataclass(frozen=True)
class Statement:
    """Something that has to hold in a trial.

    Attributes:
        kind: at one frame at least, or at every frame.
        what: holds, in words; a failed test says it.
        holds: whether it does.
    """

    kind: Literal["eventually", "always"]
    what: str
    holds: Predicate


def eventually(what: str, holds: Predicate) -> Statement:
    """Return the statement that something holds at some frame.

    A trial ends early once all its statements of this kind did hold.

    Args:
        what: holds, in words.
        holds: whether it does at a frame.
    """
    return Statement("eventually", what, holds)


def always(what: str, holds: Predicate) -> Statement:
    """Return the statement that something holds at every frame.

    Args:
        what: holds, in words.
        holds: whether it does at a frame.
    """
    return Statement("always", what, holds)


def never(what: str, holds: Predicate) -> Statement:
    """Return the statement that something holds at no frame.

    Args:
        what: does not hold, in words.
        holds: whether it does at a frame.
    """
    return Statement("always", f"not: {what}", lambda frame: not holds(frame))
