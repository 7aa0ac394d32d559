"""Settings of the training environments, SI units, from YAML or Python."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from robobt.models.actions import GO_TO_BALL_ACTION, SHOOT_ACTION, ActionScaling
from robobt.sim.settings import SimSettings, preset, settings_from
from robobt.world.field import DIVISION_B, FIELDS, FieldGeometry
from robobt.world.limits import RobotLimits

Span = Annotated[tuple[float, float], Field(description="least and most")]
"""A range that is drawn from evenly."""

HARDWARE_CHALLENGE = FieldGeometry(
    length=6.0, width=4.0, goal_width=0.7, defense_width=2.0, defense_depth=0.8
)
"""The 6 m x 4 m field that the authors trained Go-To-Ball on. Source: rSim's field type 2."""

TRAINING_FIELDS: dict[str, FieldGeometry] = {**FIELDS, "hardware_challenge": HARDWARE_CHALLENGE}
"""Fields that settings may call by name."""


class _Settings(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        for name in type(self).model_fields:
            value = getattr(self, name)
            if isinstance(value, tuple) and len(value) == 2 and value[0] > value[1]:
                raise ValueError(f"{name}: the least, {value[0]:g}, is above the most, {value[1]:g}")
        return self


def _field(value: Any) -> Any:
    if isinstance(value, str):
        if value not in TRAINING_FIELDS:
            raise ValueError(f"no field is called {value!r}; there are {', '.join(TRAINING_FIELDS)}")
        return TRAINING_FIELDS[value]
    return value


def _simulator(value: Any) -> Any:
    if isinstance(value, str) or (isinstance(value, Mapping) and not _complete(value)):
        try:
            return settings_from(value)
        except KeyError as error:
            raise ValueError(error.args[0]) from error
    return value


def _complete(value: Mapping[str, Any]) -> bool:
    """Whether the mapping is what a settings object was written out as."""
    return set(SimSettings.model_fields) <= set(value)


class NoiseSettings(_Settings):
    """Standard deviations of what is observed; cut off at four of them."""

    robot_position: float = Field(0.0, ge=0, le=0.5, description="of x and y of the robot [m]")
    ball_position: float = Field(0.0, ge=0, le=0.5, description="of x and y of the ball [m]")
    heading: float = Field(0.0, ge=0, le=1, description="of the heading [rad]")
    velocity: float = Field(
        0.0, ge=0, le=2, description="of vx and vy of robot and ball, on top of true velocities [m/s]"
    )
    turn_rate: float = Field(0.0, ge=0, le=5, description="of omega, on top of a true one [rad/s]")


class RandomisationSettings(_Settings):
    """What differs from episode to episode: each is drawn evenly from its range at the start.

    All but the delay are factors on the simulator's own value.
    """

    friction: Span = Field((1.0, 1.0), description="on the ball's sliding and rolling deceleration")
    acceleration: Span = Field((1.0, 1.0), description="on the robot's accelerations, turning included")
    mass: Span = Field((1.0, 1.0), description="on the robot's mass")
    kick_speed: Span = Field((1.0, 1.0), description="on the speed of kicks")
    dribbler: Span = Field((1.0, 1.0), description="on the dribbler's pull and side acceleration")
    control_delay: Span = Field((0.0, 0.0), description="command to effect, to the sub-step [s]")

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        for name in ("friction", "acceleration", "mass", "kick_speed"):
            if getattr(self, name)[0] <= 0.0:
                raise ValueError(f"{name} must be above 0")
        if self.dribbler[0] < 0.0:
            raise ValueError("dribbler must not be negative")
        if not 0.0 <= self.control_delay[0] <= self.control_delay[1] <= 0.5:
            raise ValueError("control_delay must lie in [0, 0.5] s")
        return self


class TaskSettings(_Settings):
    """What both environments have in common."""

    field: Annotated[FieldGeometry, BeforeValidator(_field)] = Field(
        DIVISION_B,
        description="a field by name (division_a, division_b, hardware_challenge) or its dimensions",
    )
    simulator: Annotated[SimSettings, BeforeValidator(_simulator)] = Field(
        preset("default"), description="a preset by name, or as in a scenario file"
    )
    limits: RobotLimits | None = Field(None, description="of the robot; None takes the simulator's own")
    period: float = Field(0.030, ge=0.005, le=0.1, description="control period [s]")
    sub_steps: int = Field(4, ge=1, le=100, description="physics steps a control period")
    velocities: Literal["true", "finite_difference"] = Field(
        "true",
        description="the bodies' own velocities, or differences of two observed positions, 0 at first",
    )
    noise: NoiseSettings = NoiseSettings()
    latency: int = Field(0, ge=0, le=20, description="age of what is observed [ticks]")
    randomisation: RandomisationSettings = RandomisationSettings()

    @model_validator(mode="after")
    def _fine_steps(self) -> Self:
        if self.period / self.sub_steps > 0.01:
            raise ValueError(
                f"sub_steps: {self.period:g} s in {self.sub_steps} physics steps are more than 0.01 s each"
            )
        return self

    @property
    def robot_limits(self) -> RobotLimits:
        """What the robot can do."""
        return self.simulator.limits if self.limits is None else self.limits

    @property
    def stepped_simulator(self) -> SimSettings:
        """The simulator with the physics steps that ``sub_steps`` asks for."""
        return self.simulator.model_copy(update={"sub_step": self.period / self.sub_steps})


class ContactRule(_Settings):
    """When the robot has reached the ball.

    ``distance``: its centre is within ``distance`` of the ball's (the paper's
    Eq. 7). ``distance_facing``: also with the ball no more than ``angle`` off the
    heading. ``infrared``: the ball lies in the mouth (the authors' code).
    ``held``: it has lain there for ``ticks`` in a row with the dribbler on.
    """

    rule: Literal["distance", "distance_facing", "infrared", "held"] = "distance"
    distance: float = Field(0.2, gt=0.05, le=2, description="centre to centre [m]")
    angle: float = Field(pi / 6, gt=0, le=pi, description="ball off the heading [rad]")
    ticks: int = Field(3, ge=1, le=100, description="how long the ball is held [ticks]")
    max_speed: float | None = Field(
        None, gt=0, le=10, description="a faster robot has not reached it yet [m/s]; None for any speed"
    )


class GoToBallReward(_Settings):
    """Weights of the reward's terms."""

    contact: float = Field(100.0, ge=0, le=1e4, description="Eq. 7: once, on reaching the ball")
    distance: float = Field(1.0, ge=0, le=100, description="times 5/sqrt(2 pi) exp(-d^2/2) - 2, Eq. 8")
    orientation: float = Field(
        1.0, ge=0, le=100, description="times 1/sqrt(2 pi) exp(-2 |theta|/pi^2), Eq. 9"
    )
    time: float = Field(0.0, ge=0, le=100, description="taken off every tick")


class GoToBallStarts(_Settings):
    """Where episodes start; None for a range takes the field inside its lines less ``inset``."""

    inset: float = Field(0.1, ge=0, le=2, description="distance kept from the lines [m]")
    robot_x: Span | None = None
    robot_y: Span | None = None
    heading: Span = Field((-pi, pi), description="[rad]")
    robot_speed: Span = Field((0.0, 0.0), description="in any direction [m/s]")
    robot_turn: Span = Field((0.0, 0.0), description="turning rate [rad/s]")
    ball_x: Span | None = None
    ball_y: Span | None = None
    ball_speed: Span = Field((0.0, 0.0), description="in any direction [m/s]")
    distance: Span = Field((0.2, 100.0), description="robot to ball, drawn again until it fits [m]")


class GoToBallSettings(TaskSettings):
    """Go-To-Ball: drive to the ball. The paper's environment by default."""

    action: ActionScaling = GO_TO_BALL_ACTION
    time_limit: int = Field(330, ge=1, le=100_000, description="ticks to the end of an episode")
    contact: ContactRule = ContactRule()
    reward: GoToBallReward = GoToBallReward()
    starts: GoToBallStarts = GoToBallStarts()

    @model_validator(mode="after")
    def _drives(self) -> Self:
        if self.action.kind != "drive":
            raise ValueError("action: Go-To-Ball needs drive actions")
        if self.contact.rule == "held" and not self.action.dribbler:
            raise ValueError("contact: the rule 'held' needs action.dribbler")
        return self


class ShootReward(_Settings):
    """Weights of the reward's terms."""

    face_goal: float = Field(1.0, ge=0, le=100, description="times (alpha - beta) |v_ball|, Eq. 12")
    inside_share: float = Field(
        0.05, ge=0, le=1, description="Eq. 12: share that is left where alpha >= beta"
    )
    kick: float = Field(10.0, ge=0, le=1e3, description="Eq. 13: once, on kicking while facing the goal")
    kick_counts: Literal["pressed", "fired"] = Field(
        "pressed",
        description="what a kick is to Eq. 13: the first kick action, ball or not, or the kicker's firing",
    )
    waiting: float = Field(
        0.25, ge=0, le=10, description="Eq. 13: taken off a tick before the kick or not facing the goal"
    )
    goal: float = Field(20.0, ge=0, le=1e3, description="on a goal, instead of all other terms")
    time: float = Field(0.0, ge=0, le=10, description="taken off every tick that does not end the episode")


SHOOT_REWARDS: dict[str, ShootReward] = {
    "coded": ShootReward(),
    "printed": ShootReward(goal=0.0),
    "cmu": ShootReward(kick=0.0, waiting=0.0),
    "sparse": ShootReward(face_goal=0.0, kick=0.0, waiting=0.0, time=0.05),
}
"""Rewards by name: the authors' code, the paper's equations alone, Eq. 12 and the goal, the goal and time."""


def _reward(value: Any) -> Any:
    if isinstance(value, str):
        if value not in SHOOT_REWARDS:
            raise ValueError(f"no reward is called {value!r}; there are {', '.join(SHOOT_REWARDS)}")
        return SHOOT_REWARDS[value]
    return value


class ShootStarts(_Settings):
    """Where episodes start: the robot stands with the ball in its mouth."""

    robot_x: Span | None = Field(None, description="None: 0.3 m to 0.3 m before the defence area [m]")
    robot_y: Span | None = Field(None, description="None: inside the touch lines less 0.1 m [m]")
    heading: Span = Field((-pi, pi), description="[rad]")
    robot_turn: Span = Field((0.0, 0.0), description="turning rate [rad/s]")
    robot_speed: Span = Field(
        (0.0, 0.0), description="with the ball, in any direction in which it stops inside the ranges [m/s]"
    )
    ball_aside: Span = Field((0.0, 0.0), description="ball off the middle of the mouth, left positive [m]")
    warm_up: int = Field(
        3, ge=0, le=100, description="ticks at rest before the start, in which the dribbler takes the ball"
    )


class ShootSettings(TaskSettings):
    """Shoot-Towards-Goal: turn with the ball and kick it into the goal. The paper's by default."""

    action: ActionScaling = SHOOT_ACTION
    time_limit: int = Field(100, ge=1, le=100_000, description="ticks to the end of an episode")
    reward: Annotated[ShootReward, BeforeValidator(_reward)] = Field(
        ShootReward(), description="a reward by name (coded, printed, cmu, sparse) or its weights"
    )
    starts: ShootStarts = ShootStarts()
    lost_distance: float | None = Field(
        None, gt=0.1, le=10, description="an unkicked ball farther away than this ends the episode [m]"
    )

    @model_validator(mode="after")
    def _kicks(self) -> Self:
        if self.action.kind != "turn_and_kick":
            raise ValueError("action: Shoot needs turn_and_kick actions")
        return self
