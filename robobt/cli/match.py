"""``robobt match``: play a scenario and print the results."""

from __future__ import annotations

import tempfile
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import (
    Json,
    Progress,
    blaming,
    complete_scenario,
    errors,
    parse_assignments,
    print_json,
    say,
    world_of,
)
from robobt.cli.compile_ahead import compile_before_first_match
from robobt.cli.match_summary import TREES_FAILED, print_summary, tell_failures
from robobt.cli.option_groups.match import KeptTrials, MatchVenue, Trees, Trials
from robobt.cli.option_groups.page import Page
from robobt.cli.option_groups.refereeing import Refereeing
from robobt.cli.option_groups.scenario import TeamChanges
from robobt.cli.outputs import PAGES, RECORDING, check_ending, make_folders
from robobt.cli.shown.round_trips import print_delays
from robobt.config.extras import need

if TYPE_CHECKING:
    from collections.abc import Callable

    from robobt.cli.identify import Identified
    from robobt.config.errors import RobobtError
    from robobt.match import MatchLoop, Scenario
    from robobt.match.refereeing import RefereeFactory
    from robobt.match.results.results import MatchResult
    from robobt.match.runner import Run


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
    is equal for equal runs; recording: the file written, or null; delays: where they are measured, each
    robot's delay at the end of the last trial, from a command to its seen effect (seconds, low, high; null if
    not seen enough); identified: with --identify the preset file written, or null.

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
    if kept.identify is not None:
        raise typer.BadParameter("needs --trials", param_hint="--identify")
    if kept.record is not None and not kept.record.name.lower().endswith(RECORDING):
        there = f"takes a name that ends in {RECORDING} here, not '{kept.record}'"
        raise typer.BadParameter(there, param_hint="--record")
    make_folders({"--record": kept.record})
    compile_before_first_match()
    start = loaded.seed if run.seed is None else run.seed
    records = [kept.record]

    def make(trial: int) -> MatchLoop:
        recorded = records.pop() if records else None
        return MatchLoop(loaded, trial_seed(start, trial), factory, recorded, trial, referees, kept.layers)

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
    file = kept.recording(loaded.name, count)
    if kept.identify is not None:
        need("tournament", "google.protobuf", "pyarrow", "scipy")
        check_ending("--identify", kept.identify, ".yaml", ".yml")
    make_folders({"--record": file, "--out": kept.out, "--identify": kept.identify})
    compile_before_first_match()
    with tempfile.TemporaryDirectory() as folder:
        as_page = file is not None and file.name.lower().endswith(PAGES)
        aside = as_page or (file is None and kept.identify is not None)
        recording = Path(folder) / f"trial{RECORDING}" if aside else file
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
                {} if recording is None else {kept.trial: Recorded(recording, kept.layers)},
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
        _tell(loaded, played, kept, recording, count, written=written, as_json=as_json)


def _tell(
    loaded: Scenario,
    played: Run,
    kept: KeptTrials,
    recording: Path | None,
    count: int,
    *,
    written: Path | None,
    as_json: bool,
) -> None:
    """Print what trials came to, and what is identified from the one that was recorded."""
    identified, problem = _identified(kept, played, recording)
    summary, delays = played.summary(), played.results[-1].delays
    if as_json:
        extra = {
            "requested": count,
            "interrupted": played.interrupted,
            "recording": None if written is None else str(written),
            "delays": {robot: it and asdict(it) for robot, it in delays.items()},
            "identified": None if identified is None else str(kept.identify),
        }
        print_json({**summary.to_json(), **extra})
    else:
        print_summary(summary, played, count)
        print_delays(delays)
        if written is not None:
            say(f"Recording of trial {kept.trial}: {written}")
        if identified is not None:
            from robobt.cli.identify import show_identified

            show_identified(identified, kept.identify)
    failed = tell_failures(summary, loaded.on_error)
    if problem is not None:
        raise problem
    if played.interrupted:
        raise typer.Exit(130)
    if failed:
        raise typer.Exit(TREES_FAILED)


def _identified(
    kept: KeptTrials, played: Run, recording: Path | None
) -> tuple[Identified | None, RobobtError | None]:
    """Return what is identified from the recorded trial, if that is asked for, or why nothing is."""
    recorded = any(result.trial == kept.trial for result in played.results)
    if kept.identify is None or recording is None or not recorded:
        return None, None
    from robobt.cli.identify import identified_from
    from robobt.identify.sources import NothingToIdentifyError

    try:
        return identified_from(recording, f"trial {kept.trial}", kept.identify), None
    except NothingToIdentifyError as error:
        return None, error


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
