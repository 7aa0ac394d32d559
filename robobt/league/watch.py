"""Warnings and errors during a match: a field that fell silent or was restarted."""

from __future__ import annotations

from robobt.league.connection import LeagueError
from robobt.league.feed import Feed
from robobt.league.placing import TIMEOUT

_REPORTED_SILENCE = 1.0
"""Silence of the vision after which a warning is given [s]."""

_DECISION_WINDOW, _DECISION_SHARE = 5.0, 0.9
"""Period for counting decisions [s of the field], and share of the due ones that causes a warning."""


class MatchWatch:
    """Follows the match that ``feed`` receives, from act to act, a ``period`` of its time apart [s]."""

    def __init__(self, feed: Feed, period: float) -> None:
        self._feed, self._period = feed, period
        # Where people place the robots, and a person decides, a match goes on with what is there.
        connection = feed.connection
        self._fatal = connection.places and not connection.follow_referee
        self._begun = False
        self._silent = False
        self._restarts = feed.filter.restarts
        self._since = feed.now()
        self._acts = 0

    def begin(self) -> None:
        """Begin a match, with everything in its place."""
        self._begun = True
        self._restarts = self._feed.filter.restarts
        self._since, self._acts = self._feed.now(), 0

    def acted(self) -> None:
        """Take note of an act that is over.

        Raises:
            LeagueError: the simulator of a match that was set up there sends no more, or was restarted.
        """
        self._watch_silence()
        self._watch_restarts()
        self._watch_pace()

    def _watch_silence(self) -> None:
        feed = self._feed
        silence = (feed.now() - feed.heard) / feed.rate
        if silence < _REPORTED_SILENCE or not feed.frames:
            self._silent = False
            return
        if not self._silent:
            self._silent = True
            feed.known.tell_again(f"{feed.no_frames(_REPORTED_SILENCE)}; robots are stopped until it returns")
        if self._begun and self._fatal and silence > TIMEOUT:
            raise LeagueError(f"{feed.no_frames(TIMEOUT)} again; it stopped during the match")

    def _watch_restarts(self) -> None:
        restarts = self._feed.filter.restarts
        if restarts == self._restarts:
            return
        self._restarts = restarts
        if self._begun and self._fatal:
            raise LeagueError(
                "the simulator was restarted during the match: its clock jumped, and everything may be "
                "somewhere else; play the match again"
            )
        self._feed.known.tell_again("the vision's clock jumped, as when it is restarted; the match goes on")

    def _watch_pace(self) -> None:
        self._acts += 1
        elapsed = self._feed.now() - self._since
        if elapsed < _DECISION_WINDOW:
            return
        share = self._acts * self._period / elapsed
        if share < _DECISION_SHARE:
            self._feed.known.tell(
                "pace",
                f"robots are commanded {self._acts / elapsed:.0f} times a second of the field, not "
                f"{1 / self._period:.0f}: this machine is too slow for their plays, and the field does not "
                "wait; play fewer robots, or on a faster machine",
            )
        self._since, self._acts = self._feed.now(), 0
