"""Eleven against eleven for as long as asked: memory and descriptors stay as they are."""

from __future__ import annotations

import os
from pathlib import Path
from time import monotonic

import pytest

from robobt.match import MatchLoop, load_scenario
from robobt.worlds import sim_world

MINUTES = float(os.environ.get("ROBOBT_SOAK", "30"))
LENGTH = 60.0
"""Of a match [s]."""


def held() -> tuple[float, int]:
    """Resident memory of this process [MB], and how many descriptors it has open."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6, len(list(Path("/proc/self/fd").iterdir()))


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory is read from /proc")
def test_recorded_matches_for_half_an_hour_hold_no_more_than_one(tmp_path: Path) -> None:
    """``ROBOBT_SOAK=60 pytest -m slow -s tests/match/test_soak.py`` goes on for an hour, a line a match."""
    scenario, end = load_scenario("eleven_v_eleven").lasting(LENGTH), monotonic() + 60.0 * MINUTES
    matches: list[tuple[float, int]] = []
    while len(matches) < 3 or monotonic() < end:
        record = tmp_path / "soak.robobt.arrows"
        MatchLoop(scenario, len(matches), sim_world, record).play()
        record.unlink()
        matches.append(held())
        memory, descriptors = matches[-1]
        simulated = len(matches) * LENGTH / 60.0
        print(f"after {simulated:.0f} min of play: {memory:.0f} MB, {descriptors} descriptors")
    # The first has compiled, imported and filled every cache.
    assert matches[-1][0] < 1.1 * matches[1][0]
    assert matches[-1][1] == matches[1][1]
