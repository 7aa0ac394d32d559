"""The controller's record of each team: score, fouls, cards, budgets and requests."""

from __future__ import annotations

from dataclasses import dataclass, field

from robobt.world.game import TeamStatus

_FOULS_PER_CARD = 3
_CARDS_TO_RED = 2
"""Number of active yellow cards from which a further card is red. Source: SSL rules."""

MOST_FAILURES = 5
"""Failed placements after which a team is not asked again in that half. Source: SSL rules."""

TIME_OUTS, TIME_OUT_TIME = 4, 300.0
EXTRA_TIME_OUTS, EXTRA_TIME_OUT_TIME = 2, 150.0
"""Number of time-outs and their total time [s], in normal time and in overtime. Source: SSL rules."""

SUBSTITUTIONS = 5
"""Free substitutions of a team in a half. Source: SSL rules."""


@dataclass(slots=True)
class TeamRecord:
    """One team's record.

    Attributes:
        most: robots allowed without cards.
        keeper: number of the goalkeeper.
        can_place: whether the team can place the ball, or has to.
        score: number of goals.
        fouls: number of counted fouls.
        last_fouls: kinds of the fouls since the last card.
        yellow: playing time left of each active yellow card [s].
        red: number of red cards.
        failures: failed placements minus successful ones.
        too_close: number of times too close to the opponents' defence area since play was stopped.
        last_foul: time of the last foul that does not stop play [s].
        time_outs: number of time-outs left.
        time_out_left: time-out time left [s].
        substitutions: free substitutions left in this half.
        wants_time_out, wants_substitution: the team's requests.
        continues: whether it wants play to continue while the opponents have too many robots.
        substituting: whether its robots may be substituted now.
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
        """Whether the team is asked to place the ball."""
        return self.can_place and self.failures < MOST_FAILURES

    @property
    def max_robots(self) -> int:
        """Number of robots allowed on the field."""
        return max(0, self.most - len(self.yellow) - self.red)

    def foul(self, kind: str) -> bool:
        """Count a foul; return whether it costs a card."""
        if self.fouls % _FOULS_PER_CARD == 0:
            self.last_fouls.clear()
        self.fouls += 1
        self.last_fouls.append(kind)
        return self.fouls % _FOULS_PER_CARD == 0

    def card(self, duration: float) -> bool:
        """Take a card, yellow for ``duration`` of playing time [s]; return whether it is red."""
        if len(self.yellow) >= _CARDS_TO_RED:
            self.red += 1
            return True
        self.yellow.append(duration)
        return False

    def play_on(self, seconds: float) -> None:
        """Advance the playing time [s]."""
        if self.yellow:
            self.yellow = [left - seconds for left in self.yellow if left > seconds]

    def begin_half(self) -> None:
        """Set the budgets of a new half."""
        self.failures, self.substitutions = 0, SUBSTITUTIONS

    def begin_extra_time(self) -> None:
        """Set the time-outs of overtime."""
        self.time_outs, self.time_out_left = EXTRA_TIME_OUTS, EXTRA_TIME_OUT_TIME

    def status(self) -> TeamStatus:
        """Return the team's data for the game state; the same object until it changes."""
        told = (self.keeper, self.max_robots, len(self.yellow), self.red, self.places, self.substituting)
        if told != self._told:
            self._told, self._status = told, TeamStatus(*told)
        return self._status
