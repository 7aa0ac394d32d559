"""The folders of outputs: those that are not there are made and told, before anything is computed."""

from __future__ import annotations

import inspect
from importlib import import_module
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt import cli
from robobt.cli.outputs import make_folders
from robobt.config.errors import ConfigError
from tests.match.recording.made_recording import record

OUTPUTS = {"out", "record", "html", "log"}
"""What parameters for outputs are called."""

COMMANDS = [
    place
    for commands in (cli._COMMANDS, *[commands for _, commands in cli._COMMAND_GROUPS.values()])
    for place, _ in commands.values()
]


def test_a_folder_that_is_not_there_is_made_and_told_with_its_option(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    make_folders({"--record": tmp_path / "a" / "b" / "x.html", "--out": None, "--svg": tmp_path / "x.svg"})
    assert list(tmp_path.iterdir()) == [tmp_path / "a"]
    assert list((tmp_path / "a" / "b").iterdir()) == []
    told = capsys.readouterr().err
    assert told.startswith("robobt: --record: made the folder ")
    assert told.count("made") == 1
    make_folders({"--out": tmp_path / "runs" / "one"}, folders=True)
    assert list((tmp_path / "runs").iterdir()) == []


@pytest.mark.parametrize(
    ("place", "folders"), [("file/x", False), ("file/y/x", False), ("folder", False), ("file", True)]
)
def test_an_output_that_cannot_be_written_is_refused_with_its_option(
    place: str, folders: bool, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("kept")
    (tmp_path / "folder").mkdir()
    with pytest.raises(ConfigError) as raised:
        make_folders({"--picture": tmp_path / place}, folders=folders)
    assert str(raised.value).startswith("--picture: ")
    assert (tmp_path / "file").read_text() == "kept"


def test_devices_are_outputs_too() -> None:
    make_folders({"--svg": Path("/dev/null")})


@pytest.mark.parametrize("place", COMMANDS)
def test_every_command_with_an_output_keeps_this_rule(place: str) -> None:
    module, _, name = place.partition(":")
    command = getattr(import_module(f"robobt.cli.{module}"), name)
    outputs = OUTPUTS & set(inspect.signature(command).parameters)
    assert not outputs or "make_folders(" in inspect.getsource(command)


@pytest.mark.integration
@pytest.mark.parametrize(
    "arguments",
    [
        [
            "match",
            "striker_vs_goalkeeper",
            "-n",
            "1",
            "--set",
            "ends.time_limit=0.1",
            "--record",
            "{}/x.html",
        ],
        ["show", "attack_main", "--out", "{}/x.yaml"],
        ["show", "{recording}", "--out", "{}/x.html"],
        ["record", "case", "{recording}", "--tick", "3", "--robot", "blue 1", "--out", "{}/x.yaml"],
    ],
)
def test_commands_make_folders_and_tell(arguments: list[str], tmp_path: Path) -> None:
    recording, folder = tmp_path / "made.robobt.arrows", tmp_path / "new" / "deep"
    record(recording)
    given = [text.format(folder, recording=recording) for text in arguments]
    ended = CliRunner().invoke(cli.app, given, terminal_width=1000)
    assert f": made the folder {folder}" in "".join(ended.stderr.splitlines())
    assert folder.is_dir()


CASE = ["record", "case", "{recording}", "--tick", "3", "--robot", "blue 1"]


@pytest.mark.integration
@pytest.mark.parametrize(
    ("arguments", "kept"),
    [
        (
            ["record", "case", "{recording}", "--tick", "3", "--robot", "blue 1", "--out", "{kept}"],
            "my_code.py",
        ),
        (
            ["record", "case", "{recording}", "--tick", "3", "--robot", "blue 1", "--out", "{kept}"],
            "mine.yaml",
        ),
        (["record", "demonstrations", "go_to_ball", "--episodes", "1", "--out", "{kept}"], "my_code.py"),
        (["record", "export", "{recording}", "--robot", "blue 1", "--out", "{kept}"], "my_code.py"),
        (["serve", "duel", "--seconds", "0.1", "--log", "{kept}"], "notes.txt"),
        (["show", "{kept}", "--kind", "play", "--out", "{kept}"], "tree.yaml"),
    ],
)
def test_a_file_of_another_kind_is_not_replaced(arguments: list[str], kept: str, tmp_path: Path) -> None:
    recording, file = tmp_path / "made.robobt.arrows", tmp_path / kept
    record(recording)
    file.write_text("play: mine\ntree: Stop\n" if file.suffix == ".yaml" else "keep = 'me'\n")
    before = file.read_text()
    given = [text.format(recording=recording, kept=file) for text in arguments]
    assert CliRunner().invoke(cli.app, given).exit_code == 2
    assert file.read_text() == before
