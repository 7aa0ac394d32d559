"""``robobt record identify``: what a field and its robots are like, from a recording, a log or live."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from robobt.cli.common import Json, Progress, console, print_json, say, table, warn
from robobt.cli.options import option
from robobt.cli.outputs import RECORDING, check_ending, make_folders
from robobt.config.extras import need

if TYPE_CHECKING:
    from robobt.identify.report import Identification
    from robobt.identify.robots import RobotEstimate
    from robobt.world.game import Team

_ROBOTS_BESIDE = 6
"""Number of robots beside each other in a table, which then fits a screen of 80 columns."""


def identify(
    source: Annotated[
        str,
        typer.Argument(
            help=f"A recording (*{RECORDING}), a league log (*.log, *.log.gz), or a field to watch, such as "
            "league://observer."
        ),
    ],
    out: Annotated[
        Path | None,
        option("--out", " a preset file (.yaml) for --set simulator.preset=FILE", metavar="FILE"),
    ] = None,
    base: Annotated[
        str, option("--base", "; what was not seen enough is this preset's", metavar="PRESET")
    ] = "default",
    seconds: Annotated[
        float | None, option("--seconds", " of watching a field; by default after 60", min=1, max=3600)
    ] = None,
    as_json: Json = False,
) -> None:
    """Identify ball, robots, kicks, cameras, delay and noise from a minute of play.

    Delay, gains and kicks need commands, which a recording holds; neither a log nor a field that is watched
    shows them. Each figure comes with its 95 % interval, or the words "not seen enough".

    Keys of --json: seconds (of play); figures: by name value, low, high, count (events it rests on), seen,
    unit; taken: what was not identified and is the preset's (--base), where that of default differs.
    """
    need("tournament", "google.protobuf", "pyarrow", "scipy")
    from robobt.league.factory import SCHEME

    _check_base(base)
    if out is not None:
        check_ending("--out", out, ".yaml", ".yml")
        make_folders({"--out": out})
    if source.startswith(SCHEME):
        with TemporaryDirectory() as folder:
            log = Path(folder) / "watched.log"
            _watch(source, 60.0 if seconds is None else seconds, log)
            identified = identified_from(log, source, out, base)
    elif seconds is not None:
        raise typer.BadParameter("is for a field that is watched", param_hint="--seconds")
    else:
        identified = identified_from(Path(source), source, out, base)
    if as_json:
        from robobt.identify.report import as_json as figures_of

        print_json({**figures_of(identified.found), "taken": identified.taken})
        return
    show_identified(identified, out, base)


class Identified(NamedTuple):
    """What was identified, and what a preset file takes from its preset."""

    found: Identification
    taken: dict[str, object]


def identified_from(file: Path, name: str, out: Path | None, base: str = "default") -> Identified:
    """Identify what a file shows, and write a preset file.

    Args:
        file: a recording or a league log.
        name: of the file in messages.
        out: the preset file to write; None for none.
        base: the preset that has what was not seen enough.

    Returns:
        what was identified.

    Raises:
        NothingToIdentifyError: it holds too little.
    """
    from robobt.identify.preset_file import taken_from, write_preset
    from robobt.identify.report import identify as identify_all
    from robobt.identify.report import parts_of
    from robobt.identify.sources import NothingToIdentifyError, load_observations

    seen = load_observations(file)
    try:
        with Progress("identify", parts_of(seen)) as progress:
            found = identify_all(seen, progress.advance)
    except ValueError as error:
        raise NothingToIdentifyError(f"{name}: {error}") from error
    if out is not None:
        write_preset(found, out, base)
    return Identified(found, taken_from(found, base))


def show_identified(identified: Identified, out: Path | None, base: str = "default") -> None:
    """Print what was identified.

    Args:
        identified: that.
        out: the preset file that was written; None for none.
        base: the preset that has what was not seen enough.
    """
    _show(identified.found)
    if identified.taken:
        names = ", ".join(f"{name} {value}" for name, value in identified.taken.items())
        say(f"Not identified, from the preset {base} (default has other values): {names}")
    if out is not None:
        say(f"Preset file: {out}; play in it with --set simulator.preset={out}")


def _check_base(base: str) -> None:
    from robobt.config.errors import unknown_name
    from robobt.sim.settings import PRESETS

    if base not in PRESETS:
        there = f"no simulator preset is called {base!r}; {unknown_name(base, PRESETS)}"
        raise typer.BadParameter(there, param_hint="--base")


def _watch(address: str, seconds: float, log: Path) -> None:
    """Log what the cameras of a field send for some seconds."""
    from robobt.league.connection import LeagueError
    from robobt.league.factory import parse_address
    from robobt.league.log.files import LogKind, log_field

    connection, _ = parse_address(address)
    warn(f"watching {address} for {seconds:g} s")
    if not log_field(log, connection.endpoints, connection.interface, seconds)[LogKind.VISION]:
        vision = connection.endpoints.vision
        raise LeagueError(f"{address}: nothing came from the vision at {vision} within {seconds:g} s")


def _show(found: Identification) -> None:
    """Print the field's figures, a row each, and the robots', a row a figure."""
    from robobt.identify.estimate import short
    from robobt.world.game import Team

    listed = table(f"from {found.seconds:.0f} s of play", "value", "95 % interval", "events")
    for name, figure in found.figures():
        # Robots have spaces in their names, and tables of their own.
        if " " in name and not name.startswith("camera "):
            continue
        if figure.seen:
            value = f"{short(figure.value)} {figure.unit}".rstrip()
            listed.add_row(name, value, f"{short(figure.low)} to {short(figure.high)}", str(figure.count))
        else:
            listed.add_row(name, "not seen enough", "", str(figure.count))
    console.print(listed)
    for team in Team:
        robots = [robot for robot in found.robots if robot.robot.team is team]
        for first in range(0, len(robots), _ROBOTS_BESIDE):
            _show_robots(team, robots[first : first + _ROBOTS_BESIDE])
    say("-: not seen enough. The preset file and --json have the robots' intervals.")


def _show_robots(team: Team, robots: Sequence[RobotEstimate]) -> None:
    from robobt.identify.estimate import short
    from robobt.identify.robots import UNITS

    listed = table(team.value, *[str(robot.robot.number) for robot in robots])
    for name, unit in UNITS.items():
        figures = [robot.figures[name] for robot in robots]
        values = [short(round(it.value, 4), digits=3) if it.seen else "-" for it in figures]
        listed.add_row(f"{name}, {unit}" if unit else name, *values)
    console.print(listed)
