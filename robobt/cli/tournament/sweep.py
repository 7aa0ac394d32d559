"""``robobt tournament sweep``: tune the parameters of a play."""

from __future__ import annotations

import json
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import (
    Json,
    Progress,
    Seed,
    as_far_as_read,
    console,
    cores,
    print_json,
    say,
    table,
    warn,
)
from robobt.cli.option_groups.refereeing import Refereeing
from robobt.cli.option_groups.scenario import Changes, parse_play
from robobt.cli.options import option
from robobt.cli.outputs import make_folders
from robobt.cli.tournament.asked import (
    ALPHA,
    BETA,
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
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.tournament.fixtures import Fixture
    from robobt.tournament.played import PlayedMatch
    from robobt.tournament.sequential import RunningTest
    from robobt.tournament.sweeps.search import Candidate, Swept
    from robobt.tournament.sweeps.sweep import Sweep

_VARY = "NAME=VALUES"


@dataclass(frozen=True)
class Tried:
    """What is tried."""

    candidates: Annotated[int, option("--candidates", min=1, max=10_000)] = 24
    concurrent: Annotated[
        int, option("--concurrent", "; their results decide which are tried next", min=1, max=256)
    ] = 4
    rounds: Annotated[int, option("--rounds", " with each candidate at most", min=1, max=10_000)] = 20


@dataclass(frozen=True)
class Confirmation:
    """The test of the best candidate, on other seeds."""

    sprt: Annotated[tuple[float, float], option("--sprt", ", for the best candidate on other seeds")] = (
        0.0,
        30.0,
    )
    alpha: Alpha = ALPHA
    beta: Beta = BETA
    confirm_rounds: Annotated[int, option("--confirm-rounds", min=0, max=100_000)] = 5000


@dataclass(frozen=True)
class SweepConditions:
    """How the matches are played, and where they are kept."""

    out: OutOption = None
    seed: Seed = None
    workers: WorkersOption = None


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
        option("--vary", ": rater=nn_filtered,open_angle, or a range of numbers, shot_distance=2:6"),
    ],
    against: Annotated[
        str | None,
        option("--against", "; by default the play itself, without what --vary changes"),
    ] = None,
    scenario: ScenarioOption = "six_v_six",
    *,
    tried: Tried,
    confirmation: Confirmation,
    running: SweepConditions,
    changes: Changes,
    refereeing: Refereeing,
    as_json: Json = False,
) -> None:
    """Tune parameters of a play: try sets of them against one team, and test the best on fresh seeds.

    Optuna proposes them. All play the same rounds, from either side, and are stopped once they surely are
    worse than whom they play, or than the best so far.

    The exit code is that of the test of the best: 0 for better, 1 for not better (also where no candidate
    did better at all), 2 for undecided.

    Keys of --json: scenario, seed, referee, against; candidates in the order in which they were proposed:
    number, name (an entrant of 'robobt tournament run'), params, rounds, score (0 to 1 in the mean), lead
    (goals a match), stopped, problem, errors (ticks in which a tree failed), first_error; best, one of them
    or null; failed: what kept matches from being played, by match; interrupted; sprt, null without: as of
    'robobt tournament run'.
    """
    from robobt.plays.files import is_play_file, problem_with_play
    from robobt.tournament.sweeps.sweep import Sweep
    from robobt.tournament.sweeps.vary import read_varied

    name, fixed = parse_play(play, "PLAY")
    base, referees = refereeing.of_tournament(changes.scenario(scenario))
    if is_play_file(name):
        raise typer.BadParameter(f"{name} is a file; a sweep tunes a play by its name", param_hint="PLAY")
    if problem := problem_with_play(name):
        raise typer.BadParameter(problem, param_hint="PLAY")
    asked = Sweep(
        base,
        name,
        fixed,
        tuple([read_varied(name, text) for text in vary]),
        parse_entrant(against or play),
        tried.candidates,
        tried.concurrent,
        tried.rounds,
        base.seed if running.seed is None else running.seed,
        referee=referees,
    )
    make_folders({"--out": running.out})
    found = _searched(asked, confirmation, running)
    best, test = found.swept.best, found.test
    _warn_of(found, running.out)
    said = {
        "scenario": base.name,
        "seed": asked.seed,
        "referee": "none" if base.referee is None else getattr(referees, "name", "own"),
        "against": asked.against.name,
    }
    with as_far_as_read():
        if as_json:
            candidates = [asdict(one) for one in found.swept.candidates]
            ended = {
                "failed": {str(one): why for one, why in found.failed.items()},
                "interrupted": found.interrupted,
                "sprt": None if test is None else test.to_json(),
            }
            print_json({**said, "candidates": candidates, "best": best and asdict(best), **ended})
        else:
            console.print(
                f"[bold]{escape(name)}[/bold] in {escape(base.name)} against {escape(asked.against.name)}: "
                f"{counted(len(found.matches), 'match', 'matches')}, seed {asked.seed}, "
                f"{'no' if said['referee'] == 'none' else said['referee']} referee"
            )
            _print(found.swept, best)
            if test is not None:
                say(f"\n{test.line()}")
    if found.interrupted:
        raise typer.Exit(130)
    if test is not None:
        raise typer.Exit(EXITS.index(test.verdict.value))
    if not _is_better(best):
        raise typer.Exit(EXITS.index("not better"))


