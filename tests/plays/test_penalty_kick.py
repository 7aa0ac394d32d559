"""A penalty kick from the mark to its end, under the referee."""

from __future__ import annotations

import pytest

from robobt.match import MatchLoop, load_scenario
from robobt.match.results.results import MatchResult
from robobt.worlds import sim_world

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def shoot_out() -> tuple[MatchResult, list[str]]:
    """The first kick of each team."""
    happened: list[str] = []
    with MatchLoop(load_scenario("shoot_out").lasting(23.0), 2, sim_world) as match:
        update = match.referee.update  # type: ignore[union-attr]

        def told(frame):  # type: ignore[no-untyped-def]
            decision = update(frame)
            happened.extend(event.kind.value for event in decision.events)
            return decision

        match.referee.update = told  # type: ignore[union-attr, method-assign]
        # For a second after the second kick.
        left = 1.0
        while match.tick() and left > 0.0:
            kicks = [kind for kind in happened if kind in ("goal", "penalty_kick_failed")]
            left -= match.scenario.period * (len(kicks) >= 2)
        return match.result(), happened


def test_both_teams_take_their_kicks_without_a_fault(shoot_out: tuple[MatchResult, list[str]]) -> None:
    result, happened = shoot_out
    assert set(happened) <= {"possible_goal", "goal", "penalty_kick_failed"}
    assert len([kind for kind in happened if kind in ("goal", "penalty_kick_failed")]) == 2
    assert result.teams["blue"].fouls == result.teams["yellow"].fouls == 0


def test_the_ball_goes_into_the_goal(shoot_out: tuple[MatchResult, list[str]]) -> None:
    result, _ = shoot_out
    assert result.blue_score + result.yellow_score >= 1
