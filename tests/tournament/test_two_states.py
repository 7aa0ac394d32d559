"""Two states of one team, with the same names in files of the same names, meet in a tournament."""

from __future__ import annotations

import json
import shutil
import sqlite3
import textwrap
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.match.recording import load_recording
from robobt.tournament.entrants import Entrant, EntrantError, read_entrant
from robobt.tournament.play import play_tournament
from robobt.tournament.recordings import Keep, Recordings
from robobt.tournament.store import StoreError
from tests.tournament.made_up import plan
from tests.tournament.test_play import rows

pytestmark = pytest.mark.integration

PLAYS = """
    from robobt.plays import PLAYS
    from runs import Run

    @PLAYS.register("striker")
    def striker(*, speed: float = {speed}):
        return Run(speed=speed)
"""

RUNS = """
    from robobt.skills.base import skill
    from tests.match.scripted import Scripted

    @skill
    class Run(Scripted):
        ticks = 0  # of this state's robots, in all matches

        def __init__(self, *, speed: float = 1.0, name: str = "") -> None:
            super().__init__(speed=speed, kick=4.0, breaks="", name=name)

        def on_running(self):
            import settings  # only now
            Run.ticks += 1
            self.speed = min(self.speed, settings.FASTEST)
            assert settings.STATE in __file__
            return super().on_running()
"""


def state(folder: Path, speed: float) -> str:
    """Write a state of the team and return its play."""
    folder.mkdir()
    (folder / "my_team.py").write_text(textwrap.dedent(PLAYS).format(speed=speed))
    (folder / "runs.py").write_text(textwrap.dedent(RUNS))
    (folder / "settings.py").write_text(f"STATE, FASTEST = '{folder.name}', {speed}\n")
    return f"{folder.name}/my_team.py:striker"


