"""``robobt tournament run``: teams against each other, and who is better."""

from __future__ import annotations

import tempfile
from collections.abc import Collection
from dataclasses import asdict, dataclass
from enum import StrEnum
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
    warn,
)
from robobt.cli.option_groups.refereeing import Refereeing
from robobt.cli.option_groups.scenario import Changes
from robobt.cli.options import option
from robobt.cli.outputs import make_folders
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
    require_programs,
    tell_code,
    tell_waiting,
)
from robobt.cli.tournament.tables import print_standings
from robobt.config.extras import need
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.tournament.fixtures import Fixture
    from robobt.tournament.plan import Plan
    from robobt.tournament.play import Played
    from robobt.tournament.played import PlayedMatch
    from robobt.tournament.recordings import Recordings
    from robobt.tournament.sequential import RunningTest, SequentialTest
    from robobt.tournament.standings import Standings

_DEFAULT_ROUNDS, _MOST_ROUNDS = 10, 5000
"""Rounds by default: of a tournament, and of a sequential test."""


class KeepOption(StrEnum):
    """Which recordings are kept."""

    NONE = "none"
    WORST = "worst"
    LOST = "lost"
    ALL = "all"


@dataclass(frozen=True)
class Test:
    """The sequential test that ends the tournament."""

    sprt: Annotated[
        tuple[float, float] | None,
        option("--sprt", ", by points of Elo; play until that is decided, against --against"),
    ] = None
    alpha: Alpha = ALPHA
    beta: Beta = BETA

    def asked(self, entrants: list[str], against: str | None) -> SequentialTest | None:
        """Return the test that is asked for, if one is.

        Raises:
            typer.BadParameter: the options do not go together.
        """
        if self.sprt is None:
            if (self.alpha, self.beta) != (ALPHA, BETA):
                raise typer.BadParameter("are for --sprt", param_hint="--alpha, --beta")
            return None
        if against is None or len([text for text in entrants if text != against]) != 1:
            raise typer.BadParameter("needs one entrant, and --against for the other", param_hint="--sprt")
        return asked_test(self.sprt, self.alpha, self.beta)


@dataclass(frozen=True)
class KeptMatches:
    """What is kept of the matches."""

    out: OutOption = None
    html: Annotated[Path | None, option("--html")] = None
    keep: Annotated[
        KeepOption,
        option(
            "--recordings",
            " beside --out: none, the match that goes worst for the first entrant against each other one, "
            "those it loses, or all",
        ),
    ] = KeepOption.NONE

    def recordings(self, first: str) -> Recordings | None:
        """Return what keeps recordings, in which ``first`` is the first entrant's name.

        Raises:
            typer.BadParameter: the outputs do not go together.
        """
        from robobt.tournament.recordings import Keep, Recordings

        if self.html is not None and self.out is not None and self.html.resolve() == self.out.resolve():
            there = f"would take the place of the store {self.out}"
            raise typer.BadParameter(there, param_hint="--html")
        if self.keep is KeepOption.NONE:
            return None
        if self.out is None:
            raise typer.BadParameter(
                "needs --out, beside which recordings are kept", param_hint="--recordings"
            )
        return Recordings(self.out.with_suffix(".recordings"), Keep(self.keep.value), first)


@dataclass(frozen=True)
class MatchConditions:
    """How the matches are played."""

    seed: Seed = None
    workers: WorkersOption = None
    speed_factor: Annotated[
        float, option("--speed-factor", " in matches with programs", min=0.05, max=20.0)
    ] = 1.0


