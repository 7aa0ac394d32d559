"""Python files of the user's: what they register is there, what is wrong with them is one line."""

from __future__ import annotations

import re
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.match import run_trials_in
from robobt.match.scenario.scenario import scenario_from
from robobt.plays import PLAYS, python_files
from robobt.plays.python_files import PythonFileError, import_file, imported_files
from robobt.skills import SKILLS
from robobt.skills.aim.raters import RATERS
from robobt.skills.ball.go_to_ball import GO_TO_BALL_POLICIES
from robobt.worlds import sim_world
from tests.match.scripted import PlainWorld, data
from tests.registries import temporarily

Write = Callable[..., Path]

MINE = '''
    from math import hypot

    from robobt.plays import PLAYS
    from robobt.skills.base import Skill, skill
    from robobt.tree import Sequence, Status
    from robobt.world import RobotCommand


    @skill
    class Advance(Skill):
        """Drives ahead."""

        def __init__(self, *, speed: float = 1.0, name: str = "") -> None:
            super().__init__(name)
            self.speed = speed

        def on_running(self) -> Status:
            self.store.command = RobotCommand(vx=self.speed)
            return self.run()


    @PLAYS.register("advance")
    def advance(*, speed: float = 1.0):
        """Advance and nothing else."""
        return Sequence("advance", memory=False, children=[Advance(speed=speed)])
'''


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Write]:
    """Writes a Python file; what it registers, and that it was imported, is forgotten after the test."""
    monkeypatch.setattr(python_files, "_imported", {})
    monkeypatch.setattr(sys, "path", list(sys.path))
    before = set(sys.modules)
    with temporarily(PLAYS), temporarily(SKILLS), temporarily(RATERS), temporarily(GO_TO_BALL_POLICIES):

        def make(source: str = MINE, name: str = "mine.py") -> Path:
            path = tmp_path / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(textwrap.dedent(source), encoding="utf-8")
            return path

        yield make
    for name in set(sys.modules) - before:
        if name.startswith("file_"):
            del sys.modules[name]


def test_what_a_file_registers_is_there(write: Write) -> None:
    module = import_file(write())
    assert SKILLS["Advance"] is module.Advance
    assert PLAYS["advance"](speed=0.5).children[0].speed == 0.5


def test_a_file_is_run_once(write: Write) -> None:
    path = write()
    assert import_file(path) is import_file(str(path))
    assert imported_files() == (path,)


def test_files_of_one_name_in_two_folders_are_two(write: Write) -> None:
    one = import_file(write("x = 1", "one/plays.py"))
    other = import_file(write("x = 2", "other/plays.py"))
    assert (one.x, other.x) == (1, 2)
    assert one.__name__ != other.__name__


def test_a_file_called_like_an_installed_module_takes_nobodys_place(write: Write) -> None:
    import_file(write("x = 1", "json.py"))
    import json

    assert json.dumps([1]) == "[1]"


def test_a_file_can_import_what_lies_beside_it(write: Write) -> None:
    write("ANSWER = 42", "beside_mine.py")
    assert import_file(write("from beside_mine import ANSWER")).ANSWER == 42


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("x = 1\nx = = 2\n", ":2: invalid syntax"),
        ("x = 1\n\ny = 1 / 0\n", ":3: ZeroDivisionError: division by zero"),
        ("def f():\n    raise KeyError('what')\n\nf()\n", ":2: KeyError: what"),
        ("import no_such_module_here\n", ":1: ModuleNotFoundError: No module named 'no_such_module_here'"),
        ("raise SystemExit(3)\n", ":1: SystemExit: 3"),
        ("import json\n\njson.loads('{')\n", ":3: JSONDecodeError: "),
        ("# -*- coding: nothing -*-\n", ": unknown encoding: nothing"),
        ("x = '\0'\n", ": "),
    ],
)
def test_what_is_wrong_is_one_line_with_file_and_line(write: Write, source: str, said: str) -> None:
    path = write(source)
    with pytest.raises(PythonFileError) as raised:
        import_file(path)
    assert str(raised.value).startswith(f"{path}{said}")
    assert "\n" not in str(raised.value)


def test_a_name_that_is_taken_is_told_with_both(write: Write) -> None:
    path = write(MINE.replace('"advance"', '"goalkeeper"'))
    with pytest.raises(
        PythonFileError, match=r"mine.py:\d+: ValueError: play 'goalkeeper' is registered twice"
    ):
        import_file(path)


@pytest.mark.parametrize(
    ("registry", "module"),
    [("PLAYS", "plays"), ("SKILLS", "skills"), ("RATERS", "skills.aim.raters")],
)
def test_registering_without_a_name_says_what_to_write(write: Write, registry: str, module: str) -> None:
    path = write(f"from robobt.{module} import {registry}\n\n@{registry}.register\ndef mine():\n    pass\n")
    with pytest.raises(PythonFileError) as raised:
        import_file(path)
    advice = f'{registry}.register takes a name: write @{registry}.register("mine")'
    assert str(raised.value) == f"{path}:3: TypeError: {advice}"
    path = write(f"from robobt.{module} import {registry}\n\n{registry}.register()\n", "empty.py")
    with pytest.raises(PythonFileError, match=rf"empty\.py:3: TypeError: {registry}.register takes a name"):
        import_file(path)


