"""The referee of a simulated match by the official game controller, in lock step."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from zlib import crc32

import numpy as np

from robobt.league.referee.lockstep import EPOCH, LockstepController
from robobt.league.referee.people import People
from robobt.league.referee.process import GameControllerError, GameControllerProcess
from robobt.league.referee.setup import ORIGIN, MatchSetup, game_event
from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.messages import Change
from robobt.league.wire.messages import Referee as RefereeMessage
from robobt.match.referee.automatic import CONTROLLER_SEES, AutomaticReferee
from robobt.match.referee.events import Decision, RefereeEvent
from robobt.match.referee.openings import opening_of
from robobt.match.refereeing import referee_settings
from robobt.match.scenario.scenario import Scenario
from robobt.world.field import FieldGeometry
from robobt.world.game import Restart
from robobt.world.presence import without_absent
from robobt.world.state import Frame

_DECIDING_PERIOD, _STOPPED_PERIOD, _WAITING_PERIOD = 0.1, 0.2, 0.8
"""Time between two ticks of the controller [s].

Three values: while it has something to decide; while play is stopped; while it waits for a report, with the
ball in play or being placed. Reports are sent at once.
"""

_DECIDES = 1.5
"""Time for which the controller has to decide on a report, which it believes after a second [s]."""


class OfficialReferee:
    """Sends the true frames and events to the official controller, and adopts its decisions.

    The events of its decisions are those that it raises itself and the reports that it accepts.

    Args:
        setup: what is played.
        start: starts the controller with settings of the game.
    """

    def __init__(
        self, setup: MatchSetup, start: Callable[[Mapping[str, object]], GameControllerProcess]
    ) -> None:
        self._setup, self._start = setup, start
        self._automatic = AutomaticReferee(setup.field, setup.settings, CONTROLLER_SEES)
        self._people = People(setup.field, setup.settings)
        self._follower = RefereeFollower()
        self._process: GameControllerProcess | None = None
        self._controller: LockstepController | None = None
        self._reports: list[Change] = []
        self._due = self._decided = 0.0

    def update(self, frame: Frame) -> Decision:
        """Judge the next frame.

        Raises:
            GameControllerError: the controller cannot be started or has failed.
        """
        begins = self._controller is None
        if self._controller is None:
            self._process = self._start(self._setup.game_settings())
            self._controller = LockstepController(self._process.stream)
        controller = self._controller
        seen = self._automatic.watch(frame, self._follower.game)
        self._reports += [game_event(write_event(event, EPOCH, ORIGIN)) for event in seen]
        events: list[RefereeEvent] = []
        try:
            if begins:
                events += self._set_up(controller, frame)
            if controller.asked:
                events += self._hear(controller.answer(), frame.time)
            if self._reports or frame.time >= self._due - 1e-6:
                events += self._hear(controller.rest(), frame.time)
                changes = self._reports + self._people.clicks(frame, self._follower.game)
                if changes:
                    self._reports = []
                    self._decided = frame.time + _DECIDES
                    events += self._hear(controller.change(changes), frame.time)
                game = self._follower.game
                waits = game.in_play or game.restart is Restart.BALL_PLACEMENT
                pause = _WAITING_PERIOD if waits else _STOPPED_PERIOD
                self._due = frame.time + (_DECIDING_PERIOD if frame.time < self._decided else pause)
                controller.ask(frame.time, without_absent(frame, game))
        except GameControllerError as error:
            crash = "" if self._process is None else self._process.crash()
            raise GameControllerError(f"{error}: {crash}" if crash else str(error)) from error
        game = self._follower.watch(frame)
        place = None if game.in_play else self._people.puts_ball(frame, game)
        return Decision(game, tuple(events), place)

    def tell(self, change: Change) -> None:
        """Let the controller change the match at its next step, as a person at its screen may."""
        self._reports.append(change)

    def close(self) -> None:
        """End the controller."""
        process, self._process, self._controller = self._process, None, None
        if process is not None:
            process.close()

    def _set_up(self, controller: LockstepController, frame: Frame) -> list[RefereeEvent]:
        setup = self._setup
        opening = opening_of(setup.settings, setup.field, frame, np.random.default_rng(crc32(frame.packed())))
        # Changes need a clock; sizes are sent after the division, which would change them.
        controller.ask(frame.time)
        said = controller.answer() + controller.change(setup.changes(opening), setup.config())
        controller.ask(frame.time, None, write_geometry(setup.field))
        return self._hear(said + controller.answer(), frame.time)

    def _hear(self, messages: Iterable[RefereeMessage], now: float) -> list[RefereeEvent]:
        """Follow the controller's messages; return the events that are new in them at this time [s]."""
        events: list[RefereeEvent] = []
        for message in messages:
            self._follower.follow(message)
            events += self._follower.reported(now, EPOCH)
        return events


@dataclass(slots=True, frozen=True)
class OfficialRefereeFactory:
    """Makes the referee of each match; ``program`` is the official one."""

    program: Path

    @property
    def name(self) -> str:
        """Name by which result files are distinguished."""
        return "official"

    def __call__(self, scenario: Scenario, field: FieldGeometry) -> OfficialReferee:
        """Return the referee of a match on this field."""
        robots = Counter(robot.team for robot, _ in scenario.robots)
        setup = MatchSetup(field, referee_settings(scenario), robots)
        return OfficialReferee(setup, partial(GameControllerProcess, self.program))
