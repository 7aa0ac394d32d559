import json
from math import pi
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest
import torch
from typer.testing import CliRunner

from robobt.cli import app
from robobt.models.file import ModelError
from robobt.models.policy import load_policy
from robobt.shots.data.files import write_shots
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.data.schema import GOALKEEPERS, SCHEMA, ShotDataError
from robobt.shots.predict.scene_network import SceneNetwork
from robobt.shots.predict.score import measured, predicted_by
from robobt.shots.predict.shipped import train_shipped
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.world import BallState, Frame, RobotState, Team
from robobt.world.features import SCENE_HEAD
from robobt.world.field import DIVISION_B
from tests.shots.made_up import made_up_table, train_quickly
from tests.shots.real_data import REAL_SHOTS, needs_real_shots


@pytest.mark.integration
@pytest.mark.parametrize("name", ["shot_nn", "shot_expected"])
def test_a_predictor_ships_with_a_card_that_says_how_good_it_is(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    train_quickly(monkeypatch)
    file, figures = train_shipped(name, made_up_table(600), tmp_path, epochs=8)
    card = load_policy(file).card
    assert card.kind == "shot_predictor"
    assert card.held_out == figures
    assert figures["accuracy"].value > 0.6
    assert figures["accuracy"].n == 60


@pytest.mark.parametrize("name", ["shot_nn", "shot_expected"])
def test_the_shipped_predictors_are_calibrated_and_trained_on_our_own_shots(name: str):
    card = load_policy(name).card
    assert card.held_out["calibration_error"].value < 0.05
    assert card.environment["shots"] >= 20_000


def test_the_cards_of_the_shipped_predictors_say_how_they_do_on_the_real_shots():
    for name, right, loss in (("shot_nn", 0.84, 0.42), ("shot_expected", 0.86, 0.38)):
        figures = load_policy(name).card.held_out
        assert figures["real_accuracy"].n == 201
        assert figures["real_accuracy"].value >= right
        assert figures["real_log_loss"].value <= loss


@needs_real_shots
@pytest.mark.parametrize("name", ["shot_nn", "shot_expected"])
def test_the_command_finds_what_the_card_says_about_the_real_shots(name: str):
    said = CliRunner().invoke(app, ["shots", "score", "--model", name, "--data", str(REAL_SHOTS), "--json"])
    assert said.exit_code == 0, said.output
    figures, card = json.loads(said.output), load_policy(name).card.held_out
    assert figures["shots"] == 201
    for figure in ("accuracy", "log_loss", "calibration_error"):
        assert figures[figure]["value"] == pytest.approx(card[f"real_{figure}"].value, abs=1e-5)


def test_the_interval_of_few_shots_holds_only_losses_that_are_possible() -> None:
    loss = measured([0.99, 0.98, 0.6], [1, 1, 1])["log_loss"]
    assert loss.low == 0.0
    assert loss.value < loss.high


def test_a_predictor_for_a_few_shots_rates_shots_in_play(tmp_path: Path):
    table = made_up_table(300)
    file, figures = train_shipped("shot_best", table, tmp_path, called="mine", real=made_up_table(80, seed=1))
    assert figures["accuracy"].n == 300
    assert figures["real_accuracy"].value > 0.8
    assert measured(predicted_by(file, table), goals(table))["log_loss"].value < figures["log_loss"].value
    frame = Frame(
        0.0,
        DIVISION_B,
        BallState(2.0, 0.0),
        (RobotState(0, 1.9, 0.0),),
        (RobotState(0, 4.2, 0.3, pi),),
        Team.BLUE,
        0.03,
    )
    shot = ExpectedGoal(model=str(file)).rate(frame, frame.ball.position, frame.own[0])
    assert shot is not None
    assert shot.target[1] < 0.0
    assert shot.score > 0.5


@pytest.mark.integration
def test_a_model_that_is_there_is_not_written_over_unless_told(tmp_path: Path):
    data = tmp_path / "shots.parquet"
    write_shots(made_up_table(200), data)
    command = ["shots", "train", "--data", str(data), "--predictor", "shot_best", "--out", str(tmp_path)]
    assert CliRunner().invoke(app, command).exit_code == 0
    before = (tmp_path / "shot_best.pt").read_bytes()
    refused = CliRunner().invoke(app, [*command, "--seed", "1"])
    assert refused.exit_code == 1
    assert "shot_best.pt: is there already" in refused.output
    assert (tmp_path / "shot_best.pt").read_bytes() == before
    assert CliRunner().invoke(app, [*command, "--seed", "1", "--force"]).exit_code == 0
    assert (tmp_path / "shot_best.pt").read_bytes() != before


@pytest.mark.integration
def test_training_again_gives_the_same_file(tmp_path: Path):
    first, _ = train_shipped("shot_expected", made_up_table(200), tmp_path / "a", epochs=2)
    second, _ = train_shipped("shot_expected", made_up_table(200), tmp_path / "b", epochs=2)
    assert first.read_bytes() == second.read_bytes()


def test_too_few_shots_are_said(tmp_path: Path):
    with pytest.raises(ShotDataError, match="100 shots or more"):
        train_shipped("shot_nn", made_up_table(50), tmp_path)


def network() -> SceneNetwork:
    torch.manual_seed(0)
    return SceneNetwork().eval()


def answers(scenes: np.ndarray) -> np.ndarray:
    with torch.inference_mode():
        return network()(torch.tensor(scenes, dtype=torch.float32)).numpy()[:, 0]


def test_the_order_of_opponents_does_not_matter_and_one_fewer_never_hurts():
    scenes = shot_inputs(made_up_table(40, opponents=3))
    blocks = scenes[:, SCENE_HEAD:].reshape(40, 6, 4)
    swapped, fewer = scenes.copy(), scenes.copy()
    swapped[:, SCENE_HEAD:] = blocks[:, [2, 0, 1, 3, 4, 5]].reshape(40, -1)
    fewer[:, SCENE_HEAD + 8 : SCENE_HEAD + 12] = scenes[:, SCENE_HEAD + 20 :][:, :4]
    assert answers(swapped) == pytest.approx(answers(scenes), abs=1e-6)
    assert np.all(answers(fewer) >= answers(scenes) - 1e-6)


def test_a_mirrored_scene_gets_the_same_answer():
    scenes = shot_inputs(made_up_table(40))
    mirrored = scenes.copy()
    mirrored[:, [1, 3, 5, 7, 9]] *= -1.0
    mirrored[:, [SCENE_HEAD + 1, SCENE_HEAD + 3]] *= -1.0
    assert answers(mirrored) == pytest.approx(answers(scenes), abs=1e-6)


@pytest.mark.integration
def test_training_and_map_are_commands(tmp_path: Path):
    data = tmp_path / "shots.parquet"
    write_shots(made_up_table(200), data)
    options = ["shots", "train", "--data", str(data), "--predictor", "shot_expected", "--epochs", "2"]
    said = CliRunner().invoke(app, [*options, "--out", str(tmp_path / "models"), "--json"])
    assert said.exit_code == 0, said.output
    figures = json.loads(said.output)
    assert Path(figures["file"]).is_file()
    drawn = ["shots", "map", "--model", figures["file"], "--spacing", "1.0"]
    shown = CliRunner().invoke(app, [*drawn, "--out", str(tmp_path / "map.png")])
    assert shown.exit_code == 0, shown.output


@pytest.mark.integration
def test_collecting_is_a_command(tmp_path: Path):
    options = ["shots", "collect", "--count", "3", "-w", "1", "--out", str(tmp_path / "shots.csv")]
    shown = CliRunner().invoke(app, options)
    assert shown.exit_code == 0, shown.output
    assert "3 shots" in shown.output
    said = json.loads(CliRunner().invoke(app, [*options, "--json"]).output)
    assert (said["shots"], said["new"]) == (3, 0)
    refused = CliRunner().invoke(app, [*options[:-1], str(tmp_path / "shots.txt")])
    assert refused.exit_code == 1


def labelled(count: int, *kinds: str) -> pa.Table:
    """Made-up shots, a share of them against each kind of goalkeeper; the last kind saves them all."""
    table = made_up_table(count)
    names = [kinds[i % len(kinds)] for i in range(count)]
    scored = [int(one and name != kinds[-1]) for one, name in zip(goals(table), names, strict=True)]
    for column, values in (("goalkeeper", names), ("success", scored)):
        place = SCHEMA.names.index(column)
        table = table.set_column(place, SCHEMA.field(column), pa.array(values, SCHEMA.field(column).type))
    return table


@pytest.mark.integration
def test_a_model_has_an_output_for_each_kind_of_goalkeeper_that_its_shots_met(tmp_path: Path):
    table = labelled(600, "fitted", "full_speed")
    file, figures = train_shipped(
        "shot_expected", table, tmp_path, epochs=40, recorded=made_up_table(200, seed=3)
    )
    policy = load_policy(file)
    assert [output.name for output in policy.card.outputs] == ["fitted", "full_speed"]
    assert figures["fitted_accuracy"].n + figures["full_speed_accuracy"].n == figures["accuracy"].n == 60
    assert figures["recorded_accuracy"].n == 200
    weak, strong = policy(shot_inputs(table)).mean(axis=0)
    assert strong < 0.1 < weak


@pytest.mark.integration
def test_scoring_learns_from_earlier_shots_which_goalkeeper_it_is(tmp_path: Path):
    file, _ = train_shipped("shot_expected", labelled(600, "fitted", "full_speed"), tmp_path, epochs=40)
    shots = made_up_table(200, seed=5)
    learned, told = predicted_by(file, shots), predicted_by(file, shots, goalkeeper="fitted")
    other = predicted_by(file, shots, goalkeeper="full_speed")
    assert learned[0] == pytest.approx((told[0] + other[0]) / 2)
    assert learned[100:] == pytest.approx(told[100:], abs=0.01)
    with pytest.raises(ModelError, match=r"knows no goalkeeper 'half_speed'"):
        predicted_by(file, shots, goalkeeper="half_speed")


def test_the_shipped_predictor_is_right_about_every_kind_of_goalkeeper():
    figures = load_policy("shot_expected").card.held_out
    for kind in (*GOALKEEPERS, "recorded", "real"):
        assert figures[f"{kind}_accuracy"].value >= 0.9
        assert figures[f"{kind}_log_loss"].value <= 0.26
