import json
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from robobt.match import MatchResult, RobotResult, Scenario, run_trials_in, summarise
from robobt.match.results.file import ResultsFile, ResultsFileError
from robobt.match.results.teams import TeamResult
from robobt.match.scenario.scenario import scenario_from
from robobt.world.protocol import World
from robobt.worlds import sim_world
from tests.match.scripted import data


def trial(number: int, outcome: str = "goal_blue", **changes: object) -> MatchResult:
    result = MatchResult(
        scenario="test",
        trial=number,
        seed=100 + number,
        outcome=outcome,
        time=2.0,
        blue_score=1 if outcome == "goal_blue" else 0,
        yellow_score=0,
        in_play=1.0,
        ticks=100,
        robots={"blue 0": RobotResult(1.0 + number, 0.25, 1), "yellow 0": RobotResult()},
        trace=f"{number:032x}",
        wall_time=0.5,
        teams={"blue": TeamResult(goals=number, possession=0.5), "yellow": TeamResult()},
    )
    return replace(result, **changes)  # type: ignore[arg-type]


class TestSummary:
    def test_outcomes_are_counted_with_their_wilson_interval(self):
        summary = summarise([trial(i, "goal_blue" if i < 28 else "saved") for i in range(100)])
        goals = summary.outcomes["goal_blue"]
        assert (goals.count, goals.rate) == (28, 0.28)
        assert (goals.low, goals.high) == pytest.approx((0.2014, 0.3749), abs=1e-4)
        assert summary.outcomes["saved"].count == 72
        assert summary.goals["blue"].total == summary.goals["blue"].trials.count == 28
        assert summary.goals["yellow"].total == 0

    def test_each_figure_of_a_team_has_its_mean(self):
        summary = summarise([trial(i) for i in range(3)])
        assert summary.teams["blue"]["goals"].mean == 1.0
        assert summary.teams["yellow"]["possession"].mean == 0.0

    def test_one_trial_repeated_has_no_interval(self):
        summary = summarise([trial(i, trace="same") for i in range(20)])
        goals = summary.outcomes["goal_blue"]
        assert (summary.distinct, goals.count, goals.rate) == (1, 20, 1.0)
        assert (goals.low, goals.high) == (None, None)
        assert goals.interval() == "none: one trial, repeated"

    def test_trials_that_repeat_another_count_once_for_the_interval(self):
        repeated = summarise(
            [trial(i, "goal_blue" if i % 2 else "saved", trace=str(i % 4)) for i in range(40)]
        )
        once = summarise([trial(i, "goal_blue" if i % 2 else "saved") for i in range(4)])
        mine, theirs = repeated.outcomes["goal_blue"], once.outcomes["goal_blue"]
        assert (repeated.distinct, mine.count, mine.rate) == (4, 20, 0.5)
        assert (mine.low, mine.high) == (theirs.low, theirs.high)

    def test_several_goals_in_a_trial_are_one_trial_with_a_goal(self):
        summary = summarise([trial(0, "time", blue_score=3), trial(1, "time")])
        assert summary.goals["blue"].total == 3
        assert summary.goals["blue"].trials.rate == 0.5

    def test_times_have_mean_and_sample_variance(self):
        robot = summarise([trial(0), trial(1), trial(2)]).robots["blue 0"]
        assert (robot.go_to_ball.n, robot.go_to_ball.mean, robot.go_to_ball.variance) == (3, 2.0, 1.0)
        assert robot.total.mean == 2.25

    def test_a_robot_that_never_had_the_ball_has_no_times(self):
        robot = summarise([trial(0)]).robots["yellow 0"]
        assert (robot.go_to_ball.n, robot.go_to_ball.mean, robot.go_to_ball.variance) == (0, None, None)

    def test_errors_are_added_up_and_the_first_is_told(self):
        broken = {"blue 0": RobotResult(errors=3, first_error="Scripted: broken")}
        robot = summarise([trial(0), trial(1, robots=broken), trial(2, robots=broken)]).robots["blue 0"]
        assert (robot.errors, robot.first_error) == (6, "Scripted: broken")

    def test_the_order_of_the_trials_does_not_matter(self):
        trials = [trial(i) for i in range(5)]
        assert summarise(trials) == summarise(trials[::-1])

    def test_the_trace_is_that_of_all_trials(self):
        assert summarise([trial(0), trial(1)]).trace != summarise([trial(0), trial(2)]).trace

    def test_the_real_time_factor_is_simulated_over_computing_time(self):
        assert summarise([trial(0), trial(1)]).real_time_factor == 4.0

    def test_nothing_to_summarise_is_an_error(self):
        with pytest.raises(ValueError, match="no trial"):
            summarise([])

    def test_it_is_plain_json(self):
        told = json.loads(json.dumps(summarise([trial(0)]).to_json(), allow_nan=False))
        assert told["outcomes"]["goal_blue"]["count"] == 1
        assert told["robots"]["blue 0"]["shoot"] == {"n": 1, "mean": 0.25, "variance": None}


