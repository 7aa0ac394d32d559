"""Composite: one child for each part that a robot of the team can have."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum

from py_trees.behaviour import Behaviour

from robobt.skills.plan import ATTACK, RECEIVE, SUPPORT, Omitted
from robobt.skills.store import Store
from robobt.skills.tactics.agree import agree
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings
from robobt.tree.leaf import Bound
from robobt.tree.nodes import Switch
from robobt.world.game import BALL_PLACEMENT, KICKOFF, Restart


class Part(StrEnum):
    """The part of a field player, given by the rules or else by its team's plan."""

    HALT = "halt"
    """Stand still."""
    TAKE_PENALTY = "take_penalty"
    """Take the own penalty kick."""
    PENALTY = "penalty"
    """Stay behind while another robot takes a penalty kick."""
    PLACE_BALL = "place_ball"
    """Bring the ball to the referee's spot."""
    TAKE_RESTART = "take_restart"
    """Take the own kick-off or free kick, and prepare for it."""
    KICKOFF = "kickoff"
    """Line up for a kick-off that another robot takes."""
    DEAD_BALL = "dead_ball"
    """Keep the distance from the ball, in any other pause."""
    ATTACK = "attack"
    RECEIVE = "receive"
    WALL = "wall"
    MARK = "mark"
    SUPPORT = "support"
    ASSIST = "assist"


_LINED_UP, _DEAD_BALL = Part.KICKOFF.value, Part.DEAD_BALL.value


class TaskSwitch(Switch, Bound[Store]):
    """Ticks the child for this robot's present :class:`Part`, and only that one.

    The referee's commands come first; in play the part is the robot's task in the team's plan. The robot
    takes part in the plan from its first tick.

    Args:
        cases: a child for each part by its name; one child may serve several parts.
        otherwise: the child for every other part.
        without: parts of the tactics that are switched off, for comparisons.
        tactics: settings of the team's tactics. Settings given to one robot apply to its whole team.
        at_ball: number of the team's robots with the part ``attack`` or ``assist`` while the ball is in play,
            those that can have the ball first; 0 for the attacker alone.

    Raises:
        ValueError: a case does not name a part; the message lists all parts.
    """

    kind = Part

    def __init__(
        self,
        name: str,
        cases: Mapping[str, Behaviour],
        *,
        otherwise: Behaviour | None = None,
        without: Omitted = "nothing",
        tactics: TacticsSettings = DEFAULT_TACTICS,
        at_ball: int = 0,
    ) -> None:
        super().__init__(name, cases, otherwise=otherwise)
        self.without: Omitted = without
        self.tactics = tactics
        self.at_ball = at_ball
        self._told = False

    def case(self) -> str:
        """Return the robot's present part."""
        store = self.store
        frame, team, number = store.frame, store.team, store.me.id
        if not self._told or number not in team.plan.players:
            self._told = True
            team.plan.players.add(number)
            team.plan.without = self.without
            team.plan.at_ball = self.at_ball
            team.plan.change_tactics(self.tactics)
            team.attackers.add(number)
            team.plan.frame = team.followed = None
        task = agree(frame, team).tasks.get(number, SUPPORT)
        game = frame.game
        if game.in_play and game.penalty is None:
            return task._value_
        if game.halted:
            return Part.HALT._value_
        ours = game.restart_team is frame.team
        first = task is ATTACK
        if game.penalty is not None or game.restart is Restart.PENALTY:
            taking = first and (ours or game.penalty is frame.team)
            return Part.TAKE_PENALTY._value_ if taking else Part.PENALTY._value_
        if game.restart is not None and ours and first:
            placing = game.restart is BALL_PLACEMENT
            return Part.PLACE_BALL._value_ if placing else Part.TAKE_RESTART._value_
        lining_up = game.restart is KICKOFF and not (task is RECEIVE and game.may_touch)
        return _LINED_UP if lining_up else _DEAD_BALL
