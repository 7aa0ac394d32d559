"""The aids on random trees and mutated files: they always come to an end, and never spoil a tree."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import py_trees
import pytest

from robobt.tree import Behaviour, Status, TreeRunner, bind, node_path, preorder
from robobt.tree.devtools import NodeStatistics, ScriptedLeaf, lint_tree, read_substitutions, substitute
from robobt.tree.interop import TreeFileError
from tests.match.scenario.mutation import mutated
from tests.tree.random_trees import random_tree

STATUSES = (Status.SUCCESS, Status.FAILURE, Status.RUNNING)

RULES = [
    '"*/HasBall": SUCCESS\n"field player/*/KickToTarget": [RUNNING, RUNNING, FAILURE]\n',
    '"*/HasBall": {script: [FAILURE, SUCCESS]}\n"?[a-c]*": {status: RUNNING}\n"[!x]": FAILURE\n',
]


@pytest.fixture(autouse=True)
def _quiet_and_clean(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr("py_trees.decorators.time.monotonic", lambda: 1000.0)
    monkeypatch.setattr("py_trees.logging.Logger.error", lambda *_: None)
    yield
    py_trees.blackboard.Blackboard.clear()


class Clock:
    """A store that has nothing but the time."""

    time = 0.0


def shape(root: Behaviour) -> list[tuple[str, str]]:
    return [(node_path(node), type(node).__name__) for node in preorder(root)]


@pytest.mark.integration
@pytest.mark.parametrize("block", range(3))
def test_random_trees_with_substitutes_are_ticked_as_py_trees_ticks_them(block: int) -> None:
    ticked = sum(_live_the_same_life(seed) for seed in range(100 * block, 100 * (block + 1)))
    assert ticked > 30


def _live_the_same_life(seed: int) -> bool:
    """Tick two copies of a tree with substitutes; False where the rules left one of them no node."""
    rng = random.Random(seed)
    recipe = random_tree(rng, "n")
    trees = [recipe([], f"{word}{seed}") for word in "ab"]
    nodes = preorder(trees[0])
    rules = {
        rng.choice((node_path(node), f"*{node.name}")): [
            rng.choice(STATUSES) for _ in range(rng.randint(1, 3))
        ]
        for node in rng.sample(nodes, min(3, len(nodes)))
    }
    try:
        stock, fast = [substitute(tree, rules) for tree in trees]
    except TreeFileError:
        return False
    assert shape(stock) == shape(fast)
    assert any(isinstance(node, ScriptedLeaf) for node in preorder(fast))
    assert all(child.parent is node for node in preorder(fast) for child in node.children)
    clock = Clock()
    bind(stock, clock)
    runner = TreeRunner(fast, clock)
    for _ in range(20):
        clock.time = round(clock.time + 0.1, 9)
        raised = _tick(stock)
        runner.tick()
        assert (runner.error is not None) == raised, seed
        if raised:
            break
        assert [node.status for node in preorder(stock)] == [node.status for node in preorder(fast)], seed
    return True


def _tick(root: Behaviour) -> bool:
    """Tick by py_trees; whether a node raised."""
    try:
        for _ in root.tick():
            pass
    except Exception:
        return True
    return False


def test_the_linter_only_looks_and_names_nodes_of_the_tree() -> None:
    for seed in range(300, 500):
        root = random_tree(random.Random(seed), "n")([], f"c{seed}")
        before = shape(root)
        found = lint_tree(root)
        assert shape(root) == before, seed
        assert all(node.status is Status.INVALID for node in preorder(root)), seed
        assert {finding.path for finding in found} <= {path for path, _ in before}, seed
        assert found == lint_tree(root), seed


@pytest.mark.integration
def test_statistics_add_up_whatever_the_tree() -> None:
    for seed in range(500, 600):
        runner = TreeRunner(random_tree(random.Random(seed), "n")([], f"d{seed}"), Clock())
        statistics = NodeStatistics(runner.root)
        runner.show_to(statistics)
        clean = 0
        for _ in range(20):
            runner.tick()
            clean += runner.error is None
        root, *_ = counts = statistics.counts()
        assert root.ticks == clean, seed
        for one in counts:
            assert one.successes + one.failures + one.runs <= one.ticks, seed
            assert one.transitions <= one.ticks, seed
            assert 0.0 <= one.own_time <= one.time + 1e-9, seed
        assert len(statistics.as_table().splitlines()) == 1 + len(counts), seed


@pytest.mark.integration
def test_mutated_files_of_rules_are_rules_or_one_clear_error(tmp_path: Path) -> None:
    _mutate_rules(tmp_path, range(300))


@pytest.mark.slow
def test_many_mutated_files_of_rules_are_rules_or_one_clear_error(tmp_path: Path) -> None:
    _mutate_rules(tmp_path, range(300, 10_000))


def _mutate_rules(folder: Path, seeds: range) -> None:
    file = folder / "rules.yaml"
    sound = 0
    for seed in seeds:
        file.write_bytes(mutated(random.Random(seed), RULES))
        said = None
        try:
            rules = read_substitutions(file)
        except TreeFileError as error:
            said = str(error)
        if said is None:
            sound += 1
            assert all(rule.script for rule in rules), seed
        else:
            assert said.startswith(f"{file}:"), seed
            assert "\n" not in said, seed
    assert len(seeds) // 20 < sound < len(seeds)
