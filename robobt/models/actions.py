"""What a learned policy's action in [-1, 1] tells the robot, written once.

The environments that a policy is trained in and the skill that runs it scale,
limit and read actions with these functions alone. A model card carries the
:class:`ActionScaling` that its policy was trained with.

Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
Go-To-Ball and Shoot-Towards-Goal, in the form of the authors' published code.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot
from typing import Literal, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BaseModel, ConfigDict, Field, model_validator

from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.geometry import FloatArray

COMMAND_COLUMNS = ("vx", "vy", "omega", "kick_speed", "on_contact", "dribbler")
"""Columns of a command as an array: m/s, m/s, rad/s, m/s, 0 or 1, 0 or 1."""

ACTION_ENTRIES: dict[str, tuple[str, ...]] = {
    "drive": ("vx", "vy", "omega"),
    "turn_and_kick": ("omega", "kick"),
}
"""Entries of an action vector by the kind of action."""


class ActionScaling(BaseModel):
    """How an action in [-1, 1] becomes a command, SI units.

    ``drive`` actions are (vx, vy, omega) in the robot's frame: the velocity is
    scaled by ``max_speed`` and shortened to it, so that driving diagonally is
    not faster. ``turn_and_kick`` actions are (omega, kick): the robot stays
    where it is, turns, and kicks at once where ``kick`` is above 0.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    kind: Literal["drive", "turn_and_kick"]
    max_speed: float = Field(0.0, ge=0, le=10, description="speed of a full drive action [m/s]")
    max_turn: float = Field(gt=0, le=100, description="turning rate of a full action [rad/s]")
    kick_speed: float = Field(0.0, ge=0, le=20, description="speed of a kick [m/s]")
    dribbler: bool = Field(False, description="whether the dribbler turns all the time")

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if self.kind == "drive" and self.max_speed == 0.0:
            raise ValueError("max_speed must be above 0 for drive actions")
        if self.kind == "turn_and_kick" and self.kick_speed == 0.0:
            raise ValueError("kick_speed must be above 0 for turn_and_kick actions")
        return self

    @property
    def entries(self) -> tuple[str, ...]:
        """Names of the action's entries."""
        return ACTION_ENTRIES[self.kind]

    @property
    def size(self) -> int:
        """Length of the action vector."""
        return len(self.entries)


GO_TO_BALL_ACTION = ActionScaling(kind="drive", max_speed=1.5, max_turn=1.395)
"""The paper's Go-To-Ball. Source: the authors' training code and deployment."""

SHOOT_ACTION = ActionScaling(kind="turn_and_kick", max_turn=10.0, kick_speed=5.0, dribbler=True)
"""The paper's Shoot-Towards-Goal, with the dribbler on as in the authors' deployment."""


def commands_of(actions: ArrayLike, scaling: ActionScaling) -> FloatArray:
    """The commands that actions stand for.

    Args:
        actions: (..., A) in [-1, 1], :attr:`ActionScaling.entries`; what lies
            outside is clipped.
        scaling: of the policy.

    Returns:
        (..., 6): :data:`COMMAND_COLUMNS`.
    """
    a = np.minimum(np.maximum(np.asarray(actions, dtype=np.float64), -1.0), 1.0)
    commands = np.zeros((*a.shape[:-1], len(COMMAND_COLUMNS)))
    if scaling.kind == "drive":
        # A vector longer than 1 is shortened to 1.
        norm = np.maximum(np.hypot(a[..., 0], a[..., 1]), 1.0)
        commands[..., 0] = scaling.max_speed * a[..., 0] / norm
        commands[..., 1] = scaling.max_speed * a[..., 1] / norm
        commands[..., 2] = scaling.max_turn * a[..., 2]
    else:
        commands[..., 2] = scaling.max_turn * a[..., 0]
        commands[..., 3] = np.where(a[..., 1] > 0.0, scaling.kick_speed, 0.0)
    commands[..., 5] = float(scaling.dribbler)
    return commands


def command_of(action: Iterable[float], scaling: ActionScaling) -> RobotCommand:
    """The command that one action (A,) stands for; kicks fire at once or not at all.

    :func:`commands_of` for a single action, without arrays, which would take several times as long.
    """
    entries = [min(max(float(entry), -1.0), 1.0) for entry in action]
    if scaling.kind == "drive":
        x, y, turn = entries
        norm = max(hypot(x, y), 1.0)
        vx, vy, kick = scaling.max_speed * x / norm, scaling.max_speed * y / norm, 0.0
    else:
        turn, trigger = entries
        vx = vy = 0.0
        kick = scaling.kick_speed if trigger > 0.0 else 0.0
    return RobotCommand(vx, vy, scaling.max_turn * turn, kick, KickTrigger.NOW, scaling.dribbler)
