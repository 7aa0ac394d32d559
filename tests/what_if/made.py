"""Small matches to branch from, played once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.worlds import play_match

SEED = 5


def small_match(seconds: float, **changes: Any) -> Scenario:
    """Two field players and a goalkeeper a side; blue has the ball in the other half, and play goes on."""

    def robots(ahead: float) -> list[dict[str, Any]]:
        return [
            {"number": 0, "play": "team_goalkeeper", "goalkeeper": True, "start": {"position": [-4.3, 0.0]}},
            {"number": 1, "play": "team_player", "start": {"position": [ahead, 0.6], "heading": 0.0}},
            {"number": 2, "play": "team_player", "start": {"position": [ahead - 1.0, -0.8], "heading": 0.0}},
        ]

    data = {
        "name": "small",
        "field": "division_b",
        "period": 1 / 60,
        "robots": {"blue": robots(1.2), "yellow": robots(-2.5)},
        "ball": {"position": [1.6, 0.6]},
        "referee": {"opening": "force_start"},
        "ends": {"time_limit": seconds},
        **changes,
    }
    return scenario_from(data, "small.yaml")


def recorded(folder: Path, seconds: float = 6.0, **changes: Any) -> Path:
    """Record such a match and return where."""
    path = folder / "small.robobt.arrows"
    play_match(small_match(seconds, **changes), SEED, record=path)
    return path
