"""Mark an opponent, so that it gets no pass."""

from __future__ import annotations

from robobt.plays.baselines.agreement import enter_marker, marked
from robobt.skills.base import Skill, skill
from robobt.tree import Status


@skill
class MarkOpponent(Skill):
    """Stand beside an opponent in the own half, between it and the ball.

    The marking robots of a team share the opponents: starting with the opponents nearest to the own goal,
    each gets the nearest free marker; the holder of the ball is not marked. FAILURE while no opponent is left
    for this robot; otherwise it never ends by itself.

    Source: RoboBulls' published code (MarkBot).

    Args:
        gap: distance between centres [m].
    """

    reads = ("team",)
    writes = ("team",)

    gap: float = 0.25

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        frame, me, team = self.frame, self.me, self.store.team
        enter_marker(team, me.id)
        opponent = marked(frame, team, me.id)
        if opponent is None:
            return self.fail("nobody to mark")
        ball = frame.ball
        dx, dy = ball.x - opponent.x, ball.y - opponent.y
        share = self.gap / max(self.gap, (dx * dx + dy * dy) ** 0.5)
        target = (opponent.x + dx * share, opponent.y + dy * share)
        self.drive_to(target, ball.position, avoid_ball=True, thereabouts=True)
        return self.run(f"marking {opponent.id}")
