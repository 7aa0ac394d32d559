"""One trial of a collection, played to its end."""

from __future__ import annotations

from typing import NamedTuple

from robobt.shots.collect.balanced import balanced_attempt
from robobt.shots.collect.fitted import against_fitted
from robobt.shots.collect.paper import paper_attempt
from robobt.shots.collect.plan import CollectionSettings
from robobt.shots.collect.watch import take_shot
from robobt.shots.data.schema import Row, complete_row


class Taken(NamedTuple):
    """The result of one trial: its shot, or None, and its simulated duration [s]."""

    trial: int
    row: Row | None
    time: float


def play_trial(settings: CollectionSettings, trial: int) -> Taken:
    """Play one trial; its shot depends only on the settings and the trial's number. Return the result."""
    attempt = (paper_attempt if settings.protocol == "paper" else balanced_attempt)(settings, trial)
    if settings.goalkeepers is not None:
        attempt = against_fitted(attempt, settings.goalkeepers)
    shot, time = take_shot(attempt, trial)
    return Taken(trial, None if shot is None else complete_row(shot), time)
