"""Levels of realism: what cameras and radio do to what is seen and commanded."""

from __future__ import annotations

from pydantic import Field

from robobt.config.errors import unknown_name
from robobt.config.validation import Settings


class RealismSettings(Settings):
    """Noise, systematic errors, losses and delays between the world and the trees.

    Noise differs from frame to frame. ``object_offset`` and ``camera_error`` are systematic: they stay the
    same for as long as a match lasts, and no averaging removes them.
    """

    ball_noise: float = Field(0.0, ge=0, le=1, description="standard deviation of the ball's position [m]")
    robot_noise: float = Field(0.0, ge=0, le=1, description="standard deviation of a robot's position [m]")
    heading_noise: float = Field(0.0, ge=0, le=3, description="standard deviation of a robot's heading [rad]")
    object_offset: float = Field(
        0.0, ge=0, le=0.5, description="by which each camera sees everything farther from the centre [m]"
    )
    camera_error: float = Field(
        0.0, ge=0, le=1, description="by which the cameras' reported places are wrong [m]"
    )
    camera_overlap: float = Field(
        0.2, ge=0, le=5, description="how far a camera sees beyond its part of the field [m]"
    )
    hidden_below: float = Field(
        0.0,
        ge=0,
        le=1,
        description="share of the ball that a camera has to see past the robots; 0 looks through them",
    )
    false_balls: float = Field(
        0.0, ge=0, le=60, description="balls a second seen at each robot's dribbler, where none is [1/s]"
    )
    missing_ball: float = Field(0.0, ge=0, le=1, description="chance a tick that the ball is not seen")
    missing_robot: float = Field(0.0, ge=0, le=1, description="chance a tick and robot that it is not seen")
    command_loss: float = Field(
        0.0, ge=0, le=1, description="chance that a command is lost; the last one stands"
    )
    response_loss: float = Field(
        0.0,
        ge=0,
        le=1,
        description="chance that a robot's report of the ball at its dribbler is lost; the last one stands",
    )
    vision_delay: float = Field(0.0, ge=0, le=0.5, description="age of what is observed [s]")
    processing_time: float | None = Field(
        None, ge=0, le=0.5, description="age that the cameras' timestamps admit to; none for all of it [s]"
    )
    command_delay: float = Field(0.0, ge=0, le=0.5, description="command to effect [s]")


REALISM: dict[str, RealismSettings] = {
    "none": RealismSettings(),
    "friendly": RealismSettings(
        ball_noise=0.0004,
        robot_noise=0.0003,
        heading_noise=0.003,
        object_offset=0.02,
        camera_error=0.05,
        camera_overlap=1.0,
        hidden_below=0.4,
        false_balls=0.001,
        missing_ball=0.05,
        missing_robot=0.02,
        command_loss=0.01,
        response_loss=0.01,
        vision_delay=0.035,
        processing_time=0.01,
    ),
    "rc2021": RealismSettings(
        ball_noise=0.001,
        robot_noise=0.0013,
        heading_noise=0.01,
        camera_overlap=1.0,
        hidden_below=0.4,
        false_balls=0.02,
        missing_ball=0.05,
        command_loss=0.03,
        response_loss=0.1,
        vision_delay=0.035,
        processing_time=0.01,
    ),
    "realistic": RealismSettings(
        ball_noise=0.0014,
        robot_noise=0.0013,
        heading_noise=0.01,
        object_offset=0.02,
        camera_error=0.1,
        camera_overlap=1.0,
        hidden_below=0.4,
        false_balls=0.05,
        missing_ball=0.05,
        missing_robot=0.02,
        command_loss=0.03,
        response_loss=0.1,
        vision_delay=0.035,
        processing_time=0.01,
        command_delay=0.003,
    ),
}
"""Realism levels. Source: ER-Force's simulator-realism configurations Friendly, RC2021 and Realistic; the
offset of objects and the missing robots of Realistic are Friendly's where a version leaves them out, the
command delay is robobt's own."""


def realism_level(name: str) -> RealismSettings:
    """Return a realism level by name.

    Raises:
        KeyError: no such level; the message lists those there are.
    """
    if name not in REALISM:
        raise KeyError(f"no realism level is called {name!r}; {unknown_name(name, REALISM)}")
    return REALISM[name]
