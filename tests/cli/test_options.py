"""Every option has one meaning, in all commands."""

from __future__ import annotations

from collections.abc import Iterator

import click
import pytest
import typer

from benchmarks.__main__ import application as benchmarks_application
from mkdocs_hooks import commands, options_table
from paper.__main__ import application as paper_application
from robobt.cli import _COMMAND_GROUPS, _COMMANDS, application
from robobt.cli.list_ import ListedKind
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
        (
            "tournament a b -n 2",
            "'robobt tournament' is 'robobt tournament run' now: robobt tournament run a b --rounds 2",
        ),
        ("tree attack_main --svg x.svg", "'robobt tree' is 'robobt show' now"),
        ("plays --import q.py mine", "'robobt plays' is 'robobt show' now: robobt show --import q.py mine"),
        ("train duel -n5", "'robobt train -n5' is '--seeds' now"),
        ("--engine=local live x", "'robobt live' is 'robobt match --live' now: robobt match --live x"),
        ("tournament run a b -n 3", "'robobt tournament run -n' is '--rounds' now"),
        ("serve --referee", "robobt serve --referee takes own or none"),
        ("tournament night.sqlite", "robobt tournament results night.sqlite sums up what a store holds"),
    ],
)
def test_an_old_spelling_says_what_it_became(typed: str, said: str) -> None:
    assert what_became(typed.split()) == said


@pytest.mark.parametrize(
    "typed",
    [
        "match x -n 3",
        "tournament run a b",
        "serve --referee own",
        "",
        "--help",
        "list plays",
        "tournament resuls x",
        "tournament -h",
    ],
)
def test_what_is_typed_today_passes(typed: str) -> None:
    assert what_became(typed.split()) is None


USED = {(path, name) for path, option in ALL for name in option.opts}
PATHS = {path for path, _ in USED}


@pytest.mark.parametrize(("old", "now"), COMMANDS.items())
def test_what_a_command_became_is_there(old: str, now: str) -> None:
    assert old not in PATHS
    program, _, words = now.partition("robobt ")
    if program:
        made = {"python -m benchmarks": benchmarks_application, "python -m paper": paper_application}
        head = " ".join(now.split()[:3])
        inner = typer.main.get_command(made[head]())
        assert set(now.split()[3:]) <= set(inner.commands)  # type: ignore[attr-defined]
        return
    names = [word for word in words.split() if not word.startswith("-")]
    listed = names[0] == "list"
    path = "list" if listed else " ".join(names)
    assert not listed or names[1:] in [[kind.value] for kind in ListedKind]
    assert path in PATHS
    assert all((path, word) in USED for word in words.split() if word.startswith("-"))


@pytest.mark.parametrize(
    ("command", "old", "now"), [(name, *pair) for name, all_ in OPTIONS.items() for pair in all_.items()]
)
def test_what_an_option_became_is_there(command: str, old: str, now: str) -> None:
    assert command in PATHS
    assert (command, old) not in USED
    assert all((command, word) in USED for word in now.split() if word.startswith("-"))
    # A letter stood for the option that has its place now.
    assert old.startswith("--") or now.startswith(("--", "NAME"))


def test_the_letters_that_went_say_their_options() -> None:
    assert {name: given["-n"] for name, given in OPTIONS.items() if "-n" in given} == {
        "evaluate": "--starts",
        "record demonstrations": "--episodes",
        "shots collect": "--count",
        "tournament run": "--rounds",
        "tournament sweep": "--rounds",
        "train": "--seeds",
    }
    assert OPTIONS["train"]["-p"] == "--preset"
    assert OPTIONS["log"]["--referee"] == OPTIONS["serve"]["--publish"] == "--referee-address"
