"""Recordings and league logs that commands are given, and the robots in them."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from robobt.cli.outputs import RECORDING
from robobt.league.log.names import is_log

if TYPE_CHECKING:
    from robobt.match.recording import Recording
    from robobt.world import RobotId


@contextmanager
def recording_file(file: Path) -> Iterator[Path]:
    """Give the file itself, or a recording of what a league log holds."""
    if not is_log(file):
        yield file
        return
    from robobt.league.log.world import record_log

    with tempfile.TemporaryDirectory() as folder:
        yield record_log(file, Path(folder) / f"{file.name}{RECORDING}")


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
