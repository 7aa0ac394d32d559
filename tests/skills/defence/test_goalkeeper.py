"""Goalkeeper keeps goal as its policy was trained to."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.models.file import ModelError
from robobt.skills import Goalkeeper
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import RobotCommand
from tests.models.made_models import Faulty, network, team_card, write_model
from tests.skills.fixed_world import Alone
from tests.skills.side_by_side import the_leaf_does_what_it_does_in_training


def test_it_keeps_goal_as_in_training(tmp_path: Path) -> None:
    the_leaf_does_what_it_does_in_training("Save", "Goalkeeper", tmp_path)


def test_a_wrong_answer_fails_it_and_stops_the_robot(tmp_path: Path) -> None:
    # The ball's place ahead is entry 7.
    faulty = Faulty("nan", far=2.0, entry=7, outputs=4)
    model = write_model(tmp_path, faulty, team_card("Goalkeeper", 0, 1), probed=False)
    alone = Alone(Goalkeeper(policy=str(model)))
    assert alone.tick(frame(robot(-4.3, 0.0), ball=(-4.0, 0.0))) is Status.RUNNING
    assert alone.tick(frame(robot(-4.3, 0.0), ball=(0.0, 0.0), time=0.1)) is Status.FAILURE
    assert alone.command == RobotCommand()


def test_without_a_policy_for_it_it_does_nothing(tmp_path: Path) -> None:
    assert Alone(Goalkeeper()).tick(frame(robot())) is Status.FAILURE
    other = write_model(tmp_path, network(23, 4), team_card("Duel", 0, 1))
    with pytest.raises(ModelError, match="is a model for Duel, not for Goalkeeper"):
        Goalkeeper(policy=str(other))
