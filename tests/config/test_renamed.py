"""Old names of scenarios and plays are answered with the new ones."""

import pytest

from robobt.config.errors import unknown_name
from robobt.config.renamed import RENAMED
from robobt.config.resources import bundled_scenarios, models_folder
from robobt.match import ScenarioError, load_scenario
from robobt.models.find import list_models
from robobt.plays import PLAYS
from robobt.tournament.entrants import EntrantError, read_entrant


def test_what_a_name_has_become_is_there() -> None:
    models = {path.stem for path in list_models(models_folder())}
    assert set(RENAMED.values()) <= {*PLAYS, *bundled_scenarios(), *models}
    assert not set(RENAMED) & {*PLAYS, *bundled_scenarios(), *models}


def test_an_old_scenario_is_answered_with_the_new_name() -> None:
    with pytest.raises(ScenarioError, match="striker_vs_goalie is striker_vs_goalkeeper now"):
        load_scenario("striker_vs_goalie")


@pytest.mark.parametrize("name", ["keeper", "team_keeper", "keeper_2026_11"])
def test_an_old_play_is_answered_with_the_new_name(name: str) -> None:
    with pytest.raises(KeyError, match=f"{name} is {RENAMED[name]} now"):
        PLAYS[name]
    with pytest.raises(EntrantError, match=f"{name} is {RENAMED[name]} now"):
        read_entrant(name)


def test_only_where_the_new_name_is_meant() -> None:
    assert "now" not in unknown_name("keeper", ["HasBall", "Stop"])
