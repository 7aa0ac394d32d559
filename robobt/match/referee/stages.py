"""The stages of a match: halves, overtime, shoot-out.

Source: RoboCup SSL rules, chapter "Match"; a stage ends at the first stoppage after its time, as the
league's game controller has it.
"""

from __future__ import annotations

from robobt.match.referee.settings import RefereeSettings
from robobt.world.game import Stage, Team

_MERCY_GOALS, _MERCY_LEAD = 10, 2
"""Goals and lead of a team at which a match ends early. Source: SSL rules."""

_SHOOT_OUT_KICKS = 10
"""Number of kicks of a shoot-out, of both teams together, before the score decides. Source: SSL rules."""

_BEGUN = {
    Stage.NORMAL_FIRST_HALF_PRE: Stage.NORMAL_FIRST_HALF,
    Stage.NORMAL_SECOND_HALF_PRE: Stage.NORMAL_SECOND_HALF,
    Stage.EXTRA_FIRST_HALF_PRE: Stage.EXTRA_FIRST_HALF,
    Stage.EXTRA_SECOND_HALF_PRE: Stage.EXTRA_SECOND_HALF,
}
_AFTER_BREAK = {
    Stage.NORMAL_HALF_TIME: Stage.NORMAL_SECOND_HALF_PRE,
    Stage.EXTRA_TIME_BREAK: Stage.EXTRA_FIRST_HALF_PRE,
    Stage.EXTRA_HALF_TIME: Stage.EXTRA_SECOND_HALF_PRE,
    Stage.PENALTY_SHOOTOUT_BREAK: Stage.PENALTY_SHOOTOUT,
}
_EXTRA = frozenset({Stage.EXTRA_FIRST_HALF, Stage.EXTRA_SECOND_HALF})
_SECOND = frozenset({Stage.NORMAL_SECOND_HALF_PRE, Stage.EXTRA_SECOND_HALF_PRE})


class Stages:
    """The stage of a match, and its playing time.

    Attributes:
        stage: the present stage.
        played: playing time in it [s].
        turn: the team that kicks next in a shoot-out.
        attempts: kicks of the shoot-out so far.
    """

    def __init__(self, settings: RefereeSettings) -> None:
        self._settings = settings
        self.stage = Stage.NORMAL_FIRST_HALF_PRE
        self.played = 0.0
        self.turn = settings.opening_team
        self.attempts = 0

    @property
    def length(self) -> float | None:
        """Playing time of this stage [s], None for no end."""
        if self.stage in _EXTRA:
            return self._settings.extra_length
        return None if self.stage is Stage.PENALTY_SHOOTOUT else self._settings.half_length

    @property
    def left(self) -> float | None:
        """Playing time left in this stage [s], negative once it is over; None for no end."""
        return None if self.length is None else self.length - self.played

    @property
    def in_break(self) -> bool:
        """Whether this is the time between two stages of play."""
        return self.stage in _AFTER_BREAK

    @property
    def shoot_out(self) -> bool:
        """Whether penalty kicks are taken in turn."""
        return self.stage is Stage.PENALTY_SHOOTOUT

    @property
    def kickoff_team(self) -> Team:
        """The team that begins this stage."""
        team = self._settings.opening_team
        return team.other if self.stage in _SECOND else team

    def begin_play(self) -> None:
        """Note that the ball may be played: a half begins."""
        self.stage = _BEGUN.get(self.stage, self.stage)

    def begin_attempt(self) -> None:
        """Note that a kick of the shoot-out may be taken."""
        self.attempts += 1
        self.turn = self.turn.other

    def end_break(self) -> None:
        """Go on after a break."""
        self.stage, self.played = _AFTER_BREAK[self.stage], 0.0

    def over(self, scores: tuple[int, int]) -> Stage | None:
        """Return the stage that follows at this stoppage, or None if the present one continues."""
        most, lead = max(scores), abs(scores[0] - scores[1])
        if self.shoot_out:
            decided = self.attempts >= _SHOOT_OUT_KICKS and self.attempts % 2 == 0 and lead > 0
            return Stage.POST_GAME if decided else None
        if self._settings.half_length is None:
            return None
        if most >= _MERCY_GOALS and lead >= _MERCY_LEAD:
            return Stage.POST_GAME
        if self.left is None or self.left > 0.0:
            return None
        if self.stage is Stage.NORMAL_FIRST_HALF:
            return Stage.NORMAL_HALF_TIME
        if self.stage is Stage.EXTRA_FIRST_HALF:
            return Stage.EXTRA_HALF_TIME
        if lead == 0 and self.stage is Stage.NORMAL_SECOND_HALF and self._settings.extra_length is not None:
            return Stage.EXTRA_TIME_BREAK
        if lead == 0 and self._settings.shoot_out:
            return Stage.PENALTY_SHOOTOUT_BREAK
        return Stage.POST_GAME
