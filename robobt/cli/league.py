"""``robobt serve`` and ``robobt log``: our simulator for other teams' software, and logs of a field."""

from __future__ import annotations

import time
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass
from enum import StrEnum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import MAX_SEED, Json, print_json, say, warn
from robobt.cli.option_groups.page import Page
from robobt.cli.options import option
from robobt.cli.outputs import check_ending, make_folders
from robobt.config.errors import unknown_name
from robobt.config.wording import counted
from robobt.signals import Terminated

if TYPE_CHECKING:
    from robobt.league.serve.served_field import ServedField
    from robobt.league.serve.server import SimServer
    from robobt.league.wire.endpoints import Endpoint, Endpoints
    from robobt.match.referee.settings import RefereeSettings


VISION, TRACKER, REFEREE = "224.5.23.2:10020", "224.5.23.2:10010", "224.5.23.1:10003"
"""Where the league's programs send and listen by default; on a real field the vision's port is 10006."""

_port = partial(option, min=0, max=65535, show_default=True)


class FieldReferee(StrEnum):
    """Who referees a field that is served."""

    OWN = "own"
    NONE = "none"


class Clock(StrEnum):
    """What timestamps count from."""

    SIM = "sim"
    UNIX = "unix"


@dataclass(frozen=True)
class LineUp:
    """What stands on the field that is served."""

    robots: Annotated[int, option("--robots", ", without a scenario", min=0, max=16)] = 6
    field: Annotated[str, option("--field", ", without a scenario")] = "division_b"
    simulator: Annotated[str | None, option("--simulator", "; by default the scenario's, or grsim")] = None
    realism: Annotated[str | None, option("--realism", "; by default the preset's")] = None
    referee: Annotated[
        FieldReferee, option("--referee", ": own (robobt's, whose messages are published) or none")
    ] = FieldReferee.NONE

    def served(self, scenario: str | None, seed: int) -> tuple[ServedField, RefereeSettings | None]:
        """Return the field to serve, and a referee's settings where there is to be one."""
        from robobt.league.serve.served_field import served_line_up, served_scenario
        from robobt.match import load_scenario
        from robobt.match.referee.settings import RefereeSettings
        from robobt.world import FIELDS

        rules = RefereeSettings() if self.referee is FieldReferee.OWN else None
        if scenario is None:
            if self.field not in FIELDS:
                there = f"there is no field {self.field!r}; {unknown_name(self.field, FIELDS)}"
                raise typer.BadParameter(there, param_hint="--field")
            field, preset = FIELDS[self.field], self.simulator or "grsim"
            return served_line_up(field, self.robots, preset, self.realism, seed), rules
        loaded = load_scenario(scenario)
        if rules is not None and loaded.referee is not None:
            keepers = {f"{team.value}_keeper": number for team, number in loaded.goalkeepers().items()}
            rules = loaded.referee.model_copy(update=keepers)
        return served_scenario(loaded, self.simulator, self.realism), rules


@dataclass(frozen=True)
class Pictures:
    """What the cameras see, and when."""

    cameras: Annotated[int, option("--cameras", min=1, max=16)] = 1
    speed_factor: Annotated[float, option("--speed-factor", min=0.05, max=20)] = 1.0
    clock: Annotated[Clock, option("--clock")] = Clock.SIM
    seed: Annotated[int, option("--seed", " of the cameras' noise", min=0, max=MAX_SEED)] = 0


@dataclass(frozen=True)
class Addresses:
    """Where packets go and come from."""

    interface: Annotated[str, option("--interface", "; by default nothing leaves this machine")] = "127.0.0.1"
    vision: Annotated[str, option("--vision")] = VISION
    tracker: Annotated[str, option("--tracker")] = TRACKER
    referee_address: Annotated[str, option("--referee-address")] = REFEREE
    grsim_port: Annotated[int, _port("--grsim-port")] = 20011
    control_port: Annotated[int, _port("--control-port")] = 10300
    blue_port: Annotated[int, _port("--blue-port")] = 10301
    yellow_port: Annotated[int, _port("--yellow-port")] = 10302
    blue_status_port: Annotated[int, _port("--blue-status-port")] = 30011
    yellow_status_port: Annotated[int, _port("--yellow-status-port")] = 30012

    def endpoints(self) -> Endpoints:
        """Return them all.

        Raises:
            typer.BadParameter: one is no address.
        """
        from robobt.league.wire.endpoints import Endpoints

        return Endpoints(
            vision=_address("--vision", self.vision),
            tracker=_address("--tracker", self.tracker),
            referee=_address("--referee-address", self.referee_address),
            grsim=self.grsim_port,
            control=self.control_port,
            blue=self.blue_port,
            yellow=self.yellow_port,
            blue_status=self.blue_status_port,
            yellow_status=self.yellow_status_port,
        )


