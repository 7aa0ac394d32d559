"""A field player of a team of any size, which plays by one learned policy."""

from __future__ import annotations

from robobt.plays.base import PLAYS
from robobt.plays.team_player import OpenPlayTasks, team_player
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings
from robobt.tree import Behaviour


@PLAYS.register("any_number_player")
def any_number_player(
    *,
    model: str = "any_number_ppo",
    tasks: OpenPlayTasks = "near_ball",
    tactics: TacticsSettings = DEFAULT_TACTICS,
) -> Behaviour:
    """Play in a team of two to eleven robots by one policy while the ball is in play.

    It is the play ``team_player`` with this policy. Restarts, penalty kicks and ball placement are those of
    ``team_player``, and the goalkeeper plays ``team_goalkeeper``: the policy has learned neither.

    Args:
        model: name or file of a model for a task with several robots whose network treats robots as sets.
        tasks: which field players the policy moves: ``near_ball``, the three that can have the ball first,
            with ``attack`` attacker, receivers and supporters, or ``all``. The others play their tasks in the
            team's plan, such as wall and markers.
        tactics: settings of the team's tactics, which say who attacks, marks and stands in the wall.
    """
    return team_player(open_play=model, open_play_tasks=tasks, tactics=tactics)
