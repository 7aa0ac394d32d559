"""What the commands that let teams play ask for: entrants and sequential tests."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import warn
from robobt.cli.option_groups.scenario import parse_play
from robobt.cli.options import option
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.tournament.entrants import Entrant
    from robobt.tournament.played import PlayedMatch
    from robobt.tournament.sequential import SequentialTest

ENTRANT = "ENTRANT"

EXITS = ("better", "not better", "undecided")
"""What a sequential test says, by the exit code."""

ALPHA = BETA = 0.05
"""How often a sequential test may err by default."""

Alpha = Annotated[float, option("--alpha", min=1e-6, max=0.49)]

Beta = Annotated[float, option("--beta", min=1e-6, max=0.49)]

ScenarioOption = Annotated[str, option("--scenario")]

OutOption = Annotated[
    Path | None,
    option(
        "--out",
        ": a file that keeps every match (SQLite). The same command plays what it lacks, also while another "
        "one does",
        metavar="FILE",
    ),
]

WorkersOption = Annotated[
    int | None, option("--workers", "; 0 plays in the command's own process", min=0, max=256)
]


def asked_test(sprt: tuple[float, float], alpha: float, beta: float) -> SequentialTest:
    """Return the test that --sprt, --alpha and --beta ask for."""
    from robobt.tournament.sequential import SequentialTest

    try:
        return SequentialTest(*sprt, alpha, beta)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint="--sprt") from error


def parse_entrant(text: str) -> Entrant:
    """Return the entrant of a command line."""
    from robobt.tournament.entrants import read_entrant

    if "=" not in text:
        return read_entrant(text)
    play, params = parse_play(text, ENTRANT)
    return read_entrant(play, params, text)


def require_programs(teams: Iterable[Entrant]) -> None:
    """Raise an error that names the entrant whose program is not on this machine, where matches are played.

    A match that cannot begin is lost by rule, so a misspelt command would look like a weak team.
    """
    from robobt.engines.run import engine
    from robobt.league.programs.process import is_there

    for team in teams:
        program = team.program
        if program is not None and engine() is None:
            command = program.command[0]
            # What is filled in is known with the match.
            if "{" not in command and not is_there(command, Path(team.source).parent):
                raise team.error(f"there is no such program: {command}", "program.command.0")


def tell_waiting(matches: int) -> None:
    """Tell that another command holds up this one."""
    warn(
        f"waiting for {counted(matches, 'match', 'matches')} that another command plays with the same store; "
        "if it is suspended, let it go on or end it"
    )


def tell_code(matches: Iterable[PlayedMatch]) -> None:
    """Warn when matches were played by several states of the code."""
    versions = {match.code for match in matches}
    if len(versions) > 1:
        warn(
            f"the matches were played by {counted(len(versions), 'state')} of the code; for a fair "
            "comparison play them all again, with another --out"
        )
