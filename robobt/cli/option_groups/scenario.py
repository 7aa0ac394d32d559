"""The options that change a scenario: its settings and the plays of its teams."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import Imports, blaming, import_files, parse_assignments
from robobt.cli.options import option

if TYPE_CHECKING:
    from robobt.match import Scenario

SCENARIO_CHANGES = ", as in 'ends.time_limit=10', 'simulator.preset=grsim' or 'blue 0.max_distance=2'"
"""What --set changes in a scenario."""

Set = Annotated[list[str] | None, option("--set", SCENARIO_CHANGES)]
Blue = Annotated[str, option("--blue")]
Yellow = Annotated[str, option("--yellow")]


@dataclass(frozen=True)
class Changes:
    """What is changed in the scenario that a command plays."""

    settings: Set = None
    imports: Imports = None

    def scenario(self, name: str) -> Scenario:
        """Load the scenario with these changes, after the user's files whose plays it may name."""
        import_files(self.imports)
        return scenario_of(name, self.settings)


@dataclass(frozen=True)
class TeamChanges:
    """What is changed in the scenario that a command plays, its teams' plays included."""

    blue: Blue = ""
    yellow: Yellow = ""
    settings: Set = None
    imports: Imports = None

    def scenario(self, name: str) -> Scenario:
        """Load the scenario with these changes, after the user's files whose plays it may name."""
        loaded = Changes(self.settings, self.imports).scenario(name)
        return with_teams(loaded, self.blue, self.yellow)


def scenario_of(scenario: str, settings: list[str] | None) -> Scenario:
    """Load a scenario with the changes of ``--set``."""
    from robobt.match import load_scenario
    from robobt.match.scenario.changes import changed
    from robobt.worlds import scenario_settings

    loaded = load_scenario(scenario)
    if settings:
        with blaming("--set"):
            loaded = changed(loaded, parse_assignments(settings, "--set"))
            # Settings of the simulator are free until it is known which.
            scenario_settings(loaded)
    return loaded


def with_teams(scenario: Scenario, blue: str, yellow: str) -> Scenario:
    """Return the scenario with what --blue and --yellow say; empty texts change nothing."""
    from robobt.match.scenario.changes import with_team
    from robobt.world.game import Team

    for team, text in ((Team.BLUE, blue), (Team.YELLOW, yellow)):
        if text:
            option = f"--{team.value}"
            play, params = parse_play(text, option)
            with blaming(option):
                scenario = with_team(scenario, team, play or None, params)
    return scenario


def parse_play(text: str, option: str) -> tuple[str, dict[str, object]]:
    """Return the play and its parameters in ``PLAY[:NAME=VALUE,...]``; the option is named in errors."""
    # A play of a Python file has a colon of its own.
    own = re.match(r"([^=]+?\.py:[^:=]+)(?::(.*))?$", text)
    play, given = (own[1], own[2] or "") if own else text.partition(":")[::2]
    # A comma inside a value is not followed by NAME=.
    parts = re.split(r",(?=\s*[\w.]+=)", given) if given else []
    params = parse_assignments([part.strip() for part in parts], option)
    if len(params) < len(parts):
        raise typer.BadParameter(f"a parameter is given twice in {text!r}", param_hint=option)
    return play, params
