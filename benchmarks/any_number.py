"""How a play does against another with any number of robots a side."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Annotated, Any

import typer

from robobt.cli.common import MAX_SEED, Json, Progress, Workers, console, cores, print_json, table
from robobt.cli.tournament.asked import parse_entrant
from robobt.match.scenario.robots import Robots
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.statistics import wilson_interval
from robobt.tournament import Plan, play_tournament, standings_of
from robobt.tournament.standings import Encounter
from robobt.world.division import A, B

_IN = {
    B.robots: ("six_v_six", (0, 3, 4, 5, 1, 2)),
    A.robots: ("eleven_v_eleven", (0, 5, 6, 7, 10, 8, 9, 1, 2, 3, 4)),
}
"""Scenarios by their numbers of robots a side, and in which order robots come in: the goalkeeper is first."""


def with_robots(count: int) -> Scenario:
    """Return a match of ``count`` robots a side: up to six in division B, more in division A."""
    name, order = _IN[B.robots if count <= B.robots else A.robots]
    scenario, numbers = load_scenario(name), set(order[:count])
    blue, yellow = (
        tuple(robot for robot in side if robot.number in numbers)
        for side in (scenario.robots.blue, scenario.robots.yellow)
    )
    robots = Robots(blue=blue, yellow=yellow)
    return scenario.model_copy(update={"name": f"{count}_v_{count}", "robots": robots})


def any_number(
    play: Annotated[str, typer.Argument(help="An entrant, as for robobt tournament.")],
    against: Annotated[str, typer.Option("--against", help="The other entrant.")] = (
        "team_player:without=score"
    ),
    robots: Annotated[
        list[int] | None, typer.Option("--robots", min=1, max=11, help="Robots a side; several times.")
    ] = None,
    rounds: Annotated[
        int, typer.Option("--rounds", min=1, max=1000, help="Each is a match from either side.")
    ] = 5,
    seconds: Annotated[float, typer.Option("--seconds", min=10, max=3600, help="Of a match [s].")] = 120.0,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    workers: Workers = None,
    as_json: Json = False,
) -> None:
    """Let field players of one play meet those of another, with several numbers of robots a side.

    Goalkeepers play team_goalkeeper. Keys of --json: play, against, rounds, seconds, seed; robots: by number,
    won, drawn, lost, goals_for, goals_against, decided (share of the decided matches that were won), low and
    high (its 95 % interval, by Wilson); these three are null without a decided match.
    """
    teams = parse_entrant(play), parse_entrant(against)
    asked = robots or [2, 3, 6]
    found: dict[int, dict[str, Any]] = {}
    with Progress("matches", 2 * rounds * len(asked)) as progress, tempfile.TemporaryDirectory() as folder:
        for count in asked:
            plan = Plan(with_robots(count).lasting(seconds), teams, rounds, seed, against=teams[1].name)
            with plan.open_store(Path(folder) / f"{count}.sqlite") as store:
                played = play_tournament(
                    plan,
                    store,
                    min(workers or cores(), 2 * rounds),
                    on_match=lambda _: progress.advance(),
                )
            (encounter,) = standings_of(played.matches, plan.names).encounters
            found[count] = figures_of(encounter, teams[0].name)
    if as_json:
        about = {"play": teams[0].name, "against": teams[1].name, "rounds": rounds}
        print_json({**about, "seconds": seconds, "seed": seed, "robots": found})
        return
    shown = table("robots a side", "won", "drawn", "lost", "goals", "won of the decided (95 %)")
    for count, it in found.items():
        share = "" if it["decided"] is None else f"{it['decided']:.0%} ({it['low']:.0%} to {it['high']:.0%})"
        results = [str(it[key]) for key in ("won", "drawn", "lost")]
        shown.add_row(str(count), *results, f"{it['goals_for']} : {it['goals_against']}", share)
    console.print(shown)


def figures_of(encounter: Encounter, name: str) -> dict[str, Any]:
    """Return the results of an encounter as the entrant called ``name`` sees them."""
    first = encounter.first == name
    won, lost = (encounter.won, encounter.lost) if first else (encounter.lost, encounter.won)
    goals = encounter.goals_for, encounter.goals_against
    low, high = wilson_interval(won, won + lost) if won + lost else (None, None)
    return {
        "won": won,
        "drawn": encounter.drawn,
        "lost": lost,
        "goals_for": goals[0] if first else goals[1],
        "goals_against": goals[1] if first else goals[0],
        "decided": won / (won + lost) if won + lost else None,
        "low": low,
        "high": high,
    }
