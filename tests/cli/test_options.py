"""Every option has one meaning, in all commands."""

from __future__ import annotations

from collections.abc import Iterator

import click
import pytest
import typer

from mkdocs_hooks import commands, options_table
from robobt.cli import _COMMAND_GROUPS, _COMMANDS, application
from robobt.cli.moved import COMMANDS, OPTIONS, what_became
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


def test_there_are_twelve_commands() -> None:
    assert len(_COMMANDS) + len(_COMMAND_GROUPS) == 12


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


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("replay a.robobt.arrows", "'robobt replay' is 'robobt show' now: robobt show a.robobt.arrows"),
        ("plays", "'robobt plays' is 'robobt list plays' now: robobt list plays"),
        ("plays attack_main", "'robobt plays' is 'robobt show' now: robobt show attack_main"),
        (
            "--debug live six_v_six",
            "'robobt live' is 'robobt match --live' now: robobt match --live six_v_six",
        ),
        (
            "collect shots --seed 3",
            "'robobt collect shots' is 'robobt shots collect' now: robobt shots collect --seed 3",
        ),
        ("tournament a b", "'robobt tournament' is 'robobt tournament run' now: robobt tournament run a b"),
        ("match x --replay=y.html", "'robobt match --replay' is '--record' now"),
        ("tournament run a b -n 3", "'robobt tournament run -n' is '--rounds' now"),
        ("serve --referee", "robobt serve --referee takes own or none"),
        ("tournament night.sqlite", "robobt tournament results night.sqlite sums up what a store holds"),
    ],
)
def test_an_old_spelling_says_what_it_became(typed: str, said: str) -> None:
    assert what_became(typed.split()) == said


@pytest.mark.parametrize(
    "typed", ["match x -n 3", "tournament run a b", "serve --referee own", "", "--help", "list plays"]
)
def test_what_is_typed_today_passes(typed: str) -> None:
    assert what_became(typed.split()) is None


def test_what_has_moved_is_gone_and_what_it_became_is_there() -> None:
    used = {(path, name) for path, option in ALL for name in option.opts}
    paths = {path for path, _ in used}
    for old, now in COMMANDS.items():
        assert old not in paths
        assert now.startswith("python -m ") or any(
            " ".join(now.split()[1:3]).startswith(path) for path in paths if path
        )
    for command, changed in OPTIONS.items():
        assert not {(command, old) for old in changed} & used
