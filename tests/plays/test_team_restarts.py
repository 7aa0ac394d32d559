"""A team takes free kicks, opponents as near as the rules let them, without a foul of the taker's."""

from __future__ import annotations

from collections import Counter

import pytest

from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.match.referee.events import Decision, EventKind
from robobt.match.referee.referee import Referee
from robobt.match.refereeing import referee_settings
from robobt.match.scenario.changes import changed, with_team
from robobt.match.scenario.scenario import Scenario
from robobt.world import FieldGeometry, Frame, RobotId, Team
from robobt.worlds import sim_world

pytestmark = pytest.mark.integration

AFTERWARDS = 3.0
"""For so long after the kick it is watched [s]."""

FOULS = (EventKind.ATTACKER_DOUBLE_TOUCHED_BALL, EventKind.BOT_KICKED_BALL_TOO_FAST)


class Noting(Referee):
    """The scenario's own referee, which keeps the fouls it saw."""

    def __init__(self, scenario: Scenario, field: FieldGeometry) -> None:
        super().__init__(field, referee_settings(scenario))
        self.fouls: Counter[tuple[EventKind, RobotId | None]] = Counter()

    def update(self, frame: Frame) -> Decision:
        decision = super().update(frame)
        self.fouls.update((event.kind, event.robot) for event in decision.events if event.kind in FOULS)
        return decision


def crowded() -> Scenario:
    """Free kicks of blue in midfield, everybody about."""
    scenario = load_scenario("free_kick_drill")
    places = {
        f"{team} {n}.start.position": {"x": [-2.2, 2.2], "y": [-2.0, 2.0]}
        for team in Team
        for n in range(1, 6)
    }
    scenario = changed(scenario, {"ball.position": {"x": [-1.5, 1.5], "y": [-1.5, 1.5]}, **places})
    for team in Team:
        scenario = with_team(scenario, team, "team_player", {})
    return scenario


def taken(scenario: Scenario, seed: int) -> Counter[tuple[EventKind, RobotId | None]]:
    """Play until a while after the kick: the fouls at it."""
    noting: list[Noting] = []

    def referee(scenario: Scenario, field: FieldGeometry) -> Noting:
        noting.append(Noting(scenario, field))
        return noting[-1]

    until = None
    with MatchLoop(scenario, seed, sim_world, referee=referee) as match:
        while match.tick():
            now = match.world.truth().time
            if until is None and match.game.in_play:
                until = now + AFTERWARDS
            if until is not None and now > until:
                break
    assert until is not None
    return noting[0].fouls


def test_the_taker_touches_the_ball_once() -> None:
    # With the first it touched the ball askew and carried it on, with the second a mate touched it at once.
    scenario = crowded()
    for seed in (1151, 1240):
        assert not taken(scenario, seed)


@pytest.mark.slow
def test_it_does_so_300_times(capsys: pytest.CaptureFixture[str]) -> None:
    scenario, fouls = crowded(), Counter[tuple[EventKind, RobotId | None]]()
    for seed in range(1000, 1300):
        fouls += taken(scenario, seed)
    with capsys.disabled():
        print(f"\n300 free kicks: {dict(fouls)}")
    assert not fouls
