"""The base of skills that consist of one trained policy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from robobt.skills.ball.learned_control import PacedControl, PolicyError
from robobt.skills.base import Skill
from robobt.tree import Status
from robobt.world.command import RobotCommand


@dataclass(kw_only=True, eq=False, repr=False)
class PolicySkill(Skill):
    """A skill that a trained policy plays for as long as it is ticked.

    It decides as often as in training, by its card's period, and holds its command in between. When its
    answer is not a valid action, the skill fails and the robot stops. The model has to be one for the skill
    of this name.

    Args:
        policy: name or file of a model; without one the leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    doing: ClassVar[str] = "playing"
    """Feedback while the robot does not kick."""

    policy: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        self._control = PacedControl(self.policy, skill=type(self).__name__) if self.policy else None

    def on_start(self) -> None:
        """Forget the last decision."""
        if self._control is not None:
            self._control.restart()

    def on_running(self) -> Status:
        """Decide, or repeat the last decision, for one tick."""
        if self._control is None:
            return self.fail("it has no model: give it one with policy=NAME (robobt list models shows them)")
        try:
            command = self._control.decide(self.frame, self.me, self.draw, self.store.team)
        except PolicyError as error:
            self.store.command = RobotCommand()
            return self.fail(str(error))
        self.store.command = command
        return self.run("kicking" if command.kick_speed > 0.0 else self.doing)
