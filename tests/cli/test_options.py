"""Every option has one meaning, in all commands."""

from __future__ import annotations

from collections.abc import Iterator

import click
import typer

from mkdocs_hooks import commands, options_table
from robobt.cli import _COMMAND_GROUPS, _COMMANDS, application
from robobt.cli.options import LETTERS, MEANINGS


def options(command: click.Command, path: str = "") -> Iterator[tuple[str, click.Option]]:
    """Give the options of a command and of all below it, each with the command's words."""
    inner = getattr(command, "commands", {})
    for param in command.params:
        if param.param_type_name == "option" and not {"--help", "--install-completion"} & {*param.opts}:
            yield path, param  # type: ignore[misc]
    for name, one in inner.items():
        yield from options(one, f"{path} {name}".strip())


ALL = [
    (path, option)
    for path, option in options(typer.main.get_command(application()))  # type: ignore[arg-type]
    if "--show-completion" not in option.opts
]


def test_there_are_fourteen_commands() -> None:
    assert len(_COMMANDS) + len(_COMMAND_GROUPS) == 14


def test_every_option_is_in_the_table_and_its_help_begins_with_its_meaning() -> None:
    assert len(ALL) > 100
    for path, option in ALL:
        (name,) = [one for one in option.opts if one.startswith("--")]
        assert name in MEANINGS, f"robobt {path} {name}"
        assert (option.help or "").startswith(MEANINGS[name]), f"robobt {path} {name}"


def test_every_entry_of_the_table_is_an_option() -> None:
    assert {name for _, option in ALL for name in option.opts if name.startswith("--")} == set(MEANINGS)


def test_the_reference_has_the_table() -> None:
    table = options_table()
    assert all(f"| `{name}`" in table and meaning in table for name, meaning in MEANINGS.items())
    assert commands().count(table) == 1


def test_a_letter_is_one_option() -> None:
    found = {(option.opts[0], letter) for _, option in ALL for letter in option.opts if letter[1] != "-"}
    assert found == set(LETTERS.items())
