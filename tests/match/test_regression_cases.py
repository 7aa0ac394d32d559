import json
from pathlib import Path

import pytest

from robobt.config.resources import bundled_scenarios
from robobt.config.yaml import parse_marked, write_yaml
from robobt.match import MatchLoop
from robobt.match.recording import load_recording
from robobt.match.regression_cases import (
    RegressionCaseError,
    RegressionError,
    check_regression_case,
    load_regression_case,
    save_regression_case,
)
from robobt.match.scenario.scenario import load_scenario
from robobt.plays import PLAYS
from robobt.plays.files import tree_yaml
from robobt.skills import SelectShot
from robobt.tree import Status
from robobt.world import RobotId, Team
from robobt.worlds import sim_world
from tests.match.recording.made_recording import record

BLUE_0 = RobotId(Team.BLUE, 0)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("match") / "match.robobt.arrows"
    scenario = load_scenario("striker_vs_goalkeeper").with_robot("blue 0", max_distance=None)
    MatchLoop(scenario.lasting(1.5), 3, sim_world, path).play()
    return path


@pytest.fixture
def case(recording: Path, tmp_path: Path) -> Path:
    return save_regression_case(load_recording(recording), BLUE_0, 20, tmp_path / "case.yaml")


def test_a_saved_tick_is_played_again_to_the_same_end(case: Path) -> None:
    check_regression_case(case)
    loaded = load_regression_case(case)
    assert (loaded.robot, loaded.tick) == (BLUE_0, 20)
    recorded = loaded.recording.ticked_path(BLUE_0, 20)
    assert recorded
    assert set(recorded) <= set(loaded.expected.statuses)


def test_every_tick_of_a_match_can_be_a_case(recording: Path, tmp_path: Path) -> None:
    whole = load_recording(recording)
    for tick in range(0, len(whole) - 1, 13):
        check_regression_case(save_regression_case(whole, BLUE_0, tick, tmp_path / f"{tick}.yaml"))


def test_noisy_late_cameras_are_played_again_as_the_trees_saw_them(tmp_path: Path) -> None:
    scenario = load_scenario("striker_vs_goalkeeper").lasting(1.0)
    noisy = scenario.model_copy(update={"simulator": {"preset": "default", "realism": "realistic"}})
    if sim_world(noisy).shows_truth:
        pytest.fail("this realism adds no noise")
    path = tmp_path / "noisy.robobt.arrows"
    MatchLoop(noisy, 4, sim_world, path).play()
    recording = load_recording(path)
    assert recording.observed is not None
    assert recording.observation(20).ball != recording.frame(20).ball
    check_regression_case(save_regression_case(recording, BLUE_0, 20, tmp_path / "case.yaml"))


