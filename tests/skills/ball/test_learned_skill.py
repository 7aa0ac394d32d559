"""Any trained policy is a leaf, and one that goes wrong stops its robot and nothing else."""

from __future__ import annotations

from math import isclose
from pathlib import Path

import pytest
from torch import nn

from robobt.models.card import ObservationCard
from robobt.models.file import ModelError
from robobt.plays.files import VOCABULARY, load_play
from robobt.skills import HasBall, LearnedSkill
from robobt.skills.ball.learned_control import LearnedControl
from robobt.testing import (
    Trial,
    alone,
    always,
    blue,
    eventually,
    frame,
    has_ball,
    held,
    inside_the_field,
    robot,
)
from robobt.tree import Selector, Status
from robobt.tree.interop import describe_tree, write_yaml
from robobt.world import RobotCommand
from robobt.world.features import SHOT
from tests.models.made_models import (
    Aimed,
    Faulty,
    Straight,
    go_to_ball_card,
    predictor_card,
    shoot_card,
    write_model,
)
from tests.skills.fixed_world import Alone

STILL = RobotCommand()


def test_it_drives_as_its_policy_says_in_the_robots_frame(tmp_path: Path) -> None:
    alone = Alone(LearnedSkill(model=str(write_model(tmp_path, Straight()))))
    # Heading up the field's y axis, the ball to the right.
    assert alone.tick(frame(robot(heading=1.5707963267948966), ball=(2.0, 0.0))) is Status.RUNNING
    assert isclose(alone.command.vx, 0.0, abs_tol=1e-6)
    assert isclose(alone.command.vy, -1.5, rel_tol=1e-6)
    assert isclose(alone.command.omega, -1.395, rel_tol=1e-6)


def test_it_decides_as_often_as_in_training(tmp_path: Path) -> None:
    alone = Alone(LearnedSkill(model=str(write_model(tmp_path, Straight(), go_to_ball_card(period=0.06)))))
    turning = []
    for tick in range(6):
        alone.tick(frame(robot(), (1.0, 0.01 * tick), time=0.03 * tick, period=0.03))
        turning.append(alone.command.omega / 1.395)
    assert turning == pytest.approx([0.0, 0.0, 0.04, 0.04, 0.08, 0.08], abs=1e-3)


def test_what_it_observes_can_be_looked_at(tmp_path: Path) -> None:
    alone = Alone(LearnedSkill(model=str(write_model(tmp_path, Straight()))))
    alone.store.draw.want({"observation"}, set())
    alone.tick(frame(robot(0.0, 0.0, 0.0), (3.0, 0.0)))
    numbers = {name: value for _, _, value, name in alone.store.draw.take()}
    assert numbers["ball_distance"] == 3.0
    assert {"action 0", "action 1", "action 2"} <= numbers.keys()


def test_its_robot_gets_to_the_ball(tmp_path: Path) -> None:
    tree = LearnedSkill(model=str(write_model(tmp_path, Straight())))
    trial = alone(tree, (-2.0, 0.0, 2.0), ball=(1.0, 1.0), period=0.03)
    trial.run(
        5.0,
        eventually("it touches the ball", has_ball(blue(0))),
        always("inside the field", inside_the_field),
    )


def test_a_policy_for_shooting_turns_and_kicks_with_the_dribbler_on(tmp_path: Path) -> None:
    alone = Alone(LearnedSkill(model=str(write_model(tmp_path, Aimed(), shoot_card()))))
    away = robot(2.0, 0.0, 3.0, contact=True)
    alone.tick(frame(away, ball=held(away)))
    assert (alone.command.vx, alone.command.vy, alone.command.kick_speed) == (0.0, 0.0, 0.0)
    assert alone.command.omega < 0.0
    assert alone.command.dribbler
    aimed = robot(2.0, 0.0, 0.0, contact=True)
    alone.tick(frame(aimed, ball=held(aimed), time=0.03))
    assert alone.command.kick_speed == 5.0


