from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import transfer
from robobt.models.file import ModelError
from tests.models.made_models import Passing, go_to_ball_card, network, score_card, team_card, write_model


def test_a_model_for_score_plays_in_each_world_beside_the_play(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = str(write_model(tmp_path, Passing(), score_card()))
    transfer.main([model, "--trials", "1", "--only", "default", "--only", "grsim"])
    head, *lines = capsys.readouterr().out.splitlines()
    assert "of 1" in head
    players = [line.split()[:2] for line in lines]
    assert players == [
        [world, player] for world in ("default", "grsim") for player in ("attack_expected", "Score")
    ]
    # A policy that drives at the ball alone scores nowhere; the play does.
    assert [int(line.split()[2]) > 0 for line in lines] == [True, False, True, False]


def test_a_model_for_goalkeeper_keeps_goal_beside_the_play(tmp_path: Path) -> None:
    model = str(write_model(tmp_path, network(23, 4), team_card("Goalkeeper", 0, 1)))
    for against in ("", "attack_main"):
        assert transfer.variants(model, against) == {
            "team_goalkeeper": (against, "team_goalkeeper"),
            "Goalkeeper": (against, f"team_goalkeeper:policy={model}"),
        }


@pytest.mark.parametrize(
    ("model", "scenario"),
    [
        ("score_on_goalkeeper_ppo", "score_on_goalkeeper"),
        ("score_on_defender_ppo", "score_on_defender"),
        ("score_on_two_defenders_ppo", "score_on_two_defenders"),
        ("duel_ppo", "duel"),
        ("save_ppo", "score_on_goalkeeper"),
    ],
)
def test_a_model_meets_what_it_has_learned_against(model: str, scenario: str) -> None:
    assert transfer.scenario_of(model) == scenario


def test_another_model_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="is a model for GoToBall, not for Score"):
        transfer.variants(str(write_model(tmp_path, network(), go_to_ball_card())))
