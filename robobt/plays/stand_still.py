"""A robot that stands still, for example because a person drives it."""

from __future__ import annotations

from robobt.plays.base import PLAYS
from robobt.skills.stop import Stop
from robobt.tree import Behaviour


@PLAYS.register("stand_still")
def stand_still() -> Behaviour:
    """Stand still."""
    return Stop()
