"""``robobt tournament results``: what a tournament's store holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import Json, console, print_json, say, table
from robobt.cli.options import option
from robobt.cli.tournament.regenerated import Tracking, regenerate_matches
from robobt.cli.tournament.tables import lead_text, print_encounters, print_standings
from robobt.config.errors import unknown_name
from robobt.config.wording import counted

if TYPE_CHECKING:
    from robobt.tournament.played import PlayedMatch
    from robobt.tournament.standings import Encounter, Paired


def results(
    store: Annotated[Path, typer.Argument(help="A tournament's store (SQLite).")],
    entrant: Annotated[list[str] | None, option("--entrant")] = None,
    outcome: Annotated[str | None, option("--outcome", ", as full_time or forfeit_blue")] = None,
    lost_by: Annotated[str | None, option("--lost-by")] = None,
    matches: Annotated[bool, option("--matches", " instead of the standings")] = False,
    compare: Annotated[tuple[str, str] | None, option("--compare")] = None,
    merge: Annotated[list[Path] | None, option("--merge")] = None,
    regenerate: Annotated[
        Path | None, option("--regenerate", "; --entrant, --outcome and --lost-by choose among them")
    ] = None,
    tracking: Annotated[
        Tracking | None, option("--tracking", ", for --regenerate; by default arrows")
    ] = None,
    workers: Annotated[
        int | None,
        option("--workers", ", for --regenerate; 0 plays in the command's own process", min=0, max=256),
    ] = None,
    as_json: Json = False,
) -> None:
    """Sum up, list, compare and merge what tournaments have stored, and play matches again.

    Keys of --json: played (what was played, by field), merged (matches that were new); then either matches,
    each with the columns of the table; or compare: met (as an encounter of 'robobt tournament run'; null
    if they have not), and others: opponents, rounds, lead (goals a match by which the first did better),
    low and high (95 %), ahead and behind (rounds in which the first made more and fewer points), p (exact);
    or the keys of 'robobt tournament run': matches, distinct, standings, encounters; with --regenerate:
    differences (what differs from who played them), equal (matches with equal hashes), regenerated, for each
    match blue, yellow, round, seed, trace, again (its trace now), equal, problem and file. Exit code 1 if a
    hash differs.
    """
    if tracking is not None and regenerate is None:
        raise typer.BadParameter("goes with --regenerate", param_hint="--tracking")
    from robobt.tournament.standings import paired, standings_of
    from robobt.tournament.store import MatchStore

    with MatchStore(store) as held:
        merged = 0
        for path in merge or ():
            with MatchStore(path) as other:
                merged += held.merge(other)
        known, played, found = list(held.entrants()), held.played, held.matches()
    for name in [*(entrant or []), *(compare or ()), *([lost_by] if lost_by else [])]:
        if name not in known:
            raise typer.BadParameter(f"no entrant is called {name!r}; {unknown_name(name, known)}")
    if compare is not None and compare[0] == compare[1]:
        raise typer.BadParameter("needs two different entrants", param_hint="--compare")
    ends = sorted({match.outcome for match in found})
    found = [match for match in found if _wanted(match, entrant or [], outcome, lost_by)]
    said: dict[str, object] = {"played": played, "merged": merged}
    if regenerate is not None:
        with MatchStore(store) as held:
            written = tracking or Tracking.ARROWS
            regenerate_matches(held, found, regenerate, written, workers, said, as_json=as_json)
        return
    if merge and not as_json:
        say(f"Matches taken over: {merged}")
    if matches or outcome or lost_by:
        if as_json:
            print_json({**said, "matches": [match.row() for match in found]})
        else:
            _list(found)
            if not found:
                say(f"No such match; matches ended as {', '.join(ends)}.")
        return
    if not found:
        raise typer.BadParameter(f"{store}: no match is left, or none was played yet")
    there = {name for match in found for name in (match.blue, match.yellow)}
    names = [name for name in dict.fromkeys([*(compare or ()), *known]) if name in there]
    summed = standings_of(found, names)
    if compare is not None:
        met = [one for one in summed.encounters if {one.first, one.second} == {*compare}]
        others = paired(found, *compare)
        if as_json:
            print_json({**said, "compare": {"met": met[0] if met else None, "others": others}})
        else:
            _print_compared(met, others)
    elif as_json:
        print_json({**said, **asdict(summed)})
    else:
        told = [f"{name} {value}" for name, value in played.items() if name not in ("format", "digest")]
        console.print(
            f"[bold]{escape(str(store))}[/bold]: {escape(', '.join(told))}; "
            f"{counted(len(found), 'match', 'matches')}"
        )
        print_standings(summed)


def _wanted(match: PlayedMatch, entrants: list[str], outcome: str | None, lost_by: str | None) -> bool:
    sides = {match.blue, match.yellow}
    if entrants and not (sides <= {*entrants} if len(entrants) > 1 else sides & {*entrants}):
        return False
    if lost_by is not None and (lost_by not in sides or match.score(lost_by) > 0.0):
        return False
    return outcome is None or match.outcome == outcome


def _list(matches: Sequence[PlayedMatch]) -> None:
    listed = table("round", "blue", "yellow", "goals", "end", "time, s", "trace")
    for match in matches:
        listed.add_row(
            str(match.round),
            escape(match.blue),
            escape(match.yellow),
            f"{match.blue_score} : {match.yellow_score}",
            match.outcome.replace("_", " "),
            f"{match.time:.1f}",
            match.trace[:8],
        )
    console.print(listed)


def _print_compared(met: list[Encounter], others: Paired) -> None:
    if met:
        print_encounters(met)
    else:
        say(f"{others.first} and {others.second} have not met.")
    if not others.rounds:
        say("They have no opponent in common from the same side with the same seed.")
        return
    console.print(f"\nagainst the same opponents ({escape(', '.join(others.opponents))}):")
    listed = table("rounds", "better by, goals a match (95 %)", "ahead", "p")
    text = lead_text(others.lead, others.low, others.high)
    listed.add_row(str(others.rounds), text, f"{others.ahead} : {others.behind}", f"{others.p:.2g}")
    console.print(listed)
