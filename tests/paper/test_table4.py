"""Table 4: the paper's figures beside ours."""

from __future__ import annotations

import json
import pickle
from collections.abc import Iterable, Iterator
from math import radians
from pathlib import Path

import pytest
from typer.testing import CliRunner

from paper.__main__ import application
from paper.table4 import COMBINATIONS, Conditions, table4
from paper.table4 import LEARNED as LEARNED_ROW
from paper.table4_picture import draw_table4
from paper.table4_rows import PAPER
from paper.table4_runs import Attempt, play_attempt
from paper.table4_starts import LIMITS, drawn_starts, minimum_times, table4_scenario
from robobt.engines.run import running_on
from robobt.engines.work import Work
from robobt.match import load_scenario
from robobt.match.loop import MatchLoop, WorldFactory
from robobt.match.results.file import ResultsFileError
from robobt.match.runner import RunError, trial_seed
from robobt.match.scenario.scenario import Scenario
from robobt.models.policy import load_policy
from robobt.sim.settings import settings_from
from robobt.world.state import Frame
from robobt.worlds import sim_world

pytestmark = pytest.mark.integration

QUICK = ("robobulls", "geometric, kick")
SHIPPED = "3-step ddpg, ddpg"
LEARNED = COMBINATIONS[SHIPPED]


@pytest.mark.parametrize("trial", ["1", "2"])
@pytest.mark.parametrize("row", ["ddpg", "baseline", "human"])
def test_the_papers_totals_are_the_sums_of_its_parts(trial: str, row: str) -> None:
    figures = PAPER[trial][row]
    assert figures["to_ball"] + figures["shoot"] == pytest.approx(figures["total"], abs=2e-4)


def test_the_table_holds_every_figure() -> None:
    found = table4(3, combinations=QUICK, conditions=Conditions(limits=["own"]), trials=["1"])["limits"][
        "own"
    ]["1"]
    row = found["rows"]["geometric, kick"]
    goals = row["goals"]
    assert (goals.count, goals.rate, goals.high) == (3, 1.0, 1.0)
    assert goals.low == pytest.approx(0.4385, abs=1e-3)
    for part in ("approach", "pick_up", "to_ball"):
        assert row[part]["n"] == 3
    assert row["approach"]["low"] < row["approach"]["mean"] < row["approach"]["high"]
    assert row["approach"]["mean"] + row["pick_up"]["mean"] == pytest.approx(row["to_ball"]["mean"])
    assert row["to_ball"]["mean"] + row["shoot"]["mean"] == pytest.approx(row["total"]["mean"])
    assert row["ball_ratio"] > 1.0
    assert row["paper_start"]["goal"]
    assert found["best_hand_written"] == "geometric, kick"
    assert found["to_ball"] is found["to_kick"] is None


def test_runs_that_were_kept_are_not_played_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kinds = {"combinations": QUICK[1:], "conditions": Conditions(limits=["own"]), "trials": ["1"]}
    whole = table4(3, **kinds)
    played: list[int] = []

    def killed_at_the_second(
        scenario: Scenario, seed: int, world: WorldFactory, trial: int = 0, show: None = None
    ) -> Attempt:
        if trial == 1 and len(played) == 1:
            raise KeyboardInterrupt
        played.append(trial)
        return play_attempt(scenario, seed, world, trial)

    monkeypatch.setattr("paper.table4_runs.play_attempt", killed_at_the_second)
    with pytest.raises(KeyboardInterrupt):
        table4(3, out=tmp_path, **kinds)
    (file,) = tmp_path.iterdir()
    # Cut off in the middle of a line, as a process may be.
    file.write_text(file.read_text() + '{"trial":1,"appr')
    played.append(-1)
    assert table4(3, out=tmp_path, **kinds) == whole
    # Then the run from the paper's own start, which is not kept.
    assert played == [0, -1, 1, 2, 0]
    with pytest.raises(ResultsFileError, match="holds results of seed 1"):
        table4(3, 2, out=tmp_path, **kinds)


