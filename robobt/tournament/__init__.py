"""Tournaments of teams: entrants, pairings, the store of results, ratings and tests."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "Plan": "plan",
    "play_tournament": "play",
    "read_entrant": "entrants",
    "standings_of": "standings",
}

if TYPE_CHECKING:
    from robobt.tournament.entrants import read_entrant as read_entrant
    from robobt.tournament.plan import Plan as Plan
    from robobt.tournament.play import play_tournament as play_tournament
    from robobt.tournament.standings import standings_of as standings_of
else:
    __getattr__, __dir__ = lazily(
        __name__, _HOMES, needs=("tournament", "google.protobuf", "pyarrow", "scipy")
    )
