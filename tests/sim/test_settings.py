"""Settings come from presets and mappings, and say what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import pytest
from pydantic import ValidationError

from robobt.config.errors import ConfigError
from robobt.config.validation import first_problem
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


def test_a_preset_may_be_a_file_of_settings(tmp_path: Path) -> None:
    path = tmp_path / "field.yaml"
    path.write_text("preset: grsim\nball: {slide_deceleration: 2.5}\n")
    settings = preset(str(path))
    assert settings.ball.slide_deceleration == 2.5
    assert settings.limits == preset("grsim").limits
    assert settings_from({"preset": str(path), "ball": {"mass": 0.05}}).ball.slide_deceleration == 2.5


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (None, "cannot be read"),
        ("ball: {mass: 9}", "ball.mass"),
        ("preset: other", "no simulator preset is called 'other'"),
        ("preset: other.yaml", "preset: must be the name of a shipped preset"),
        ("realism: strong", "no realism level is called 'strong'"),
        ("wheel: 3", "wheel"),
    ],
)
def test_what_is_wrong_with_a_preset_file_is_said(tmp_path: Path, text: str | None, problem: str) -> None:
    path = tmp_path / "field.yaml"
    if text is not None:
        path.write_text(text)
    with pytest.raises(ConfigError) as error:
        preset(str(path))
    assert str(error.value).startswith(str(path))
    assert problem in str(error.value)


def test_a_name_is_a_preset() -> None:
    assert settings_from("grsim") == preset("grsim")


@pytest.mark.parametrize("name", ["grsim", "rsim", "robobulls"])
def test_a_kick_adds_to_a_ball_that_comes_what_grsims_does(name: str) -> None:
    assert preset(name).limits.touch_returned == 0.2


@pytest.mark.parametrize(
    ("given", "now"),
    [
        ({"limits": {"kick_rebound": 0.2}}, "touch_returned"),
        ({"kicker": {"damping": 0.2}}, "limits.touch_returned"),
    ],
)
def test_an_old_name_is_answered_with_the_new_one(given: dict[str, object], now: str) -> None:
    with pytest.raises(ValidationError) as caught:
        settings_from(given)
    assert f"has been renamed: use {now}" in first_problem(caught.value, SimSettings, given)[1]


def test_a_mapping_changes_a_preset_and_keeps_the_rest() -> None:
    settings = settings_from({"preset": "grsim", "kicker": {"max_speed": 6.5}, "realism": "realistic"})
    assert settings.kicker.max_speed == 6.5
    assert settings.kicker.recharge == preset("grsim").kicker.recharge
    assert settings.realism == REALISM["realistic"]
    assert settings.ball == preset("grsim").ball


def test_settings_survive_a_round_trip() -> None:
    for settings in PRESETS.values():
        assert SimSettings.model_validate_json(settings.model_dump_json()) == settings


@pytest.mark.parametrize("name", ["", "none"])
def test_an_unknown_preset_lists_those_there_are(name: str) -> None:
    with pytest.raises(KeyError, match="default, erforce, grsim"):
        settings_from(name)


def test_a_misspelt_preset_is_told_what_it_may_mean() -> None:
    with pytest.raises(KeyError, match="did you mean grsim"):
        settings_from("grSim")


def test_an_unknown_realism_lists_those_there_are() -> None:
    with pytest.raises(KeyError, match="none, friendly"):
        settings_from({"realism": "perfect"})


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"kicker": {"max_sped": 3}}, "max_sped"),
        ({"ball": {"mass": -1}}, "ball.mass"),
        ({"preset": "grsim", "wheels": {"height": 0}}, "wheels.height"),
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


@pytest.mark.parametrize("name", ["real_2023", "real_2025", "raven_2", "sumatra"])
def test_presets_of_real_robots_and_fields_have_one_touch_of_their_own(name: str) -> None:
    settings = preset(name)
    assert settings.limits.touch_kept < 1.0
    assert 0.0 < settings.limits.touch_returned < 0.6


def test_identified_robots_reach_a_part_of_their_commands() -> None:
    limits = preset("raven_4").limits
    assert (limits.dead_time, limits.gain, limits.side_gain) == (0.117, 0.94, 0.57)
    assert not limits.answers_as_commanded
