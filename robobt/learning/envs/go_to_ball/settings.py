"""Settings of Go-To-Ball."""

from __future__ import annotations

from math import pi
from typing import Literal, Self

from pydantic import Field, model_validator

from robobt.learning.envs.go_to_ball.rewards import GoToBallReward
from robobt.learning.envs.settings import OrderedSettings, Span, TaskSettings
from robobt.models.actions import GO_TO_BALL_ACTION, ActionScaling


class ContactRule(OrderedSettings):
    """The rule for having reached the ball.

    ``distance``: its centre is within ``distance`` of the ball's (the paper's
    Eq. 7). ``distance_facing``: also with the ball no more than ``angle`` off the
    heading. ``infrared``: the ball is in the mouth (the authors' code). ``held``: it has been there for
    ``ticks`` in a row with the dribbler on.
    """

    rule: Literal["distance", "distance_facing", "infrared", "held"] = "distance"
    distance: float = Field(0.2, gt=0.05, le=2, description="centre to centre [m]")
    angle: float = Field(pi / 6, gt=0, le=pi, description="largest angle of the ball off the heading [rad]")
    ticks: int = Field(3, ge=1, le=100, description="time for which the ball is held [ticks]")
    max_speed: float | None = Field(
        None,
        gt=0,
        le=10,
        description="a robot faster than this has not reached the ball yet [m/s]; None for any speed",
    )


class GoToBallStarts(OrderedSettings):
    """Starts of episodes; None for a range takes the field inside the lines, minus ``inset``."""

    inset: float = Field(0.1, ge=0, le=2, description="distance kept from the lines [m]")
    robot_x: Span | None = None
    robot_y: Span | None = None
    heading: Span = Field((-pi, pi), description="[rad]")
    robot_speed: Span = Field((0.0, 0.0), description="in any direction [m/s]")
    robot_turn: Span = Field((0.0, 0.0), description="turning rate [rad/s]")
    ball_x: Span | None = None
    ball_y: Span | None = None
    ball_speed: Span = Field((0.0, 0.0), description="in any direction [m/s]")
    distance: Span = Field(
        (0.2, 100.0), description="distance from robot to ball; starts are drawn again until it fits [m]"
    )


class OthersSettings(OrderedSettings):
    """Moving obstacles that drive back and forth and ignore other robots, drawn for each episode."""

    count: int = Field(0, ge=0, le=21, description="number of robots; touching one ends the episode")
    speed: Span = Field((0.5, 1.5), description="top speed of each [m/s]")
    way: float = Field(1.5, gt=0, le=10, description="least distance of the ends of a way [m]")
    crossing: float = Field(
        0.6, ge=0, le=1, description="share of them whose way crosses the initial straight line to the ball"
    )
    from_ball: float = Field(0.4, ge=0, le=3, description="least distance of a way from the ball [m]")
    apart: float = Field(1.0, ge=0.2, le=5, description="least distance from the robot at first [m]")

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        if self.speed[0] < 0.2:
            raise ValueError("speed must be at least 0.2")
        return self


class GoToBallSettings(TaskSettings):
    """Go-To-Ball: drive to the ball. The paper's environment by default."""

    action: ActionScaling = GO_TO_BALL_ACTION
    time_limit: int = Field(330, ge=1, le=100_000, description="ticks to the end of an episode")
    contact: ContactRule = ContactRule()
    to_shoot: bool = Field(
        False,
        description="the robot observes the attacked goal's direction, reaches the ball only where a kick "
        "would go in, and is rewarded for its orientation to the goal",
    )
    others: OthersSettings = OthersSettings()
    reward: GoToBallReward = GoToBallReward()
    starts: GoToBallStarts = GoToBallStarts()

    @model_validator(mode="after")
    def _drives(self) -> Self:
        if self.action.kind != "drive":
            raise ValueError("action: Go-To-Ball needs drive actions")
        if self.contact.rule == "held" and not self.action.dribbler:
            raise ValueError("contact: the rule 'held' needs action.dribbler")
        if self.others.count and self.to_shoot:
            raise ValueError("to_shoot: not together with others")
        return self


class GoToBallAmongRobotsSettings(GoToBallSettings):
    """Go-To-Ball among five moving robots that ignore all others."""

    decide_every: int = Field(2, ge=1, le=20, description="ticks for which an action holds")
    others: OthersSettings = OthersSettings(count=5)
    starts: GoToBallStarts = GoToBallStarts(distance=(2.0, 100.0))
    reward: GoToBallReward = GoToBallReward(
        contact=5.0, distance=0.0, orientation=0.0, closing=0.015, time=0.005, touched=5.0, near=0.05
    )
