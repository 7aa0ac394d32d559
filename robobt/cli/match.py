"""``robobt match``: play a scenario and print the results."""

from __future__ import annotations

import re
import tempfile
from contextlib import ExitStack
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import (
    Json,
    Progress,
    Seed,
    Where,
    blaming,
    complete_scenario,
    cores,
    errors,
    parse_assignments,
    print_json,
    say,
    world_of,
)
from robobt.cli.layers import Layers, layer_names
from robobt.cli.live import Page
from robobt.cli.match_summary import TREES_FAILED, print_summary, tell_failures
from robobt.cli.outputs import PAGES, RECORDING, make_folders
from robobt.cli.refereeing import Refereeing
from robobt.cli.scenario_options import TeamChanges

if TYPE_CHECKING:
    from collections.abc import Callable

    from robobt.match import Scenario
    from robobt.match.results.results import MatchResult


class OnError(StrEnum):
    """What an exception in a tree does."""

    STOP = "stop"
    RAISE = "raise"


@dataclass(frozen=True)
class Trials:
    """How often a scenario is played, and in how many processes."""

    trials: Annotated[
        int | None,
        typer.Option("--trials", "-n", min=1, max=100_000, help="Trials to play; by default the scenario's."),
    ] = None
    workers: Annotated[
        int | None,
        typer.Option(
            "--workers", "-w", min=1, max=256, help="Processes; by default one a core, for 4 trials each."
        ),
    ] = None
    seed: Seed = None

    def count(self, scenario: Scenario) -> int:
        """Return how many trials are played."""
        return scenario.trials if self.trials is None else self.trials

    def processes(self, count: int, alone: bool) -> int:
        """Return how many processes play so many trials; ``alone`` where one has to.

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
class Kept:
    """What is kept of the trials: a recording of one, and all results."""

    replay: Annotated[
        Path | None,
        typer.Option(
            "--replay",
            help="Record a trial to this file: a page for the browser (.html) or a recording for "
            f"'robobt replay' ({RECORDING}).",
        ),
    ] = None
    record: Annotated[
        int | None,
        typer.Option(
            "--record",
            min=0,
            help=f"Which trial to record, from 0; without --replay to SCENARIO-N{RECORDING}.",
        ),
    ] = None
    record_layers: Layers = ""
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            help="Append each trial's result to this file (JSON lines) as it finishes; "
            "a run that was stopped goes on from there.",
        ),
    ] = None

    @property
    def trial(self) -> int:
        """Which trial is recorded, if one is."""
        return 0 if self.record is None else self.record

    def recording(self, name: str, count: int) -> Path | None:
        """Return the file to write, of a scenario of that name with so many trials; None to record nothing.

        Raises:
            typer.BadParameter: there is no such trial, or the file is more likely another's.
        """
        if self.trial >= count:
            there = f"there is no trial {self.trial}; they are 0 to {count - 1}"
            raise typer.BadParameter(there, param_hint="--record")
        replay = self.replay
        if replay is None and self.record is not None:
            # A scenario's name is free text: it must not lead to another folder.
            safe = re.sub(r"[^\w.-]+", "_", name)
            replay = Path(f"{safe}-{self.record}{RECORDING}")
        if replay is not None:
            _check_replay(replay, self.out)
        return replay


@dataclass(frozen=True)
class Trees:
    """What happens in the robots' trees besides what the scenario says."""

    on_error: Annotated[
        OnError | None,
        typer.Option(
            "--on-error",
            help="On an exception in a tree: stop that robot for the tick, or raise and end the run "
            "with the node's path; by default as in the scenario.",
        ),
    ] = None
    substitute: Annotated[
        list[str] | None,
        typer.Option(
            "--substitute",
            metavar="ROBOT:PATH=STATUS",
            help="Let nodes follow a script, as in 'yellow 0:*/BlockShot=FAILURE' or "
            "'blue:*/KickToTarget=[RUNNING, SUCCESS]'; may be given often.",
        ),
    ] = None


@dataclass(frozen=True)
class Played:
    """Where a match is played, and who else is told of it."""

    world: Where = "sim"
    publish: Annotated[
        bool,
        typer.Option(
            "--publish",
            help="Play in real time and send vision, tracked frames and the referee's messages to the "
            "league's programs on this machine (one worker).",
        ),
    ] = False


