"""Commands take options that they share with others as groups."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from robobt.cli.option_groups.spread import spread


@dataclass(frozen=True)
class Where:
    place: Annotated[str, typer.Option("--place", help="Where it is.")]
    port: Annotated[int, typer.Option(min=1, help="At which port.")] = 80


def called(*arguments: str) -> str:
    def command(name: str, *, where: Where, loud: bool = False) -> None:
        typer.echo(f"{name} at {where.place}:{where.port}, {'loud' if loud else 'quiet'}")

    app = typer.Typer()
    app.command()(spread(command))
    result = CliRunner().invoke(app, [*arguments])
    return f"{result.output.strip()} ({result.exit_code})"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["ball", "--place", "here"], "ball at here:80, quiet (0)"),
        (["ball", "--place", "here", "--port", "5", "--loud"], "ball at here:5, loud (0)"),
    ],
)
def test_a_group_is_made_of_the_options_that_are_its_fields(arguments: list[str], said: str) -> None:
    assert called(*arguments) == said


@pytest.mark.parametrize("arguments", [["ball"], ["ball", "--place", "here", "--port", "0"]])
def test_options_of_a_group_are_checked_as_any_others(arguments: list[str]) -> None:
    assert called(*arguments).endswith("(2)")


def test_options_stand_in_the_place_of_their_group() -> None:
    shown = called("--help")
    assert shown.index("--place") < shown.index("--port") < shown.index("--loud")


def test_a_command_without_groups_stays_as_it_is() -> None:
    def command(name: str) -> None:
        """Say nothing."""

    assert spread(command) is command
