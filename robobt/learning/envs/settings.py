"""Settings of the training environments, SI units, from YAML or Python."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from robobt.config.errors import FieldError, unknown_name
from robobt.config.validation import Settings
from robobt.models.actions import SCORE_ACTION, ActionScaling
from robobt.sim.settings import SimSettings, preset, settings_from
from robobt.world.field import DIVISION_B, FIELDS, FieldGeometry
from robobt.world.limits import RobotLimits

Span = Annotated[tuple[float, float], Field(description="least and most")]
"""A range for uniform draws."""


def weight(default: float, description: str) -> Any:
    """Return the field of the weight of a term of a reward, from 0 to 10,000."""
    return Field(default, ge=0, le=1e4, description=description)


HARDWARE_CHALLENGE = FieldGeometry(
    length=6.0, width=4.0, goal_width=0.7, defense_width=2.0, defense_depth=0.8
)
"""The 6 m x 4 m field that the authors trained Go-To-Ball on. Source: rSim's field type 2."""

TRAINING_FIELDS: dict[str, FieldGeometry] = {**FIELDS, "hardware_challenge": HARDWARE_CHALLENGE}
"""Fields that settings may call by name."""


class OrderedSettings(Settings):
    """Settings whose ranges have to be in order."""

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        for name in type(self).model_fields:
            value = getattr(self, name)
            ranges = isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], int | float)
            if ranges and value[0] > value[1]:
                raise ValueError(f"{name}: the least, {value[0]:g}, is above the most, {value[1]:g}")
        return self


def by_name(named: Mapping[str, object], noun: str) -> BeforeValidator:
    """Let a field be given by its name in ``named``; ``noun`` is what the error message calls it."""

    def look_up(value: object) -> object:
        if isinstance(value, str):
            if value not in named:
                raise ValueError(f"no {noun} is called {value!r}; {unknown_name(value, named)}")
            return named[value]
        return value

    return BeforeValidator(look_up)


def _simulator(value: object) -> object:
    # What holds all fields is a settings object in serialised form.
    whole = isinstance(value, Mapping) and set(SimSettings.model_fields) <= set(value)
    if isinstance(value, str | Mapping) and not whole:
        try:
            return settings_from(value)
        except KeyError as error:
            raise ValueError(error.args[0]) from error
    return value


class NoiseSettings(Settings):
    """Standard deviations of observation noise, cut off at four times their value."""

    robot_position: float = Field(0.0, ge=0, le=0.5, description="of x and y of the robot [m]")
    ball_position: float = Field(0.0, ge=0, le=0.5, description="of x and y of the ball [m]")
    heading: float = Field(0.0, ge=0, le=1, description="of the heading [rad]")
    velocity: float = Field(
        0.0, ge=0, le=2, description="of vx and vy of robot and ball, on top of true velocities [m/s]"
    )
    turn_rate: float = Field(0.0, ge=0, le=5, description="of omega, on top of a true one [rad/s]")


class MemorySettings(Settings):
    """What a policy observes of the past, so that it can tell how its robot answers; for one learner."""

    actions: int = Field(0, ge=0, le=32, description="past actions, the latest first")
    observations: int = Field(0, ge=0, le=32, description="past observations, the latest first")


class RandomisationSettings(OrderedSettings):
    """Domain randomisation: each parameter is drawn uniformly from its range at the start of an episode.

    All are factors on the simulator's value, except delay and lag, which are added to it, and what a touch
    keeps and returns, which replace it. The axes' lags and gains are drawn independently.
    """

    friction: Span = Field((1.0, 1.0), description="on the ball's sliding and rolling deceleration")
    acceleration: Span = Field(
        (1.0, 1.0), description="on the robot's accelerations, turning included, and its wheels' grip"
    )
    top_speed: Span = Field((1.0, 1.0), description="on the robot's top speed")
    mass: Span = Field((1.0, 1.0), description="on the robot's mass")
    kick_speed: Span = Field((1.0, 1.0), description="on the speed of kicks")
    dribbler: Span = Field((1.0, 1.0), description="on the dribbler's pull and side acceleration")
    control_delay: Span = Field((0.0, 0.0), description="command to effect, to the sub-step [s]")
    lag: Span = Field((0.0, 0.0), description="time constant of each axis of the robot [s]")
    gain: Span = Field((1.0, 1.0), description="on the share of a velocity that each axis reaches")
    touch_kept: Span | None = Field(
        None, description="share of the ball's sideways velocity that a kick keeps; none for the limits'"
    )
    touch_returned: Span | None = Field(
        None, description="share of the speed of a ball that comes which a kick adds; none for the limits'"
    )

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        for name in ("friction", "acceleration", "top_speed", "mass", "kick_speed", "gain"):
            if getattr(self, name)[0] <= 0.0:
                raise ValueError(f"{name} must be above 0")
        if self.dribbler[0] < 0.0:
            raise ValueError("dribbler must not be negative")
        if not 0.0 <= self.control_delay[0] <= self.control_delay[1] <= 0.5:
            raise ValueError("control_delay must lie in [0, 0.5] s")
        if not 0.0 <= self.lag[0] <= self.lag[1] <= 0.3:
            raise ValueError("lag must lie in [0, 0.3] s")
        for name in ("touch_kept", "touch_returned"):
            share = getattr(self, name)
            if share is not None and not 0.0 <= share[0] <= share[1] <= 1.0:
                raise ValueError(f"{name} must lie in [0, 1]")
        return self


