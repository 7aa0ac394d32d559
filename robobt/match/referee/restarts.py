"""Restarts: the ball's spot and the team. World coordinates, metres.

Source: RoboCup SSL rules, chapters "Ball Leaves The Field" and "Resuming The Game".
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign

from robobt.world.field import FieldGeometry
from robobt.world.game import RefereeCommand, Restart, Team
from robobt.world.geometry import Point
from robobt.world.rules import own_side

LINE_GAP = 0.2
"""Least distance of a restart from the lines [m]."""

RESTART_AREA_GAP = 1.0
"""Least distance of a restart from a defence area [m]."""

GOAL_KICK_DISTANCE = 1.0
"""Distance of a goal kick from the goal line [m]."""


@dataclass(slots=True, frozen=True)
class Resumption:
    """The restart after a STOP: of ``team`` at ``spot``, or of both teams without ``team``.

    ``left_field`` says whether the ball had left the field.
    """

    spot: Point
    restart: Restart | None = None
    team: Team | None = None
    left_field: bool = False

    @property
    def command(self) -> RefereeCommand:
        """The command that starts it."""
        if self.restart is None or self.team is None:
            return RefereeCommand.FORCE_START
        if self.restart is Restart.FREE_KICK:
            return DIRECT_FREE[self.team]
        return PREPARE[self.restart, self.team]


def free_kick_spot(field: FieldGeometry, x: float, y: float) -> Point:
    """Return the nearest legal place for a free kick: off the lines and off the defence areas."""
    most_x, most_y = field.half_length - LINE_GAP, field.half_width - LINE_GAP
    x = min(most_x, max(-most_x, x))
    y = min(most_y, max(-most_y, y))
    front = field.half_length - field.defense_depth - RESTART_AREA_GAP
    side = field.defense_width / 2 + RESTART_AREA_GAP
    into_front, into_side = abs(x) - front, side - abs(y)
    if into_front <= 0.0 or into_side <= 0.0:
        return (x, y)
    if into_side < into_front and side <= most_y:
        return (x, copysign(side, y))
    return (copysign(max(0.0, front), x), y)


def drop_ball(field: FieldGeometry, x: float, y: float) -> Resumption:
    """Return a forced start from the legal spot nearest to (x, y)."""
    return Resumption(free_kick_spot(field, x, y))


def free_kick(field: FieldGeometry, team: Team, x: float, y: float) -> Resumption:
    """Return a free kick of ``team`` from the legal spot nearest to (x, y)."""
    return Resumption(free_kick_spot(field, x, y), Restart.FREE_KICK, team)


def throw_in(field: FieldGeometry, team: Team, x: float, y: float) -> Resumption:
    """Return the free kick of ``team`` after the ball has left over a touch line at (x, y)."""
    return Resumption(free_kick_spot(field, x, y), Restart.FREE_KICK, team, True)


def kickoff(team: Team) -> Resumption:
    """Return a kick-off of ``team``."""
    return Resumption((0.0, 0.0), Restart.KICKOFF, team)


def goal_kick(field: FieldGeometry, defender: Team, y: float) -> Resumption:
    """Return the goal kick of ``defender`` after the ball has left at ``y``."""
    x = own_side(defender) * (field.half_length - GOAL_KICK_DISTANCE)
    return Resumption((x, copysign(field.half_width - LINE_GAP, y)), Restart.FREE_KICK, defender, True)


def corner_kick(field: FieldGeometry, attacker: Team, y: float) -> Resumption:
    """Return the corner kick of ``attacker`` after the ball has left at ``y``."""
    x = -own_side(attacker) * (field.half_length - LINE_GAP)
    return Resumption((x, copysign(field.half_width - LINE_GAP, y)), Restart.FREE_KICK, attacker, True)


def penalty(field: FieldGeometry, attacker: Team) -> Resumption:
    """Return the penalty kick of ``attacker``."""
    mark = -own_side(attacker) * (field.half_length - field.penalty_distance)
    return Resumption((mark, 0.0), Restart.PENALTY, attacker)


DIRECT_FREE = {Team.BLUE: RefereeCommand.DIRECT_FREE_BLUE, Team.YELLOW: RefereeCommand.DIRECT_FREE_YELLOW}
"""The command that lets a team take a free kick."""

PREPARE = {
    (Restart.KICKOFF, Team.BLUE): RefereeCommand.PREPARE_KICKOFF_BLUE,
    (Restart.KICKOFF, Team.YELLOW): RefereeCommand.PREPARE_KICKOFF_YELLOW,
    (Restart.PENALTY, Team.BLUE): RefereeCommand.PREPARE_PENALTY_BLUE,
    (Restart.PENALTY, Team.YELLOW): RefereeCommand.PREPARE_PENALTY_YELLOW,
}
"""The command that lets everybody take position for a kick-off or a penalty kick."""

PLACEMENT_COMMANDS = {
    Team.BLUE: RefereeCommand.BALL_PLACEMENT_BLUE,
    Team.YELLOW: RefereeCommand.BALL_PLACEMENT_YELLOW,
}
"""The command that lets a team place the ball."""

TIME_OUT = {Team.BLUE: RefereeCommand.TIMEOUT_BLUE, Team.YELLOW: RefereeCommand.TIMEOUT_YELLOW}
"""The command of a team's time-out."""