@dataclass
class _SweepOutcome:
    """What a search and the test of its best candidate found.

    Attributes:
        swept: the search.
        matches: those of both.
        failed: what kept matches from being played.
        interrupted: whether one of both was.
        test: of the best candidate; None where there was none.
    """

    swept: Swept
    matches: list[PlayedMatch]
    failed: dict[Fixture, str]
    interrupted: bool
    test: RunningTest | None = None


def _searched(asked: Sweep, confirmation: Confirmation, running: SweepConditions) -> _SweepOutcome:
    """Search, and test the best candidate unless that is left out."""
    from robobt.tournament.sweeps.search import search
    from robobt.tournament.sweeps.sweep import confirm

    test = asked_test(confirmation.sprt, confirmation.alpha, confirmation.beta)
    workers = cores() if running.workers is None else running.workers
    kept, rounds = running.out is not None, confirmation.confirm_rounds
    with tempfile.TemporaryDirectory(prefix="robobt-") as folder:
        store = Path(folder) / "sweep.sqlite" if running.out is None else running.out
        with Progress("sweep", 2 * asked.rounds * asked.tries) as progress:

            def on_progress(steps: int, found: Swept) -> None:
                progress.advance(steps)
                if found.best is not None:
                    progress.name(f"sweep, best {found.best.score:.3f}")

            swept = search(asked, store, workers, on_progress, tell_waiting, kept)
        found = _SweepOutcome(swept, list(swept.matches), dict(swept.failed), swept.interrupted)
        if swept.best is None or not _is_better(swept.best) or not rounds or found.interrupted:
            return found
        with Progress("confirm", 2 * rounds) as progress:

            def on_match(test: RunningTest) -> None:
                progress.advance(1)
                progress.name(test.brief())

            try:
                found.test, played = confirm(
                    asked, swept.best.params, test, rounds, store, workers, on_match, kept
                )
                found.matches += played.matches
                found.failed |= played.failed
                found.interrupted = played.interrupted
            except KeyboardInterrupt:
                # Before its first match.
                found.interrupted = True
    return found


def _is_better(best: Candidate | None) -> bool:
    return best is not None and (best.score or 0.0) > 0.5


def _warn_of(found: _SweepOutcome, out: Path | None) -> None:
    """Warn of what went wrong: matches, trees, an early end."""
    for fixture, problem in found.failed.items():
        warn(f"{fixture} could not be played: {problem}")
    for one in found.swept.candidates:
        if one.first_error is not None:
            failed_in = (
                f"trees failed in {counted(one.errors, 'tick')}; the first" if one.errors else "lost by rule"
            )
            warn(f"{one.name}: {failed_in}: {one.first_error}")
    tell_code(found.matches)
    if found.interrupted:
        kept = "without --out nothing is kept" if out is None else "the same command goes on with it"
        warn(f"stopped after {counted(len(found.matches), 'match', 'matches')}; {kept}")


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
    elif not _is_better(best):
        say("\nNo candidate did better.")
    else:
        say(f"\nBest: {best.name}")
