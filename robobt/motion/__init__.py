"""Driving without trees: trajectories, path planning, the ball's motion, the kick approach."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "ROBOBULLS_LIMITS": "pilot",
    "drive": "pilot",
}

if TYPE_CHECKING:
    from robobt.motion.pilot import ROBOBULLS_LIMITS as ROBOBULLS_LIMITS
    from robobt.motion.pilot import drive as drive
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
