"""Eleven against eleven for as long as asked: memory and descriptors stay as they are."""

from __future__ import annotations

import os
from pathlib import Path
from time import monotonic

import pytest

from robobt.config.resources import bundled_scenarios
from robobt.config.yaml import parse_marked
from robobt.match import Match
from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.worlds import sim_world

MINUTES = float(os.environ.get("ROBOBT_SOAK", "30"))


def eleven_a_side() -> Scenario:
    def robot(number: int, play: str, x: float, y: float, **more: object) -> dict[str, object]:
        return {"number": number, "play": play, "start": {"position": [x, y]}, **more}

    team = [
        robot(0, "keeper", -5.8, 0.0, goalkeeper=True),
        *[robot(n, "defender", -4.0, 0.8 * n - 2.0, params={"place": n - 1, "size": 4}) for n in range(1, 5)],
        *[robot(n, "field_player", -1.0, 1.2 * n - 9.0) for n in range(5, 11)],
    ]
    data = parse_marked(bundled_scenarios()["six_v_six"].read_text(), "six_v_six").plain()
    assert isinstance(data, dict)
    data |= {"field": "division_a", "robots": {"blue": team, "yellow": team}, "ends": {"time_limit": 60}}
    return scenario_from(data, "eleven_a_side")


def held() -> tuple[float, int]:
    """Resident memory of this process [MB], and how many descriptors it has open."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6, len(list(Path("/proc/self/fd").iterdir()))


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory is read from /proc")
def test_recorded_matches_for_half_an_hour_hold_no_more_than_one(tmp_path: Path) -> None:
    """``ROBOBT_SOAK`` says another number of minutes."""
    scenario, end = eleven_a_side(), monotonic() + 60.0 * MINUTES
    matches: list[tuple[float, int]] = []
    while len(matches) < 3 or monotonic() < end:
        record = tmp_path / "soak.robobt.arrows"
        Match(scenario, len(matches), sim_world, record).play()
        record.unlink()
        matches.append(held())
        memory, descriptors = matches[-1]
        print(f"match {len(matches)}: {memory:.0f} MB, {descriptors} descriptors")
    # The first has compiled, imported and filled every cache.
    assert matches[-1][0] < 1.1 * matches[1][0]
    assert matches[-1][1] == matches[1][1]