def run(
    entrants: Annotated[
        list[str],
        typer.Argument(
            metavar=f"{ENTRANT}...",
            help="A play with parameters (team_player:shoot_at=0.4), also of a Python file "
            "(my_team.py:striker), an entrant's file (.yaml), or a scenario's side (team_v_baseline:yellow).",
        ),
    ],
    against: Annotated[
        str | None,
        option("--against", "; by default all meet each other"),
    ] = None,
    scenario: ScenarioOption = "six_v_six",
    rounds: Annotated[
        int | None,
        option(
            "--rounds",
            f" in each pairing; by default {_DEFAULT_ROUNDS}, with --sprt at most {_MOST_ROUNDS}",
            min=1,
            max=100_000,
        ),
    ] = None,
    *,
    test: Test,
    kept: KeptMatches,
    running: MatchConditions,
    changes: Changes,
    refereeing: Refereeing,
    as_json: Json = False,
) -> None:
    """Let teams play each other, each pairing from either side with the same seeds, and rate them.

    Ratings are Bradley and Terry's on the Elo scale (400 points are odds of ten to one), 0 being --against,
    or else the mean. Whose play ends the process or hangs for five minutes, twice, has lost that match.

    With --sprt the exit code is 0 for better, 1 for not better, 2 for undecided after the last round.

    Keys of --json: scenario, seed, referee, rounds, matches, distinct (matches that differ from each other);
    standings by entrant, the best first: matches, won, drawn, lost, forfeits (lost because its play crashed
    or hung), goals_for, goals_against, rating (elo, low and high: 95 %), figures (means a match), errors
    (ticks in which a tree failed), first_error; encounters: first, second, matches, won, drawn, lost,
    goals_for, goals_against, lead (goals a match), low and high (95 %), rounds_won, rounds_lost, p (exact
    test on the rounds), holm (p corrected for the number of encounters); failed: what kept matches from
    being played, by match; interrupted; sprt, null without: elo0, elo1, alpha, beta, verdict, rounds,
    ratio (log-likelihood), bounds.
    """
    need("tournament", "google.protobuf", "pyarrow", "scipy")
    from robobt.tournament.plan import Plan
    from robobt.tournament.sequential import RunningTest
    from robobt.tournament.standings import standings_of

    asked = test.asked(entrants, against)
    base, referees = refereeing.of_tournament(changes.scenario(scenario))
    texts = [*entrants, *([against] if against is not None and against not in entrants else [])]
    teams = tuple([parse_entrant(text) for text in texts])
    require_programs(teams)
    recordings = kept.recordings(teams[0].name)
    plan = Plan(
        base,
        teams,
        rounds or (_DEFAULT_ROUNDS if asked is None else _MOST_ROUNDS),
        base.seed if running.seed is None else running.seed,
        None if against is None else teams[texts.index(against)].name,
        referees,
        speed=running.speed_factor,
    )
    if running.speed_factor != 1.0 and not any(team.program for team in teams):
        raise typer.BadParameter(
            "is for matches with programs, and none takes part", param_hint="--speed-factor"
        )
    make_folders({"--out": kept.out, "--html": kept.html})
    result = None if asked is None else RunningTest(asked, *plan.pairings[0])
    played = _played(plan, running.workers, kept.out, recordings, result)
    _warn_of(played, len(plan.fixtures()), kept.out)
    if not played.matches:
        raise typer.Exit(130 if played.interrupted else 1)
    found = standings_of(played.matches, plan.names, plan.against)
    said = {
        "scenario": base.name,
        "seed": plan.seed,
        "referee": "none" if base.referee is None else getattr(referees, "name", "own"),
        "rounds": plan.rounds,
    }
    tell_code(played.matches)
    # The exit code says who is better also where nobody reads on.
    with as_far_as_read():
        _print(said, found, played, result, as_json=as_json)
    if kept.html is not None:
        from robobt.tournament.report import write_report

        line = None if result is None else result.line()
        write_report(kept.html, said, found, played.matches, recordings, line)
        if not as_json:
            with as_far_as_read():
                say(f"Report: {kept.html}")
    if played.interrupted:
        raise typer.Exit(130)
    if result is not None:
        raise typer.Exit(EXITS.index(result.verdict.value))
    if played.failed:
        raise typer.Exit(1)


def _print(
    said: dict[str, object], found: Standings, played: Played, test: RunningTest | None, *, as_json: bool
) -> None:
    if as_json:
        failed = {str(fixture): problem for fixture, problem in played.failed.items()}
        ended = {"failed": failed, "interrupted": played.interrupted}
        print_json({**said, **asdict(found), **ended, "sprt": None if test is None else test.to_json()})
        return
    console.print(
        f"[bold]{escape(str(said['scenario']))}[/bold]: {counted(found.matches, 'match', 'matches')}, "
        f"seed {said['seed']}, {'no' if said['referee'] == 'none' else said['referee']} referee"
    )
    print_standings(found)
    if test is not None:
        say(f"\n{test.line()}")


def _played(
    plan: Plan, workers: int | None, out: Path | None, recordings: Recordings | None, test: RunningTest | None
) -> Played:
    """Play what is not in the store yet, until the test is decided if there is one."""
    from robobt.tournament.play import play_tournament

    with tempfile.TemporaryDirectory(prefix="robobt-") as folder:
        path = Path(folder) / "tournament.sqlite" if out is None else out
        with plan.open_store(path) as store, Progress("tournament", len(plan.fixtures())) as progress:

            def enough(matches: Collection[PlayedMatch], failed: Collection[Fixture]) -> bool:
                if test is None:
                    return False
                decided = test.enough(matches, failed)
                progress.name(test.brief())
                return decided

            return play_tournament(
                plan,
                store,
                _workers(plan) if workers is None else workers,
                recordings=recordings,
                on_match=lambda _: progress.advance(),
                enough=enough,
                on_wait=tell_waiting,
                tell_outputs=out is not None,
            )


def _warn_of(played: Played, count: int, out: Path | None) -> None:
    """Warn of matches that could not be played, and of an early end."""
    for fixture, problem in played.failed.items():
        warn(f"{fixture} could not be played: {problem}")
    if played.interrupted:
        kept = "without --out nothing is kept" if out is None else "the same command goes on with it"
        warn(f"stopped after {len(played.matches)} of {counted(count, 'match', 'matches')}; {kept}")


def _workers(plan: Plan) -> int:
    """Return how many matches are played at a time: one a core, but with a core for each program."""
    most = max(
        1 + sum(entrant.program is not None for entrant in plan.entrants if entrant.name in pair)
        for pair in plan.pairings
    )
    return min(max(1, cores() // most), len(plan.fixtures()))