def test_runs_are_the_same_wherever_they_are_played(tmp_path: Path) -> None:
    kinds = {"combinations": QUICK, "conditions": Conditions(limits=["own"]), "trials": ["1"]}
    here = table4(2, **kinds)
    played: list[object] = []

    class Elsewhere:
        workers = 2

        def run(self, work: Work, tasks: Iterable[object], workers: int, **_: object) -> Iterator[object]:
            sent = pickle.loads(work.packed())
            for task in reversed(list(tasks)):
                played.append(task)
                yield sent.attempt(task, print)

    with running_on(Elsewhere()):
        assert table4(2, workers=2, out=tmp_path, **kinds) == here
    assert len(played) == 6
    assert {path.name: len(path.read_text().splitlines()) for path in tmp_path.iterdir()} == {
        "own-1-robobulls.jsonl": 3,
        "own-1-geometric-kick.jsonl": 3,
    }


def test_what_goes_wrong_in_a_run_is_named_with_its_row(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> Attempt:
        raise ZeroDivisionError("on purpose")

    monkeypatch.setattr("paper.table4_runs.play_attempt", broken)
    with pytest.raises(RunError, match=r"run 0 of 'robobulls' \(trial 1, limits own\): ZeroDivisionError"):
        table4(1, combinations=QUICK[:1], conditions=Conditions(limits=["own"]))


def test_runs_that_are_all_the_same_have_no_interval() -> None:
    """From the paper's start without noise every run is the same one."""
    found = table4(
        3,
        conditions=Conditions(realism="none", limits=["own"], starts="paper"),
        combinations=["geometric, kick"],
    )
    for trial in found["limits"]["own"].values():
        total = trial["rows"]["geometric, kick"]["total"]
        assert (total["variance"], total["low"], total["high"]) == (0.0, None, None)
        goals = trial["rows"]["geometric, kick"]["goals"]
        assert (goals.count, goals.low, goals.high) == (3, None, None)


def test_all_rows_start_from_the_same_places() -> None:
    scenarios = [drawn_starts(table4_scenario("2", COMBINATIONS[name])) for name in COMBINATIONS]
    assert len({str((one.robots.blue[0].start, one.ball)) for one in scenarios}) == 1
    starts = [start_of(scenarios[0], seed) for seed in range(20)]
    assert len({start.ball.position for start in starts}) == 20
    for start in starts:
        me, ball = start.own[0], start.ball
        assert max(abs(me.x + 3.9), abs(me.y)) <= 0.1
        assert abs(me.heading) <= radians(10.0)
        assert max(abs(ball.x), abs(ball.y - 1.5)) <= 0.05


@pytest.mark.parametrize("name", ["pilot"])
def test_limits_bind_every_robot(name: str) -> None:
    start = start_of(table4_scenario("1", {}, limits=LIMITS[name]), 1)
    assert start.own[0].limits.max_speed == 1.5
    assert start.own[0].limits.acceleration == (4.15 if name == "paper" else 2.5)


def test_the_minimum_is_a_straight_line_into_the_mouth() -> None:
    """From (-3.9, 0) m: 0.112 m before the ball's centre is in the mouth, grSim's acceleration."""
    scenario = table4_scenario("1", {}, limits=LIMITS["paper"])
    least = minimum_times(start_of(scenario, 1), settings_from(scenario.simulator))
    assert least["to_ball"] == pytest.approx((3.9 - 0.112) / 1.5 + 1.5 / (2 * 4.15), abs=1e-6)
    assert least["to_kick"] == pytest.approx(least["to_ball"], abs=1e-4)


def test_facing_the_goal_takes_a_longer_way_to_a_ball_aside() -> None:
    scenario = table4_scenario("2", {}, limits=LIMITS["paper"])
    least = minimum_times(start_of(scenario, 1), settings_from(scenario.simulator))
    assert 0.005 < least["to_kick"] - least["to_ball"] < 0.03


def start_of(scenario: Scenario, seed: int) -> Frame:
    with MatchLoop(scenario, seed, sim_world) as match:
        return match.world.truth()


def test_another_simulator_keeps_the_trial() -> None:
    own, other = table4_scenario("2", {}), table4_scenario("2", {}, "erforce", "realistic")
    assert (other.ball, other.period) == (own.ball, own.period)
    assert other.simulator["preset"] == "erforce"
    assert other.simulator["realism"] == "realistic"


def test_a_run_is_the_bundled_scenario_played_with_the_same_seed() -> None:
    for trial in ("1", "2"):
        bundled = load_scenario(f"table4_trial{trial}_ddpg")
        # The table's rows share the simpler grSim; this one is played in the preset that is like the real.
        ours = table4_scenario(trial, LEARNED).model_copy(update={"simulator": bundled.simulator})
        assert dict(bundled.robots.blue[0].params) == LEARNED
        assert bundled.simulator["preset"] == "grsim"
        assert play_attempt(bundled, 7) == play_attempt(ours, 7)


@pytest.mark.parametrize("trial", ["1", "2"])
def test_the_learned_skills_score_and_are_sooner_at_the_ball_than_the_papers(trial: str) -> None:
    """At the paper's limits; six of the hundred runs of ``python -m paper table4 --runs 100``."""
    found = table4(6, combinations=[LEARNED_ROW], conditions=Conditions(limits=["paper"]), trials=[trial])
    row = found["limits"]["paper"][trial]["rows"][LEARNED_ROW]
    assert row["goals"].count == 6
    assert row["to_ball"]["mean"] <= PAPER[trial]["ddpg"]["to_ball"]
    assert row["ball_ratio"] <= 1.03


def test_rows_are_named_by_what_the_models_were_trained_with() -> None:
    approach, shot = load_policy("go_to_ball_ddpg").card, load_policy("shoot_ddpg").card
    assert f"{approach.algorithm}, {shot.algorithm}" == SHIPPED


@pytest.mark.parametrize("trial", ["1", "2"])
@pytest.mark.parametrize(
    ("preset", "realism"), [("grsim", None), ("erforce", None), ("default", None), ("grsim", "realistic")]
)
def test_the_shipped_models_score_in_simulators_they_were_not_trained_in(
    preset: str, realism: str | None, trial: str
) -> None:
    scenario = table4_scenario(trial, LEARNED, preset, realism)
    runs = [play_attempt(scenario, trial_seed(1, run)) for run in range(3)]
    assert sum(run.to_ball is not None for run in runs) == 3
    assert sum(run.goal for run in runs) >= 2


def test_the_picture_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    result = table4(2, combinations=QUICK, conditions=Conditions(limits=["own", "paper"]))
    draw_table4(result, tmp_path / "sub" / "table4.png")
    assert (tmp_path / "sub" / "table4.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ValueError, match="not supported"):
        draw_table4(result, tmp_path / "table4.doc")
    assert [path.name for path in tmp_path.iterdir()] == ["sub"]


def test_the_command_prints_and_is_read_by_programs() -> None:
    call = ["table4", "--runs", "1", "--only", "geometric, kick", "--limits", "paper"]
    shown = CliRunner().invoke(application(), call)
    assert shown.exit_code == 0, shown.output
    assert "baseline" in shown.stdout
    assert "minimum  " in shown.stdout
    assert "1/1" in shown.stdout
    told = json.loads(CliRunner().invoke(application(), [*call, "--json"]).stdout)
    assert told["runs"] == 1
    assert set(told["limits"]["paper"]["2"]["rows"]) == {"geometric, kick"}


@pytest.mark.parametrize(
    "wrong",
    [
        ["--limits", "none"],
        ["--starts", "x"],
        ["--preset", "mars"],
        ["--realism", "dreamy"],
        ["--only", "nobody"],
        ["--runs", "0"],
        ["--workers", "2", "--world", "league://grsim"],
        ["--workers", "2", "--human"],
    ],
)
def test_what_there_is_not_is_said(wrong: list[str]) -> None:
    refused = CliRunner().invoke(application(), ["table4", "--runs", "1", *wrong])
    assert refused.exit_code == 2
