"""A card says what a model may be used for, and one that does not fit together is refused by field."""

from __future__ import annotations

import json
from typing import Any

import pytest

from robobt.models.actions import GO_TO_BALL_ACTION, SHOOT_ACTION
from robobt.models.card import (
    MAX_CARD_SIZE,
    ModelCardError,
    ObservationCard,
    action_outputs,
    read_card,
)
from robobt.world.features import GO_TO_BALL, OBSERVATIONS
from robobt.world.limits import RobotLimits
from tests.models.made_models import go_to_ball_card, predictor_card, shoot_card


@pytest.mark.parametrize("card", [go_to_ball_card(), shoot_card(), predictor_card()])
def test_a_card_written_and_read_is_the_same(card: Any) -> None:
    assert read_card(card.to_json()) == card
    assert card.to_json() == read_card(card.to_json()).to_json()


def test_it_names_scales_and_units_of_the_action() -> None:
    drive = [(one.name, one.unit, one.scale) for one in action_outputs(GO_TO_BALL_ACTION)]
    assert drive == [("vx", "m/s", 1.5), ("vy", "m/s", 1.5), ("omega", "rad/s", 1.395)]
    kick = [(one.name, one.unit, one.scale) for one in action_outputs(SHOOT_ACTION)]
    assert kick == [("omega", "rad/s", 10.0), ("kick", "m/s", 5.0)]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"format": 2}, "format"),
        ({"kind": "planner"}, "kind"),
        ({"name": "../up"}, "name"),
        ({"action": None}, "action"),
        ({"period": None}, "period"),
        ({"period": 0}, "period"),
        ({"colour": "red"}, "colour"),
        ({"outputs": []}, "outputs"),
        ({"payload": "12"}, "payload"),
        ({"observation": {"name": "go_to_ball", "version": 1, "size": 6, "features": ["x"]}}, "observation"),
        ({"observation": {"name": "mine", "version": 1, "size": 6}}, "mine"),
    ],
)
def test_what_is_wrong_is_named(change: dict[str, Any], said: str) -> None:
    data = json.loads(go_to_ball_card().to_json()) | change
    with pytest.raises(ModelCardError, match=said):
        read_card(json.dumps(data))


def test_outputs_have_to_be_those_of_the_action() -> None:
    data = json.loads(go_to_ball_card().to_json())
    data["outputs"].reverse()
    with pytest.raises(ModelCardError, match="drive action is vx, vy, omega"):
        read_card(json.dumps(data))


@pytest.mark.parametrize("text", ["", "no json", "[]", "{", '{"kind": "policy"}', "nan", b"\xff\xfe\x00"])
def test_what_is_no_card_is_one_line(text: str | bytes) -> None:
    with pytest.raises(ModelCardError) as caught:
        read_card(text)
    assert "\n" not in str(caught.value)


def test_a_card_of_any_length_is_not_read() -> None:
    with pytest.raises(ModelCardError, match="longer"):
        read_card(" " * (MAX_CARD_SIZE + 1))


def test_settings_are_plain_data() -> None:
    with pytest.raises(ValueError, match="plain data"):
        go_to_ball_card(training={"rate": float("nan")})
    assert go_to_ball_card(training={"sizes": (64, 64)}).training == {"sizes": [64, 64]}


def test_only_the_observation_as_it_is_defined_now_fits() -> None:
    now = ObservationCard.of(GO_TO_BALL)
    assert now.problem() is None
    assert "version" in str(now.model_copy(update={"version": GO_TO_BALL.version + 1}).problem())
    turned = now.model_copy(update={"features": now.features[::-1]})
    assert "entries" in str(turned.problem())
    shorter = ObservationCard(name="go_to_ball", version=GO_TO_BALL.version, size=3)
    assert "3 entries" in str(shorter.problem())


@pytest.mark.parametrize("name", list(OBSERVATIONS))
def test_every_observation_can_be_put_on_a_card(name: str) -> None:
    card = ObservationCard.of(OBSERVATIONS[name])
    assert card.size == len(card.features) == OBSERVATIONS[name].size


def test_a_predictor_answers_a_probability_and_has_no_action() -> None:
    assert predictor_card().output_range == (0.0, 1.0)
    assert go_to_ball_card().output_range == (-1.0, 1.0)
    data = json.loads(predictor_card().to_json()) | {"action": GO_TO_BALL_ACTION.model_dump()}
    with pytest.raises(ModelCardError, match="only a policy"):
        read_card(json.dumps(data))


def test_limits_of_an_earlier_version_are_read_by_their_present_names() -> None:
    card = json.loads(shoot_card().to_json())
    limits = {"max_speed": 2.0, "kick_rebound": 0.1}
    card["limits"] = limits
    card["environment"] = {
        "limits": {"max_speed": 2.0},
        "simulator": {"kicker": {"damping": 0.2, "max_speed": 6.0}, "limits": dict(limits)},
    }
    read = read_card(json.dumps(card))
    assert read.limits == RobotLimits(max_speed=2.0, touch_returned=0.1)
    now = {"max_speed": 2.0, "touch_returned": 0.1}
    assert read.environment["simulator"] == {"kicker": {"max_speed": 6.0}, "limits": now}
    assert read.environment["limits"] == {"max_speed": 2.0, "touch_returned": 0.2}
