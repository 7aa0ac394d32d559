"""Made-up results, to measure the driver and the store."""

from __future__ import annotations

import tempfile
from pathlib import Path
from time import perf_counter
from typing import Annotated

import numpy as np
import typer

from robobt.cli import Json, Progress, print_json, say
from robobt.match import load_scenario, trial_seed
from robobt.tournament import Plan, play_tournament, read_entrant, standings_of
from robobt.tournament.fixtures import Fixture
from robobt.tournament.job import Failure, Job
from robobt.tournament.played import PlayedMatch, SideResult
from robobt.tournament.store import MatchStore
from robobt.world import Team


class MadeUp(Job):
    """A job that makes its results up."""

    def play(self, fixture: Fixture, _report: object) -> PlayedMatch | Failure:
        """Return figures as a full match has them."""
        seed = trial_seed(self.plan.seed, fixture.round)
        rng = np.random.default_rng([seed, fixture.blue < fixture.yellow])
        goals = rng.poisson(2.0, 2)
        sides = {
            team.value: SideResult(
                goals=int(goals[number]),
                passes=int(rng.poisson(60.0)),
                passes_completed=int(rng.poisson(40.0)),
                expected_goals=float(rng.gamma(2.0)),
                possession=0.5,
                distance=float(rng.normal(2500.0, 100.0)),
                fouls=int(rng.poisson(5.0)),
            )
            for number, team in enumerate(Team)
        }
        return PlayedMatch(
            *fixture,
            seed=seed,
            outcome="full_time",
            time=900.0,
            blue_score=int(goals[0]),
            yellow_score=int(goals[1]),
            in_play=0.6,
            ticks=54_000,
            trace=rng.bytes(16).hex(),
            code=self.code,
            wall_time=140.0,
            finished="2026-11-01T00:00:00+00:00",
            sides=sides,
        )


def tournament(
    results: Annotated[int, typer.Option(min=2, max=1_000_000, help="How many are made up.")] = 10_000,
    workers: Annotated[int, typer.Option("--workers", "-w", min=0, max=256)] = 1,
    as_json: Json = False,
) -> None:
    """Let workers make results up instead of playing, and keep them all.

    Keys of --json: results, workers, driver_per_minute (from worker to store), store_per_minute (the store
    alone), sum_up_s (seconds for ratings and tests of all of them), bytes_per_result.
    """

    teams = tuple([read_entrant(name) for name in ("take_shot", "attack_main")])
    plan = Plan(load_scenario("striker_vs_goalkeeper"), teams, rounds=-(-results // 2), seed=1)
    with tempfile.TemporaryDirectory() as folder, Progress("results", 2 * plan.rounds) as progress:
        with plan.open_store(Path(folder) / "driver.sqlite") as store:
            begun = perf_counter()
            played = play_tournament(plan, store, workers, on_match=lambda _: progress.advance(), job=MadeUp)
            driver = perf_counter() - begun
        begun = perf_counter()
        standings_of(played.matches, plan.names)
        summed = perf_counter() - begun
        path = Path(folder) / "alone.sqlite"
        with MatchStore(path, {"seed": 1}) as store:
            begun = perf_counter()
            for match in played.matches:
                store.add(match)
            alone = perf_counter() - begun
        size = path.stat().st_size / len(played.matches)
    count = len(played.matches)
    figures = {"driver_per_minute": 60.0 * count / driver, "store_per_minute": 60.0 * count / alone}
    if as_json:
        told = {"results": count, "workers": workers, **figures}
        print_json({**told, "sum_up_s": summed, "bytes_per_result": size})
        return
    say(
        f"{count} results by {workers} workers: {figures['driver_per_minute']:.0f} a minute from worker to "
        f"store, {figures['store_per_minute']:.0f} a minute by the store alone, {size:.0f} bytes each; "
        f"summed up in {summed:.1f} s"
    )
