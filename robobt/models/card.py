"""The model card inside every model file: what the model may be used for, and how it was made."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Literal, Self

from pydantic import Field, ValidationError, field_validator, model_validator

from robobt.config.errors import ConfigError
from robobt.config.validation import Settings, first_problem
from robobt.models.actions import ActionScaling
from robobt.world.features import ObservationSpec, find_observation
from robobt.world.limits import RobotLimits, limits_as_named_now

MODEL_NAME = r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$"
"""Allowed names of models, as a regular expression."""

MAX_CARD_SIZE = 64 * 1024
"""Longest card that is read [bytes]."""

Kind = Literal["policy", "shot_predictor"]


class ModelCardError(ConfigError):
    """A model card cannot be read."""


class ObservationCard(Settings):
    """The meaning of the model's input.

    Either an observation known to :func:`robobt.world.features.find_observation`, with its version in
    training, or any other vector, by the names of its entries.
    """

    name: str = Field(min_length=1, max_length=64, description="name of the observation")
    version: int = Field(ge=1, description="version it was trained with")
    size: int = Field(ge=1, le=4096, description="length of the vector")
    features: tuple[str, ...] = Field((), description="its entries in order, with their units")

    @classmethod
    def of(cls, spec: ObservationSpec) -> ObservationCard:
        """Return the card of an observation whose definition now is ``spec``."""
        entries = tuple([f"{entry.name} [{entry.unit}]" for entry in spec.entries])
        return cls(name=spec.name, version=spec.version, size=spec.size, features=entries)

    @model_validator(mode="after")
    def _sized(self) -> Self:
        if self.features and len(self.features) != self.size:
            raise ValueError(f"size is {self.size}, but features names {len(self.features)} entries")
        if not self.features and find_observation(self.name) is None:
            raise ValueError(f"there is no observation {self.name!r}, so features has to name its entries")
        return self

    def problem(self) -> str | None:
        """Return how this differs from the present observation of that name, or None.

        An unknown name is not checked here.
        """
        spec = find_observation(self.name)
        if spec is None or self == ObservationCard.of(spec):
            return None
        if self.version != spec.version:
            return f"observation {self.name!r} is version {self.version}, here it is version {spec.version}"
        if self.size != spec.size:
            return f"observation {self.name!r} has {self.size} entries, here it has {spec.size}"
        if self.features:
            return f"the entries of observation {self.name!r} are not those it has here"
        return None


class OutputEntry(Settings):
    """One entry of the model's output."""

    name: str = Field(min_length=1, max_length=64)
    unit: str = Field("1", max_length=16, description="unit once multiplied by scale")
    scale: float = Field(1.0, description="what an output of 1 stands for, in that unit")


class Measured(Settings):
    """A figure with its interval, as measured on data or starts that training never saw."""

    value: float
    low: float | None = Field(None, description="lower end of the interval")
    high: float | None = Field(None, description="upper end of the interval")
    n: int = Field(ge=0, description="of how many trials or samples")
    unit: str = Field("1", max_length=16)
    interval: str = Field("", max_length=64, description='what the interval is ("95 % Wilson")')