def test_a_case_finds_its_files_from_anywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Played here, recorded there, the case somewhere else, and the test run from nowhere."""
    here, there, tests, nowhere = (tmp_path / name for name in ("here", "there", "tests/cases", "nowhere"))
    for folder in (here, there, nowhere):
        folder.mkdir()
    (here / "mine.yaml").write_text(tree_yaml(PLAYS["attack_main"](), "mine"))
    (here / "rules.yaml").write_text('"*/KickToTarget": RUNNING\n')
    scenario = parse_marked(bundled_scenarios()["striker_vs_goalkeeper"].read_text(), "yaml").plain()
    scenario["robots"]["blue"][0] |= {"play": "mine.yaml", "params": {}, "substitute": "rules.yaml"}
    (here / "match.yaml").write_text(write_yaml(scenario))
    monkeypatch.chdir(here)
    recorded = there / "match.robobt.arrows"
    MatchLoop(load_scenario("match.yaml").lasting(0.6), 3, sim_world, recorded).play()
    save_regression_case(load_recording(recorded), BLUE_0, 20, Path("../tests/cases/case.yaml"))
    monkeypatch.chdir(nowhere)
    check_regression_case(tests / "case.yaml")
    (here / "mine.yaml").write_text("play: mine\ntree: Stop\n")
    with pytest.raises(RegressionCaseError, match="no node of the tree is left for"):
        check_regression_case(tests / "case.yaml")
    (here / "mine.yaml").rename(here / "gone.yaml")
    with pytest.raises(RegressionCaseError, match=r"mine\.yaml: cannot be read"):
        check_regression_case(tests / "case.yaml")
    with pytest.raises(RegressionCaseError, match=r"mine\.yaml is neither here nor"):
        save_regression_case(load_recording(recorded), BLUE_0, 20, tmp_path / "case.yaml")


def test_a_skill_that_does_something_else_fails_the_case_by_name(
    case: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuses(self: SelectShot) -> Status:
        return self.fail("no shot is good enough")

    monkeypatch.setattr(SelectShot, "on_running", refuses)
    with pytest.raises(RegressionError) as failed:
        check_regression_case(case)
    said = str(failed.value)
    assert said.startswith(f"{case}: blue 0 at tick 20 (")
    assert "SelectShot was SUCCESS and is FAILURE (no shot is good enough)" in said
    assert "\n" not in said


def test_a_changed_parameter_of_a_play_fails_the_case(recording: Path, tmp_path: Path) -> None:
    path = save_regression_case(load_recording(recording), BLUE_0, 20, tmp_path / "case.yaml")
    case = load_regression_case(path)
    play = case.recording.header.played["robots"]["blue"][0]
    play["params"] = {**play["params"], "speed_factor": 0.5}
    with pytest.raises((RegressionError, RegressionCaseError), match=r"command vx was|params"):
        check_regression_case(case)


@pytest.mark.parametrize(
    ("robot", "tick", "problem"),
    [
        (RobotId(Team.BLUE, 9), 3, "robot blue 9 is not in"),
        (BLUE_0, 10_000, "there is no tick 10000"),
        (BLUE_0, -1, "there is no tick -1"),
    ],
)
def test_what_was_not_recorded_is_no_case(
    recording: Path, tmp_path: Path, robot: RobotId, tick: int, problem: str
) -> None:
    with pytest.raises(RegressionCaseError, match=problem):
        save_regression_case(load_recording(recording), robot, tick, tmp_path / "case.yaml")
    assert not (tmp_path / "case.yaml").exists()


def test_a_tick_at_which_the_tree_rested_is_no_case(recording: Path, tmp_path: Path) -> None:
    whole = load_recording(recording)
    with pytest.raises(RegressionCaseError, match=f"was not ticked at tick {len(whole) - 1}"):
        save_regression_case(whole, BLUE_0, len(whole) - 1, tmp_path / "case.yaml")


def test_a_recording_without_its_scenario_is_no_case(tmp_path: Path) -> None:
    record(tmp_path / "made.robobt.arrows")
    made = load_recording(tmp_path / "made.robobt.arrows")
    with pytest.raises(RegressionCaseError, match="does not hold its scenario"):
        save_regression_case(made, RobotId(Team.BLUE, 1), 3, tmp_path / "case.yaml")


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"format": "robobt-case"}, r"is not a regression case of robobt .*format: .*save the tick again"),
        ({"version": 9}, "version: input should be 1, not 9"),
        ({"robot": "green 1"}, r"robot: string should match pattern .*, not 'green 1'"),
        ({"robot": "blue 9"}, "robot blue 9 is not in"),
        ({"tick": 9999}, "tick: must be 0 to"),
        ({"tick": "x"}, "tick: input should be a valid integer"),
        ({"statuses": {"a": 1}}, "statuses.a: input should be a valid string"),
        ({"expected": {}}, "expected: there is no such field"),
        ({"match": "####"}, "match: "),
        ({"match": "AAAA"}, "match: "),
    ],
)
def test_a_spoiled_case_is_named_with_its_field(case: Path, change: dict[str, object], problem: str) -> None:
    case.write_text(json.dumps(json.loads(case.read_text()) | change))
    with pytest.raises(RegressionCaseError, match=problem) as error:
        load_regression_case(case)
    assert str(case) in str(error.value)


def test_a_file_that_is_no_case_is_one_clear_error(tmp_path: Path) -> None:
    with pytest.raises(RegressionCaseError, match="No such file"):
        load_regression_case(tmp_path / "none.yaml")
    (tmp_path / "words").write_text("just words")
    with pytest.raises(RegressionCaseError, match="is not a regression case of robobt"):
        load_regression_case(tmp_path / "words")
