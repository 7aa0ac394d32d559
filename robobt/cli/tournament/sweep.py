"""``robobt sweep``: tune the parameters of a play."""

from __future__ import annotations

import json
import tempfile
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import (
    Imports,
    Json,
    Progress,
    Seed,
    as_far_as_read,
    console,
    cores,
    import_files,
    print_json,
    say,
    table,
    warn,
)
from robobt.cli.compare import Set, parse_play, scenario_of
from robobt.cli.outputs import make_folders
from robobt.cli.refereeing import ControllerOption, RefereeOption, StagesOption, Who, refereed
from robobt.cli.tournament.asked import (
    ALPHA,
    BETA,
    ENTRANT,
    EXITS,
    Alpha,
    Beta,
    OutOption,
    ScenarioOption,
    WorkersOption,
    asked_test,
    parse_entrant,
    tell_code,
    tell_waiting,
)

if TYPE_CHECKING:
    from robobt.tournament.sequential import RunningTest
    from robobt.tournament.sweeps.search import Candidate, Swept

_VARY = "NAME=VALUES"


def sweep(
    play: Annotated[
        str,
        typer.Argument(
            metavar="PLAY[:NAME=VALUE,...]",
            help="A play by name; parameters given here stay as they are.",
        ),
    ],
    vary: Annotated[
        list[str],
        typer.Option(
            "--vary",
            metavar=_VARY,
            help="A parameter and what is tried: rater=nn_filtered,open_angle, or for numbers a range, "
            "shot_distance=2:6; may be given often.",
        ),
    ],
    against: Annotated[
        str | None,
        typer.Option(metavar=ENTRANT, help="Whom all play; by default the play as it is without --vary."),
    ] = None,
    scenario: ScenarioOption = "six_v_six",
    candidates: Annotated[
        int, typer.Option(min=1, max=10_000, help="How many sets of parameters are tried.")
    ] = 24,
    at_once: Annotated[
        int,
        typer.Option(
            "--at-once",
            min=1,
            max=256,
            help="How many of them play at a time; the next ones are proposed by what these have done.",
        ),
    ] = 4,
    rounds: Annotated[
        int,
        typer.Option(
            "--rounds", "-n", min=1, max=10_000, help="Rounds of two matches that a candidate plays at most."
        ),
    ] = 20,
    sprt: Annotated[
        tuple[float, float],
        typer.Option(
            metavar="ELO0 ELO1", help="What the best is tested for, on other seeds; as of robobt tournament."
        ),
    ] = (0.0, 30.0),
    alpha: Alpha = ALPHA,
    beta: Beta = BETA,
    confirm_rounds: Annotated[
        int,
        typer.Option(
            "--confirm-rounds", min=0, max=100_000, help="Rounds of that test at most; 0 leaves it out."
        ),
    ] = 5000,
    out: OutOption = None,
    seed: Seed = None,
    workers: WorkersOption = None,
    settings: Set = None,
    imports: Imports = None,
    referee: RefereeOption = None,
    game_controller: ControllerOption = None,
    stages: StagesOption = None,
    as_json: Json = False,
) -> None:
    """Tune parameters of a play: try sets of them against one team, and test the best on fresh seeds.

    Optuna proposes them. All play the same rounds, from either side, and are stopped once they surely are
    worse than whom they play, or than the best so far.

    The exit code is that of the test of the best: 0 for better, 1 for not better (also where no candidate
    did better at all), 2 for undecided.

    Keys of --json: scenario, seed, referee, against; candidates in the order in which they were proposed:
    number, name (an entrant of 'robobt tournament'), params, rounds, score (0 to 1 in the mean), lead
    (goals a match), stopped, problem, errors (ticks in which a tree failed), first_error; best, one of them
    or null; failed: what kept matches from being played, by match; interrupted; sprt, null without: as of
    'robobt tournament'.
    """
    from robobt.plays.files import is_play_file, problem_with_play
    from robobt.tournament.sweeps.search import search
    from robobt.tournament.sweeps.sweep import Sweep, confirm
    from robobt.tournament.sweeps.vary import read_varied

    import_files(imports)
    name, fixed = parse_play(play, "PLAY")
    if is_play_file(name):
        raise typer.BadParameter(f"{name} is a file; a sweep tunes a play by its name", param_hint="PLAY")
    if problem := problem_with_play(name):
        raise typer.BadParameter(problem, param_hint="PLAY")
    test = asked_test(sprt, alpha, beta)
    if referee is Who.NONE:
        raise typer.BadParameter("must be own or official", param_hint="--referee")
    base = scenario_of(scenario, settings)
    base, referees = refereed(base, referee, game_controller, stages)
    asked = Sweep(
        base,
        name,
        fixed,
        tuple([read_varied(name, text) for text in vary]),
        parse_entrant(against or play),
        candidates,
        at_once,
        rounds,
        base.seed if seed is None else seed,
        referee=referees,
    )
    make_folders({"--out": out})
    crew = cores() if workers is None else workers
    running = None
    with tempfile.TemporaryDirectory(prefix="robobt-") as folder:
        store = Path(folder) / "sweep.sqlite" if out is None else out
        with Progress("sweep", 2 * rounds * asked.tries) as progress:

            def on_progress(steps: int, found: Swept) -> None:
                progress.advance(steps)
                if found.best is not None:
                    progress.name(f"sweep, best {found.best.score:.3f}")

            swept = search(asked, store, crew, on_progress, tell_waiting, out is not None)
        best, matches, failed = swept.best, swept.matches, swept.failed
        interrupted = swept.interrupted
        if best is not None and (best.score or 0.0) > 0.5 and confirm_rounds and not interrupted:
            with Progress("confirm", 2 * confirm_rounds) as progress:

                def on_match(test: RunningTest) -> None:
                    progress.advance(1)
                    progress.name(test.brief())

                try:
                    running, played = confirm(
                        asked, best.params, test, confirm_rounds, store, crew, on_match, out is not None
                    )
                    matches, failed = [*matches, *played.matches], {**failed, **played.failed}
                    interrupted = played.interrupted
                except KeyboardInterrupt:
                    # Before its first match.
                    interrupted = True
    for fixture, problem in failed.items():
        warn(f"{fixture} could not be played: {problem}")
    for one in swept.candidates:
        if one.first_error is not None:
            failed_in = f"trees failed in {one.errors} ticks; the first" if one.errors else "lost by rule"
            warn(f"{one.name}: {failed_in}: {one.first_error}")
    tell_code(matches)
    if interrupted:
        kept = "without --out nothing is kept" if out is None else "the same command goes on with it"
        warn(f"stopped after {len(matches)} matches; {kept}")
    said = {
        "scenario": base.name,
        "seed": asked.seed,
        "referee": getattr(referees, "name", "own"),
        "against": asked.against.name,
    }
    with as_far_as_read():
        if as_json:
            found = {"candidates": [asdict(one) for one in swept.candidates], "best": best and asdict(best)}
            ended = {
                "failed": {str(one): why for one, why in failed.items()},
                "interrupted": interrupted,
                "sprt": None if running is None else running.to_json(),
            }
            print_json({**said, **found, **ended})
        else:
            console.print(
                f"[bold]{escape(name)}[/bold] in {escape(base.name)} against {escape(asked.against.name)}: "
                f"{len(matches)} matches, seed {asked.seed}, {said['referee']} referee"
            )
            _print(swept, best)
            if running is not None:
                say(f"\n{running.line()}")
    if interrupted:
        raise typer.Exit(130)
    if running is not None:
        raise typer.Exit(EXITS.index(running.verdict.value))
    if best is None or (best.score or 0.0) <= 0.5:
        raise typer.Exit(EXITS.index("not better"))


def _print(swept: Swept, best: Candidate | None) -> None:
    """Print the candidates, the best first."""
    names = list(swept.candidates[0].params) if swept.candidates else []
    tried = table(*names, "rounds", "score", "lead a match", "")
    for one in sorted(swept.candidates, key=lambda one: (one.stopped, -(one.score or 0.0), one.number)):
        values = [escape(str(json.dumps(value)).strip('"')) for value in one.params.values()]
        score = "-" if one.score is None else f"{one.score:.3f}"
        lead = "-" if one.lead is None else f"{one.lead:+.2f}"
        remark = one.problem or ("surely worse" if one.stopped else "best" if one is best else "")
        tried.add_row(*values, str(one.rounds), score, lead, escape(remark))
    console.print(tried)
    if best is None:
        say("\nNo candidate was played to the end.")
    elif (best.score or 0.0) <= 0.5:
        say("\nNo candidate did better.")
    else:
        say(f"\nBest: {best.name}")
