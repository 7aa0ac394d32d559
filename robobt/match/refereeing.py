"""The interface of a referee, and the referee that a scenario asks for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from robobt.match.referee.events import Decision
from robobt.match.referee.referee import Referee
from robobt.match.referee.settings import RefereeSettings
from robobt.match.scenario.scenario import Scenario
from robobt.world.field import FieldGeometry
from robobt.world.state import Frame


class MatchReferee(Protocol):
    """Referees a match: decides the state of the game."""

    def update(self, frame: Frame) -> Decision:
        """Judge the next frame, the true one seen from blue's side."""

    def close(self) -> None:
        """Release its resources when the match is over."""


RefereeFactory = Callable[[Scenario, FieldGeometry], MatchReferee | None]
"""Makes the referee of a match, None for free play.

For workers it must be picklable, such as a function of a module. Any other than :func:`own_referee` has a
``name``, by which result files are distinguished.
"""


def own_referee(scenario: Scenario, field: FieldGeometry) -> Referee | None:
    """Return the referee that the scenario asks for on a field: robobt's own, or none."""
    return None if scenario.referee is None else Referee(field, referee_settings(scenario))


def referee_settings(scenario: Scenario) -> RefereeSettings:
    """Return the scenario's settings, with its goalkeepers; the defaults if it has no referee."""
    keepers = {f"{team.value}_keeper": number for team, number in scenario.goalkeepers().items()}
    return (scenario.referee or RefereeSettings()).model_copy(update=keepers)
