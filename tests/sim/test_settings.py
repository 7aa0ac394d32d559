"""Settings come from presets and mappings, and say what is wrong with them."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from robobt.sim import PRESETS, REALISM, SimSettings, preset, settings_from


def test_the_named_presets_are_there() -> None:
    assert {"default", "grsim", "rsim", "erforce", "sumatra", "robobulls"} <= set(PRESETS)
    assert set(REALISM) == {"none", "friendly", "rc2021", "realistic"}


@pytest.mark.parametrize(
    ("level", "figures"),
    [
        # stddev_ball_p, stddev_robot_p, stddev_robot_phi, object_position_offset, camera_position_error,
        # dribbler_ball_detections, missing_ball_detections, missing_robot_detections, robot_command_loss,
        # robot_response_loss, as ER-Force's configurations have them.
        ("friendly", (0.0004, 0.0003, 0.003, 0.02, 0.05, 0.001, 0.05, 0.02, 0.01, 0.01)),
        ("rc2021", (0.0010, 0.0013, 0.01, 0.0, 0.0, 0.02, 0.05, 0.0, 0.03, 0.1)),
        ("realistic", (0.0014, 0.0013, 0.01, 0.02, 0.1, 0.05, 0.05, 0.02, 0.03, 0.1)),
    ],
)
def test_the_levels_are_er_forces(level: str, figures: tuple[float, ...]) -> None:
    it = REALISM[level]
    assert figures == (
        it.ball_noise,
        it.robot_noise,
        it.heading_noise,
        it.object_offset,
        it.camera_error,
        it.false_balls,
        it.missing_ball,
        it.missing_robot,
        it.command_loss,
        it.response_loss,
    )
    assert (it.hidden_below, it.camera_overlap, it.vision_delay, it.processing_time) == (
        0.4,
        1.0,
        0.035,
        0.01,
    )


def test_a_name_is_a_preset() -> None:
    assert settings_from("grsim") == preset("grsim")


def test_a_mapping_changes_a_preset_and_keeps_the_rest() -> None:
    settings = settings_from({"preset": "grsim", "kicker": {"max_speed": 6.5}, "realism": "realistic"})
    assert settings.kicker.max_speed == 6.5
    assert settings.limits.touch_returned == preset("grsim").limits.touch_returned
    assert settings.realism == REALISM["realistic"]
    assert settings.ball == preset("grsim").ball


def test_settings_survive_a_round_trip() -> None:
    for settings in PRESETS.values():
        assert SimSettings.model_validate_json(settings.model_dump_json()) == settings


@pytest.mark.parametrize("name", ["", "grSim", "none"])
def test_an_unknown_preset_lists_those_there_are(name: str) -> None:
    with pytest.raises(KeyError, match="default, erforce, grsim"):
        settings_from(name)


def test_an_unknown_realism_lists_those_there_are() -> None:
    with pytest.raises(KeyError, match="none, friendly"):
        settings_from({"realism": "perfect"})


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"kicker": {"max_sped": 3}}, "max_sped"),
        ({"ball": {"mass": -1}}, "ball.mass"),
        ({"ball": 3}, "ball"),
        ({"sub_step": float("nan")}, "sub_step"),
        ({"gravity": 9.81}, "gravity"),
    ],
)
def test_a_wrong_setting_is_named(changes: dict[str, object], field: str) -> None:
    with pytest.raises(ValidationError) as caught:
        settings_from(changes)
    assert field in {".".join(map(str, error["loc"])) for error in caught.value.errors()} | {
        str(caught.value.errors()[0]["loc"][-1])
    }