@pytest.mark.parametrize(("wrong", "said"), [("nan", "no number"), ("range", r"outside \[-1, 1\]")])
def test_what_is_no_action_fails_the_leaf_and_stops_the_robot(tmp_path: Path, wrong: str, said: str) -> None:
    leaf = LearnedSkill(model=str(write_model(tmp_path, Faulty(wrong))))
    far = frame(robot(), ball=(0.0, -3000.0), time=0.03)
    alone = Alone(leaf)
    assert alone.tick(frame(robot(), ball=(1.0, 0.0))) is Status.RUNNING
    assert alone.command != STILL
    assert alone.tick(far) is Status.FAILURE
    assert alone.command == STILL
    assert "small" in leaf.feedback_message
    assert alone.tick(frame(robot(), ball=(1.0, 0.0))) is Status.RUNNING


def test_a_frame_that_holds_no_numbers_stops_the_robot_too(tmp_path: Path) -> None:
    alone = Alone(LearnedSkill(model=str(write_model(tmp_path, Straight()))))
    assert alone.tick(frame(robot(x=float("nan")), ball=(1.0, 0.0))) is Status.FAILURE
    assert alone.command == STILL


def test_other_branches_go_on_when_the_policy_fails(tmp_path: Path) -> None:
    model = str(write_model(tmp_path, Faulty("nan")))
    tree = Selector("root", memory=False, children=[LearnedSkill(model=model), HasBall()])
    me = robot(contact=True)
    assert Alone(tree).tick(frame(me, ball=(3000.0, 0.0))) is Status.SUCCESS


def test_the_other_robots_play_on_when_a_policy_fails(tmp_path: Path) -> None:
    faulty = LearnedSkill(model=str(write_model(tmp_path / "faulty", Faulty("nan", far=3.0), probed=False)))
    sound = LearnedSkill(model=str(write_model(tmp_path, Straight())))
    trial = Trial(
        {blue(0): faulty, blue(1): sound},
        {blue(0): (-4.0, 0.0, 0.0), blue(1): (0.0, 1.0, 0.0)},
        ball=(1.0, 1.0),
        period=0.03,
    )
    trial.run(
        5.0,
        eventually("the sound one touches the ball", has_ball(blue(1))),
        always("the faulty one stands", lambda seen: seen.own[0].speed < 0.01),
    )
    assert faulty.status is Status.FAILURE


def test_without_a_model_it_fails() -> None:
    alone = Alone(LearnedSkill())
    assert alone.tick(frame(robot())) is Status.FAILURE
    assert alone.command == STILL


def test_a_model_that_cannot_be_used_is_an_error_when_the_leaf_is_made(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no such file"):
        LearnedSkill(model=str(tmp_path / "none.pt"))
    with pytest.raises(ModelError, match="no model is called 'nobody'"):
        LearnedSkill(model="nobody")
    predictor = write_model(tmp_path, nn.Sequential(nn.Linear(2, 1), nn.Sigmoid()), predictor_card())
    with pytest.raises(ModelError, match="is a shot predictor, not a policy"):
        LearnedSkill(model=str(predictor))
    card = go_to_ball_card("other", observation=ObservationCard.of(SHOT))
    other = write_model(tmp_path, nn.Sequential(nn.Linear(5, 3), nn.Tanh()), card)
    with pytest.raises(ModelError, match="no skill makes the observation 'shot'"):
        LearnedSkill(model=str(other))
    with pytest.raises(ModelError, match="for GoToBall, not for Shoot"):
        LearnedControl(write_model(tmp_path), skill="Shoot")


@pytest.mark.parametrize("suffix", [".pt", ".onnx"])
def test_a_tree_file_needs_nothing_but_the_models_name(tmp_path: Path, suffix: str) -> None:
    write_model(tmp_path, Straight(), formats=("torchscript", "onnx"))
    path = tmp_path / "play.yaml"
    path.write_text(f"play: mine\ntree:\n  LearnedSkill: {{model: {tmp_path / f'small{suffix}'}}}\n")
    tree = load_play(path)()
    assert Alone(tree).tick(frame(robot(), ball=(1.0, 0.0))) is Status.RUNNING
    assert f"small{suffix}" in write_yaml(describe_tree(tree, VOCABULARY, "mine"))
