"""``robobt record identify``: what a field and its robots are like, from a recording or a log."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import Json, Progress, console, print_json, say, table
from robobt.cli.options import option
from robobt.cli.outputs import RECORDING, check_ending, make_folders

if TYPE_CHECKING:
    from robobt.identify.report import Identification
    from robobt.identify.robots import RobotEstimate
    from robobt.world.game import Team

_ROBOTS_BESIDE = 6
"""Number of robots beside each other in a table, which then fits a screen of 80 columns."""


def identify(
    file: Annotated[
        Path, typer.Argument(help=f"A recording (*{RECORDING}), or a league log (*.log, *.log.gz).")
    ],
    out: Annotated[
        Path | None,
        option("--out", " a preset file (.yaml) for --set simulator.preset=FILE", metavar="FILE"),
    ] = None,
    base: Annotated[
        str, option("--base", "; what was not seen enough is this preset's", metavar="PRESET")
    ] = "default",
    as_json: Json = False,
) -> None:
    """Identify ball, robots, kicks, delay and noise from a minute of play.

    Delay, gains and kicks need commands, which a recording holds and a log does not. Each figure comes with
    its 95 % interval, or the words "not seen enough".

    Keys of --json: seconds (of play); figures: by name value, low, high, count (events it rests on), seen,
    unit; taken: what was not identified and is the preset's (--base), where that of default differs.
    """
    from robobt.config.errors import unknown_name
    from robobt.identify.preset_file import taken_from, write_preset
    from robobt.identify.report import as_json as figures_of
    from robobt.identify.report import identify as identified_from
    from robobt.identify.report import parts_of
    from robobt.identify.sources import NothingToIdentifyError, load_observations
    from robobt.sim.settings import PRESETS

    if base not in PRESETS:
        there = f"no simulator preset is called {base!r}; {unknown_name(base, PRESETS)}"
        raise typer.BadParameter(there, param_hint="--base")
    if out is not None:
        check_ending("--out", out, ".yaml", ".yml")
        make_folders({"--out": out})
    seen = load_observations(file)
    try:
        with Progress("identify", parts_of(seen)) as progress:
            found = identified_from(seen, progress.advance)
    except ValueError as error:
        raise NothingToIdentifyError(f"{file}: {error}") from error
    taken = taken_from(found, base)
    if out is not None:
        write_preset(found, out, base)
    if as_json:
        print_json({**figures_of(found), "taken": taken})
        return
    _show(found)
    if taken:
        names = ", ".join(f"{name} {value}" for name, value in taken.items())
        say(f"Not identified, from the preset {base} (default has other values): {names}")
    if out is not None:
        say(f"Preset file: {out}; play in it with --set simulator.preset={out}")


def _show(found: Identification) -> None:
    """Print the field's figures, a row each, and the robots', a row a figure."""
    from robobt.world.game import Team

    listed = table(f"from {found.seconds:.0f} s of play", "value", "95 % interval", "events")
    for name, figure in found.figures():
        # Robots have spaces in their names, and tables of their own.
        if " " in name:
            continue
        if figure.seen:
            value = f"{figure.value:.4g} {figure.unit}".rstrip()
            listed.add_row(name, value, f"{figure.low:.4g} to {figure.high:.4g}", str(figure.count))
        else:
            listed.add_row(name, "not seen enough", "", str(figure.count))
    console.print(listed)
    for team in Team:
        robots = [robot for robot in found.robots if robot.robot.team is team]
        for first in range(0, len(robots), _ROBOTS_BESIDE):
            _show_robots(team, robots[first : first + _ROBOTS_BESIDE])
    say("-: not seen enough. The preset file and --json have the robots' intervals.")


def _show_robots(team: Team, robots: Sequence[RobotEstimate]) -> None:
    from robobt.identify.robots import UNITS

    listed = table(team.value, *[str(robot.robot.number) for robot in robots])
    for name, unit in UNITS.items():
        figures = [robot.figures[name] for robot in robots]
        # What is less than a tenth of a thousandth is 0, and so is -0.
        values = [f"{round(it.value, 4) + 0.0:.3g}" if it.seen else "-" for it in figures]
        listed.add_row(f"{name}, {unit}" if unit else name, *values)
    console.print(listed)
