"""A sweep tries candidates against one team, stops those that are surely worse, and confirms the best."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from robobt.tournament.entrants import Entrant, EntrantError
from robobt.tournament.fixtures import Fixture
from robobt.tournament.job import Job
from robobt.tournament.played import PlayedMatch, SideResult
from robobt.tournament.sequential import SequentialTest, Verdict
from robobt.tournament.store import MatchStore, StoreError
from robobt.tournament.sweeps.race import Race
from robobt.tournament.sweeps.search import Candidate, Swept, search
from robobt.tournament.sweeps.sweep import Sweep, confirm
from robobt.tournament.sweeps.vary import SweepError, read_varied
from tests.match.scripted import PlainWorld
from tests.tournament.made_up import drill, plan, played, runner


def tuned(**changes: Any) -> Sweep:
    """How fast should a runner be, against one at 1 m/s?"""
    given = {
        "scenario": drill(1.0),
        "play": "scripted",
        "params": {"kick": 4.0},
        "varied": (read_varied("scripted", "speed=0.2:3"),),
        "against": runner(1.0),
        "candidates": 12,
        "at_once": 4,
        "rounds": 20,
        "seed": 3,
        "world": PlainWorld,
    }
    return Sweep(**{**given, **changes})


def told(swept: Swept) -> list[Any]:
    return [(one.name, one.rounds, one.score, one.lead, one.stopped, one.problem) for one in swept.candidates]


def speed(one: Candidate) -> float:
    return float(str(one.params["speed"]))


@pytest.fixture
def made_up(monkeypatch: pytest.MonkeyPatch) -> list[Fixture]:
    """What was played: matches that the faster one wins, more often the faster it is; 2.2 m/s is best."""
    asked: list[Fixture] = []

    def decided(_: Job, fixture: Fixture, __: object) -> PlayedMatch:
        asked.append(fixture)
        other, blue = (fixture.yellow, False) if fixture.blue == "at 1" else (fixture.blue, True)
        gap = 1.2 - abs(float(other.rpartition("=")[2]) - 2.2)
        luck = random.Random(f"{other} {fixture.round} {blue}").gauss(0.0, 0.5)
        return played(*fixture, (1, 0) if (gap + luck > 0.0) is blue else (0, 1))

    monkeypatch.setattr(Job, "play", decided)
    return asked


def test_good_values_are_found_and_who_surely_is_worse_is_stopped(
    made_up: list[Fixture], tmp_path: Path
) -> None:
    swept = search(tuned(), tmp_path / "a")
    assert len(swept.candidates) == 12
    assert swept.best is not None
    assert 1.8 < speed(swept.best) < 2.6
    assert swept.best.rounds == 20
    assert swept.best.score is not None
    assert swept.best.score > 0.9
    assert swept.best.lead == pytest.approx(2.0 * swept.best.score - 1.0)
    stopped = [one for one in swept.candidates if one.stopped]
    assert {one.name for one in stopped} >= {one.name for one in swept.candidates if speed(one) < 0.6}
    assert all(abs(speed(one) - 2.2) > 0.5 and one.rounds < 20 for one in stopped)
    assert len(made_up) == len(swept.matches) < 2 * 20 * 12


@pytest.mark.integration
def test_it_is_the_same_for_any_number_of_workers(tmp_path: Path) -> None:
    sweep = tuned(scenario=drill(3.0), rounds=2, candidates=4, at_once=2)
    alone = search(sweep, tmp_path / "a")
    assert told(search(sweep, tmp_path / "b", 2)) == told(alone)


class HaltedError(Exception):
    pass


@pytest.mark.parametrize("most", [5, 150])
def test_a_search_that_was_stopped_goes_on_and_plays_nothing_twice(
    most: int, made_up: list[Fixture], tmp_path: Path
) -> None:
    whole = search(tuned(), tmp_path / "a")
    once = sorted(made_up)
    made_up.clear()

    def halt(_: int, __: Swept) -> None:
        if len(made_up) > most:
            raise HaltedError

    with pytest.raises(HaltedError):
        search(tuned(), tmp_path / "b", on_progress=halt)
    assert told(search(tuned(), tmp_path / "b")) == told(whole)
    assert sorted(made_up) == once


@pytest.mark.usefixtures("made_up")
def test_the_best_is_confirmed_on_seeds_that_the_search_never_used(tmp_path: Path) -> None:
    sweep = tuned()
    swept = search(sweep, tmp_path / "a")
    assert swept.best is not None
    test, fresh = confirm(sweep, swept.best.params, SequentialTest(0, 300), 40, tmp_path / "a")
    assert test.verdict is Verdict.BETTER
    assert test.rounds < 40
    assert min(match.round for match in fresh.matches) == 20
    assert max(match.round for match in swept.matches) == 19
    with MatchStore(tmp_path / "a") as store:
        assert len(store.matches()) == len(swept.matches) + len(fresh.matches)


@pytest.mark.usefixtures("made_up")
def test_a_store_goes_on_with_more_candidates_but_no_other_sweep(tmp_path: Path) -> None:
    search(tuned(candidates=4), tmp_path / "a")
    assert told(search(tuned(), tmp_path / "a")) == told(search(tuned(), tmp_path / "b"))
    for field, value in {"rounds": 19, "at_once": 3, "params": {"kick": 5.0}}.items():
        name = "sweep" if field == "params" else field
        with pytest.raises(StoreError, match=f"a: {name}: the store holds a tournament of"):
            search(tuned(**{field: value}), tmp_path / "a")


@pytest.mark.usefixtures("made_up")
def test_a_tournaments_store_is_no_sweeps(tmp_path: Path) -> None:
    plan(1).open_store(tmp_path / "a").close()
    with pytest.raises(StoreError, match="a: sweep: the store says nothing of that"):
        search(replace(tuned(), scenario=plan(1).scenario), tmp_path / "a")


@pytest.mark.usefixtures("made_up")
def test_what_went_wrong_in_a_candidates_trees_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def decided(_: Job, fixture: Fixture, __: object) -> PlayedMatch:
        match = played(*fixture, (0, 0))
        return replace(
            match, sides={**match.sides, "blue": SideResult(errors=3, first_error=f"{fixture.blue} failed")}
        )

    monkeypatch.setattr(Job, "play", decided)
    for one in search(tuned(candidates=2, rounds=2), tmp_path / "a").candidates:
        assert (one.errors, one.first_error) == (6, f"{one.name} failed")


def test_a_candidate_proposed_again_is_not_played_again(made_up: list[Fixture], tmp_path: Path) -> None:
    swept = search(tuned(varied=(read_varied("scripted", "speed=1.5,2.0"),)), tmp_path / "a")
    assert sorted(speed(one) for one in swept.candidates) == [1.5, 2.0]
    assert len(made_up) <= 2 * 20 * 2


@pytest.mark.usefixtures("made_up")
def test_who_all_play_is_no_candidate(tmp_path: Path) -> None:
    sweep = tuned(varied=(read_varied("scripted", "speed=0.5,2.0"),))
    sweep = replace(sweep, against=replace(runner(1.0), name=sweep.named({"speed": 0.5})))
    (refused,) = [one for one in search(sweep, tmp_path / "a").candidates if one.problem]
    assert refused.params == {"speed": 0.5}
    assert "two entrants are called" in str(refused.problem)


@pytest.mark.usefixtures("made_up")
def test_values_that_do_not_fit_each_other_are_told_and_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    entrant = Sweep.entrant

    def picky(sweep: Sweep, params: dict[str, Any]) -> Entrant:
        if len(params) == 2 and params["speed"] == params["kick"]:
            raise EntrantError("scripted", "never as fast as the ball")
        return entrant(sweep, params)

    monkeypatch.setattr(Sweep, "entrant", picky)
    varied = tuple([read_varied("scripted", text) for text in ("kick=1,2", "speed=1,2")])
    swept = search(tuned(params={}, varied=varied), tmp_path / "a")
    wrong = [one for one in swept.candidates if one.params["speed"] == one.params["kick"]]
    assert {one.problem for one in wrong} == {"scripted: never as fast as the ball"}
    assert swept.best is not None


def test_without_optuna_it_is_told_how_to_get_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "optuna", None)
    with pytest.raises(SweepError, match=r"pip install \"robobt\[sweep\]\""):
        search(tuned(), tmp_path / "a")


class TestRace:
    def race(self, scores: list[float], best: dict[int, float] | None = None) -> Race:
        race = Race("old", best or {}, 0.05)
        for number, score in enumerate(scores):
            goals = {0.0: ((0, 1), (1, 0)), 0.5: ((0, 1), (0, 1)), 1.0: ((1, 0), (0, 1))}[score]
            race.take(played("new", "old", number, goals[0]))
            race.take(played("old", "new", number, goals[1]))
        return race

    def test_who_loses_every_round_is_stopped(self) -> None:
        race = self.race([0.0] * 9)
        assert race.stopped == {"new": 7}
        assert race.scores("new") == dict.fromkeys(range(7), 0.0)
        assert race.needless(Fixture("old", "new", 9))

    def test_who_is_worse_than_the_best_in_the_same_rounds_is_stopped(self) -> None:
        assert not self.race([0.5] * 40).stopped
        assert self.race([0.5] * 40, dict.fromkeys(range(40), 1.0)).stopped == {"new": 11}
        assert not self.race([1.0] * 40, dict.fromkeys(range(40), 1.0)).stopped

    def test_rounds_count_up_to_the_first_that_is_missing(self) -> None:
        race = Race("old", {}, 0.05)
        for number in (0, 2):
            race.take(played("new", "old", number, (1, 0)))
            race.take(played("old", "new", number, (0, 1)))
        assert race.scores("new") == {0: 1.0}
        assert race.scores("new", [Fixture("new", "old", 1)]) == {0: 1.0, 2: 1.0}


class TestVaried:
    @pytest.mark.parametrize(
        ("text", "extremes"),
        [
            ("speed=0.2:3", (0.2, 3.0)),
            ("speed=1,2.5", (1, 2.5)),
            ("breaks=raise,nan", ("raise", "nan")),
            ("corner=[1, 2],[3, 4]", ([1, 2], [3, 4])),
        ],
    )
    def test_values_are_of_the_parameter(self, text: str, extremes: tuple[object, ...]) -> None:
        assert read_varied("scripted", text).extremes() == extremes

    def test_an_integer_is_varied_by_whole_numbers(self) -> None:
        assert read_varied("defender_2026_11", "place=0:2").extremes() == (0, 2)

    @pytest.mark.parametrize(
        ("text", "problem"),
        [
            ("sped=1,2", "sped: scripted has no such parameter; it has speed, kick"),
            ("speed", "what is varied is NAME=VALUE,VALUE,... or NAME=LOW:HIGH"),
            ("speed=3:1", "speed: a range goes from a number to a larger one, not '3:1'"),
            ("speed=1:2:3", "speed: a range is LOW:HIGH, two numbers, not '1:2:3'"),
            ("speed=1", "speed: needs two or more different values, VALUE,VALUE,... or a range"),
            ("speed=1,1.0", "speed: needs two or more different values"),
            ("speed=fast,slow", "speed: .*not 'fast'"),
            ("speed=[1", "speed: "),
            ("breaks=1:2", "breaks: .*"),
        ],
    )
    def test_what_cannot_be_varied_is_told(self, text: str, problem: str) -> None:
        with pytest.raises(SweepError, match=problem):
            read_varied("scripted", text)

    def test_a_range_that_the_play_refuses_is_told_before_anything_is_played(self) -> None:
        with pytest.raises(SweepError, match=r"^speed=-1\.0: .*speed must not be negative"):
            tuned(varied=(read_varied("scripted", "speed=-1:3"),))

    def test_whom_all_play_is_not_blamed_on_what_is_varied(self) -> None:
        with pytest.raises(EntrantError, match=r"^scripted: .*speed must not be negative"):
            tuned(against=runner(-1.0))

    def test_a_parameter_is_given_once(self) -> None:
        speed = read_varied("scripted", "speed=1,2")
        with pytest.raises(SweepError, match="speed: is given twice"):
            tuned(varied=(speed, speed))
        with pytest.raises(SweepError, match="speed: is given twice"):
            tuned(varied=(speed,), params={"speed": 1.0})


def test_few_combinations_are_all_tried_once(made_up: list[Fixture], tmp_path: Path) -> None:
    varied = (read_varied("scripted", "speed=1.8,2.2"), read_varied("scripted", "kick=3,4,5"))
    swept = search(tuned(varied=varied, params={}, candidates=6, rounds=1), tmp_path / "a")
    tried = [(one.params["speed"], one.params["kick"]) for one in swept.candidates]
    assert tried == [(speed, kick) for speed in (1.8, 2.2) for kick in (3, 4, 5)]
    assert len(made_up) == 12


def test_a_search_that_is_stopped_while_nothing_is_played_says_so(
    made_up: list[Fixture], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from robobt.tournament.sweeps import search as module

    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(module, "_judge", stopped)
    swept = search(tuned(rounds=1), tmp_path / "a")
    assert swept.interrupted
    assert len(swept.matches) == len(made_up) == 8
