"""Consequences of an event: the restart, and whether it counts as a foul.

Source: RoboCup SSL rules of 2026, chapter "Offenses"; where they leave it open, what the league's game
controller was seen to do.
"""

from __future__ import annotations

from collections.abc import Callable

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.restarts import (
    Resumption,
    corner_kick,
    drop_ball,
    free_kick,
    goal_kick,
    penalty,
    throw_in,
)
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point

_K = EventKind

SOFT_FOULS = frozenset(
    {
        _K.ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA,
        _K.BOT_KICKED_BALL_TOO_FAST,
        _K.BOT_CRASH_UNIQUE,
        _K.BOT_CRASH_DRAWN,
    }
)
"""Fouls that do not stop play; a team's goal within :data:`FOUL_MEMORY` after one does not count."""

FREE_KICK_FOULS = frozenset(
    {
        _K.BOT_PUSHED_BOT,
        _K.BOT_HELD_BALL_DELIBERATELY,
        _K.BOT_TIPPED_OVER,
        _K.BOT_DROPPED_PARTS,
        _K.BOUNDARY_CROSSING,
        _K.KEEPER_HELD_BALL,
        _K.BOT_DRIBBLED_BALL_TOO_FAR,
    }
)
"""Fouls that stop play and give the opponents a free kick where they happened."""

FOULS = (
    SOFT_FOULS
    | FREE_KICK_FOULS
    | {
        _K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA,
        _K.DEFENDER_TOO_CLOSE_TO_KICK_POINT,
        _K.BOT_TOO_FAST_IN_STOP,
        _K.BOT_INTERFERED_PLACEMENT,
        _K.EXCESSIVE_BOT_SUBSTITUTION,
    }
)
"""Events that add to a team's fouls; every third foul costs a card."""

PENALTY_BREACHES = frozenset(
    {
        _K.BOUNDARY_CROSSING,
        _K.BOT_DRIBBLED_BALL_TOO_FAR,
        _K.ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA,
        _K.BOT_KICKED_BALL_TOO_FAST,
        _K.BOT_CRASH_UNIQUE,
        _K.BOT_PUSHED_BOT,
        _K.BOT_TIPPED_OVER,
        _K.BOT_DROPPED_PARTS,
    }
)
"""Offences that end a penalty kick: a goal when the defending team commits them, else a failure."""

FOUL_MEMORY = 2.0
"""Time for which a foul that did not stop play annuls its team's goals [s]. Source: SSL rules."""

HIGHEST_GOAL = 0.15
"""Greatest height of the ball since its scorers touched it [m]. Source: SSL rules."""

After = Callable[[RefereeEvent, Point], Resumption | None]
"""Returns the restart after an event, given the ball's position, or None if play goes on."""


def resumption_after(field: FieldGeometry, event: RefereeEvent, ball: Point) -> Resumption | None:
    """Return the restart after an event that stops play, or None after any other event.

    Goals and events of placements are handled by the controller itself.

    Args:
        field: the field.
        event: the event while the ball was in play.
        ball: the ball's position now [m]; the event's ``ball_location`` comes first if it has one.
    """
    kind, team, x, y = event.kind, event.team, event.x, event.y
    told = event.details.get("ball_location")
    if isinstance(told, tuple):
        ball = told
    if kind in (_K.NO_PROGRESS_IN_GAME, _K.TOO_MANY_ROBOTS):
        return drop_ball(field, *ball)
    if kind is _K.BALL_LEFT_FIELD_TOUCH_LINE:
        return drop_ball(field, x, y) if team is None else throw_in(field, team.other, x, y)
    if kind is _K.BALL_LEFT_FIELD_GOAL_LINE:
        defender = Team.BLUE if x < 0.0 else Team.YELLOW
        return corner_kick(field, defender.other, y) if team is defender else goal_kick(field, defender, y)
    if team is None:
        return None
    if kind is _K.DEFENDER_IN_DEFENSE_AREA:
        return penalty(field, team.other)
    if kind is _K.AIMLESS_KICK:
        place = event.details.get("kick_location")
        return free_kick(field, team.other, *(place if isinstance(place, tuple) else ball))
    if kind in (_K.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA, _K.BOT_TIPPED_OVER, _K.BOT_DROPPED_PARTS):
        return free_kick(field, team.other, *ball)
    if kind is _K.ATTACKER_DOUBLE_TOUCHED_BALL or kind in FREE_KICK_FOULS:
        return free_kick(field, team.other, x, y)
    return None
