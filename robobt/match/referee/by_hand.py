"""Referee commands given by hand, as by a person at the game controller."""

from __future__ import annotations

from typing import Literal

from robobt.match.referee.controller import Controller
from robobt.match.referee.restarts import free_kick, kickoff, penalty
from robobt.world.field import FieldGeometry
from robobt.world.game import Team

Order = Literal["halt", "stop", "continue", "force start", "kick-off", "free kick", "penalty"]


def give(controller: Controller, field: FieldGeometry, order: Order, team: Team | None = None) -> None:
    """Give an order; the controller handles its consequences.

    Raises:
        ValueError: the order needs a team.
    """
    state = controller.state
    if order == "halt":
        state.halt(None)
    elif order == "stop":
        state.stop(state.following)
    elif order == "force start":
        state.play()
    elif order == "continue":
        # A HALT is left through a STOP, as the rules say.
        state.wait() if state.game.halted else state.resume()
    elif team is None:
        raise ValueError(f"a {order} needs a team")
    elif order == "kick-off":
        state.stop(kickoff(team))
    elif order == "free kick":
        state.stop(free_kick(field, team, *state.ball))
    else:
        state.stop(penalty(field, team))
