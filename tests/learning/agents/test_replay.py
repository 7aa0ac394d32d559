from __future__ import annotations

import numpy as np
import pytest

from robobt.learning.agents.nstep import Transitions
from robobt.learning.agents.replay import PrioritisedReplay, ReplayBuffer, SumTree


def rows(first, count):
    """Transitions whose every entry tells which they are."""
    n = np.arange(first, first + count, dtype=np.float64)
    return Transitions(n[:, None] + [0.0, 0.25], -n[:, None], 10 * n, n / 1000, n[:, None] + [0.5, 0.75])


def held(replay):
    """The numbers of the transitions in a replay."""
    batch = replay.gather(np.arange(len(replay)), None)
    numbers = batch.observation[:, 0].numpy()
    assert np.array_equal(batch.action[:, 0].numpy(), -numbers)
    assert np.array_equal(batch.bootstraps[0].reward.numpy(), 10 * numbers)
    assert np.array_equal(batch.bootstraps[0].next_observation[:, 1].numpy(), numbers + 0.75)
    return sorted(numbers.tolist())


def prioritised(capacity=100, **changes):
    return PrioritisedReplay(
        capacity, 2, 1, **({"alpha": 1.0, "beta": 1.0, "epsilon": 1e-6, "bonus": 0.0} | changes)
    )


def test_the_newest_take_the_place_of_the_oldest():
    replay = ReplayBuffer(10, 2, 1)
    for first in range(0, 28, 4):
        replay.add(rows(first, 4))
    assert len(replay) == 10
    assert held(replay) == list(range(18, 28))


def test_demonstrations_are_never_overwritten():
    replay = ReplayBuffer(10, 2, 1)
    replay.add(rows(0, 4))
    replay.keep()
    for first in range(100, 150, 5):
        replay.add(rows(first, 5))
    assert held(replay) == [0, 1, 2, 3, *range(144, 150)]


def test_a_replay_full_of_kept_transitions_is_refused():
    replay = ReplayBuffer(4, 2, 1)
    replay.add(rows(0, 4))
    with pytest.raises(ValueError, match="no room"):
        replay.keep()


def test_more_at_once_than_there_is_room_for_is_refused():
    with pytest.raises(ValueError, match="room for 3"):
        ReplayBuffer(3, 2, 1).add(rows(0, 4))


def test_a_batch_does_not_change_with_the_replay():
    replay = ReplayBuffer(4, 2, 1)
    replay.add(rows(0, 4))
    batch = replay.gather(np.array([0]), None)
    replay.add(rows(50, 4))
    assert batch.observation[0, 0] == 0.0


def test_every_row_is_drawn_as_often_as_any_other():
    replay = ReplayBuffer(8, 2, 1)
    replay.add(rows(0, 6))
    drawn = np.bincount(replay.sample(60_000, np.random.default_rng(0)).rows, minlength=8)
    assert drawn[6:].sum() == 0
    assert np.abs(drawn[:6] - 10_000).max() < 500


def test_returns_of_two_horizons_stay_apart():
    replay = ReplayBuffer(8, 2, 1, horizons=2)
    near = rows(0, 3)._replace(reward=np.array([7.0, 8.0, 9.0]))
    replay.add(rows(0, 3), near)
    far, close = replay.gather(np.arange(3), None).bootstraps
    assert far.reward.tolist() == [0.0, 10.0, 20.0]
    assert close.reward.tolist() == [7.0, 8.0, 9.0]


def test_rows_are_drawn_in_proportion_to_their_priorities_and_weighted_back():
    replay = prioritised()
    replay.add(rows(0, 4))
    replay.update_priorities(np.arange(4), np.array([1.0, 2.0, 3.0, 4.0]))
    batch = replay.sample(50_000, np.random.default_rng(1))
    share = np.bincount(batch.rows, minlength=4) / 50_000
    assert share == pytest.approx([0.1, 0.2, 0.3, 0.4], abs=0.005)
    assert batch.weights is not None
    # With beta 1 every row counts the same in the end.
    total = [float(batch.weights[np.flatnonzero(batch.rows == i)].sum()) for i in range(4)]
    assert total == pytest.approx([total[0]] * 4, rel=0.05)
    assert float(batch.weights.max()) == 1.0


def test_new_rows_are_drawn_before_what_is_known_well():
    replay = prioritised()
    replay.add(rows(0, 50))
    replay.update_priorities(np.arange(50), np.full(50, 1e-4))
    replay.add(rows(50, 2))
    drawn = replay.sample(64, np.random.default_rng(2)).rows
    assert (drawn >= 50).mean() > 0.9


def test_demonstrations_have_a_bonus():
    replay = prioritised(bonus=1.0)
    replay.add(rows(0, 2))
    replay.keep()
    replay.add(rows(2, 2))
    replay.update_priorities(np.arange(4), np.full(4, 0.25))
    share = np.bincount(replay.sample(30_000, np.random.default_rng(3)).rows, minlength=4) / 30_000
    assert share == pytest.approx([5 / 12, 5 / 12, 1 / 12, 1 / 12], abs=0.01)


@pytest.mark.parametrize("make", [lambda: ReplayBuffer(10, 2, 1), prioritised])
def test_a_restored_replay_goes_on_as_the_one_it_was(make):
    replay, again = make(), make()
    replay.add(rows(0, 4))
    replay.keep()
    for first in range(10, 25, 5):
        replay.add(rows(first, 5))
    if isinstance(replay, PrioritisedReplay):
        replay.update_priorities(np.array([1, 1, 3]), np.array([5.0, 5.0, 0.3]))
    again.restore(replay.state())
    for each in (replay, again):
        each.add(rows(70, 3))
    assert held(again) == held(replay)
    first, second = [each.sample(32, np.random.default_rng(5)).rows for each in (replay, again)]
    assert np.array_equal(first, second)


@pytest.mark.parametrize("capacity", [1, 2, 3, 7, 64, 1000])
def test_the_sum_tree_adds_up_and_never_draws_what_has_no_priority(capacity):
    rng = np.random.default_rng(capacity)
    tree = SumTree(capacity)
    known = np.zeros(capacity)
    for _ in range(20):
        items = rng.integers(0, capacity, 5)
        tree.set(items, (items * 0.7) % 3)
        known[items] = (items * 0.7) % 3
        assert tree.total == pytest.approx(known.sum())
        if known.sum() > 0:
            assert (known[tree.sample(50, rng)] > 0).all()
    assert np.array_equal(tree[np.arange(capacity)], known)
