"""Matches on a cluster are the same as anywhere, also when a node is lost; left out without Ray."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robobt.engines.cluster import RayEngine
from robobt.engines.run import running_on
from robobt.match import MatchResult, load_scenario, run_trials_in
from robobt.tournament.play import play_tournament
from robobt.tournament.played import MAY_DIFFER
from robobt.worlds import sim_world
from tests.campaign import count
from tests.tournament.made_up import plan

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]


@pytest.fixture
def cluster() -> Iterator[Any]:
    """Three nodes of one core each."""
    ray = pytest.importorskip("ray", reason="needs Ray: pip install 'robobt[ray]'")
    from ray.cluster_utils import Cluster

    nodes = Cluster(initialize_head=True, head_node_args={"num_cpus": 1})
    for _ in range(2):
        nodes.add_node(num_cpus=1)
    ray.init(address=nodes.address, logging_level="ERROR")
    nodes.wait_for_nodes()
    yield nodes
    ray.shutdown()
    nodes.shutdown()


def figures(results: list[MatchResult]) -> list[dict[str, Any]]:
    return [{**result.to_json(), "wall_time": None} for result in results]


def test_trials_are_the_same_on_one_machine_on_ray_and_with_a_lost_node(cluster: Any) -> None:
    scenario, trials = load_scenario("striker_vs_goalkeeper").lasting(10.0), count(200)
    local = run_trials_in(scenario, sim_world, trials, 2)
    with RayEngine("ray") as engine, running_on(engine):
        assert engine.workers == 3
        two = run_trials_in(scenario, sim_world, trials, 2)
        told: list[int] = []

        def lose_a_node(result: MatchResult) -> None:
            told.append(result.trial)
            if len(told) == trials // 2:
                cluster.remove_node(cluster.list_all_nodes()[1], allow_graceful=False)

        three = run_trials_in(scenario, sim_world, trials, 3, on_result=lose_a_node)
    assert len(cluster.list_all_nodes()) == 2
    assert sorted(told) == list(range(trials))
    assert figures(two.results) == figures(three.results) == figures(local.results)


def test_a_tournament_is_the_same_on_ray(cluster: Any, tmp_path: Path) -> None:
    stores = []
    for name in ("local", "ray"):
        with RayEngine("ray") as engine, plan(2).open_store(tmp_path / name) as store:
            if name == "ray":
                with running_on(engine):
                    played = play_tournament(plan(2), store, 3)
            else:
                played = play_tournament(plan(2), store, 2)
        rows = [match.row() for match in played.matches]
        stores.append([{key: row[key] for key in row if key not in MAY_DIFFER} for row in rows])
    assert stores[0] == stores[1]
    assert len(stores[0]) == 12
