"""The referee of a served field."""

from __future__ import annotations

from robobt.league.serve.served_field import ServedField
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.messages import GameEvent
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.league.wire.tracker import SOURCE
from robobt.match.referee.referee import Referee
from robobt.match.referee.settings import RefereeSettings
from robobt.world.game import Team

_REPEAT = 6
"""Frames from one referee message to the next while nothing changes."""


class ServedReferee:
    """Referees a served field and puts the ball down for restarts."""

    def __init__(self, field: ServedField, settings: RefereeSettings) -> None:
        self.referee = Referee(field.field, settings)
        self._field = field
        self._publisher = RefereePublisher({team: settings.keeper(team).number for team in Team})
        self._frames = 0
        self._events: list[GameEvent] = []

    def judge(self, timestamp: float) -> bytes | None:
        """Judge the field after a step; return the message if one is due."""
        before = self.referee.game
        truth = self._field.truth()
        decision = self.referee.update(truth)
        # The state lists the events still to be sent, the newest last.
        epoch = timestamp - truth.time
        self._events += [write_event(event, epoch, SOURCE) for event in decision.events]
        del self._events[: -len(decision.game.events) or None]
        if decision.place_ball is not None:
            self._field.place_ball(*decision.place_ball)
        due = decision.game != before or self._frames % _REPEAT == 0
        self._frames += 1
        return self._publisher.write(decision.game, timestamp, self._events) if due else None
