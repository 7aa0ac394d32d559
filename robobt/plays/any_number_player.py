"""A field player of a team of any size, which plays by one learned policy."""

from __future__ import annotations

from robobt.plays.base import PLAYS
from robobt.plays.team_player import OpenPlayTasks, team_player
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TacticsSettings
from robobt.tree import Behaviour


@PLAYS.register("any_number_player")
def any_number_player(
    *,
    model: str = "any_number_imitated",
    tasks: OpenPlayTasks = "by_number",
    tactics: TacticsSettings = DEFAULT_TACTICS,
) -> Behaviour:
    """Play in a team of two to eleven robots by one policy while the ball is in play.

    It is the play ``team_player`` with this policy. Restarts, penalty kicks and ball placement are those of
    ``team_player``, and the goalkeeper plays ``team_goalkeeper``: the policy has learned neither.

    Args:
        model: name or file of a model for a task with several robots whose network treats robots as sets.
        tasks: which field players the policy moves: ``all``, or with ``attack`` attacker, receivers and
            supporters, while wall and markers are hand-written. ``by_number``: ``all`` in teams of up to
            three robots, ``attack`` in larger ones.
        tactics: settings of the team's tactics, which say who attacks, marks and stands in the wall.
    """
    return team_player(open_play=model, open_play_tasks=tasks, tactics=tactics)
