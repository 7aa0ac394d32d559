"""Settings of Go-To-Ball."""

from __future__ import annotations

from math import pi
from typing import Literal, Self

from pydantic import Field, model_validator

from robobt.learning.envs.go_to_ball.rewards import GoToBallReward
from robobt.learning.envs.settings import OrderedSettings, Span, TaskSettings
from robobt.models.actions import GO_TO_BALL_ACTION, ActionScaling


class ContactRule(OrderedSettings):
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


class GoToBallStarts(OrderedSettings):
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
    to_shoot: bool = Field(
        False,
        description="it sees the attacked goal's direction, has reached the ball only when a kick would go "
        "in, and is rewarded for its orientation to the goal",
    )
    reward: GoToBallReward = GoToBallReward()
    starts: GoToBallStarts = GoToBallStarts()

    @model_validator(mode="after")
    def _drives(self) -> Self:
        if self.action.kind != "drive":
            raise ValueError("action: Go-To-Ball needs drive actions")
        if self.contact.rule == "held" and not self.action.dribbler:
            raise ValueError("contact: the rule 'held' needs action.dribbler")
        return self
