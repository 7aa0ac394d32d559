"""Entrants that end the process, hang or flood: they lose by rule, and the tournament goes on."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robobt.plays import PLAYS, python_files
from robobt.tournament.entrants import read_entrant
from robobt.tournament.fixtures import Fixture
from robobt.tournament.play import Played, play_tournament
from tests.registries import temporarily
from tests.tournament.made_up import plan, runner

pytestmark = pytest.mark.integration

HOSTILE = """
import os, signal, sys
from pathlib import Path
from robobt import PLAYS
from robobt.skills.base import Skill


class Hostile(Skill):
    def __init__(self, *, what: str = "", name: str = "") -> None:
        super().__init__(name)
        self.what = what

    def on_running(self):
        if self.what == "quits":
            os._exit(3)
        if self.what == "exits":
            sys.exit(0)
        if self.what == "killed":
            os.kill(os.getpid(), signal.SIGKILL)
        if self.what == "killed once":
            try:
                Path(__file__).with_name("killed").touch(exist_ok=False)
            except FileExistsError:
                return self.run()
            os.kill(os.getpid(), signal.SIGKILL)
        if self.what == "interrupts":
            raise KeyboardInterrupt
        if self.what == "shouts":
            os.write(1, b"x" * 1_000_000)
        while self.what == "hangs":
            pass
        return self.run()


def hostile(*, what: str = "quits"):
    return Hostile(what=what)


PLAYS.register("hostile")(hostile)
"""


@pytest.fixture
def _hostile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(python_files, "_imported", {})
    monkeypatch.setattr(sys, "path", list(sys.path))
    (tmp_path / "hostile.py").write_text(HOSTILE)
    with temporarily(PLAYS):
        python_files.import_file(tmp_path / "hostile.py")
        yield


def tournament(path: Path, *what: str, rounds: int = 1, workers: int = 2, **options: Any) -> Played:
    teams = [read_entrant("hostile", {"what": name}, name) for name in what]
    against = plan(rounds, entrants=(runner(1.0), *teams), against="at 1", silence=8.0)
    with against.open_store(path / "night.sqlite") as store:
        return play_tournament(against, store, workers, **options)


@pytest.mark.usefixtures("_hostile")
def test_a_match_whose_process_is_killed_from_outside_is_played_again(tmp_path: Path) -> None:
    ended: list[Fixture] = []
    found = tournament(
        tmp_path, "killed once", rounds=2, workers=1, on_match=lambda match: ended.append(match.fixture)
    )
    assert (tmp_path / "killed").exists()
    assert [match.forfeited_by for match in found.matches] == [None] * 4
    assert not found.failed
    # A sequential test waits for the first round: it must not have to until all others are played.
    assert [(one.blue, one.round) for one in ended[:2]] == [("at 1", 0), ("killed once", 0)]


@pytest.mark.usefixtures("_hostile")
def test_who_ends_the_process_has_lost_from_either_side(tmp_path: Path) -> None:
    found = tournament(tmp_path, "quits")
    assert [match.forfeited_by for match in found.matches] == ["quits", "quits"]
    assert {match.outcome for match in found.matches} == {"forfeit_blue", "forfeit_yellow"}
    told = found.matches[0].side("quits").first_error
    assert told == "quits: its worker process died (exit code 3)"
    assert not found.failed


@pytest.mark.slow
@pytest.mark.usefixtures("_hostile")
def test_a_tournament_of_hostile_entrants_ends(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    wicked = ("quits", "exits", "killed", "interrupts", "hangs")
    found = tournament(tmp_path, *wicked, "shouts")
    assert len(found.matches) == 2 * (len(wicked) + 1)
    for name in wicked:
        assert [match.forfeited_by for match in found.matches if name in match.fixture] == [name, name]
    assert all(match.forfeited_by is None for match in found.matches if "shouts" in match.fixture)
    assert not found.failed
    assert "xxx" not in capfd.readouterr().out
