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
    """What came of one trial: its shot, None without one, and how long it lasted in the world [s]."""

    trial: int
    row: Row | None
    time: float


def play_trial(settings: CollectionSettings, trial: int) -> Taken:
    """Play one trial; the same settings and number give the same shot wherever it is played."""
    attempt = (paper_attempt if settings.protocol == "paper" else balanced_attempt)(settings, trial)
    if settings.goalkeepers is not None:
        attempt = against_fitted(attempt, settings.goalkeepers)
    shot, time = take_shot(attempt, trial)
    return Taken(trial, None if shot is None else complete_row(shot), time)
