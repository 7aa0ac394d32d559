"""Random scenario files mutated from valid ones: played for 20 ticks or refused in one line, never a hang."""

from __future__ import annotations

import random
import signal
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from robobt.config.resources import bundled_scenarios
from robobt.config.yaml import write_yaml
from robobt.match import MatchLoop, ScenarioError, load_scenario
from robobt.worlds import sim_world
from tests.match.scenario.mutation import mutated
from tests.match.scripted import data

pytestmark = pytest.mark.integration

TICKS = 20
HANG = 60
"""Processor time after which a case hangs; but for the first, which compiles, they take hundredths [s]."""


def texts() -> list[str]:
    return [path.read_text() for path in bundled_scenarios().values()] + [write_yaml(data())]


@contextmanager
def no_longer_than(seconds: int) -> Iterator[None]:
    def ring(*_: object) -> None:
        raise AssertionError(f"still busy after {seconds} s of the processor")

    before = signal.signal(signal.SIGPROF, ring)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def outcome(path: Path) -> str:
    """ "played" or "refused"; any other exception is a finding and goes through."""
    try:
        scenario = load_scenario(path)
        result = MatchLoop(scenario.lasting(TICKS * scenario.period), scenario.seed, sim_world).play()
    except ScenarioError as error:
        message = str(error)
        assert message.startswith(str(path)), message
        assert message.isprintable(), message
        assert len(message) <= 600, message
        return "refused"
    assert result.ticks <= TICKS + 1
    broken = [robot.first_error for robot in result.robots.values() if robot.errors]
    assert not broken, broken
    return "played"


def check(cases: range, folder: Path) -> Counter[str]:
    originals, outcomes = texts(), Counter[str]()
    path = folder / "mutated.yaml"
    for case in cases:
        content = mutated(random.Random(case), originals)
        path.write_bytes(content)
        try:
            with no_longer_than(HANG):
                outcomes[outcome(path)] += 1
        except Exception as error:
            raise AssertionError(f"case {case}:\n{content[:3000]!r}") from error
    return outcomes


@pytest.mark.parametrize("block", range(2))
def test_a_mutated_file_is_played_or_refused_in_one_line(block: int, tmp_path: Path):
    outcomes = check(range(50 * block, 50 * block + 50), tmp_path)
    # Both kinds have to come up, or the mutations have stopped testing anything.
    assert min(outcomes["played"], outcomes["refused"]) >= 5


@pytest.mark.slow
def test_ten_thousand_mutated_files(tmp_path: Path):
    outcomes = check(range(1_000_000, 1_010_000), tmp_path)
    assert min(outcomes["played"], outcomes["refused"]) >= 1000
