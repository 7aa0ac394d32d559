"""What ``robobt serve`` puts together: a field from a scenario or a line-up, its server, its referee."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path

import numpy as np

from robobt.league.log.files import LogKind, LogWriter
from robobt.league.serve.served_field import ServedField, line_up
from robobt.league.serve.server import SimServer
from robobt.league.wire.endpoints import Endpoint, Endpoints
from robobt.league.wire.gamecontroller import RefereePublisher
from robobt.league.wire.sockets import LOOPBACK, Sender
from robobt.match.referee.referee import Referee
from robobt.match.referee.settings import RefereeSettings
from robobt.match.scenario.scenario import Scenario
from robobt.sim.settings import REALISM, SimSettings, preset, settings_from
from robobt.world.field import FieldGeometry
from robobt.world.game import Team

_REPEAT = 6
"""Frames from one referee message to the next while nothing changes."""


def served_scenario(
    scenario: Scenario, simulator: str | None = None, realism: str | None = None
) -> ServedField:
    """The field of a scenario, everything where its seed puts it.

    Args:
        simulator: a preset instead of the scenario's simulator.
        realism: a level instead of the scenario's.

    Raises:
        KeyError: no such preset or level.
        ScenarioError: its objects find no place.
        ValueError: its simulator's settings are wrong.
    """
    settings = settings_from(scenario.simulator) if simulator is None else preset(simulator)
    limits = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    placement = scenario.place(np.random.default_rng(scenario.seed))
    return ServedField(scenario.field, placement, _with(settings, realism), limits, seed=scenario.seed)


def served_line_up(
    field: FieldGeometry, robots: int, simulator: str = "grsim", realism: str | None = None, seed: int = 0
) -> ServedField:
    """A field with so many robots a team, lined up in their halves.

    Raises:
        KeyError: no such preset or level.
        ValueError: more robots than a team can have.
    """
    return ServedField(field, line_up(field, robots), _with(preset(simulator), realism), seed=seed)


def _with(settings: SimSettings, realism: str | None) -> SimSettings:
    if realism is None:
        return settings
    if realism not in REALISM:
        raise KeyError(f"no realism level is called {realism!r}; there are {', '.join(REALISM)}")
    return settings.model_copy(update={"realism": REALISM[realism]})


class RefereeDesk:
    """Referees a served field, puts the ball down for restarts, and tells everybody.

    Call it after every step of the field.

    Args:
        field: its dimensions.
        settings: of the referee.
        to: where the messages go.
        interface: own address of the interface they leave by.
        epoch: their times count from here [s].
        log: where they are written down as well.
    """

    def __init__(
        self,
        field: FieldGeometry,
        settings: RefereeSettings | None = None,
        to: Endpoint | None = None,
        interface: str = LOOPBACK,
        epoch: float = 0.0,
        log: LogWriter | None = None,
    ) -> None:
        rules = settings or RefereeSettings()
        self.referee = Referee(field, rules)
        self._sender = Sender(*(to or Endpoints().referee), interface)
        keepers = {team: rules.keeper(team).number for team in Team}
        self._publisher = RefereePublisher(keepers=keepers)
        self._epoch, self._log = epoch, log
        self._frames = 0

    def __call__(self, field: ServedField) -> None:
        """Judge the field as it is now."""
        before = self.referee.game
        decision = self.referee.update(field.truth())
        if decision.place_ball is not None:
            field.place_ball(*decision.place_ball)
        if decision.game != before or self._frames % _REPEAT == 0:
            now = self._epoch + field.time
            data = self._publisher.write(decision.game, now)
            self._sender.send(data)
            if self._log is not None:
                self._log.write(round(now * 1e9), LogKind.REFEREE, data)
        self._frames += 1

    def close(self) -> None:
        """Stop talking."""
        self._sender.close()


def serve(
    field: ServedField,
    endpoints: Endpoints,
    interface: str = LOOPBACK,
    cameras: int = 1,
    speed: float = 1.0,
    seed: int = 0,
    epoch: float = 0.0,
    referee: RefereeSettings | None = None,
    seconds: float | None = None,
    log: str | Path | None = None,
    on_ready: Callable[[SimServer], None] | None = None,
) -> SimServer:
    """Serve a field until interrupted, or for so many seconds of this machine's clock.

    Args:
        referee: settings of the referee who judges and publishes; none: nobody does.
        log: a league log to write.
        on_ready: called once it listens.

    Returns:
        The server, closed, for its counts.
    """
    with ExitStack() as stack:
        writer = None if log is None else stack.enter_context(LogWriter(log))
        server = stack.enter_context(
            SimServer(field, endpoints, interface, cameras, speed, seed, epoch, writer)
        )
        desk = None
        if referee is not None:
            desk = RefereeDesk(field.field, referee, endpoints.referee, interface, epoch, writer)
            stack.callback(desk.close)
        if on_ready is not None:
            on_ready(server)
        with suppress(KeyboardInterrupt):
            server.run(seconds, desk)
    return server
