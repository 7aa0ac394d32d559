"""A tournament: what is missing is played, on however many processes, whatever happens."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import pytest

from robobt.league.referee.process import GameControllerError
from robobt.match import ScenarioError
from robobt.match.recording import load_recording
from robobt.tournament import play as play_module
from robobt.tournament.claims import Claims
from robobt.tournament.fixtures import Fixture
from robobt.tournament.plan import Plan, TournamentError
from robobt.tournament.play import Played, play_tournament
from robobt.tournament.played import MAY_DIFFER, PlayedMatch
from robobt.tournament.recordings import Keep, Recordings
from tests.match.scripted import PlainWorld
from tests.tournament.made_up import drill, plan, runner

pytestmark = pytest.mark.integration


def rows(matches: list[PlayedMatch]) -> list[dict[str, Any]]:
    """All that has to be the same whenever and wherever a match is played."""
    return [
        {name: value for name, value in match.row().items() if name not in MAY_DIFFER} for match in matches
    ]


def run(what: Plan, path: Path, workers: int = 0, **options: Any) -> Played:
    with what.open_store(path) as store:
        return play_tournament(what, store, workers, **options)


def test_every_pairing_is_played_from_both_sides_with_one_seed(tmp_path: Path) -> None:
    matches = run(plan(), tmp_path / "a").matches
    assert len(matches) == 2 * 3 * 2
    for number in (0, 1):
        assert len({match.seed for match in matches if match.round == number}) == 1
    assert len({match.seed for match in matches}) == 2
    assert len({match.trace for match in matches}) == len(matches)


def test_the_better_side_wins_from_either_side(tmp_path: Path) -> None:
    matches = run(plan(4), tmp_path / "a").matches
    scores = {
        blue: sum(match.score("at 2") for match in matches if match.fixture[:2] == (blue, yellow))
        for blue, yellow in (("at 2", "at 0.5"), ("at 0.5", "at 2"))
    }
    assert min(scores.values()) >= 3.0


def test_worker_processes_play_the_same_tournament(tmp_path: Path) -> None:
    alone, shared = run(plan(), tmp_path / "a"), run(plan(), tmp_path / "b", 2)
    assert rows(shared.matches) == rows(alone.matches)
    assert not shared.failed


def test_only_what_is_missing_is_played(tmp_path: Path) -> None:
    whole = run(plan(3), tmp_path / "a")
    run(plan(1), tmp_path / "b")
    reported: list[Fixture] = []

    def refuse(_: object) -> PlainWorld:
        raise AssertionError("this match has been played")

    kept = run(plan(1, world=refuse), tmp_path / "b", on_match=lambda match: reported.append(match.fixture))
    assert len(kept.matches) == len(reported) == 6
    assert rows(run(plan(3), tmp_path / "b").matches) == rows(whole.matches)


def test_another_entrant_can_be_added_to_a_store(tmp_path: Path) -> None:
    run(plan(1, entrants=(runner(2.0), runner(1.0))), tmp_path / "a")
    assert len(run(plan(1), tmp_path / "a").matches) == 6


def test_it_stops_when_it_is_enough(tmp_path: Path) -> None:
    found = run(plan(5), tmp_path / "a", enough=lambda matches, _: len(matches) >= 4)
    assert len(found.matches) == 4


class RaisingWorld(PlainWorld):
    def act(self, commands: Any) -> None:
        if self.ticks > 3:
            raise RuntimeError("the field is on fire")
        super().act(commands)


def test_a_match_that_cannot_be_played_is_left_out_and_tried_again(tmp_path: Path) -> None:
    found = run(plan(1, world=RaisingWorld), tmp_path / "a")
    assert found.matches == []
    assert len(found.failed) == 6
    assert set(found.failed.values()) == {"RuntimeError: the field is on fire"}
    assert len(run(plan(1), tmp_path / "a").matches) == 6


class LosingItsController(PlainWorld):
    """Loses the game controller in the first try of every match."""

    lost: ClassVar[set[object]] = set()

    def reset(self, placement: Any, seed: int) -> None:
        super().reset(placement, seed)
        if seed not in self.lost:
            self.lost.add(seed)
            raise GameControllerError("the game controller closed the connection")


def test_a_match_whose_game_controller_is_lost_is_played_again(tmp_path: Path) -> None:
    two = (runner(2.0), runner(1.0))
    found = run(plan(1, world=LosingItsController, entrants=two), tmp_path / "a")
    assert not found.failed
    assert rows(found.matches) == rows(run(plan(1, entrants=two), tmp_path / "b").matches)


class WithoutController(PlainWorld):
    def reset(self, placement: Any, seed: int) -> None:
        raise GameControllerError("the game controller closed the connection")


def test_where_it_is_lost_again_the_match_is_left_out_and_the_tournament_ends(tmp_path: Path) -> None:
    found = run(plan(1, world=WithoutController), tmp_path / "a")
    assert len(found.failed) == 6
    assert "GameControllerError: the game controller closed" in next(iter(found.failed.values()))


def test_trees_that_fail_are_counted_and_the_match_goes_on(tmp_path: Path) -> None:
    broken = runner(0.25, breaks="raise")
    matches = run(plan(1, entrants=(runner(1.0), broken)), tmp_path / "a").matches
    assert all(match.side(broken.name).errors > 10 for match in matches)
    assert all(match.side("at 1").errors == 0 for match in matches)
    assert "broken on purpose" in str(matches[0].side(broken.name).first_error)


@pytest.mark.parametrize("keep", list(Keep))
def test_recordings_are_kept_of_what_matters(keep: Keep, tmp_path: Path) -> None:
    recordings = Recordings(tmp_path / "recordings", keep, "at 0.5")
    found = run(plan(1, entrants=(runner(0.5), runner(2.0))), tmp_path / "a", recordings=recordings)
    kept = recordings.kept(found.matches)
    assert {recordings.path(fixture) for fixture in kept} == set(recordings.folder.iterdir())
    for fixture in kept:
        assert load_recording(recordings.path(fixture)).header.trial == fixture.round


@pytest.mark.parametrize(
    ("changes", "error", "problem"),
    [
        ({"entrants": (runner(1.0),)}, TournamentError, "needs two entrants"),
        ({"entrants": (runner(1.0), runner(1.0))}, TournamentError, "two entrants are called 'at 1'"),
        ({"against": "nobody"}, TournamentError, "no entrant 'nobody' to play against"),
        ({"scenario": drill(simulator={"preset": "mars"})}, ScenarioError, "simulator"),
    ],
)
def test_what_cannot_be_played_is_told_before(
    changes: dict[str, Any], error: type[Exception], problem: str
) -> None:
    with pytest.raises(error, match=problem):
        plan(**changes)


def test_an_entrant_that_does_not_fit_the_scenario_is_told_before() -> None:
    with pytest.raises(
        Exception, match=r"scripted: .*robots\.blue\.0\.params\.speed: blue 0: speed must not be negative"
    ):
        plan(entrants=(runner(1.0), runner(-1.0)))


def test_who_waits_for_another_program_tells_it_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(play_module, "_CLAIM_POLL", 0.0)
    told: list[int] = []
    looks = 0

    def taken(_: Claims, __: object) -> bool:
        nonlocal looks
        looks += 1
        return looks > 6 * 40

    monkeypatch.setattr(Claims, "take", taken)
    found = run(plan(1), tmp_path / "a", on_wait=told.append)
    assert told == [6]
    assert len(found.matches) == 6
