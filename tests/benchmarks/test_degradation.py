"""The cells in which policies are judged differ only in what they say, and figures get on the card."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.degradation import CELLS, cell_environment, degradation, write_on_card
from robobt.learning.envs import GoToBallSettings, ShootSettings, make_task
from robobt.models.card import ObservationCard
from robobt.models.file import read_model_file
from tests.models.made_models import Aimed, shoot_card, write_model

TRAINED = ShootSettings.model_validate(
    {
        "simulator": "rsim",
        "memory": {"actions": 2, "observations": 1},
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


def test_policies_with_and_without_memory_play_the_same_starts(tmp_path: Path) -> None:
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