class TaskSettings(OrderedSettings):
    """Settings common to all environments; a task has its own defaults, reward, starts and ends."""

    action: ActionScaling = SCORE_ACTION
    time_limit: int = Field(334, ge=1, le=100_000, description="ticks to the end of an episode")
    field: Annotated[FieldGeometry, by_name(TRAINING_FIELDS, "field")] = Field(
        DIVISION_B,
        description="a field by name (division_a, division_b, hardware_challenge) or its dimensions",
    )
    simulator: Annotated[SimSettings, BeforeValidator(_simulator)] = Field(
        preset("default"), description="a preset by name, or as in a scenario file"
    )
    limits: RobotLimits | None = Field(None, description="of the robot; None takes the simulator's own")
    period: float = Field(0.030, ge=0.005, le=0.1, description="control period [s]")
    sub_steps: int = Field(4, ge=1, le=100, description="physics steps a control period")
    decide_every: int = Field(1, ge=1, le=20, description="ticks for which an action holds")
    velocities: Literal["true", "finite_difference"] = Field(
        "true", description="the bodies' own velocities, or differences of two observed positions, 0 at first"
    )
    noise: NoiseSettings = NoiseSettings()
    memory: MemorySettings = MemorySettings()
    latency: int = Field(0, ge=0, le=20, description="age of observations [ticks]")
    randomisation: RandomisationSettings = RandomisationSettings()

    @model_validator(mode="before")
    @classmethod
    def _in_part(cls, data: object) -> object:
        """Complete a partly given group with the task's defaults."""
        if not isinstance(data, Mapping):
            return data
        result = dict(data)
        for name, value in data.items():
            own = cls.model_fields[name].default if name in cls.model_fields else None
            if isinstance(own, Settings) and not isinstance(own, SimSettings) and isinstance(value, Mapping):
                kept = own.model_dump(exclude_unset=True)
                # The scale of one kind of action does not apply to another.
                if value.get("kind", kept.get("kind")) == kept.get("kind"):
                    result[name] = {**kept, **value}
        return result

    @model_validator(mode="after")
    def _one_remembers(self) -> Self:
        if self.memory != MemorySettings() and len(self.learners) > 1:
            raise FieldError("memory", "is for tasks with one learner")
        return self

    @model_validator(mode="after")
    def _fine_steps(self) -> Self:
        if self.period / self.sub_steps > 0.01:
            raise ValueError(
                f"sub_steps: {self.period:g} s in {self.sub_steps} physics steps are more than 0.01 s each"
            )
        return self

    @property
    def learners(self) -> tuple[int, ...]:
        """Indices of the robots that learn."""
        return (0,)

    @property
    def two_alike(self) -> bool:
        """Whether two teams of equal size play, both with learners."""
        return False

    @property
    def ball_speed(self) -> float:
        """Highest ball speed at the start of an episode [m/s]."""
        return 0.0

    @property
    def robot_limits(self) -> RobotLimits:
        """The robot's limits."""
        return self.simulator.limits if self.limits is None else self.limits

    @property
    def longest_delay(self) -> float:
        """Longest time for which a command is kept from the robot [s]."""
        return self.simulator.holds_back(self.robot_limits) + self.randomisation.control_delay[1]

    @property
    def stepped_simulator(self) -> SimSettings:
        """The simulator with the physics steps that ``sub_steps`` asks for."""
        return self.simulator.model_copy(update={"sub_step": self.period / self.sub_steps})
