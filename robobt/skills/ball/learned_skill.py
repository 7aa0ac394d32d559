"""Any trained policy as a leaf."""

from __future__ import annotations

from robobt.skills.ball.learned_control import PacedControl, PolicyError
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import RobotCommand


@skill
class LearnedSkill(Skill):
    """Drive the robot by a trained policy; runs for as long as it is ticked.

    It decides as often as in training, by its card's period, and holds its command in between. The tree
    decides when it starts and ends: put conditions beside it. If the policy's answer is not a valid action,
    the skill fails and the robot stops.

    Args:
        model: name of a shipped model (``robobt list models``) or the path of a model
            file; its card has the observation and the scale of the actions. Without a model the leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    model: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        self._control = PacedControl(self.model) if self.model else None

    def on_start(self) -> None:
        """Forget the last decision."""
        if self._control is not None:
            self._control.restart()

    def on_running(self) -> Status:
        """Decide, or repeat the last decision, for one tick."""
        if self._control is None:
            return self.fail("it has no model: give it one with model=NAME (robobt list models shows them)")
        try:
            self.store.command = self._control.decide(self.frame, self.me, self.draw, self.store.team)
        except PolicyError as error:
            self.store.command = RobotCommand()
            return self.fail(str(error))
        return self.run(f"driven by {self.model}")
