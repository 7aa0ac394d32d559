"""Policies and scripts that meet, and what it says of them."""

from __future__ import annotations

from pathlib import Path

import pytest
import torch

from robobt.learning.agents.networks import Actor
from robobt.learning.envs.soccer.suite import SUITE
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.training.meetings import Contender, MeetingError, contenders_of, encounters, script


def test_everybody_meets_everybody_from_either_side() -> None:
    settings = SUITE["Duel"](time_limit=200)
    stands = Actor([1.0] * SoccerTask(settings).observation.size, 4, [4])
    with torch.no_grad():
        for weight in stands.parameters():
            weight.zero_()
        stands.body[-1].bias[3] = -1.0
    contenders = [script("attack"), script("still"), Contender("idle", stands)]
    found = encounters(settings, contenders, 40, seed=3)
    assert [(one.first, one.second) for one in found] == [
        ("attack", "still"), ("attack", "idle"), ("still", "idle"),
    ]  # fmt: skip
    for one in found:
        assert one.won + one.drawn + one.lost == 80
        assert sum(one.scores) == one.won + 0.5 * one.drawn
    # Who attacks scores on whoever stands, script or policy; these two score on nobody.
    assert found[0].won > found[0].lost + 10
    assert found[1].won > found[1].lost + 10
    assert found[2].drawn == 80
    assert found == encounters(settings, contenders, 40, seed=3)


@pytest.mark.parametrize("model", ["duel_ppo", "models/duel_ppo.pt"])
def test_a_model_does_not_take_part(model: str) -> None:
    with pytest.raises(MeetingError, match="no folder of a training run; models do not take part"):
        contenders_of(Path(model), 5)