@pytest.fixture
def teams(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[str, str]:
    """Make a slow and a fast state, and return their plays as a command line has them."""
    monkeypatch.chdir(tmp_path)
    return state(tmp_path / "old", 0.25), state(tmp_path / "new", 2.0)


def entered(teams: tuple[str, str]) -> tuple[Entrant, Entrant]:
    return read_entrant(teams[0]), read_entrant(teams[1])


def test_each_plays_its_own_on_any_number_of_processes(teams: tuple[str, str], tmp_path: Path) -> None:
    found = {}
    for workers in (0, 2):
        what = plan(3, entrants=entered(teams))
        with what.open_store(tmp_path / f"{workers}.sqlite") as store:
            recordings = Recordings(tmp_path / f"kept_{workers}", Keep.ALL, teams[0])
            played = play_tournament(what, store, workers, recordings=recordings)
        assert not played.failed
        assert [match.side(name).first_error for match in played.matches for name in teams] == [None] * 12
        found[workers] = played.matches
    assert rows(found[0]) == rows(found[2])
    old, new = [sum(match.score(name) for match in found[0]) for name in teams]
    assert new > old + 2
    kept = load_recording(recordings.path(found[2][0].fixture)).header
    assert {robot.play for robot in kept.robots} == set(teams)
    assert {robot.tree[0].type for robot in kept.robots} == {"Run"}


def test_a_store_goes_on_with_the_states_that_it_knows_only(teams: tuple[str, str], tmp_path: Path) -> None:
    one, other = entered(teams)
    assert one.digest() != other.digest()
    path = tmp_path / "a.sqlite"
    for rounds in (1, 2):
        what = plan(rounds, entrants=(one, other))
        with what.open_store(path) as store:
            assert len(play_tournament(what, store).matches) == 2 * rounds
    shutil.copytree(tmp_path / "new", tmp_path / "edited")
    with (tmp_path / "edited" / "settings.py").open("a") as file:
        file.write("# edited\n")
    edited = read_entrant("edited/my_team.py:striker", name=teams[1])
    with pytest.raises(StoreError, match="is another team in this store"):
        plan(2, entrants=(one, edited)).open_store(path)


def test_files_that_are_edited_while_a_tournament_runs_change_nothing(
    teams: tuple[str, str], tmp_path: Path
) -> None:
    whole = plan(1, entrants=entered(teams))
    with whole.open_store(tmp_path / "a.sqlite") as store:
        before = play_tournament(whole, store).matches
    (tmp_path / "old" / "settings.py").write_text("STATE, FASTEST = 'old', 6.0\n")
    with whole.open_store(tmp_path / "b.sqlite") as store:
        assert rows(play_tournament(whole, store, 2).matches) == rows(before)


@pytest.mark.usefixtures("teams")
def test_entrants_files_in_one_folder_may_import_the_same_names(tmp_path: Path) -> None:
    entrants = []
    for name in ("old", "new"):
        (tmp_path / f"{name}.yaml").write_text(
            f"entrant: {name}\nimports: [{name}/runs.py, {name}/my_team.py]\nplayers: [{{play: striker}}]\n"
        )
        entrants.append(read_entrant(str(tmp_path / f"{name}.yaml")))
    what = plan(1, entrants=tuple(entrants))
    with what.open_store(tmp_path / "a.sqlite") as store:
        played = play_tournament(what, store)
    assert not played.failed
    assert [match.side("old").errors + match.side("new").errors for match in played.matches] == [0, 0]


@pytest.mark.usefixtures("teams")
def test_a_play_that_a_python_file_does_not_register_is_told() -> None:
    with pytest.raises(EntrantError, match=r"no play is called 'strikr' in old/my_team.py"):
        read_entrant("old/my_team.py:strikr")


QUICK = ("--scenario", "striker_vs_goalkeeper", "--set", "ends.time_limit=0.3", "--workers", "2")


def test_a_sequential_test_compares_two_states(teams: tuple[str, str]) -> None:
    old, new = teams
    given = [
        "tournament",
        "run",
        f"{new}:speed=1.5",
        "--against",
        old,
        "--sprt",
        "0",
        "30",
        *QUICK,
        "--rounds",
        "1",
    ]
    for _ in range(2):
        shown = CliRunner().invoke(app, [*given, "--out", "ci.sqlite", "--json"])
        assert shown.exit_code == 2, shown.output
        said = json.loads(shown.stdout)
        assert set(said["standings"]) == {f"{new}:speed=1.5", old}
        assert (said["failed"], said["matches"]) == ({}, 2)
    with sqlite3.connect("ci.sqlite") as store:
        assert len({digest for (digest,) in store.execute("SELECT digest FROM entrants")}) == 2


@pytest.mark.usefixtures("teams")
def test_the_command_of_the_documentation_compares_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (Path(__file__).parents[2] / "docs" / "tournament.md").read_text(encoding="utf-8")
    command = next(line for line in text.splitlines() if "../old/my_team.py:striker" in line).split()
    monkeypatch.chdir(tmp_path / "new")
    shown = CliRunner().invoke(app, [*command[1:], *QUICK[:-1], "0", "--rounds", "1"])
    assert shown.exit_code == 2, shown.output
    assert "undecided between my_team.py:striker" in " ".join(shown.output.split())


def test_a_sweep_tunes_one_state_against_another(teams: tuple[str, str]) -> None:
    pytest.importorskip("optuna")
    old, new = teams
    sizes = ("--candidates", "2", "--concurrent", "2", "--rounds", "1", "--confirm-rounds", "0")
    given = [
        "tournament",
        "sweep",
        new,
        "--vary",
        "speed=0.5,1.5",
        "--against",
        old,
        *sizes,
        *QUICK,
        "--json",
    ]
    shown = CliRunner().invoke(app, given)
    said = json.loads(shown.stdout)
    assert (shown.exit_code, said["failed"]) == (1, {}), shown.output
    assert {one["name"] for one in said["candidates"]} <= {f"{new}:speed=0.5", f"{new}:speed=1.5"}
    assert [one["first_error"] for one in said["candidates"]] == [None] * len(said["candidates"])
