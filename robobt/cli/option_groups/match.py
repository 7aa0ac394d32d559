"""The options of ``robobt match``: how often, what is kept, what trees do, where it is played."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import Seed, Where, cores
from robobt.cli.options import option
from robobt.cli.outputs import PAGE, PAGES, RECORDING

if TYPE_CHECKING:
    from robobt.match import Scenario

BUILT_IN = "sim"
"""The built-in simulator, as a world's name; see :data:`robobt.worlds.SIM`."""


class OnError(StrEnum):
    """What an exception in a tree does."""

    STOP = "stop"
    RAISE = "raise"


@dataclass(frozen=True)
class Trials:
    """How often a scenario is played, and in how many processes."""

    trials: Annotated[
        int | None, option("--trials", "; by default the scenario's number", min=1, max=100_000)
    ] = None
    workers: Annotated[int | None, option("--workers", ", for at least 4 trials each", min=1, max=256)] = None
    seed: Seed = None

    def count(self, scenario: Scenario) -> int:
        """Return how many trials are played."""
        return scenario.trials if self.trials is None else self.trials

    def processes(self, count: int, alone: bool) -> int:
        """Return how many processes play that many trials; ``alone`` where one has to.

        Raises:
            typer.BadParameter: more are asked for than can play there.
        """
        if alone:
            if self.workers not in (None, 1):
                there = "must be 1 to play or publish over the network, or live"
                raise typer.BadParameter(there, param_hint="--workers")
            return 1
        return min(cores(), -(-count // 4)) if self.workers is None else self.workers


@dataclass(frozen=True)
class KeptTrials:
    """What is kept of the trials: a recording of one, and all results."""

    record: Annotated[
        Path | None,
        option(
            "--record", f": a page for the browser ({PAGE}), or a recording for 'robobt show' ({RECORDING})"
        ),
    ] = None
    record_trial: Annotated[
        int | None,
        option("--record-trial", f"; without --record the file is SCENARIO-N{RECORDING}", min=0),
    ] = None
    record_layers: Annotated[
        str, option("--record-layers", ": names separated by commas, as in 'paths, targets, observation'")
    ] = ""
    identify: Annotated[
        Path | None, option("--identify", " (.yaml), as 'robobt record identify' does; without --record too")
    ] = None
    out: Annotated[
        Path | None,
        option(
            "--out",
            ": a line of JSON for each trial as it ends. The same command continues a run that was stopped",
            metavar="FILE",
        ),
    ] = None

    @property
    def layers(self) -> frozenset[str]:
        """Layers of the skills' drawings that are recorded."""
        return frozenset({name.strip() for name in self.record_layers.split(",")} - {""})

    @property
    def trial(self) -> int:
        """Which trial is recorded, if one is."""
        return self.record_trial or 0

    def recording(self, name: str, count: int) -> Path | None:
        """Return the file to write for ``count`` trials of a scenario of that name; None to record nothing.

        Raises:
            typer.BadParameter: there is no such trial, or the file is more likely another's.
        """
        if self.trial >= count:
            there = f"there is no trial {self.trial}; they are 0 to {count - 1}"
            raise typer.BadParameter(there, param_hint="--record-trial")
        file = self.record
        if file is None and self.record_trial is not None:
            # A scenario's name is free text: it must not lead to another folder.
            safe = re.sub(r"[^\w.-]+", "_", name)
            file = Path(f"{safe}-{self.record_trial}{RECORDING}")
        if file is not None:
            _check_recording(file, self.out)
        elif self.record_layers:
            raise typer.BadParameter("needs --record", param_hint="--record-layers")
        return file


@dataclass(frozen=True)
class Trees:
    """What happens in the robots' trees besides what the scenario says."""

    on_error: Annotated[
        OnError | None,
        option(
            "--on-error",
            ": stop that robot for the tick, or raise and end the run with the node's path; by default as in "
            "the scenario",
        ),
    ] = None
    substitute: Annotated[
        list[str] | None,
        option(
            "--substitute",
            ", as in 'yellow 0:*/BlockShot=FAILURE' or 'blue:*/KickToTarget=[RUNNING, SUCCESS]'",
        ),
    ] = None


@dataclass(frozen=True)
class MatchVenue:
    """Where a match is played, and who sees it meanwhile."""

    world: Where = "sim"
    publish: Annotated[bool, option("--publish", ", and play in real time")] = False
    live: Annotated[
        bool,
        option("--live", " in real time, until Ctrl-C; with --trials only those, and print results"),
    ] = False
    speed_factor: Annotated[float, option("--speed-factor", " with --live", min=0.05, max=20.0)] = 1.0
    paused: Annotated[bool, option("--paused", ", with --live")] = False

    def check(self) -> None:
        """Refuse options that would do nothing."""
        if not self.live and (self.paused or self.speed_factor != 1.0):
            option = "--paused" if self.paused else "--speed-factor"
            raise typer.BadParameter("is for --live", param_hint=option)

    @property
    def alone(self) -> bool:
        """Whether one process plays, one trial after the other."""
        return self.world != BUILT_IN or self.publish or self.live


def _check_recording(path: Path, out: Path | None) -> None:
    """Refuse a name that is more likely another file's: what is there is replaced."""
    ends = (*PAGES, RECORDING)
    if not path.name.lower().endswith(ends):
        there = f"takes a name that ends in {', '.join(ends)}, not '{path}'"
        trial = "; which trial is recorded is --record-trial" if path.name.isdecimal() else ""
        raise typer.BadParameter(f"{there}{trial}", param_hint="--record")
    if out is not None and path.resolve() == out.resolve():
        raise typer.BadParameter("the recording and the results need a file each", param_hint="--record")
