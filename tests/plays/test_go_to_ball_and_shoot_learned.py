"""The benchmark's play with hand-written and learned parts in every combination."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Literal

import pytest

from robobt.plays import go_to_ball_and_shoot
from robobt.skills import GoToBall, KickToTarget, SelectShot, Shoot
from robobt.testing import alone, always, eventually, goal_for, inside_the_field
from robobt.tree import preorder
from robobt.world import Team
from tests.models.made_models import Aimed, Straight, go_to_ball_card, shoot_card, write_model

Kick = Literal["kick_to_target", "geometric", "ddpg"]
SHOTS: tuple[Kick, ...] = ("kick_to_target", "geometric", "ddpg")


@pytest.fixture(scope="module", autouse=True)
def shipped(tmp_path_factory: pytest.TempPathFactory) -> Path:  # type: ignore[misc]
    folder = tmp_path_factory.mktemp("models")
    write_model(folder, Straight(), go_to_ball_card("go_to_ball_ddpg"))
    write_model(folder, Aimed(), shoot_card("shoot_ddpg"))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("robobt.models.find.model_folders", lambda: [folder])
        yield folder


@pytest.mark.parametrize("shoot", SHOTS)
@pytest.mark.parametrize("policy", ["geometric", "ddpg"])
def test_every_combination_scores(policy: str, shoot: Kick) -> None:
    tree = go_to_ball_and_shoot(policy=policy, shoot=shoot)
    trial = alone(tree, (-1.0, 0.0, 0.0), (1.0, 1.0), "robobulls", period=0.03)
    trial.run(
        10.0,
        eventually("the ball is in the goal", goal_for(Team.BLUE)),
        always("inside the field", inside_the_field),
    )


def test_a_word_swaps_a_part() -> None:
    def parts(**parameters: str) -> list[tuple[str, str]]:
        nodes = preorder(go_to_ball_and_shoot(**parameters))  # type: ignore[arg-type]
        return [
            (type(node).__name__, getattr(node, "policy", ""))
            for node in nodes
            if isinstance(node, GoToBall | Shoot | KickToTarget)
        ]

    assert parts() == [("KickToTarget", ""), ("GoToBall", "geometric")]
    assert parts(policy="ddpg", shoot="ddpg") == [("Shoot", "ddpg"), ("GoToBall", "ddpg")]


def test_a_shot_is_selected_unless_a_trained_policy_aims() -> None:
    for shoot, selected in (
        ("kick_to_target", True),
        ("geometric", True),
        ({"name": "geometric", "kick_speed": 5.0}, True),
        ("ddpg", False),
    ):
        nodes = preorder(go_to_ball_and_shoot(shoot=shoot))  # type: ignore[arg-type]
        assert any(isinstance(node, SelectShot) for node in nodes) is selected


def test_models_of_ones_own_take_the_place_of_the_shipped_ones(shipped: Path) -> None:
    own = str(shipped / "shoot_ddpg.pt")
    tree = go_to_ball_and_shoot(policy=str(shipped / "go_to_ball_ddpg.pt"), shoot=own)
    assert [node.policy for node in preorder(tree) if isinstance(node, Shoot)] == [own]


def test_approach_and_pick_up_do_not_take_turns() -> None:
    tree = go_to_ball_and_shoot(policy="ddpg", shoot="ddpg")
    names = {type(node).__name__: node for node in preorder(tree)}
    trial = alone(tree, (-2.0, 0.0, 0.0), (1.0, 0.5), "robobulls", period=0.03)
    doing = []
    for _ in range(200):
        seen = trial.tick()
        doing.append(names["PickUpBall"].status.value == "RUNNING")
        if seen.own[0].ball_contact:
            break
    changes = sum(now != before for before, now in pairwise(doing))
    assert changes <= 2
