"""The kicker of the own team's last restart, who may not touch the ball again yet."""

from __future__ import annotations

from robobt.skills.store import TeamStore
from robobt.world.rules import owner
from robobt.world.state import Frame, RobotId


def has_kicked(frame: Frame, team: TeamStore, number: int) -> bool:
    """Return whether the robot took a restart and may not touch the ball before another robot has."""
    follow_restart(frame, team)
    return team.kicker == number


def follow_restart(frame: Frame, team: TeamStore) -> None:
    """Remember, once per frame, who took the own restart until another robot has touched the ball."""
    if team.followed is frame:
        return
    team.followed = frame
    game = frame.game
    if game.penalty is not None:
        # The kicker of a penalty may touch the ball more than once.
        team.kicker, team.restart_pending = None, False
        return
    if game.restart is not None:
        team.kicker = None
        team.restart_pending = game.may_touch and game.restart_team is frame.team
        return
    touched = frame.last_touch or owner(frame)
    if team.restart_pending:
        team.restart_pending = False
        if game.in_play:
            ours = touched is not None and touched.team is frame.team
            team.kicker = touched.number if touched is not None and ours else team.attacker
    elif team.kicker is not None and (
        not game.in_play or (touched is not None and touched != RobotId(frame.team, team.kicker))
    ):
        team.kicker = None
