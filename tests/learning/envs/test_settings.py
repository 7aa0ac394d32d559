"""Settings are read from plain data, and say what is wrong with it."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import ValidationError

from robobt.config.yaml import parse_marked
from robobt.learning.envs import (
    HARDWARE_CHALLENGE,
    SHOOT_REWARDS,
    GoToBallAmongRobotsSettings,
    GoToBallSettings,
    ShootSettings,
)
from robobt.learning.envs.make import find_task
from robobt.models.actions import ActionScaling
from robobt.sim import preset
from robobt.world import DIVISION_B

TEXT = """
field: hardware_challenge
simulator: {preset: grsim, realism: realistic}
limits: {max_speed: 2.0}
contact: {rule: distance_facing, angle: 0.3}
starts: {robot_x: [-1, 1]}
randomisation: {friction: [0.8, 1.2]}
"""


def test_settings_come_from_yaml() -> None:
    settings = GoToBallSettings.model_validate(parse_marked(TEXT, "yaml").plain())
    assert settings.field == HARDWARE_CHALLENGE
    assert settings.simulator.ball == preset("grsim").ball
    assert settings.simulator.realism.command_delay == 0.003
    assert settings.robot_limits.max_speed == 2.0
    assert settings.starts.robot_x == (-1, 1)


@pytest.mark.parametrize(
    "settings",
    [
        GoToBallSettings.model_validate(parse_marked(TEXT, "yaml").plain()),
        ShootSettings.model_validate({"reward": "sparse", "simulator": "sumatra"}),
    ],
)
def test_settings_that_are_written_out_are_read_again(settings: Any) -> None:
    assert type(settings).model_validate_json(settings.model_dump_json()) == settings
    assert type(settings).model_validate(settings.model_dump()) == settings


def test_a_group_given_in_part_keeps_what_the_task_says_of_the_rest() -> None:
    own = GoToBallAmongRobotsSettings().reward
    dearer = GoToBallAmongRobotsSettings.model_validate({"reward": {"time": 0.02}}).reward
    assert dearer == own.model_copy(update={"time": 0.02})
    assert GoToBallSettings.model_validate({"action": {"max_turn": 3.0}}).action.max_speed == 1.5


def test_the_defaults_are_the_papers() -> None:
    drive, shoot = GoToBallSettings(), ShootSettings()
    assert drive.field == shoot.field == DIVISION_B
    assert (drive.period, drive.sub_steps, drive.time_limit, shoot.time_limit) == (0.03, 4, 330, 100)
    assert (drive.action.max_speed, drive.action.max_turn) == (1.5, 1.395)
    assert (shoot.action.max_turn, shoot.action.kick_speed) == (10.0, 5.0)
    assert shoot.reward == SHOOT_REWARDS["coded"]


@pytest.mark.parametrize(
    ("model", "data", "named"),
    [
        (GoToBallSettings, {"field": "moon"}, "no field is called 'moon'; there are division_a"),
        (GoToBallSettings, {"simulator": "moon"}, "no simulator preset is called 'moon'"),
        (GoToBallSettings, {"simulator": {"realism": "moon"}}, "no realism level is called 'moon'"),
        (GoToBallSettings, {"speed": 3}, "speed"),
        (GoToBallSettings, {"starts": {"robot_x": (1, -1)}}, "robot_x: the least, 1, is above the most, -1"),
        (GoToBallSettings, {"sub_steps": 2}, "sub_steps"),
        (GoToBallSettings, {"contact": {"rule": "held"}}, "needs action.dribbler"),
        (GoToBallSettings, {"randomisation": {"mass": (0, 1)}}, "mass must be above 0"),
        (GoToBallSettings, {"randomisation": {"control_delay": (-1, 1)}}, "control_delay"),
        (GoToBallSettings, {"reward": {"contact": float("nan")}}, "contact"),
        (GoToBallSettings, {"action": {"kind": "turn_and_kick", "max_turn": 1, "kick_speed": 1}}, "drive"),
        (ShootSettings, {"action": {"kind": "drive", "max_turn": 1, "max_speed": 1}}, "turn_and_kick"),
        (ShootSettings, {"reward": "gold"}, "no reward is called 'gold'; there are coded, printed"),
    ],
)
def test_what_is_wrong_is_named(model: Any, data: dict[str, Any], named: str) -> None:
    with pytest.raises(ValidationError, match=named.replace("(", r"\(")):
        model.model_validate(data)


def test_an_action_needs_its_scale() -> None:
    with pytest.raises(ValidationError, match="max_speed"):
        ActionScaling(kind="drive", max_turn=1.0)
    with pytest.raises(ValidationError, match="kick_speed"):
        ActionScaling(kind="turn_and_kick", max_turn=1.0)
    assert ActionScaling(kind="turn_and_kick", max_turn=1.0, kick_speed=2.0).entries == ("omega", "kick")


def test_only_a_task_with_one_learner_has_a_memory() -> None:
    assert find_task("go_to_ball").Settings.model_validate({"memory": {"actions": 2}}).memory.actions == 2
    with pytest.raises(ValidationError, match="is for tasks with one learner"):
        find_task("duel").Settings.model_validate({"memory": {"actions": 2}})
