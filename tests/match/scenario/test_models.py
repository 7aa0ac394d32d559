"""A model that a play is given is read when the scenario is loaded, not at a robot's first tick."""

import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.config.resources import models_folder
from robobt.config.yaml import write_yaml
from robobt.match import ScenarioError, load_scenario
from tests.match.scripted import data

SHOT_NN, SCENE = models_folder() / "shot_nn.pt", models_folder() / "shot_expected.pt"


def spoiled(folder: Path, how: str, good: Path) -> Path:
    path = folder / f"{how}.pt"
    content = good.read_bytes()
    if how == "empty":
        path.write_bytes(b"")
    elif how == "cut":
        path.write_bytes(content[: len(content) // 2])
    elif how == "altered":
        middle = len(content) // 2
        path.write_bytes(content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :])
    elif how == "foreign":
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("x/readme", "no model")
    elif how == "policy":
        path.write_bytes((models_folder() / "shoot_ddpg.pt").read_bytes())
    elif how == "folder":
        path.mkdir()
    else:
        assert how == "missing"
    return path


def written(folder: Path, play: str, params: dict[str, Any]) -> Path:
    robot = {"number": 3, "play": play, "params": params, "start": {"position": [-2.0, 0.0]}}
    path = folder / "mine.yaml"
    path.write_text(write_yaml(data(robots={"blue": [robot]})))
    return path


def refusal(path: Path) -> str:
    with pytest.raises(ScenarioError) as caught:
        load_scenario(path)
    message = str(caught.value)
    assert "\n" not in message
    return message


REASONS = {
    "missing": "there is no such file",
    "empty": "is empty",
    "cut": "is damaged or incomplete",
    "altered": "is damaged or incomplete",
    "foreign": "is an archive, but not a TorchScript one",
    "policy": "is a policy, not a shot predictor",
    "folder": "is no file",
}


@pytest.mark.parametrize("how", REASONS)
@pytest.mark.parametrize(
    ("play", "good"),
    [("attack_nn", SHOT_NN), ("attack_expected", SCENE), ("penalty_kick", SCENE)],
)
def test_a_spoiled_shot_model_is_refused_with_file_field_and_reason(
    tmp_path: Path, play: str, good: Path, how: str
):
    model = spoiled(tmp_path, how, good)
    rater = "nn_filtered" if play == "attack_nn" else "expected_goal"
    path = written(tmp_path, play, {"rater": {"name": rater, "model": str(model)}})
    said = refusal(path)
    assert said.startswith(f"{path}: robots.blue.0.params.rater.model: {model}: ")
    assert REASONS[how] in said


@pytest.mark.parametrize(
    ("rater", "model", "reason"),
    [
        ("nn_filtered", "shot_expected", "takes the observation 'shot_scene', not 'shot'"),
        ("expected_goal", "shot_nn", "takes the observation 'shot', not 'shot_scene'"),
        ("expected_goal", "shot_expcted", "no model is called 'shot_expcted'; installed: "),
    ],
)
def test_a_model_for_something_else_or_of_no_such_name_is_refused(
    tmp_path: Path, rater: str, model: str, reason: str
):
    said = refusal(written(tmp_path, "attack_main", {"rater": {"name": rater, "model": model}}))
    assert "robots.blue.0.params.rater.model: " in said
    assert reason in said


def test_a_setting_of_a_rater_is_named_in_one_line(tmp_path: Path):
    def said(**rater: object) -> str:
        path = written(tmp_path, "attack_expected", {"rater": rater})
        return refusal(path).removeprefix(f"{path}: robots.blue.0.params.rater.")

    too_much = "threshold: input should be less than or equal to 1, not 3.0"
    assert said(name="expected_goal", threshold=3.0) == too_much
    misspelt = said(name="expected_goal", treshold=0.5)
    assert misspelt.startswith("treshold: there is no such field; ")
    assert misspelt.endswith("did you mean threshold?")
    keeper = said(name="expected_goal", goalkeeper="quick")
    assert keeper.startswith("goalkeeper: shot_expected knows no 'quick'; there are fitted, ")
    unknown = said(name="expected_gaol")
    assert unknown.startswith("name: no shot rater is called 'expected_gaol'; ")
    assert unknown.endswith("did you mean expected_goal?")
    assert said(expected_goal={"threshold": 0.5}).startswith("name: is missing: write {name: expected_goal, ")


def test_a_tree_file_with_a_spoiled_model_is_refused_with_its_line(tmp_path: Path):
    model, tree = spoiled(tmp_path, "empty", SCENE), tmp_path / "tree.yaml"
    leaf = f"ChooseKick: {{model: {model}}}"
    tree.write_text(
        f"play: mine\ntree:\n  Sequence:\n    name: mine\n    memory: false\n    children:\n    - {leaf}\n"
    )
    said = refusal(written(tmp_path, "tree.yaml", {}))
    assert said.startswith(f"{tmp_path / 'mine.yaml'}: robots.blue.0.play: {tree}:7: ")
    assert said.endswith(f"ChooseKick: model: {model}: is empty")


def test_a_model_that_was_mended_is_read_again(tmp_path: Path):
    model = spoiled(tmp_path, "empty", SCENE)
    path = written(tmp_path, "attack_expected", {"rater": {"name": "expected_goal", "model": str(model)}})
    refusal(path)
    model.write_bytes(SCENE.read_bytes())
    load_scenario(path)
    model.write_bytes(b"")
    assert refusal(path).endswith("is empty")


def test_a_match_with_a_missing_model_ends_before_it_begins(tmp_path: Path):
    rater = {"name": "expected_goal", "model": str(tmp_path / "gone.pt")}
    path = written(tmp_path, "attack_expected", {"rater": rater})
    result = CliRunner().invoke(app, ["match", str(path)])
    assert result.exit_code == 1
    assert result.output.count("\n") == 1
    assert (
        f"{path}: robots.blue.0.params.rater.model: {tmp_path / 'gone.pt'}: there is no such file"
        in result.output
    )


def test_models_lie_beside_the_file_that_names_them(tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    away = tmp_path / "away"
    (away / "models").mkdir(parents=True)
    (away / "models" / "mine.pt").write_bytes(SCENE.read_bytes())
    (away / "tree.yaml").write_text("play: t\ntree: {ChooseKick: {model: models/mine.pt}}\n")
    (away / "tree.xml").write_text(
        '<root BTCPP_format="4"><BehaviorTree ID="t">'
        '<ChooseKick model="models/mine.pt"/></BehaviorTree></root>'
    )
    for play, params in (
        ("attack_expected", {"rater": {"name": "expected_goal", "model": "models/mine.pt"}}),
        ("tree.yaml", {}),
        ("tree.xml", {}),
    ):
        load_scenario(written(away, play, params))
    (away / "models" / "mine.pt").unlink()
    assert "away/models/mine.pt: there is no such file" in refusal(
        written(away, "attack_expected", {"rater": {"name": "expected_goal", "model": "models/mine.pt"}})
    )


def test_a_model_given_on_the_command_line_is_refused_too():
    settings = ["--set", "blue 0.play=attack_nn", "--set", "blue 0.rater.model=/nowhere.pt"]
    result = CliRunner().invoke(app, ["match", "striker_vs_goalkeeper", *settings])
    assert result.exit_code == 1
    assert "blue 0: rater.model: /nowhere.pt: there is no such file" in result.output
    assert result.output.count("\n") == 1


def test_loading_a_scenario_with_a_model_does_not_need_torch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    copy = tmp_path / "mine.pt"
    copy.write_bytes(SCENE.read_bytes())
    monkeypatch.setitem(sys.modules, "torch", None)
    load_scenario(
        written(tmp_path, "attack_expected", {"rater": {"name": "expected_goal", "model": str(copy)}})
    )
