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
from robobt.cli.match_summary import TREES_FAILED, print_summary, tell_failures
from robobt.cli.options import option
from robobt.cli.outputs import PAGE, PAGES, RECORDING, make_folders
from robobt.cli.page import Page
from robobt.cli.refereeing import Refereeing
from robobt.cli.scenario_options import TeamChanges

if TYPE_CHECKING:
    from collections.abc import Callable

    from robobt.match import Scenario
    from robobt.match.refereeing import RefereeFactory
    from robobt.match.results.results import MatchResult

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
    record_layers: Layers = ""
    out: Annotated[
        Path | None,
        option(
            "--out",
            ": a line of JSON for each trial as it ends. The same command continues a run that was stopped",
            metavar="FILE",
        ),
    ] = None

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


def match(
    scenario: Annotated[
        str,
        typer.Argument(
            help="A scenario file, or the name of a bundled one (see 'robobt list scenarios').",
            autocompletion=complete_scenario,
        ),
    ],
    *,
    run: Trials,
    kept: KeptTrials,
    trees: Trees,
    changes: TeamChanges,
    where: MatchVenue,
    refereeing: Refereeing,
    page: Page,
    as_json: Json = False,
) -> None:
    """Play a scenario, once or many times, and print the results.

    Ctrl-C stops the run; the trials that are finished are kept and printed. With --live the browser shows
    the match with every tree, and can pause, step, slow down, go back up to five minutes, steer robots and
    save what was seen.

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
    is equal for equal runs; recording: the file written, or null.

    Exit code 3 when a robot's tree failed in some tick, though all trials were played.
    """
    from robobt.worlds import scenario_settings

    where.check()
    page.check(where.live)
    loaded, referees = refereeing.of(_changed(changes.scenario(scenario), trees))
    # The simulator's settings are checked before any worker is started.
    scenario_settings(loaded)
    if where.live and run.trials is None:
        if as_json or kept.out is not None:
            option = "--json" if as_json else "--out"
            raise typer.BadParameter("needs --trials, for without it --live plays on", param_hint=option)
        run.processes(1, alone=True)
        _play_on(loaded, run, kept, where, referees, page)
        return
    _play_trials(loaded, run, kept, where, referees, page, as_json=as_json)


def _play_on(
    loaded: Scenario, run: Trials, kept: KeptTrials, where: MatchVenue, referees: RefereeFactory, page: Page
) -> None:
    """Play match after match in the browser, until Ctrl-C."""
    from robobt.match import MatchLoop
    from robobt.match.runner import trial_seed

    if kept.record_trial is not None:
        raise typer.BadParameter(
            "needs --trials; --live records its first match", param_hint="--record-trial"
        )
    if kept.record is not None and not kept.record.name.lower().endswith(RECORDING):
        there = f"takes a name that ends in {RECORDING} here, not '{kept.record}'"
        raise typer.BadParameter(there, param_hint="--record")
    make_folders({"--record": kept.record})
    start = loaded.seed if run.seed is None else run.seed
    records = [kept.record]

    def make(trial: int) -> MatchLoop:
        recorded = records.pop() if records else None
        layers = layer_names(kept.record_layers)
        return MatchLoop(loaded, trial_seed(start, trial), factory, recorded, trial, referees, layers)

    with page.server() as server, world_of(where.world, where.publish) as factory:
        from robobt.live.session import Live

        Live(server, where.speed_factor, where.paused).play_on(make)


def _play_trials(
    loaded: Scenario,
    run: Trials,
    kept: KeptTrials,
    where: MatchVenue,
    referees: RefereeFactory,
    page: Page,
    *,
    as_json: bool,
) -> None:
    """Play a number of trials and print what they came to."""
    from robobt.match import MatchLoop, run_trials_in
    from robobt.match.runner import Recorded

    count = run.count(loaded)
    processes = run.processes(count, where.alone)
    file, layers = kept.recording(loaded.name, count), layer_names(kept.record_layers)
    make_folders({"--record": file, "--out": kept.out})
    with tempfile.TemporaryDirectory() as folder:
        as_page = file is not None and file.name.lower().endswith(PAGES)
        recording = Path(folder) / f"trial{RECORDING}" if as_page else file
        with ExitStack() as stack:
            play: Callable[[MatchLoop], MatchResult] = MatchLoop.play
            if where.live:
                from robobt.live.session import Live

                server = stack.enter_context(page.server())
                play = Live(server, where.speed_factor, where.paused).conduct
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
        written = file if any(result.trial == kept.trial for result in played.results) else None
        if as_page and written is not None:
            from robobt.live.replay_html import write_html

            write_html(recording, written)  # type: ignore[arg-type]
    summary = played.summary()
    if as_json:
        extra = {
            "requested": count,
            "interrupted": played.interrupted,
            "recording": None if written is None else str(written),
        }
        print_json({**summary.to_json(), **extra})
    else:
        print_summary(summary, played, count)
        if written is not None:
            say(f"Recording of trial {kept.trial}: {written}")
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


def _check_recording(path: Path, out: Path | None) -> None:
    """Refuse a name that is more likely another file's: what is there is replaced."""
    ends = (*PAGES, RECORDING)
    if not path.name.lower().endswith(ends):
        there = f"takes a name that ends in {', '.join(ends)}, not '{path}'"
        trial = "; which trial is recorded is --record-trial" if path.name.isdecimal() else ""
        raise typer.BadParameter(f"{there}{trial}", param_hint="--record")
    if out is not None and path.resolve() == out.resolve():
        raise typer.BadParameter("the recording and the results need a file each", param_hint="--record")