def test_a_result_survives_json():
    assert MatchResult.from_json(json.loads(json.dumps(trial(3).to_json()))) == trial(3)


@pytest.mark.parametrize(
    "broken",
    [
        {},
        {"robots": []},
        {**trial(0).to_json(), "robots": {"blue 0": {"x": 1}}},
        {**trial(0).to_json(), "robots": {"blue 0": {"kicks": "many"}}},
        {**trial(0).to_json(), "time": None},
        {**trial(0).to_json(), "time": float("inf")},
        {**trial(0).to_json(), "outcome": []},
    ],
    ids=str,
)
def test_what_is_no_result_is_refused(broken: dict[str, object]):
    with pytest.raises(ValueError, match="not the result of a trial"):
        MatchResult.from_json(broken)


class TestResultsFile:
    scenario = scenario_from(data(), "test.yaml")

    def write(self, path: Path, *results: MatchResult, seed: int = 0) -> None:
        with ResultsFile(path, self.scenario, seed) as file:
            for result in results:
                file.add(result)

    def test_it_is_taken_up_where_it_was_left(self, tmp_path: Path):
        path = tmp_path / "new folder" / "results.jsonl"
        self.write(path, trial(0), trial(2))
        self.write(path, trial(1))
        with ResultsFile(path, self.scenario, 0) as file:
            assert file.done == {0: trial(0), 1: trial(1), 2: trial(2)}

    def test_results_under_another_referee_are_not_mixed_with_it(self, tmp_path: Path):
        path = tmp_path / "results.jsonl"
        self.write(path, trial(0))
        with pytest.raises(ResultsFileError, match="holds results of referee 'own'"):
            ResultsFile(path, self.scenario, 0, None, "official")

    @pytest.mark.skipif(sys.platform == "win32", reason="there are no such locks")
    def test_two_runs_do_not_write_it_at_once(self, tmp_path: Path):
        path = tmp_path / "results.jsonl"
        with ResultsFile(path, self.scenario, 0) as file:
            file.add(trial(0))
            with pytest.raises(ResultsFileError, match=r"results\.jsonl: is being written by another run"):
                ResultsFile(path, self.scenario, 0)
            file.add(trial(1))
        with ResultsFile(path, self.scenario, 0) as file:
            assert sorted(file.done) == [0, 1]

    @pytest.mark.parametrize("cut", [1, 20, 200])
    def test_a_last_line_that_was_cut_is_dropped(self, tmp_path: Path, cut: int):
        path = tmp_path / "results.jsonl"
        self.write(path, trial(0), trial(1))
        path.write_bytes(path.read_bytes()[:-cut])
        self.write(path, trial(2))
        with ResultsFile(path, self.scenario, 0) as file:
            assert sorted(file.done) == [0, 2]

    @pytest.mark.parametrize("damage", [b"\x00" * 50 + b"\n", b"{\n", b"[" * 100_000 + b"\n", b"\n"])
    def test_a_damaged_line_costs_no_other(self, tmp_path: Path, damage: bytes):
        path = tmp_path / "results.jsonl"
        self.write(path, trial(0), trial(1), trial(2), trial(3))
        lines = path.read_bytes().splitlines(keepends=True)
        path.write_bytes(b"".join([*lines[:2], damage, *lines[3:-1], lines[-1][:-9]]))
        with ResultsFile(path, self.scenario, 0) as file:
            assert sorted(file.done) == [0, 2]
            file.add(trial(1))
            file.add(trial(3))
        with ResultsFile(path, self.scenario, 0) as file:
            assert file.done == {number: trial(number) for number in range(4)}

    def test_how_often_does_not_make_it_another_scenario(self, tmp_path: Path):
        path = tmp_path / "results.jsonl"
        self.write(path, trial(0))
        with ResultsFile(path, scenario_from(data(trials=9), "test.yaml"), 0) as file:
            assert sorted(file.done) == [0]

    def test_results_of_something_else_are_not_continued(self, tmp_path: Path):
        path = tmp_path / "results.jsonl"
        self.write(path, trial(0))
        with pytest.raises(ResultsFileError, match=r"results\.jsonl: holds results of seed 0"):
            ResultsFile(path, self.scenario, 1)
        with pytest.raises(ResultsFileError, match="another version of the scenario"):
            ResultsFile(path, scenario_from(data(period=0.03), "test.yaml"), 0)
        with pytest.raises(ResultsFileError, match="scenario 'test'"):
            ResultsFile(path, scenario_from(data(name="other"), "test.yaml"), 0)

    def test_results_of_another_world_are_not_continued(self, tmp_path: Path):
        class Factory:
            address = "league://grsim"

            def __call__(self, scenario: Scenario) -> World:
                return sim_world(scenario)

        path = tmp_path / "results.jsonl"
        scenario = self.scenario.lasting(0.1)
        run_trials_in(scenario, sim_world, 1, out=path)
        with pytest.raises(ResultsFileError, match="holds results of world 'sim'"):
            run_trials_in(scenario, Factory(), 1, out=path)
        path.unlink()
        run_trials_in(scenario, Factory(), 1, out=path)
        assert len(run_trials_in(scenario, Factory(), 2, out=path).results) == 2
        with pytest.raises(ResultsFileError, match="holds results of world 'league://grsim'"):
            run_trials_in(scenario, sim_world, 1, out=path)

    def test_another_tree_in_the_same_file_is_another_scenario(self, tmp_path: Path):
        tree, path = tmp_path / "tree.yaml", tmp_path / "results.jsonl"
        start = {"position": [-1.0, 0.0]}
        robots = {"blue": [{"number": 0, "play": str(tree), "start": start}]}
        scenario = data(robots=robots)
        tree.write_text("play: mine\ntree: Stop\n")
        with ResultsFile(path, scenario_from(scenario, "test.yaml"), 0) as file:
            file.add(trial(0))
        tree.write_text("play: mine\ntree: GoToBall\n")
        with pytest.raises(ResultsFileError, match="another version of the scenario"):
            ResultsFile(path, scenario_from(scenario, "test.yaml"), 0)

    @pytest.mark.parametrize("content", ["", "hello\n", "[]\n", '{"format": "x"}\n', "{}"])
    def test_another_file_is_not_overwritten(self, tmp_path: Path, content: str):
        path = tmp_path / "notes.txt"
        path.write_text(content)
        if content:
            with pytest.raises(ResultsFileError, match="not a file of results"):
                ResultsFile(path, self.scenario, 0)
            assert path.read_text() == content
        else:
            self.write(path, trial(0))
            assert len(path.read_text().splitlines()) == 2
