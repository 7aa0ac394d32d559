"""The cells in which policies are judged differ only in what they say, and figures get on the card."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from benchmarks.__main__ import application
from benchmarks.degradation import CELLS, cell_environment, degradation, write_on_card
from robobt.learning.envs import GoToBallSettings, ShootSettings, make_task
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.training.fresh_starts import JudgingError, trained_policy
from robobt.models.card import ObservationCard
from robobt.models.file import Format, read_model_file
from tests.models.made_models import Aimed, go_to_ball_card, shoot_card, write_model

TRAINED = ShootSettings.model_validate(
    {
        "simulator": "rsim",
        "memory": {"actions": 2, "observations": 1},
        "gentle": True,
        "randomisation": {"control_delay": (0.02, 0.13), "lag": (0.0, 0.05), "friction": (0.7, 1.3)},
    }
)


def test_a_cell_has_no_randomisation_but_its_own() -> None:
    plain = cell_environment(TRAINED, CELLS["as trained"])
    assert plain.randomisation.control_delay == (0.02, 0.02)
    assert plain.randomisation.lag == (0.0, 0.0)
    assert plain.randomisation.friction == (1.0, 1.0)
    late = cell_environment(TRAINED, CELLS["+100 ms"])
    assert late.randomisation.control_delay == pytest.approx((0.12, 0.12))
    assert late.memory == TRAINED.memory
    strong = cell_environment(TRAINED, CELLS["kicks x 1.3"])
    assert strong.randomisation.kick_speed == (1.3, 1.3)


def test_robots_of_erforce_start_with_balls_that_they_hold() -> None:
    cell = cell_environment(TRAINED, CELLS["erforce"])
    assert isinstance(cell, ShootSettings)
    assert cell.simulator.dribbler.kind == "roller"
    assert cell.starts.ball_aside == (-0.01, 0.01)
    assert cell.starts.warm_up == TRAINED.starts.warm_up
    cell_environment(GoToBallSettings(), CELLS["erforce"])


@pytest.mark.parametrize("first", [0, 1])
def test_policies_with_and_without_memory_play_the_same_starts(tmp_path: Path, first: int) -> None:
    sources = []
    for name, settings in (("recalling", TRAINED), ("forgetful", ShootSettings())):
        spec = make_task(settings, 1).observation
        card = shoot_card(
            name,
            observation=ObservationCard.of(spec),
            environment=settings.model_dump(mode="json"),
            training={"settings": {"task": "shoot"}},
        )
        sources.append(str(write_model(tmp_path, Aimed(), card)))
    sources = sources[first:] + sources[:first]
    found = degradation(sources, starts=12, seed=3, cells=["as trained", "+100 ms"])
    for results in found.values():
        recalling, forgetful = (results[source] for source in sources)
        # They decide alike, and what is remembered does not change that.
        assert recalling.success.tolist() == forgetful.success.tolist()
        assert recalling.returns == pytest.approx(forgetful.returns)
    write_on_card(sources[0], found)
    held_out = read_model_file(Path(sources[0])).card.held_out
    assert held_out["success, +100 ms"].value == found["+100 ms"][sources[0]].rate
    assert held_out["success, +100 ms"].n == 12


def test_a_policy_that_learned_by_playing_itself_is_judged_as_in_its_training() -> None:
    environment, _ = trained_policy("duel_ppo")
    assert isinstance(environment, SoccerSettings)
    assert environment.blue == ("learner",)
    assert environment.yellow == ("attack",)


def trained(folder: Path, name: str = "trained", task: str = "shoot", format_: Format = "torchscript") -> str:
    settings = {"shoot": ShootSettings, "go_to_ball": GoToBallSettings}[task]()
    made = {"shoot": shoot_card, "go_to_ball": go_to_ball_card}[task]
    spec = make_task(settings, 1).observation
    card = made(
        name,
        observation=ObservationCard.of(spec),
        environment=settings.model_dump(mode="json"),
        training={"settings": {"task": task}},
    )
    return str(write_model(folder, Aimed() if task == "shoot" else None, card, [format_]))


def said(*arguments: str, code: int) -> tuple[str, str]:
    result = CliRunner().invoke(application("degradation"), ["degradation", *arguments, "--starts", "2"])
    assert result.exit_code == code
    return result.stdout, " ".join(result.stderr.replace("│", " ").split())


def test_an_unknown_cell_is_named(tmp_path: Path) -> None:
    _, problem = said(trained(tmp_path), "--only", "as traned", code=2)
    assert "--only: no cell is called 'as traned'; did you mean as trained?" in problem


def test_models_of_two_tasks_are_refused_by_name(tmp_path: Path) -> None:
    shoot, go = trained(tmp_path), trained(tmp_path, "going", "go_to_ball")
    with pytest.raises(JudgingError, match=rf"^{go}: was trained for another task than {shoot}$"):
        degradation([shoot, go], 2, 0, ["as trained"])


def test_a_model_whose_card_takes_no_figures_is_refused_before_play(tmp_path: Path) -> None:
    model = trained(tmp_path, task="go_to_ball", format_="onnx")
    shown, problem = said(model, "--card", "--only", "as trained", code=1)
    assert "trained.onnx: figures are added to TorchScript models only" in problem
    assert not shown


def test_figures_are_told_where_the_card_cannot_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robobt.models.export.MAX_CARD_SIZE", 100)
    shown, problem = said(trained(tmp_path), "--card", "--only", "as trained", "--json", code=1)
    assert json.loads(shown)["cells"]["as trained"]
    assert "more than 100" in problem
