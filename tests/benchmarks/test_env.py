"""The measurement of the environments prints what it says it does."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from benchmarks.__main__ import application

pytestmark = pytest.mark.integration


def test_bench_env_measures_every_environment() -> None:
    result = CliRunner().invoke(application("env"), ["env", "--seconds", "0.1", "--json"])
    assert result.exit_code == 0
    figures = json.loads(result.stdout)
    ends = ("single", "vector_64", "vector", "gymnasium", "physics_share")
    tasks = ("go_to_ball", "shoot", "score", "small3v3")
    assert set(figures) == {f"{task}_{end}" for task in tasks for end in ends}
    assert all(figure > 0 for figure in figures.values())
    assert figures["go_to_ball_vector"] > figures["go_to_ball_single"]
