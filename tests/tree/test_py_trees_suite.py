"""py_trees' own tests hold when the engine ticks their trees."""

from __future__ import annotations

import pytest

from tests.tree.py_trees_suite import UnavailableError, _read, run_suite


@pytest.mark.slow
def test_every_test_of_py_trees_that_ticks_a_tree_passes_through_the_engine() -> None:
    try:
        outcome = run_suite()
    except UnavailableError as error:
        pytest.skip(f"py_trees' source distribution cannot be had here: {error}")
    assert outcome.failed == 0, outcome.output
    assert outcome.passed == 216
    # 107 of the 216 tick a tree; the others are about blackboards, ports, parsers and drawings.
    assert (outcome.ticking, outcome.through, outcome.past) == (107, 107, 0)


def test_the_counts_are_read_from_what_pytest_says() -> None:
    said = "....F\nthrough=3\npast=1\nticking=4\n=== 1 failed, 4 passed, 2 errors in 0.1s ==="
    outcome = _read(said)
    assert (outcome.passed, outcome.failed) == (4, 3)
    assert (outcome.through, outcome.past, outcome.ticking) == (3, 1, 4)
    with pytest.raises(RuntimeError, match="did not run:\nno module"):
        _read("no module named py_trees")
