"""Teams play on a blind field with what they identified of it, not with what it is."""

from __future__ import annotations

import pytest

from benchmarks.blind.field import draw_field
from benchmarks.blind_team import _summed, _world
from robobt.match.scenario.scenario import load_scenario
from robobt.sim.settings import settings_from
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import RobotId

BLUE, YELLOW = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)


def test_both_teams_see_what_they_identified() -> None:
    believed = {
        team: settings_from(
            {
                "limits": {"max_speed": speed},
                "ball": {"slide_deceleration": slide},
                "realism": {"vision_delay": 0.1},
            }
        )
        for team, speed, slide in ((Team.BLUE, 1.5, 2.0), (Team.YELLOW, 1.6, 2.5))
    }
    world = _world(load_scenario("striker_vs_goalkeeper"), draw_field(3), believed)
    world.reset(Placement({BLUE: (0.0, 0.0, 0.0), YELLOW: (1.0, 0.0, 0.0)}, (2.0, 0.0, 0.0, 0.0)), 1)
    seen = world.observe()
    for team, own, theirs in ((Team.BLUE, 1.5, 1.6), (Team.YELLOW, 1.6, 1.5)):
        frame = seen.seen_by(team)
        assert frame.own[0].limits.max_speed == own
        assert frame.opponents[0].limits.max_speed == theirs
        assert frame.ball_model.slide_deceleration == 2.0


def test_a_lead_is_the_mean_of_the_matches() -> None:
    found = _summed([(3, 1), (0, 1), (2, 0)])
    assert found["lead"] == pytest.approx(1.0)
    assert found["low"] < 1.0 < found["high"]