class ModelCard(Settings):
    """The card inside every model file.

    A *policy* maps an observation to an action in [-1, 1], which ``action``
    scales to a command. A *shot_predictor* maps a row of features to a
    probability.
    """

    format: Literal[1] = Field(1, description="version of this card's fields")
    kind: Kind
    name: str = Field(pattern=MODEL_NAME, description="name to load it by")
    skill: str = Field(min_length=1, max_length=64, description='what it is for ("GoToBall", "Shoot")')
    description: str = Field("", max_length=2000)
    observation: ObservationCard
    outputs: tuple[OutputEntry, ...] = Field(min_length=1, max_length=64)
    action: ActionScaling | None = Field(None, description="how a policy's output becomes a command")
    period: float | None = Field(None, gt=0, le=1, description="time between decisions in training [s]")
    limits: RobotLimits | None = Field(None, description="limits of the robot it was trained on")
    algorithm: str = Field("", max_length=64, description='what it was trained with ("ddpg", "d4pg+td3")')
    environment: dict[str, object] = Field({}, description="settings of the environment, or of the data")
    training: dict[str, object] = Field({}, description="settings of the learner")
    seed: int | None = Field(None, description="what training's randomness followed from")
    held_out: dict[str, Measured] = Field({}, description="results that training never saw, by name")
    code_version: str = Field("", max_length=128, description="version of the code that trained it")
    code_commit: str = Field(
        "",
        pattern=r"^([0-9a-f]{40,64}\+?)?$",
        description='commit of that code, with "+" where it was changed since; empty: unknown',
    )
    created_by: str = Field("", max_length=256, description="what wrote it")
    payload: str = Field(
        "",
        pattern=r"^([0-9a-f]{64})?$",
        description="SHA-256 of everything in the file but the card; export fills it in",
    )

    _limits_as_now = field_validator("limits", mode="before")(limits_as_named_now)

    @field_validator("environment", mode="before")
    @classmethod
    def _environment_as_now(cls, value: object) -> object:
        return _as_named_now(value)

    @field_validator("environment", "training")
    @classmethod
    def _plain(cls, value: dict[str, object]) -> dict[str, object]:
        try:
            plain = json.loads(json.dumps(value, allow_nan=False))
        except (TypeError, ValueError, RecursionError) as error:
            raise ValueError(f"is no plain data: {error}") from error
        assert isinstance(plain, dict)
        return plain

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if self.kind == "policy":
            if self.action is None:
                raise ValueError("a policy needs action, which says how its output becomes a command")
            if self.period is None:
                raise ValueError("a policy needs period, the control period it was trained with")
            names = tuple([entry.name for entry in self.outputs])
            if names != self.action.entries:
                needed = ", ".join(self.action.entries)
                raise ValueError(f"outputs are {', '.join(names)}; a {self.action.kind} action is {needed}")
        elif self.action is not None:
            raise ValueError("only a policy has an action")
        return self

    @property
    def output_range(self) -> tuple[float, float]:
        """Return the least and greatest output: -1 and 1 for a policy, 0 and 1 for a probability."""
        return (-1.0, 1.0) if self.kind == "policy" else (0.0, 1.0)

    def to_json(self) -> str:
        """Return the card as it is put into files: the same text for the same card."""
        return json.dumps(self.model_dump(mode="json"), indent=1, sort_keys=True, allow_nan=False) + "\n"


def _as_named_now(environment: object) -> object:
    """Return an environment's settings by the present names of limits, one of which the kicker once had."""
    simulator = environment.get("simulator") if isinstance(environment, Mapping) else None
    if not isinstance(environment, Mapping) or not isinstance(simulator, Mapping):
        return environment
    result, inner, returned = dict(environment), dict(simulator), {}
    result["simulator"] = inner
    if isinstance(inner.get("kicker"), Mapping):
        inner["kicker"] = kicker = dict(inner["kicker"])
        if "damping" in kicker:
            returned["touch_returned"] = kicker.pop("damping")
    for part in (result, inner):
        limits = limits_as_named_now(part.get("limits"))
        if isinstance(limits, Mapping):
            part["limits"] = {**returned, **limits}
    return result


def action_outputs(action: ActionScaling) -> tuple[OutputEntry, ...]:
    """Return the outputs of a policy with an action, with their units and scales."""
    scales = {
        "vx": ("m/s", action.max_speed),
        "vy": ("m/s", action.max_speed),
        "omega": ("rad/s", action.max_turn),
        "kick": ("m/s", action.kick_speed),
        "hold": ("1", 1.0),
    }
    return tuple(
        [OutputEntry(name=name, unit=scales[name][0], scale=scales[name][1]) for name in action.entries]
    )


def read_card(text: str | bytes) -> ModelCard:
    """Read a card from the text in a file.

    Raises:
        ModelCardError: the text is not a card; the message names the field.
    """
    if len(text) > MAX_CARD_SIZE:
        raise ModelCardError("its card", f"is longer than {MAX_CARD_SIZE} bytes")
    try:
        return ModelCard.model_validate_json(text)
    except ValidationError as error:
        field, problem = first_problem(error, ModelCard)
        raise ModelCardError("its card", problem, field) from error
