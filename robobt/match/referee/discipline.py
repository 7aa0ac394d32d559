"""Fouls and cards.

Source: RoboCup SSL rules, chapter "Offenses": each third foul of a team is a yellow card, and a card
while two yellow ones are in force is a red one.
"""

from __future__ import annotations

from collections.abc import Iterator

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.teams import TeamRecord
from robobt.match.referee.verdicts import FOUL_MEMORY, FOULS, SOFT_FOULS
from robobt.world.division import Division
from robobt.world.game import Team


class Discipline:
    """Counts fouls and gives cards.

    Attributes:
        records: each team's record.
    """

    def __init__(self, settings: RefereeSettings, division: Division) -> None:
        self._card_time = settings.yellow_card_time
        most = division.robots if settings.max_robots is None else settings.max_robots
        self.records = {
            team: TeamRecord(
                most,
                settings.keeper(team).number,
                can_place=division.must_place or settings.can_place(team),
            )
            for team in Team
        }

    def count(self, event: RefereeEvent) -> Iterator[RefereeEvent]:
        """Count an event if it is a foul; return the events of the resulting cards."""
        if event.kind not in FOULS:
            return
        # For a crash without a team both teams are at fault.
        for team in Team if event.team is None else (event.team,):
            record = self.records[team]
            if event.kind in SOFT_FOULS:
                record.last_foul = event.time
            if record.foul(event.kind):
                causes = ", ".join(record.last_fouls)
                yield self._about(EventKind.MULTIPLE_FOULS, team, event.time, caused_game_events=causes)
                yield from self.card(team, event.time)

    def card(self, team: Team, time: float) -> Iterator[RefereeEvent]:
        """Show a team a card; return its event if the card had to be red."""
        if self.records[team].card(self._card_time):
            yield self._about(EventKind.MULTIPLE_CARDS, team, time)

    def fouled_lately(self, team: Team, time: float) -> bool:
        """Return whether a foul of the last two seconds that did not stop play annuls a team's goal."""
        last = self.records[team].last_foul
        return last is not None and time - last <= FOUL_MEMORY

    @staticmethod
    def _about(kind: EventKind, team: Team, time: float, **details: str) -> RefereeEvent:
        return RefereeEvent(time, kind, team, details=details)
