"""What a learned policy's action in [-1, 1] tells the robot.

The environments that a policy is trained in and the skill that runs it scale,
limit and read actions with the functions here. A model card carries the
:class:`ActionScaling` that its policy was trained with.

Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
Go-To-Ball and Shoot-Towards-Goal, in the form of the authors' published code.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import hypot, isfinite
from typing import Literal, Self

from pydantic import Field, model_validator

from robobt.config.validation import Settings
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.compiled import compiled, numbers_dtype
from robobt.world.geometry import FloatArray

ACTION_ENTRIES: dict[str, tuple[str, ...]] = {
    "drive": ("vx", "vy", "omega"),
    "turn_and_kick": ("omega", "kick"),
}
"""Entries of an action vector by the kind of action."""


class ActionScaling(Settings):
    """How an action in [-1, 1] becomes a command, SI units.

    ``drive`` actions are (vx, vy, omega) in the robot's frame: the velocity is
    scaled by ``max_speed`` and shortened to it, so that driving diagonally is
    not faster. ``turn_and_kick`` actions are (omega, kick): the robot stays
    where it is, turns, and kicks at once where ``kick`` is above 0.
    """

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


_SCALING = numbers_dtype(ActionScaling)


@compiled
def fill_commands(
    actions: FloatArray, numbers: FloatArray, drive: bool, kick_factors: FloatArray, commands: FloatArray
) -> bool:
    """Fill the commands of many robots from their actions; return False where one is not finite.

    Args:
        actions: (n, A) in [-1, 1], :attr:`ActionScaling.entries`; what lies outside is clipped.
        numbers: of the :class:`ActionScaling`.
        drive: whether the actions are of that kind.
        kick_factors: (n,) by which the speed of each robot's kicks is multiplied.
        commands: (n, 6) to be filled: vx, vy [m/s], omega [rad/s], kick speed [m/s], whether to
            kick on contact, whether the dribbler turns.
    """
    scaling: ActionScaling = numbers.view(_SCALING)[0]
    for i in range(len(actions)):
        action, command = actions[i], commands[i]
        command[:] = 0.0
        if drive:
            if not isfinite(action[0] + action[1] + action[2]):
                return False
            x, y = min(max(action[0], -1.0), 1.0), min(max(action[1], -1.0), 1.0)
            # A vector longer than 1 is shortened to 1.
            norm = max(hypot(x, y), 1.0)
            command[0] = scaling.max_speed * x / norm
            command[1] = scaling.max_speed * y / norm
            command[2] = scaling.max_turn * min(max(action[2], -1.0), 1.0)
        else:
            if not isfinite(action[0] + action[1]):
                return False
            command[2] = scaling.max_turn * min(max(action[0], -1.0), 1.0)
            if action[1] > 0.0:
                command[3] = scaling.kick_speed * kick_factors[i]
        command[5] = scaling.dribbler
    return True


def command_of(action: Iterable[float], scaling: ActionScaling) -> RobotCommand:
    """Return the command that one action (A,) stands for; kicks fire at once or not at all.

    What :func:`fill_commands` does for many, to the last bit but one: the two round the norm differently.
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
