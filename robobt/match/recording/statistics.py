"""Team statistics of a recorded match."""

from __future__ import annotations

from robobt.match.recording.recording import Recording
from robobt.match.results.teams import TeamResult, TeamStatistics
from robobt.world.game import OPEN_PLAY


def recorded_statistics(recording: Recording) -> dict[str, TeamResult]:
    """Return each team's statistics by its name; an empty mapping without a referee.

    The frames have the file's precision, so a narrow contact may count differently than in the match itself.
    """
    if all(game == OPEN_PLAY for _, game in recording.games):
        return {}
    statistics = TeamStatistics()
    events = sorted(recording.events, key=lambda event: event.time)
    told = 0
    for tick, time in enumerate(recording.times):
        last = told
        while told < len(events) and events[told].time <= time + 0.5 * recording.header.period:
            told += 1
        frame = recording.frame(tick)
        statistics.update(frame, frame.game, events[last:told])
    return statistics.result()
