"""GoToBall with a trained policy differs from the hand-written one in a word."""

from __future__ import annotations

from math import hypot, pi
from pathlib import Path
from typing import Any

import pytest

from robobt.models.file import ModelError
from robobt.skills import GoToBall, PickUpBall
from robobt.testing import (
    alone,
    always,
    eventually,
    frame,
    held,
    inside_the_field,
    robot,
    succeeds,
)
from robobt.tree import Sequence, Status
from robobt.world import RobotCommand, RobotLimits
from tests.models.made_models import Faulty, Straight, go_to_ball_card, network, shoot_card, write_model
from tests.skills.fixed_world import Alone


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(write_model(tmp_path_factory.mktemp("models"), Straight()))


def trained_to(folder: Path, **contact: Any) -> str:
    return str(write_model(folder, Straight(), go_to_ball_card(environment={"contact": contact})))


@pytest.mark.parametrize("approach", ["nearest", "behind_target"])
def test_it_drives_as_the_policy_says_from_any_side(model: str, approach: Any) -> None:
    alone = Alone(GoToBall(policy=model, approach=approach))
    assert alone.tick(frame(robot(2.0, 0.0, pi), ball=(0.0, 0.0))) is Status.RUNNING
    assert alone.command.vx == pytest.approx(1.5)
    assert alone.tick(frame(robot(0.19, 0.0, pi), ball=(0.0, 0.0))) is Status.SUCCESS


def test_it_keeps_the_limits_it_is_given(model: str) -> None:
    limits = RobotLimits(max_speed=0.7, max_turn=0.5)
    alone = Alone(GoToBall(policy=model, limits=limits))
    alone.tick(frame(robot(), ball=(1.0, 1.0)))
    assert hypot(alone.command.vx, alone.command.vy) == pytest.approx(0.7)
    assert alone.command.omega == 0.5
    alone = Alone(GoToBall(policy=model, limits=RobotLimits(max_speed=2.0), speed_factor=0.5))
    alone.tick(frame(robot(), ball=(1.0, 1.0)))
    assert hypot(alone.command.vx, alone.command.vy) == pytest.approx(1.0)


def test_it_hands_over_where_it_was_trained_to_end(tmp_path: Path) -> None:
    aside = frame(robot(), ball=(0.0, 0.19))
    assert Alone(GoToBall(policy=trained_to(tmp_path, rule="distance"))).tick(aside) is Status.SUCCESS
    facing = trained_to(tmp_path, rule="distance_facing", distance=0.25, angle=0.3)
    assert Alone(GoToBall(policy=facing)).tick(aside) is Status.RUNNING
    assert Alone(GoToBall(policy=facing)).tick(frame(robot(), ball=(0.24, 0.0))) is Status.SUCCESS
    touching = trained_to(tmp_path, rule="infrared", distance=0.2)
    assert Alone(GoToBall(policy=touching)).tick(frame(robot(), ball=(0.15, 0.0))) is Status.RUNNING
    me = robot(contact=True)
    assert Alone(GoToBall(policy=touching)).tick(frame(me, ball=held(me))) is Status.SUCCESS


def test_once_handed_over_it_stays_so_until_the_ball_has_gone(model: str) -> None:
    alone = Alone(GoToBall(policy=model))
    for away, status in (
        (0.21, "RUNNING"),
        (0.19, "SUCCESS"),
        (0.28, "SUCCESS"),
        (0.31, "RUNNING"),
        (0.28, "RUNNING"),
    ):
        assert alone.tick(frame(robot(), ball=(0.0, away))).value == status


def test_what_is_no_action_fails_the_leaf_and_stops_the_robot(tmp_path: Path) -> None:
    leaf = GoToBall(policy=str(write_model(tmp_path, Faulty("range"))))
    alone = Alone(leaf)
    assert alone.tick(frame(robot(), ball=(2.0, 0.0))) is Status.RUNNING
    assert alone.tick(frame(robot(), ball=(40.0, 0.0))) is Status.FAILURE
    assert alone.command == RobotCommand()
    assert "outside" in leaf.feedback_message


def test_a_model_of_another_skill_is_refused(tmp_path: Path) -> None:
    shot = write_model(tmp_path, network(10, 2), shoot_card())
    with pytest.raises(ModelError, match="for Shoot, not for GoToBall"):
        GoToBall(policy=str(shot))


def test_the_shipped_policy_is_asked_for_when_the_leaf_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robobt.models.find.model_folders", lambda: [tmp_path])
    with pytest.raises(ModelError, match="no model is called 'go_to_ball_ddpg'"):
        GoToBall(policy="ddpg")
    write_model(tmp_path, Straight(), go_to_ball_card("go_to_ball_ddpg"))
    assert Alone(GoToBall(policy="ddpg")).tick(frame(robot(), ball=(1.0, 0.0))) is Status.RUNNING


def test_with_the_pick_up_it_gets_the_ball(model: str) -> None:
    tree = Sequence("win the ball", memory=False, children=[GoToBall(policy=model), PickUpBall()])
    trial = alone(tree, (-2.0, 0.0, 2.0), ball=(1.0, 1.0), period=0.03)
    trial.run(
        5.0,
        eventually("it has picked the ball up", succeeds(tree)),
        always("inside the field", inside_the_field),
    )