def match(
    scenario: Annotated[
        str,
        typer.Argument(
            help="A scenario file, or the name of a bundled one (see 'robobt scenarios').",
            autocompletion=complete_scenario,
        ),
    ],
    *,
    run: Trials,
    kept: Kept,
    trees: Trees,
    changes: TeamChanges,
    where: Played,
    refereeing: Refereeing,
    live: Annotated[
        bool,
        typer.Option("--live", help="Play in real time and show it in the browser (one worker)."),
    ] = False,
    page: Page,
    as_json: Json = False,
) -> None:
    """Play a scenario, once or many times, and print the results.

    Ctrl-C stops the run; the trials that are finished are kept and printed.

    Keys of --json: scenario, seed, trials (played), distinct (that differ), requested, interrupted;
    outcomes: for each outcome count, rate, low and high (95 % Wilson interval, null for one trial repeated);
    goals: for blue and yellow total, and trials: in how many it scored (count, rate, low, high);
    time: seconds a trial; in_play: share of the time with the ball in play;
    robots: for each robot go_to_ball, shoot and total (seconds) and kicks, each
    with n, mean and variance, errors (ticks its tree failed) and first_error, and always_failed (the node
    and the reason where its tree failed in every tick);
    teams: with a referee, for blue and yellow the figures of 'robobt record statistics', each with n, mean
    and variance;
    real_time_factor: simulated time over wall time, in each process; trace: a hash that
    is equal for equal runs; replay: the file written, or null.

    Exit code 3 when a robot's tree failed in some tick, though all trials were played.
    """
    from robobt.match import MatchLoop, run_trials_in
    from robobt.match.runner import Recorded
    from robobt.worlds import SIM, scenario_settings

    loaded, referees = refereeing.of(_changed(changes.scenario(scenario), trees))
    # The simulator's settings are checked before any worker is started.
    scenario_settings(loaded)
    count = run.count(loaded)
    processes = run.processes(count, where.world != SIM or where.publish or live)
    replay, layers = kept.recording(loaded.name, count), layer_names(kept.record_layers)
    make_folders({"--replay": replay, "--out": kept.out})
    with tempfile.TemporaryDirectory() as folder:
        as_page = replay is not None and replay.name.lower().endswith(PAGES)
        recording = Path(folder) / f"trial{RECORDING}" if as_page else replay
        with ExitStack() as stack:
            play: Callable[[MatchLoop], MatchResult] = MatchLoop.play
            if live:
                from robobt.live.session import Live

                play = Live(stack.enter_context(page.server())).conduct
            progress = stack.enter_context(Progress(loaded.name, count))
            played = run_trials_in(
                loaded,
                stack.enter_context(world_of(where.world, where.publish)),
                count,
                processes,
                run.seed,
                kept.out,
                {} if recording is None else {kept.trial: Recorded(recording, layers)},
                lambda _: progress.advance(),
                referees,
                play,
            )
        if not played.results:
            errors.print("robobt: stopped before the first trial was finished")
            raise typer.Exit(130)
        written = replay if any(result.trial == kept.trial for result in played.results) else None
        if as_page and written is not None:
            from robobt.live.replay_html import write_html

            write_html(recording, written)  # type: ignore[arg-type]
    summary = played.summary()
    if as_json:
        extra = {
            "requested": count,
            "interrupted": played.interrupted,
            "replay": None if written is None else str(written),
        }
        print_json({**summary.to_json(), **extra})
    else:
        print_summary(summary, played, count)
        if written is not None:
            say(f"Replay of trial {kept.trial}: {written}")
    failed = tell_failures(summary, loaded.on_error)
    if played.interrupted:
        raise typer.Exit(130)
    if failed:
        raise typer.Exit(TREES_FAILED)


def _changed(scenario: Scenario, trees: Trees) -> Scenario:
    """Return the scenario with what the command line says of trees."""
    from robobt.match.scenario.substitution import substituted

    rules = []
    for text in trees.substitute or []:
        robot, colon, rule = text.partition(":")
        path, equals, status = rule.rpartition("=")
        if not colon or not equals or not path:
            raise typer.BadParameter(f"takes ROBOT:PATH=STATUS, not {text!r}", param_hint="--substitute")
        ((_, script),) = parse_assignments([f"{path}={status}"], "--substitute").items()
        rules.append((" ".join(robot.split()), path, script))
    if rules:
        with blaming("--substitute"):
            scenario = substituted(scenario, rules)
    if trees.on_error is not None:
        scenario = scenario.model_copy(update={"on_error": trees.on_error.value})
    return scenario


def _check_replay(path: Path, out: Path | None) -> None:
    """Refuse a name that is more likely another file's: what is there is replaced."""
    ends = (*PAGES, RECORDING)
    if not path.name.lower().endswith(ends):
        there = f"takes a name that ends in {', '.join(ends)}, not '{path}'"
        raise typer.BadParameter(there, param_hint="--replay")
    if out is not None and path.resolve() == out.resolve():
        raise typer.BadParameter("the replay and the results need a file each", param_hint="--replay")
