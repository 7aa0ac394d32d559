"""A tournament whose driver is killed at any moment is taken up again, and nothing is played twice."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from robobt.tournament.played import MAY_DIFFER, PlayedMatch
from robobt.tournament.store import MatchStore, StoreError

KILLS = 10
COMMAND = [
    *("tournament", "take_shot", "attack_main", "attack_nn", "--scenario", "striker_vs_goalkeeper"),
    *("--set", "ends.time_limit=6", "--rounds", "8", "--json", "--record", "worst"),
]


def start(store: Path, workers: int = 2) -> subprocess.Popen[bytes]:
    options = ["--out", str(store), "--workers", str(workers)]
    return subprocess.Popen(
        [sys.executable, "-m", "robobt", *COMMAND, *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


def held(path: Path) -> list[PlayedMatch]:
    if not path.exists():
        return []
    try:
        with MatchStore(path) as store:
            return store.matches()
    except StoreError:
        # Its driver is about to make it. What it held before would be missed.
        return []


def same(matches: list[PlayedMatch]) -> list[dict[str, Any]]:
    return [
        {name: value for name, value in match.row().items() if name not in MAY_DIFFER} for match in matches
    ]


@pytest.mark.slow
def test_a_driver_killed_ten_times_leaves_the_store_of_an_unbroken_run(tmp_path: Path) -> None:
    whole, broken = tmp_path / "whole.sqlite", tmp_path / "broken.sqlite"
    assert start(whole).wait() == 0
    rng, kills, grew = random.Random(4), 0, 0
    while kills < KILLS:
        before = held(broken)
        driver = start(broken)
        # By what it has played, as nobody knows how fast that is; then at any moment.
        more = rng.randint(1, 2)
        while driver.poll() is None and len(held(broken)) < len(before) + more:
            time.sleep(0.05)
        time.sleep(rng.uniform(0.0, 0.5))
        kills += driver.poll() is None
        driver.send_signal(signal.SIGKILL)
        driver.wait()
        after = held(broken)
        kept = {match.fixture: match for match in after}
        assert all(kept[match.fixture] == match for match in before)
        grew += len(after) > len(before)
        assert len(after) < len(held(whole)), "killed too late to prove anything: give it more rounds"
    assert start(broken).wait() == 0
    assert same(held(broken)) == same(held(whole))
    folders = [tmp_path / f"{which}.recordings" for which in ("whole", "broken")]
    names = [{path.name for path in folder.iterdir()} for folder in folders]
    assert names[0] == names[1]
    print(f"{len(held(whole))} matches; {grew} of {KILLS} drivers had added some before they were killed")


@pytest.mark.slow
def test_two_drivers_share_one_store(tmp_path: Path) -> None:
    alone, shared = tmp_path / "alone.sqlite", tmp_path / "shared.sqlite"
    assert start(alone).wait() == 0
    drivers = [start(shared, 1), start(shared, 1)]
    assert [driver.wait() for driver in drivers] == [0, 0]
    assert same(held(shared)) == same(held(alone))
