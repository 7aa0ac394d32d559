"""Composite: one child for each phase of the game."""

from __future__ import annotations

from enum import StrEnum

from robobt.skills.store import Store
from robobt.tree.leaf import Bound
from robobt.tree.nodes import Switch
from robobt.world.game import GameState, Team


class Phase(StrEnum):
    """The phase of the game, which decides what a team may do."""

    HALT = "halt"
    STOP = "stop"
    OUR_KICKOFF = "our_kickoff"
    THEIR_KICKOFF = "their_kickoff"
    OUR_FREE_KICK = "our_free_kick"
    THEIR_FREE_KICK = "their_free_kick"
    OUR_PENALTY = "our_penalty"
    THEIR_PENALTY = "their_penalty"
    OUR_BALL_PLACEMENT = "our_ball_placement"
    THEIR_BALL_PLACEMENT = "their_ball_placement"
    PLAY = "play"


def phase(game: GameState, team: Team) -> Phase:
    """Return the phase of the game as ``team`` sees it.

    Halts and time-outs are HALT. STOP precedes every restart; the restart's own phase lasts from the
    referee's command until the ball is in play. Everything that is neither play nor a restart of one of the
    teams is also STOP.
    """
    if game.halted:
        return Phase.HALT
    if game.in_play:
        return Phase.PLAY
    if game.stopped or game.restart is None or game.restart_team is None:
        return Phase.STOP
    return Phase(f"{'our' if game.restart_team is team else 'their'}_{game.restart.value}")


class RefereeSwitch(Switch, Bound[Store]):
    """Ticks the child for the present :class:`Phase`, and only that one.

    In a phase without a child it fails and the robot stands still. When the phase changes, the old phase's
    child is interrupted before the new one is ticked.

    Args:
        cases: a child for each phase by its name; one child may serve several phases.
        otherwise: the child for every other phase.

    Raises:
        ValueError: a case does not name a phase; the message lists all phases.
    """

    kind = Phase

    def case(self) -> str:
        """Return the present phase as this team sees it."""
        frame = self.store.frame
        return phase(frame.game, frame.team).value
