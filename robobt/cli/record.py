"""``robobt record``: export recordings to other tools, and save ticks as regression cases."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import Imports, Json, console, import_files, print_json, say
from robobt.cli.outputs import RECORDING, make_folders
from robobt.cli.team_figures import team_figures

if TYPE_CHECKING:
    from robobt.match.recording import Recording
    from robobt.world import RobotId

_File = Annotated[Path, typer.Argument(help=f"A recording (*{RECORDING}).")]
_Robot = Annotated[
    str | None,
    typer.Option("--robot", help="Whose tree, as 'blue 0'; may be left out where only one was recorded."),
]


def export(
    recording: _File,
    btlog: Annotated[
        bool, typer.Option("--btlog", help="As the .btlog file of BehaviorTree.CPP's FileLogger2.")
    ] = False,
    mcap: Annotated[
        bool, typer.Option("--mcap", help="As an MCAP file of the whole match, for Foxglove and Rerun.")
    ] = False,
    robot: _Robot = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="The file to write; by default beside the recording."),
    ] = None,
) -> None:
    """Write a recording in a form that other tools read."""
    from robobt.match.recording import load_recording
    from robobt.match.recording.btlog import write_btlog

    if btlog == mcap:
        raise typer.BadParameter("name one format to write: --btlog or --mcap")
    loaded = load_recording(recording)
    if mcap:
        from robobt.match.recording.mcap import write_mcap

        target = recording.with_name(f"{recording.name.removesuffix(RECORDING)}.mcap") if out is None else out
        _spare(recording, target)
        make_folders({"--out": target})
        say(f"MCAP file: {write_mcap(loaded, target)}")
        return
    who = recorded_robot(loaded, robot)
    stem = recording.name.removesuffix(RECORDING)
    target = recording.with_name(f"{stem}-{who.team.value}-{who.number}.btlog") if out is None else out
    _spare(recording, target)
    make_folders({"--out": target})
    say(f"Log: {write_btlog(loaded, who, target)}")


def case(
    recording: _File,
    tick: Annotated[int, typer.Option("--tick", min=0, help="Which tick, from 0.")],
    out: Annotated[Path, typer.Option("--out", help="The regression case to write, a YAML file.")],
    robot: _Robot = None,
    imports: Imports = None,
) -> None:
    """Save a tick as a regression case: what a robot's tree did then, for a test to check."""
    from robobt.match.recording import load_recording
    from robobt.match.regression_cases import save_regression_case

    import_files(imports)
    loaded = load_recording(recording)
    who = recorded_robot(loaded, robot)
    _spare(recording, out)
    make_folders({"--out": out})
    say(f"Regression case: {save_regression_case(loaded, who, tick, out)}")


def statistics(
    recording: Annotated[
        Path, typer.Argument(help=f"A recording (*{RECORDING}), or a league log (*.log, *.log.gz).")
    ],
    as_json: Json = False,
) -> None:
    """Count what each team did in a match: goals, shots, passes, possession, restarts, fouls.

    Keys of --json: by team ("blue", "yellow") goals, passes, passes_completed,
    passes_intercepted, shots_on_goal, expected_goals, possession (share), distance (metres), fouls,
    yellow_cards, red_cards, placements, placements_succeeded, restarts, restarts_kept.
    """
    from dataclasses import asdict

    from robobt.match.recording import load_recording
    from robobt.match.recording.statistics import recorded_statistics

    if recording.name.lower().endswith((".log", ".log.gz")):
        from robobt.league.log.world import record_log

        with tempfile.TemporaryDirectory() as folder:
            loaded = load_recording(record_log(recording, Path(folder) / f"log{RECORDING}"))
    else:
        loaded = load_recording(recording)
    teams = {name: asdict(team) for name, team in recorded_statistics(loaded).items()}
    if not teams:
        raise typer.BadParameter("holds no referee, so there is no match to count", param_hint="RECORDING")
    if as_json:
        print_json(teams)
    else:
        console.print(team_figures(teams))


def recorded_robot(recording: Recording, text: str | None) -> RobotId:
    """Return the robot of that name, or the only one."""
    recorded = {str(robot.id): robot.id for robot in recording.header.robots if robot.tree}
    if text is None and len(recorded) == 1:
        return next(iter(recorded.values()))
    there = ", ".join(recorded) or "none"
    if text is None:
        raise typer.BadParameter(f"name a robot; trees were recorded of {there}", param_hint="--robot")
    name = " ".join(text.split())
    if name not in recorded:
        raise typer.BadParameter(f"no tree was recorded of {text!r}; there are {there}", param_hint="--robot")
    return recorded[name]


def _spare(recording: Path, target: Path) -> None:
    if target.exists() and target.samefile(recording):
        raise typer.BadParameter("is the recording itself; give another name", param_hint="--out")
