"""What a tournament says, as tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robobt.cli.common import console, name_lines, say, table, warn
from robobt.cli.team_figures import team_figures

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robobt.tournament.standings import Encounter, Standings


def print_standings(found: Standings) -> None:
    """Print ratings, encounters and the entrants' figures."""
    names = list(found.standings)
    ratings = table("", "entrant", "Elo", "95 %", "matches", "won", "drawn", "lost", "goals")
    for number, (name, one) in enumerate(found.standings.items(), start=1):
        rating = one.rating
        goals = f"{one.goals_for} : {one.goals_against}"
        counts = [str(count) for count in (one.matches, one.won, one.drawn, one.lost)]
        interval = f"{round(rating.low):+d} to {round(rating.high):+d}"
        ratings.add_row(
            str(number), name_lines(name, 60), f"{round(rating.elo):+d}", interval, *counts, goals
        )
    console.print(ratings)
    if len(names) > 2:
        console.print("\nwon-drawn-lost of the row against the column:")
        _print_cross_table(found, names)
    console.print()
    print_encounters(found.encounters)
    console.print()
    figures = {name: one.figures for name, one in found.standings.items()}
    if any(value for counted in figures.values() for value in counted.values()):
        console.print(team_figures(figures, "a match"))
    else:
        say("Passes, possession and the like are counted where the scenario has a referee.")
    for remark in found.remarks():
        warn(remark)


def print_encounters(found: Sequence[Encounter]) -> None:
    """Print two against each other, a line each."""
    columns = ("w-d-l", "goals", "lead a match (95 %)", "rounds", "p", "Holm's p")
    met = table("encounter", *columns)
    for pair in found:
        met.add_row(
            name_lines(f"{pair.first} v {pair.second}", 70),
            f"{pair.won}-{pair.drawn}-{pair.lost}",
            f"{pair.goals_for} : {pair.goals_against}",
            lead_text(pair.lead, pair.low, pair.high),
            f"{pair.rounds_won} : {pair.rounds_lost}",
            f"{pair.p:.2g}",
            f"{pair.holm:.2g}",
        )
    console.print(met)


def lead_text(lead: float | None, low: float | None, high: float | None) -> str:
    """Return a lead and its interval for a table."""
    if lead is None:
        return "-"
    return f"{lead:+.2f}" if low is None or high is None else f"{lead:+.2f} ({low:+.2f} to {high:+.2f})"


def _print_cross_table(found: Standings, names: list[str]) -> None:
    cells = {}
    for one in found.encounters:
        cells[one.first, one.second] = f"{one.won}-{one.drawn}-{one.lost}"
        cells[one.second, one.first] = f"{one.lost}-{one.drawn}-{one.won}"
    crossed = table("", *[str(number) for number in range(1, len(names) + 1)])
    for number, name in enumerate(names, start=1):
        row = ["" if name == other else cells.get((name, other), "-") for other in names]
        crossed.add_row(name_lines(f"{number} {name}", 9 * len(names)), *row)
    console.print(crossed)
