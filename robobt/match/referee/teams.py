"""What the controller keeps of each team: score, fouls, cards, budgets and wishes."""

from __future__ import annotations

from dataclasses import dataclass, field

from robobt.world.game import TeamStatus

_FOULS_PER_CARD = 3
_CARDS_TO_RED = 2
"""A further card while so many yellow ones are in force is a red one. Source: SSL rules."""

MOST_FAILURES = 5
"""A team that has failed so often to place the ball is not asked again in that half. Source: SSL rules."""

TIME_OUTS, TIME_OUT_TIME = 4, 300.0
EXTRA_TIME_OUTS, EXTRA_TIME_OUT_TIME = 2, 150.0
"""Time-outs of a team and the time they share, in normal time and in overtime. Source: SSL rules [s]."""

SUBSTITUTIONS = 5
"""Free substitutions of a team in a half. Source: SSL rules."""


@dataclass(slots=True)
class TeamRecord:
    """One team's record.

    Attributes:
        most: robots it may have without cards.
        keeper: number of its goalkeeper.
        can_place: whether it can place the ball, or has to.
        score: its goals.
        fouls: how many count.
        last_fouls: the kinds of those since its last card.
        yellow: playing time that each yellow card in force has left [s].
        red: red cards.
        failures: placements failed, less those that succeeded.
        too_close: how often it was too close to the opponents' defence area since play was stopped.
        last_foul: when it last committed a foul that does not stop play [s].
        time_outs: time-outs left.
        time_out_left: time left of them [s].
        substitutions: free substitutions left in this half.
        wants_time_out, wants_substitution: what it has asked for.
        continues: whether it wants play to go on, for its advantage, while the opponents are too many.
        substituting: whether its robots may be exchanged now.
    """

    most: int
    keeper: int
    can_place: bool = True
    score: int = 0
    fouls: int = 0
    last_fouls: list[str] = field(default_factory=list)
    yellow: list[float] = field(default_factory=list)
    red: int = 0
    failures: int = 0
    too_close: int = 0
    last_foul: float | None = None
    time_outs: int = TIME_OUTS
    time_out_left: float = TIME_OUT_TIME
    substitutions: int = SUBSTITUTIONS
    wants_time_out: bool = False
    wants_substitution: bool = False
    continues: bool = False
    substituting: bool = False
    _told: tuple[object, ...] = ()
    _status: TeamStatus = field(default_factory=TeamStatus)

    @property
    def places(self) -> bool:
        """Whether it is asked to place the ball."""
        return self.can_place and self.failures < MOST_FAILURES

    @property
    def max_robots(self) -> int:
        """How many robots it may have on the field."""
        return max(0, self.most - len(self.yellow) - self.red)

    def foul(self, kind: str) -> bool:
        """Count a foul; return whether it costs a card."""
        if self.fouls % _FOULS_PER_CARD == 0:
            self.last_fouls.clear()
        self.fouls += 1
        self.last_fouls.append(kind)
        return self.fouls % _FOULS_PER_CARD == 0

    def card(self, duration: float) -> bool:
        """Take a card, a yellow one for ``duration`` of playing time [s]; return whether it is a red one."""
        if len(self.yellow) >= _CARDS_TO_RED:
            self.red += 1
            return True
        self.yellow.append(duration)
        return False

    def play_on(self, seconds: float) -> None:
        """Let so much playing time pass [s]."""
        if self.yellow:
            self.yellow = [left - seconds for left in self.yellow if left > seconds]

    def begin_half(self) -> None:
        """Give it the budgets of a new half."""
        self.failures, self.substitutions = 0, SUBSTITUTIONS

    def begin_extra_time(self) -> None:
        """Give it the time-outs of overtime."""
        self.time_outs, self.time_out_left = EXTRA_TIME_OUTS, EXTRA_TIME_OUT_TIME

    def status(self) -> TeamStatus:
        """Return what robots are told of it; the same object until that changes."""
        told = (self.keeper, self.max_robots, len(self.yellow), self.red, self.places, self.substituting)
        if told != self._told:
            self._told, self._status = told, TeamStatus(*told)
        return self._status