def test_a_name_given_twice_in_one_file_is_told_with_both_lines(write: Write) -> None:
    _, decorator, rest = MINE.partition("    @PLAYS")
    path = write(MINE + decorator + rest)
    with pytest.raises(PythonFileError) as raised:
        import_file(path)
    first, second = re.findall(r"mine\.py:(\d+): \w+(?= and|; give)", str(raised.value))
    assert int(first) < int(second)
    assert str(raised.value).endswith("; give one of them another name")


@pytest.mark.integration
def test_two_states_of_a_team_are_told_with_the_command_in_which_they_meet(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write()
    (tmp_path / "old").mkdir()
    (tmp_path / "old" / "mine.py").write_text((tmp_path / "mine.py").read_text())
    refused = CliRunner().invoke(app, ["list", "plays", "--import", "mine.py", "--import", "old/mine.py"])
    told = " ".join(refused.output.split())
    assert refused.exit_code == 1
    assert re.search(r"registered twice: mine\.py:\d+: \w+ and old/mine\.py:\d+: \w+; ", told)
    command = (
        told.rpartition(": robobt ")[2]
        .replace("SCENARIO", "striker_vs_goalkeeper")
        .replace("PLAY", "advance")
    )
    played = CliRunner().invoke(app, [*command.split(), "-n", "1", "--set", "ends.time_limit=1"])
    assert played.exit_code == 0, played.output


def test_a_file_that_raises_leaves_nothing_behind_and_may_be_mended(write: Write) -> None:
    path = write(textwrap.dedent(MINE) + "\nraise RuntimeError\n")
    with pytest.raises(PythonFileError):
        import_file(path)
    assert "Advance" not in SKILLS
    assert "advance" not in PLAYS
    assert imported_files() == ()
    write()
    assert import_file(path).Advance is SKILLS["Advance"]


@pytest.mark.parametrize("name", ["nowhere.py", "fol\0der.py", "."])
def test_a_file_that_cannot_be_read_is_told(name: str) -> None:
    with pytest.raises(PythonFileError, match="cannot be read"):
        import_file(name)


def test_another_file_is_refused(write: Write) -> None:
    with pytest.raises(PythonFileError, match=r"its name must end in \.py"):
        import_file(write("x = 1", "mine.txt"))


@pytest.mark.integration
def test_worker_processes_run_the_files_too(write: Write, tmp_path: Path) -> None:
    import_file(write())
    # A tree file names the skill; nothing that is sent to the worker does.
    (tmp_path / "ahead.yaml").write_text("play: ahead\ntree: {Advance: {speed: 0.5}}\n")
    robots = [
        {"number": number, "play": play, "start": {"position": [-2.0, number], "heading": 0.0}}
        for number, play in enumerate(("advance", str(tmp_path / "ahead.yaml")))
    ]
    played = scenario_from(
        data(robots={"blue": robots, "yellow": []}, ends={"time_limit": 0.2}, ball={"position": [0, 2]}),
        "test",
    )
    here, there = (run_trials_in(played, PlainWorld, 2, workers=workers).results for workers in (1, 2))
    assert [result.trace for result in here] == [result.trace for result in there]
    assert not any(robot.errors for result in there for robot in result.robots.values())


def test_the_documents_example_scores(write: Write) -> None:
    text = (Path(__file__).parents[2] / "docs" / "trees.md").read_text(encoding="utf-8")
    (source,) = re.findall(r"```python\n(# my_plays\.py\n.*?)```", text, re.DOTALL)
    import_file(write(source, "my_plays.py"))
    robot = {"number": 0, "play": "chase_and_shoot", "start": {"position": [0.0, 0.0], "heading": 0.0}}
    played = scenario_from(
        data(
            robots={"blue": [robot], "yellow": []}, ball={"position": [1.0, 0.2]}, ends={"time_limit": 20.0}
        ),
        "test",
    )
    (result,) = run_trials_in(played, sim_world, 1).results
    assert result.outcome == "goal_blue"
    assert result.robots["blue 0"].errors == 0


@pytest.mark.integration
def test_importing_needs_no_test_around_it(write: Write) -> None:
    code = f"from robobt.plays.python_files import import_file; print(import_file({str(write())!r}).advance)"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert "function advance" in said


def test_what_a_file_prints_is_no_figure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "talks.py").write_text("print('hello')\n")
    import_file(tmp_path / "talks.py")
    said = capsys.readouterr()
    assert (said.out, said.err) == ("", "hello\n")


def test_a_file_that_changes_the_working_folder_changes_nobody_elses(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "strays.py"
    file.write_text("import os\nos.chdir('/')\n")
    import_file(file)
    assert Path.cwd() == tmp_path
    assert "strays.py changes the working folder" in caplog.text
