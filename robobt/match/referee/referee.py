"""robobt's own referee: the automatic referee and the controller in one.

Source of the rules: RoboCup SSL rules of 2026.
"""

from __future__ import annotations

from collections.abc import Sequence
from zlib import crc32

import numpy as np

from robobt.match.referee.automatic import AutomaticReferee
from robobt.match.referee.controller import Controller
from robobt.match.referee.events import Decision, RefereeEvent
from robobt.match.referee.restarts import Resumption
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.verdicts import resumption_after
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Stage, Team
from robobt.world.geometry import Point
from robobt.world.state import Frame

_BEFORE = GameState(RefereeCommand.HALT, stage=Stage.NORMAL_FIRST_HALF_PRE, may_touch=False, placement=None)


class Referee:
    """Referees a match in simulated time; the same frames give the same decisions.

    Its random draws depend on the first frame only.

    Args:
        field: the field, which tells the division.
        settings: checks and times; by default as in the rules.

    Attributes:
        automatic: detects the events.
        controller: decides on them and handles the teams' requests; None before the first frame.
    """

    def __init__(self, field: FieldGeometry, settings: RefereeSettings | None = None) -> None:
        self.field = field
        self.settings = settings or RefereeSettings()
        self.automatic = AutomaticReferee(field, self.settings)
        self.controller: Controller | None = None

    @property
    def game(self) -> GameState:
        """The state of the game."""
        return _BEFORE if self.controller is None else self.controller.game

    def update(self, frame: Frame) -> Decision:
        """Judge the next frame.

        ``frame`` is the true frame, from blue's side; its time increases from call to call.
        """
        if frame.team is not Team.BLUE:
            raise ValueError("the referee looks from blue's side; pass World.truth() as it is")
        if self.controller is None:
            lot = np.random.default_rng(crc32(frame.packed()))
            self.controller = Controller(self.field, self.settings, lot)
            self.controller.after = self.resumption_after
            self.automatic.watch(frame, self.game)
            return self.controller.update(frame, ())
        return self.controller.update(frame, self.watch(frame))

    def watch(self, frame: Frame) -> Sequence[RefereeEvent]:
        """Return the events in the next frame; competitions with other rules override this."""
        return self.automatic.watch(frame, self.game)

    def resumption_after(self, event: RefereeEvent, ball: Point) -> Resumption | None:
        """Return the restart after an event that stops play, else None; other rules override this.

        Args:
            event: the event while the ball was in play.
            ball: the ball's position now [m].
        """
        return resumption_after(self.field, event, ball)

    def close(self) -> None:
        """Do nothing, as there is nothing to close; see :class:`robobt.match.refereeing.MatchReferee`."""
