"""``import robobt`` gives the names of a first session, and costs nothing."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import robobt
from robobt.match import MatchResult
from tests.match.scripted import PlainWorld

STUB = Path(robobt.__file__).with_suffix(".pyi")


def test_the_stub_declares_each_name_from_the_place_it_is_taken_from() -> None:
    declared = {
        alias.name: node.module
        for node in ast.parse(STUB.read_text()).body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert declared == {name: f"robobt.{home}" for name, home in robobt._HOMES.items()}


@pytest.mark.parametrize("name", robobt.__all__)
def test_a_public_name_can_be_used(name: str) -> None:
    assert getattr(robobt, name) is not None
    assert name in dir(robobt)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'play_mach'"):
        robobt.play_mach  # type: ignore[attr-defined]  # noqa: B018


def test_importing_it_imports_nothing_heavy() -> None:
    code = "import robobt, sys; print({'numpy', 'torch', 'pydantic', 'numba', 'pymunk'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"


@pytest.mark.integration
def test_a_match_without_a_learned_skill_needs_no_torch() -> None:
    code = (
        "import sys; sys.modules['torch'] = None; import robobt\n"
        "print(robobt.play_match(robobt.load_scenario('table4_trial1_own').lasting(0.1)).ticks)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(done.stdout) > 1


def test_trials_are_played_in_the_simulator_unless_another_world_is_given() -> None:
    scenario = robobt.load_scenario("table4_trial1_own").lasting(0.5)
    run = robobt.run_trials(scenario, 2, seed=3)
    assert [result.trial for result in run.results] == [0, 1]
    assert (
        run.summary().trace == robobt.run_trials(scenario, 2, seed=3, world=robobt.sim_world).summary().trace
    )
    assert run.summary().trace != robobt.run_trials(scenario, 2, seed=3, world=PlainWorld).summary().trace


def test_a_match_has_the_scenarios_seed_unless_another_is_given() -> None:
    scenario = robobt.load_scenario("table4_trial1_own").lasting(0.2)
    result = robobt.play_match(scenario)
    assert isinstance(result, MatchResult)
    assert result.seed == scenario.seed
    assert robobt.play_match(scenario, 5).seed == 5


def test_a_world_may_be_an_address() -> None:
    scenario = robobt.load_scenario("striker_vs_goalie")
    with pytest.raises(ValueError, match="league://nobody"):
        robobt.run_trials(scenario, 1, world="league://nobody")
