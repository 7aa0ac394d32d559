"""Settings of Shoot-Towards-Goal."""

from __future__ import annotations

from math import pi
from typing import Annotated, Self

from pydantic import Field, model_validator

from robobt.config.errors import FieldError
from robobt.learning.envs.settings import MemorySettings, OrderedSettings, Span, TaskSettings, by_name
from robobt.learning.envs.shoot.rewards import SHOOT_REWARDS, ShootReward
from robobt.models.actions import SHOOT_ACTION, ActionScaling


class ShootStarts(OrderedSettings):
    """Starts of episodes: the robot has the ball in its mouth."""

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
    reward: Annotated[ShootReward, by_name(SHOOT_REWARDS, "reward")] = Field(
        ShootReward(), description="a reward by name (coded, printed, cmu, sparse) or its weights"
    )
    starts: ShootStarts = ShootStarts()
    gentle: bool = Field(
        False,
        description="turn and brake only as hard as the dribbler holds the ball, as the skill does with a "
        "policy that has a memory, which needs it",
    )
    lost_distance: float | None = Field(
        None, gt=0.1, le=10, description="an unkicked ball farther away than this ends the episode [m]"
    )

    @model_validator(mode="after")
    def _kicks(self) -> Self:
        if self.action.kind != "turn_and_kick":
            raise ValueError("action: Shoot needs turn_and_kick actions")
        return self

    @model_validator(mode="after")
    def _driven_as_in_a_match(self) -> Self:
        if self.memory != MemorySettings() and not self.gentle:
            raise FieldError("gentle", "must be true with a memory: the skill drives gently then")
        return self
