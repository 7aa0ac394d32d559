"""Where the ball is put for a restart. World coordinates, metres.

Source: RoboCup SSL rules, chapters "Ball Leaves The Field" and "Resuming The Game".
"""

from __future__ import annotations

from math import copysign

from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.rules import own_side

LINE_GAP = 0.2
"""Least distance of a restart from the lines [m]."""

AREA_GAP = 1.0
"""Least distance of a restart from a defence area [m]."""

GOAL_KICK_DISTANCE = 1.0
"""Distance of a goal kick from the goal line [m]."""

_PENALTY_SHARE = 2.0 / 3.0
"""Penalty mark to attacked goal as a share of the field's length: 6 of 9 m, 8 of 12 m."""


def free_kick_spot(field: FieldGeometry, x: float, y: float) -> Point:
    """Return the nearest legal place for a free kick: off the lines and off the defence areas."""
    most_x, most_y = field.half_length - LINE_GAP, field.half_width - LINE_GAP
    x = min(most_x, max(-most_x, x))
    y = min(most_y, max(-most_y, y))
    front = field.half_length - field.defense_depth - AREA_GAP
    side = field.defense_width / 2 + AREA_GAP
    into_front, into_side = abs(x) - front, side - abs(y)
    if into_front <= 0.0 or into_side <= 0.0:
        return (x, y)
    if into_side < into_front and side <= most_y:
        return (x, copysign(side, y))
    return (copysign(max(0.0, front), x), y)


def goal_kick_spot(field: FieldGeometry, defender: Team, y: float) -> Point:
    """Return where ``defender`` takes a goal kick when the ball has left at ``y``."""
    x = own_side(defender) * (field.half_length - GOAL_KICK_DISTANCE)
    return (x, copysign(field.half_width - LINE_GAP, y))


def corner_spot(field: FieldGeometry, defender: Team, y: float) -> Point:
    """Return where the attackers take a corner kick at ``defender``'s goal line, out at ``y``."""
    x = own_side(defender) * (field.half_length - LINE_GAP)
    return (x, copysign(field.half_width - LINE_GAP, y))


def penalty_mark(field: FieldGeometry, attacker: Team) -> Point:
    """Return where ``attacker`` takes a penalty kick."""
    return (-own_side(attacker) * (field.half_length - _PENALTY_SHARE * field.length), 0.0)
