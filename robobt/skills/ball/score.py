"""Get the ball and score on a goalkeeper, all of it learned."""

from __future__ import annotations

from dataclasses import field, replace
from math import inf

from robobt.skills.ball.learned_control import LearnedControl, PolicyError
from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.command import RobotCommand


@skill
class Score(Skill):
    """Attack by a trained policy, from first touch to goal; runs for as long as it is ticked.

    It decides as often as it did in training, by its card's period, and holds its command between. It looks
    at the goalkeeper alone (:data:`robobt.world.scoring.SCORE_ON_GOALKEEPER`): other robots it drives into,
    so that with more on the field conditions have to stand beside it. It fails, and the robot stops, when
    the policy's answer is not a valid action.

    Args:
        policy: name or file of a model for Score (``robobt train score_on_goalkeeper``); without one the
            leaf fails.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    policy: str = ""
    _decided: float = field(default=-inf, init=False)
    _command: RobotCommand = field(default_factory=RobotCommand, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._control = LearnedControl(self.policy, skill="Score") if self.policy else None

    def on_start(self) -> None:
        """Forget the last command."""
        self._decided = -inf

    def on_running(self) -> Status:
        """Decide, or do as decided, for one tick."""
        if self._control is None:
            return self.fail("it has been given no policy")
        frame, period = self.frame, self._control.card.period or 0.0
        # Half a tick of room: times are sums of periods.
        if not 0.0 <= frame.time - self._decided < period - frame.period / 2:
            try:
                self._command = self._control.decide(frame, self.me)
            except PolicyError as error:
                self._decided = -inf
                self.store.command = RobotCommand()
                return self.fail(str(error))
            self._decided = frame.time
        self.store.command = replace(self._command)
        return self.run("kicking" if self._command.kick_speed > 0.0 else "attacking")
