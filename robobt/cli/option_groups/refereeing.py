"""The options of who referees a match and how much of it is played."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.options import option

if TYPE_CHECKING:
    from robobt.match import Scenario
    from robobt.match.refereeing import RefereeFactory

HALF = 300.0
"""Playing time of a half. Source: SSL rules [s]."""

_LONGEST_MATCH = 3600.0
"""A match that is not over by then never will be [s]."""


class Who(StrEnum):
    """Who referees."""

    OWN = "own"
    OFFICIAL = "official"
    NONE = "none"


class MatchExtent(StrEnum):
    """How much of a match is played."""

    FULL = "full"


@dataclass(frozen=True)
class Refereeing:
    """Who referees a match, and how much of it is played."""

    referee: Annotated[
        Who | None,
        option(
            "--referee",
            ": own (robobt's), official (the league's game controller, stepped with the match) or none; by "
            "default as in the scenario, and none where the world brings a referee",
        ),
    ] = None
    game_controller: Annotated[
        Path | None,
        option(
            "--game-controller",
            "; by default what ROBOBT_GAME_CONTROLLER names, or ssl-game-controller on the PATH",
        ),
    ] = None
    stages: Annotated[MatchExtent | None, option("--stages")] = None

    def of(self, scenario: Scenario) -> tuple[Scenario, RefereeFactory]:
        """Return the scenario as these options change it, and who makes its referee.

        Raises:
            GameControllerError: the official controller is asked for and is not there, or does not start.
        """
        from robobt.match.referee.settings import RefereeSettings
        from robobt.match.refereeing import own_referee

        who = self.referee
        if self.game_controller is not None and who is not Who.OFFICIAL:
            raise typer.BadParameter("is for --referee official", param_hint="--game-controller")
        if who is Who.NONE:
            scenario = scenario.without_referee()
        elif who is not None and scenario.referee is None:
            scenario = scenario.model_copy(update={"referee": RefereeSettings()})
        if self.stages is MatchExtent.FULL:
            if scenario.referee is None:
                raise typer.BadParameter("needs a referee, who counts the time", param_hint="--stages")
            settings = scenario.referee.model_copy(update={"half_length": HALF})
            ends = scenario.ends.model_copy(update={"time_limit": _LONGEST_MATCH, "score_limit": None})
            scenario = scenario.model_copy(update={"referee": settings, "ends": ends})
        if who is not Who.OFFICIAL:
            return scenario, own_referee
        from robobt.league.referee.official import OfficialRefereeFactory
        from robobt.league.referee.process import check_game_controller, find_game_controller

        program = find_game_controller(self.game_controller)
        check_game_controller(program)
        return scenario, OfficialRefereeFactory(program)

    def of_tournament(self, scenario: Scenario) -> tuple[Scenario, RefereeFactory]:
        """Return the same for matches that count, which have a referee."""
        if self.referee is Who.NONE:
            raise typer.BadParameter("must be own or official", param_hint="--referee")
        return self.of(scenario)
