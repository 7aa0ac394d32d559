from __future__ import annotations

import numpy as np
import pytest

from robobt.learning.agents.nstep import NStep

GAMMA = 0.9
ENVS = 4


def episodes(seed, steps=60):
    """Random interleaved episodes: arrays (steps, envs) that hold what happened."""
    rng = np.random.default_rng(seed)
    ends = rng.random((steps, ENVS))
    return {
        "reward": rng.normal(size=(steps, ENVS)),
        "terminated": ends < 0.12,
        "truncated": (ends >= 0.12) & (ends < 0.25),
        "action": rng.normal(size=(steps, ENVS, 1)),
    }


def observation(t, env, reset=False):
    return np.array([t + 1000.0 * env, float(reset)])


def brute_force(run, t, env, n):
    """Return, discount and bootstrap observation of the transition that begins at step t."""
    total = 0.0
    for k in range(n):
        if t + k == len(run["reward"]):
            return total, GAMMA**k, observation(t + k, env)
        total += GAMMA**k * run["reward"][t + k, env]
        if run["terminated"][t + k, env]:
            return total, 0.0, observation(t + k + 1, env)
        if run["truncated"][t + k, env]:
            return total, GAMMA ** (k + 1), observation(t + k + 1, env)
    return total, GAMMA**n, observation(t + n, env)


def collect(run, horizons):
    steps = NStep(horizons, GAMMA, ENVS, 2, 1)
    rows = []
    now = np.array([observation(0, env) for env in range(ENVS)])
    for t in range(len(run["reward"])):
        after = np.array([observation(t + 1, env) for env in range(ENVS)])
        rows += steps.add(
            now, run["action"][t], run["reward"][t], after, run["terminated"][t], run["truncated"][t]
        )
        now = after
    return rows + steps.flush(now)


@pytest.mark.parametrize("horizons", [(1,), (3,), (5,), (4, 1)])
@pytest.mark.parametrize("seed", range(3))
def test_returns_are_those_of_brute_force_over_interleaved_episodes(horizons, seed):
    run = episodes(seed)
    seen = set()
    for parts in collect(run, horizons):
        assert len(parts) == len(horizons)
        for n, part in zip(horizons, parts, strict=True):
            for i in range(len(part.reward)):
                t, env = int(part.observation[i, 0]) % 1000, int(part.observation[i, 0]) // 1000
                seen.add((n, t, env))
                total, discount, next_observation = brute_force(run, t, env, n)
                assert part.action[i, 0] == run["action"][t, env, 0]
                assert part.reward[i] == pytest.approx(total)
                assert part.discount[i] == pytest.approx(discount)
                assert np.array_equal(part.next_observation[i], next_observation)
    assert seen == {(n, t, env) for n in horizons for t in range(60) for env in range(ENVS)}


def test_an_ended_episode_is_followed_by_its_own_last_observation_not_the_next_start():
    steps = NStep([2], GAMMA, 1, 1, 1)
    none, true = np.array([False]), np.array([True])
    steps.add(np.array([[1.0]]), np.zeros((1, 1)), np.ones(1), np.array([[2.0]]), none, none)
    rows = steps.add(np.array([[2.0]]), np.zeros((1, 1)), np.ones(1), np.array([[3.0]]), none, true)
    assert [row[0].next_observation[0, 0] for row in rows] == [3.0, 3.0]
    later = steps.add(np.array([[50.0]]), np.zeros((1, 1)), np.ones(1), np.array([[51.0]]), none, none)
    assert later == []


def test_what_was_handed_out_does_not_change_afterwards():
    steps = NStep([1], GAMMA, 1, 1, 1)
    none = np.array([False])
    observed = np.array([[1.0]])
    row = steps.add(observed, np.zeros((1, 1)), np.ones(1), np.array([[2.0]]), none, none)[0][0]
    observed[:] = 99.0
    steps.add(np.array([[7.0]]), np.ones((1, 1)), np.zeros(1), np.array([[8.0]]), none, none)
    assert row.observation[0, 0] == 1.0
    assert row.reward[0] == 1.0