def serve(
    scenario: Annotated[
        str | None,
        typer.Argument(help="A scenario file or the name of a bundled one; by default two teams line up."),
    ] = None,
    *,
    line_up: LineUp,
    pictures: Pictures,
    seconds: Annotated[float | None, option("--seconds", "; by default on Ctrl-C", min=0.1)] = None,
    addresses: Addresses,
    in_step: Annotated[
        bool,
        option("--in-step", ", by SimulationSyncRequest over TCP at the ports of teleports and control"),
    ] = False,
    log: Annotated[Path | None, option("--log", " (*.log, *.log.gz)")] = None,
    live: Annotated[bool, option("--live", ", where robots and ball can be moved")] = False,
    page: Page,
    as_json: Json = False,
) -> None:
    """Serve a simulated field: other teams' software connects to it as it does to grSim.

    Vision and tracked frames go out; grSim's packets and the simulation
    protocol come in. Robots stop a tenth of a second after their last command.

    At the end each commanded robot's delay and round trips are printed: from a picture's sending to the
    first command that comes then.

    Keys of --json: frames (sent), simulated_s, speed_kept (share of the speed asked for),
    packets: for each port, what happened to them; robots: for each that was commanded delay (seconds, low and
    high, from a command's coming until a picture shows its effect; null if not seen enough), commands,
    lost (commands), and round_trip (count, mean, variance and maximum in seconds, and lost: pictures to which
    no command came before the next).
    """
    from robobt.cli.shown.round_trips import print_trips, trip_figures
    from robobt.league.log.files import LogWriter
    from robobt.league.serve.server import SimServer

    if live and in_step:
        raise typer.BadParameter("cannot be shown live", param_hint="--in-step")
    page.check(live)
    if log is not None:
        check_ending("--log", log, ".log", ".log.gz")
    make_folders({"--log": log})
    served, rules = line_up.served(scenario, pictures.seed)
    with ExitStack() as stack:
        writer = None if log is None else stack.enter_context(LogWriter(log))
        server = stack.enter_context(
            SimServer(
                served,
                addresses.endpoints(),
                addresses.interface,
                pictures.cameras,
                pictures.speed_factor,
                pictures.seed,
                epoch=time.time(),
                log=writer,
                referee=rules,
                clock=pictures.clock.value,
            )
        )
        watched = None
        if live:
            from robobt.league.serve.watched import WatchedField

            shown = stack.enter_context(page.server())
            name = scenario or "robobt serve"
            watched = WatchedField(shown, name, server.referee, server.delays)
        if not as_json:
            _announce(server)
        # A signal is how one stops serving.
        with suppress(KeyboardInterrupt, Terminated):
            if in_step:
                from robobt.league.serve.synchronous import StepServer

                stack.enter_context(StepServer(server, addresses.interface)).run(seconds)
            else:
                server.run(seconds, watched, on_slow=_TellOnce())
    packets = {name: asdict(counts) for name, counts in server.counts.items()}
    figures = {
        "frames": server.frames,
        "simulated_s": served.time,
        "speed_kept": server.kept,
        "packets": packets,
        "robots": trip_figures(server),
    }
    if as_json:
        print_json(figures)
        return
    say(
        f"Served {counted(server.frames, 'frame')}, {served.time:.1f} s, "
        f"at {server.kept:.1%} of the speed asked for."
    )
    for name, counts in server.counts.items():
        if counts.dropped:
            say(
                f"{name}: "
                + ", ".join(f"{number} {what}" for what, number in packets[name].items() if number)
            )
    print_trips(server)


def _address(option: str, text: str) -> Endpoint:
    from robobt.league.wire.endpoints import parse_endpoint

    try:
        return parse_endpoint(text)
    except ValueError as error:
        raise typer.BadParameter(str(error), param_hint=option) from error


class _TellOnce:
    """Warns at the first slow stretch; the last line sums up."""

    told = False

    def __call__(self, kept: float) -> None:
        if not self.told:
            warn(
                f"this machine is too busy: the field ran at {kept:.0%} of the speed asked for; "
                "timestamps stay those of the simulated time"
            )
            self.told = True


def _announce(server: SimServer) -> None:
    to, robots = server.endpoints, server.field.truth().robots()
    say(
        f"Serving {counted(len(robots), 'robot')}: vision to {to.vision}, tracked frames to {to.tracker}, "
        f"commands at {to.grsim} (grSim), {to.blue} and {to.yellow} (control), {to.control} (teleport). "
        "Press Ctrl-C to stop."
    )


def log_packets(
    out: Annotated[Path, typer.Argument(help="The log to write (*.log, *.log.gz).")],
    seconds: Annotated[float | None, option("--seconds", "; by default on Ctrl-C", min=0.1)] = None,
    interface: Annotated[str | None, option("--interface", "; by default none")] = None,
    vision: Annotated[str, option("--vision", "; the port is 10006 on a real field")] = VISION,
    tracker: Annotated[str, option("--tracker")] = TRACKER,
    referee: Annotated[str, option("--referee-address")] = REFEREE,
    as_json: Json = False,
) -> None:
    """Log what vision, trackers and game controller send, in the league's format.

    'robobt show' turns a log into a page; 'robobt match --world LOG' lets a scenario's robots watch it.

    Keys of --json: vision, tracker, referee: packets written.
    """
    from robobt.league.log.files import log_field
    from robobt.league.log.names import is_log
    from robobt.league.wire.endpoints import Endpoints

    if not is_log(out):
        raise typer.BadParameter(f"'{out}' must end in .log or .log.gz", param_hint="OUT")
    endpoints = Endpoints(
        vision=_address("--vision", vision),
        tracker=_address("--tracker", tracker),
        referee=_address("--referee-address", referee),
    )
    make_folders({"OUT": out})
    written = {
        kind.name.lower(): count for kind, count in log_field(out, endpoints, interface, seconds).items()
    }
    if as_json:
        print_json(written)
        return
    say(f"{out}: " + ", ".join(f"{count} {kind}" for kind, count in written.items()) + " packets.")
