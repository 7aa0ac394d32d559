"""Where and when all robots of a frame can meet the ball, found once for both teams."""

from __future__ import annotations

from robobt.motion.arrival import meetings
from robobt.world.geometry import FloatArray
from robobt.world.records import ball_of, movers_of, turned
from robobt.world.state import MIRRORED_FROM, Frame

_MEETING_PLACES = slice(1, 3)
"""Columns of a :class:`~robobt.world.records.Meeting` that change their signs where the other team looks."""


def meetings_of(frame: Frame, rolling: float) -> FloatArray:
    """Return :func:`~robobt.motion.arrival.meetings` of everybody in a frame, the own team first.

    Args:
        frame: what is on the field.
        rolling: the speed from which on the ball rolls [m/s].
    """
    found = _known(frame, rolling)
    if found is None:
        before: Frame | None = frame.made.get(MIRRORED_FROM)
        seen = None if before is None else _known(before, rolling)
        if before is not None and seen is not None:
            found = turned(seen, len(before.own), _MEETING_PLACES)
        else:
            field, model = frame.field, frame.ball_model
            found = meetings(
                movers_of(frame),
                ball_of(frame.ball),
                rolling,
                model.slide_deceleration,
                model.roll_deceleration,
                field.half_length,
                field.half_width,
            )
        frame.made["meetings"] = rolling, found
    return found


def _known(frame: Frame, rolling: float) -> FloatArray | None:
    for_rolling, found = frame.made.get("meetings", (None, None))
    return found if for_rolling == rolling else None
