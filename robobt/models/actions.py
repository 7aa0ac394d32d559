"""The meaning of a learned policy's action in [-1, 1] for the robot.

The environments that a policy is trained in and the skill that runs it scale,
limit and read actions with the functions here. A model card carries the
:class:`ActionScaling` that its policy was trained with.

Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
Go-To-Ball and Shoot-Towards-Goal, in the form of the authors' published code.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from math import hypot, isfinite
from typing import Literal, Self

from pydantic import Field, model_validator

from robobt.config.validation import Settings
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.compiled import compiled_lean, numbers_dtype
from robobt.world.geometry import FloatArray

ACTION_ENTRIES: dict[str, tuple[str, ...]] = {
    "drive": ("vx", "vy", "omega"),
    "turn_and_kick": ("omega", "kick"),
    "drive_and_kick": ("vx", "vy", "omega", "kick"),
    "drive_and_hold": ("vx", "vy", "omega", "hold"),
}
"""Entries of an action vector by the kind of action."""


class ActionScaling(Settings):
    """Conversion of an action in [-1, 1] to a command, in SI units.

    ``drive`` actions are (vx, vy, omega) in the robot's frame: the velocity is
    scaled by ``max_speed`` and shortened to it, so that driving diagonally is
    not faster. ``turn_and_kick`` actions are (omega, kick): the robot stays
    where it is, turns, and kicks at once where ``kick`` is above 0.
    ``drive_and_kick`` actions are (vx, vy, omega, kick) and do both.
    ``drive_and_hold`` actions are (vx, vy, omega, hold): the dribbler turns
    where ``hold`` is above 0, whatever ``dribbler`` says.
    """

    kind: Literal["drive", "turn_and_kick", "drive_and_kick", "drive_and_hold"]
    max_speed: float = Field(0.0, ge=0, le=10, description="speed of a full drive action [m/s]")
    max_turn: float = Field(gt=0, le=100, description="turning rate of a full action [rad/s]")
    kick_speed: float = Field(0.0, ge=0, le=20, description="speed of a kick [m/s]")
    dribbler: bool = Field(False, description="whether the dribbler turns all the time")

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if self.drives and self.max_speed == 0.0:
            raise ValueError(f"max_speed must be above 0 for {self.kind} actions")
        if self.kicks and self.kick_speed == 0.0:
            raise ValueError(f"kick_speed must be above 0 for {self.kind} actions")
        return self

    @property
    def drives(self) -> bool:
        """Whether actions begin with a velocity."""
        return "vx" in self.entries

    @property
    def kicks(self) -> bool:
        """Whether their last entry is a kick."""
        return self.entries[-1] == "kick"

    @property
    def holds(self) -> bool:
        """Whether their last entry switches the dribbler."""
        return self.entries[-1] == "hold"

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

SCORE_ACTION = ActionScaling(
    kind="drive_and_kick", max_speed=3.0, max_turn=6.0, kick_speed=6.0, dribbler=True
)
"""Driving with the ball and kicking it, 0.5 m/s below the rules' limit because driving adds speed."""


_SCALING = numbers_dtype(ActionScaling)


@compiled_lean
def fill_commands(
    actions: FloatArray,
    numbers: FloatArray,
    drives: bool,
    kicks: bool,
    holds: bool,
    kick_factors: FloatArray,
    commands: FloatArray,
) -> bool:
    """Fill the commands of many robots from their actions; return False where one is not finite.

    Args:
        actions: (n, A) in [-1, 1], :attr:`ActionScaling.entries`; values outside are clipped.
        numbers: of the :class:`ActionScaling`.
        drives: whether actions begin with a velocity.
        kicks: whether the last entry is a kick.
        holds: whether the last entry switches the dribbler.
        kick_factors: (n,) by which the speed of each robot's kicks is multiplied.
        commands: (n, 6) to be filled: vx, vy [m/s], omega [rad/s], kick speed [m/s], whether to
            kick on contact, whether the dribbler turns.
    """
    scaling: ActionScaling = numbers.view(_SCALING)[0]
    turn = 2 if drives else 0
    for i in range(len(actions)):
        action, command = actions[i], commands[i]
        if not isfinite(action.sum()):
            return False
        command[:] = 0.0
        if drives:
            x, y = min(max(action[0], -1.0), 1.0), min(max(action[1], -1.0), 1.0)
            # A vector longer than 1 is shortened to 1.
            norm = max(hypot(x, y), 1.0)
            command[0] = scaling.max_speed * x / norm
            command[1] = scaling.max_speed * y / norm
        command[2] = scaling.max_turn * min(max(action[turn], -1.0), 1.0)
        if kicks and action[-1] > 0.0:
            command[3] = scaling.kick_speed * kick_factors[i]
        command[5] = action[-1] > 0.0 if holds else scaling.dribbler
    return True


def command_of(action: Iterable[float], scaling: ActionScaling) -> RobotCommand:
    """Return the command that one action (A,) stands for; kicks fire at once or not at all.

    It equals :func:`fill_commands` except for the last bit, because the two round the norm differently.
    """
    return commander(scaling)(action)


def commander(scaling: ActionScaling) -> Callable[[Iterable[float]], RobotCommand]:
    """Return :func:`command_of` for one scaling, which is looked up once in place of at every action."""
    drives, kicks, holds, dribbler = scaling.drives, scaling.kicks, scaling.holds, scaling.dribbler
    max_speed, max_turn, kick_speed = scaling.max_speed, scaling.max_turn, scaling.kick_speed
    turn_at, now = 2 if drives else 0, KickTrigger.NOW

    def command(action: Iterable[float]) -> RobotCommand:
        entries = [
            entry if -1.0 <= entry <= 1.0 else min(max(entry, -1.0), 1.0) for entry in map(float, action)
        ]
        vx = vy = 0.0
        if drives:
            x, y = entries[0], entries[1]
            norm = hypot(x, y)
            if norm < 1.0:
                norm = 1.0
            vx, vy = max_speed * x / norm, max_speed * y / norm
        kick = kick_speed if kicks and entries[-1] > 0.0 else 0.0
        turning = entries[-1] > 0.0 if holds else dribbler
        return RobotCommand(vx, vy, max_turn * entries[turn_at], kick, now, turning)

    return command
