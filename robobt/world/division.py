"""The differences between the league's divisions.

Source: RoboCup SSL rules of 2026, appendix and chapter "Offenses".
"""

from __future__ import annotations

from dataclasses import dataclass

from robobt.world.field import DIVISION_A as FIELD_A
from robobt.world.field import DIVISION_B as FIELD_B
from robobt.world.field import FieldGeometry


@dataclass(frozen=True)
class Division:
    """A division's numbers.

    Attributes:
        name: "A" or "B".
        robots: largest number of a team's robots on the field.
        kick_time: time to take a free kick, to move a ball without progress, and to clear it from the own
            defence area [s].
        aimless_kick: whether a kick from the own half over the far goal line is an offence.
        must_place: whether a team may not decline to place the ball.
        failure_loses_kick: whether a team that cannot place the ball loses the free kick.
    """

    name: str
    robots: int
    kick_time: float
    aimless_kick: bool
    must_place: bool
    failure_loses_kick: bool


A = Division("A", 11, 5.0, aimless_kick=False, must_place=True, failure_loses_kick=True)
B = Division("B", 6, 10.0, aimless_kick=True, must_place=False, failure_loses_kick=False)

_LENGTH_BETWEEN_DIVISIONS = (FIELD_A.length + FIELD_B.length) / 2


def division_of(field: FieldGeometry) -> Division:
    """Return the division whose field is nearest in length; fields may differ from the rules' sizes."""
    return A if field.length > _LENGTH_BETWEEN_DIVISIONS else B
