"""``robobt record``: export recordings, save ticks as regression cases, count, record demonstrations."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import (
    MAX_SEED,
    Imports,
    Json,
    Progress,
    console,
    import_files,
    parse_assignments,
    print_json,
    say,
)
from robobt.cli.options import option
from robobt.cli.outputs import RECORDING, check_ending, make_folders
from robobt.cli.recordings import recorded_robot, recording_file
from robobt.cli.team_figures import team_figures
from robobt.cli.train import Task
from robobt.config.wording import counted

_File = Annotated[Path, typer.Argument(help=f"A recording (*{RECORDING}).")]
_Robot = Annotated[str | None, option("--robot", "; may be left out where only one was recorded")]
_BTLOG, _MCAP, _PARQUET = ".btlog", ".mcap", ".parquet"


def export(
    recording: _File,
    out: Annotated[
        Path,
        option(
            "--out",
            f" it: as an MCAP file of the whole match for Foxglove and Rerun ({_MCAP}), as a table of where "
            f"ball and robots were ({_PARQUET}), or a robot's tree as "
            f"BehaviorTree.CPP's FileLogger2 logs it ({_BTLOG})",
            metavar="FILE",
        ),
    ],
    robot: _Robot = None,
) -> None:
    """Write a recording in a form that other tools read."""
    from robobt.match.recording import load_recording

    check_ending("--out", out, _MCAP, _PARQUET, _BTLOG)
    mcap = out.name.lower().endswith(_MCAP)
    parquet = out.name.lower().endswith(_PARQUET)
    if robot is not None and (mcap or parquet):
        raise typer.BadParameter("is for .btlog: other files hold all robots", param_hint="--robot")
    loaded = load_recording(recording)
    _spare(recording, out)
    make_folders({"--out": out})
    if mcap:
        from robobt.match.recording.mcap import write_mcap

        say(f"MCAP file: {write_mcap(loaded, out)}")
        return
    if parquet:
        from robobt.match.recording.parquet import write_parquet

        say(f"Table: {write_parquet(loaded, out)}")
        return
    from robobt.match.recording.btlog import write_btlog

    say(f"Log: {write_btlog(loaded, recorded_robot(loaded, robot), out)}")


def case(
    recording: _File,
    tick: Annotated[int, option("--tick", min=0)],
    out: Annotated[Path, option("--out", " the regression case (.yaml)", metavar="FILE")],
    robot: _Robot = None,
    imports: Imports = None,
) -> None:
    """Save a tick as a regression case: what a robot's tree did then, for a test to check."""
    from robobt.match.recording import load_recording
    from robobt.match.regression_cases import save_regression_case

    check_ending("--out", out, ".yaml", ".yml")
    _spare_others(out)
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

    with recording_file(recording) as file:
        loaded = load_recording(file)
    teams = {name: asdict(team) for name, team in recorded_statistics(loaded).items()}
    if not teams:
        raise typer.BadParameter("holds no referee, so there is no match to count", param_hint="RECORDING")
    if as_json:
        print_json(teams)
    else:
        console.print(team_figures(teams))


def demonstrations(
    task: Task,
    out: Annotated[Path, option("--out", " the episodes (.parquet)", metavar="FILE")],
    episodes: Annotated[int, option("--episodes", min=1, max=100_000)] = 200,
    by: Annotated[str, option("--by")] = "skill",
    seed: Annotated[int, option("--seed", min=0, max=MAX_SEED)] = 0,
    changes: Annotated[
        list[str] | None, option("--set", " of the environment, as in simulator=robobulls")
    ] = None,
    as_json: Json = False,
) -> None:
    """Record a hand-written skill doing a task, for learning to begin with.

    Keys of --json: task, file, episodes, steps, success (share), mean_time (seconds).
    """
    from robobt.learning.training.demonstrations import record
    from robobt.learning.training.settings import load_settings
    from robobt.learning.training.teachers import TEACHERS

    if by not in TEACHERS:
        raise typer.BadParameter(f"must be {' or '.join(TEACHERS)}, not {by!r}", param_hint="--by")
    check_ending("--out", out, ".parquet")
    given = {
        f"environment.{name}": value for name, value in parse_assignments(changes or [], "--set").items()
    }
    environment = load_settings(task, "fast", given).environment
    make_folders({"--out": out})
    with Progress(f"recording {task}", episodes) as progress:
        recorded = record(environment, episodes, by, seed, lambda _: progress.advance())
    recorded.write(out)
    figures = {
        "task": task,
        "file": str(out),
        "episodes": recorded.episodes,
        "steps": len(recorded),
        "success": float(recorded.success.sum()) / recorded.episodes,
        "mean_time": len(recorded) / recorded.episodes * environment.period,
    }
    if as_json:
        print_json(figures)
        return
    say(
        f"{counted(recorded.episodes, 'episode')}, {counted(len(recorded), 'step')}, "
        f"{figures['success']:.1%} successes, "
        f"{figures['mean_time']:.2f} s each, in {out}."
    )


def _spare_others(target: Path) -> None:
    """Refuse to replace what is no regression case: scenarios and trees end in .yaml too."""
    from robobt.config.yaml import read_yaml

    if target.is_file() and read_yaml(target).get("format") != "robobt-regression-case":
        raise typer.BadParameter(f"'{target}' is no regression case, and would be lost", param_hint="--out")


def _spare(recording: Path, target: Path) -> None:
    if target.exists() and target.samefile(recording):
        raise typer.BadParameter("is the recording itself; give another name", param_hint="--out")
