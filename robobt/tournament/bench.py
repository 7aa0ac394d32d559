"""Results that nobody played, to measure what takes them."""

from __future__ import annotations

import numpy as np

from robobt.match.runner import trial_seed
from robobt.tournament.fixtures import Fixture
from robobt.tournament.job import Failure, Job
from robobt.tournament.played import PlayedMatch, SideResult
from robobt.world.game import Team


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
