"""The referee of a branch: robobt's own, which takes over a match that another has refereed so far."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from robobt.match.referee.automatic import AutomaticReferee
from robobt.match.referee.controller import Controller
from robobt.match.referee.events import Decision
from robobt.match.referee.restarts import Resumption
from robobt.match.referee.settings import RefereeSettings
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, Team
from robobt.world.state import Frame


class ResumedReferee:
    """Watches the log up to a moment, then referees from there.

    It takes over the command, the restart, the score and the cards. It does not know of fouls before the part
    of the log that it has watched, nor how long cards still last.

    Args:
        field: the field.
        settings: checks and times.
    """

    def __init__(self, field: FieldGeometry, settings: RefereeSettings) -> None:
        self._settings = settings.model_copy(update={"opening": "force_start"})
        self._automatic = AutomaticReferee(field, self._settings)
        self._controller = Controller(field, self._settings, np.random.default_rng(0))

    def watch(self, frame: Frame) -> None:
        """Take in a logged frame with its state of the game."""
        self._automatic.watch(frame, frame.game)

    def begin(self, frame: Frame) -> GameState:
        """Take over the state of the game at the first frame of the branch, and return it."""
        given, state = frame.game, self._controller.state
        self._automatic.watch(frame, given)
        self._controller.update(frame, ())
        state.stages.stage = given.stage
        for team, score in ((Team.BLUE, given.blue_score), (Team.YELLOW, given.yellow_score)):
            record, status = state.records[team], given.status(team)
            record.score, record.red = score, status.red_cards
            record.yellow = [self._settings.yellow_card_time] * status.yellow_cards
        if given.restart is not None:
            spot = given.placement or frame.ball.position
            state.following = Resumption(spot, given.restart, given.restart_team)
            state.allow(given.command)
        state.game = replace(
            state.game,
            command=given.command,
            restart=given.restart,
            restart_team=given.restart_team,
            placement=given.placement,
        )
        state.tell()
        return self._controller.game

    def update(self, frame: Frame) -> Decision:
        """Judge the next frame."""
        return self._controller.update(frame, self._automatic.watch(frame, self._controller.game))
