"""``robobt record identify``: what a field and its robots are like, from a recording or a log."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import Json, console, print_json, say, table
from robobt.cli.options import option
from robobt.cli.outputs import RECORDING, check_ending, make_folders

if TYPE_CHECKING:
    from robobt.identify.estimate import Estimate
    from robobt.identify.report import Identification

_ROBOT_COLUMNS = {
    "max_speed": "top speed",
    "acceleration": "accelerates",
    "braking": "brakes",
    "side_acceleration": "aside",
    "side_braking": "brakes aside",
    "gain": "gain",
    "side_gain": "gain aside",
    "delay": "delay, ms",
}


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
    unit.
    """
    from robobt.config.errors import unknown_name
    from robobt.identify.preset_file import write_preset
    from robobt.identify.report import as_json as figures_of
    from robobt.identify.report import identify as identified_from
    from robobt.identify.sources import load_observations
    from robobt.sim.settings import PRESETS

    if base not in PRESETS:
        there = f"no simulator preset is called {base!r}; {unknown_name(base, PRESETS)}"
        raise typer.BadParameter(there, param_hint="--base")
    if out is not None:
        check_ending("--out", out, ".yaml", ".yml")
        make_folders({"--out": out})
    found = identified_from(load_observations(file))
    if out is not None:
        write_preset(found, out, base)
    if as_json:
        print_json(figures_of(found))
        return
    _show(found)
    if out is not None:
        say(f"Preset file: {out}; play in it with --set simulator.preset={out}")


def _show(found: Identification) -> None:
    """Print the field's figures, a row each, and the robots', a row a robot."""
    listed = table(f"from {found.seconds:.0f} s of play", "value", "95 % interval", "events")
    for name, figure in found.figures():
        # Robots have spaces in their names, and a table of their own.
        if " " in name:
            continue
        if figure.seen:
            value = f"{figure.value:.4g} {figure.unit}".rstrip()
            listed.add_row(name, value, f"{figure.low:.4g} to {figure.high:.4g}", str(figure.count))
        else:
            listed.add_row(name, "not seen enough", "", str(figure.count))
    console.print(listed)
    robots = table("m/s, m/s²", *_ROBOT_COLUMNS.values())
    for robot in found.robots:
        figures = [_short(robot.figures[name], name == "delay") for name in _ROBOT_COLUMNS]
        robots.add_row(str(robot.robot), *figures)
    console.print(robots)


def _short(figure: Estimate, milliseconds: bool) -> str:
    if not figure.seen:
        return "-"
    factor = 1000.0 if milliseconds else 1.0
    return f"{figure.value * factor:.3g} ±{figure.half_width * factor:.2g}"
