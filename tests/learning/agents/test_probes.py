"""Problems whose values are known by hand: each catches a fault of its own."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from robobt.learning.agents.nstep import NStep, Transitions
from tests.learning.tiny import learn, small_agent

pytestmark = pytest.mark.integration

ROWS = 512
ATOMS = {"num_atoms": 41, "v_min": -12.0, "v_max": 12.0}


def value(agent, observation, action):
    with torch.no_grad():
        given = torch.tensor([observation], dtype=torch.float32), torch.tensor([action], dtype=torch.float32)
        output = agent.critic.first(*given)
        mean = output[:, 0] if agent._atoms is None else agent._atoms.mean(output)
    return float(mean[0])


def act(agent, observation):
    with torch.no_grad():
        return agent.actor(torch.tensor([observation], dtype=torch.float32))[0].tolist()


def made(observation, action, reward, discount, next_observation):
    return Transitions(
        *[
            np.asarray(part, dtype=np.float64)
            for part in (observation, action, reward, discount, next_observation)
        ]
    )


def test_the_value_depends_on_the_observation():
    rng = np.random.default_rng(2)
    sign = rng.choice([-1.0, 1.0], (ROWS, 1))
    agent = small_agent(1, 1)
    learn(agent, made(sign, rng.uniform(-1, 1, (ROWS, 1)), sign[:, 0], np.zeros(ROWS), sign), 250)
    assert value(agent, [1.0], [0.0]) == pytest.approx(1.0, abs=0.1)
    assert value(agent, [-1.0], [0.0]) == pytest.approx(-1.0, abs=0.1)


@pytest.mark.parametrize(
    "switches",
    [{}, {"twin_critics": True}, ATOMS, {"layer_norm": True}, {"target_update_interval": 20, "tau": 1.0}],
    ids=str,
)
def test_a_reward_that_ends_the_episode_is_worth_itself_and_a_step_before_it_is_discounted_once(switches):
    rng = np.random.default_rng(3)
    first = rng.random((ROWS, 1)) < 0.5
    observation = np.where(first, 0.0, 1.0)
    reward = np.where(first, 0.0, 1.0)[:, 0]
    discount = np.where(first, 0.9, 0.0)[:, 0]
    agent = small_agent(1, 1, **switches)
    learn(agent, made(observation, rng.uniform(-1, 1, (ROWS, 1)), reward, discount, np.ones((ROWS, 1))), 400)
    assert value(agent, [1.0], [0.0]) == pytest.approx(1.0, abs=0.1)
    assert value(agent, [0.0], [0.0]) == pytest.approx(0.9, abs=0.1)


@pytest.mark.parametrize(
    "switches",
    [
        {},
        pytest.param(
            {"twin_critics": True, "policy_delay": 2, "target_policy_noise": 0.1}, marks=pytest.mark.slow
        ),
        pytest.param({"num_atoms": 101, "v_min": -3.0, "v_max": 1.0}, marks=pytest.mark.slow),
    ],
    ids=str,
)
def test_the_actor_finds_the_action_with_the_largest_reward(switches):
    rng = np.random.default_rng(4)
    action = rng.uniform(-1, 1, (ROWS, 2))
    reward = -np.square(action - [0.5, -0.3]).sum(1)
    zeros = np.zeros((ROWS, 1))
    agent = small_agent(1, 2, **switches)
    learn(agent, made(zeros, action, reward, np.zeros(ROWS), zeros), 800)
    assert act(agent, [0.0]) == pytest.approx([0.5, -0.3], abs=0.15)


def test_the_best_action_depends_on_the_observation():
    rng = np.random.default_rng(5)
    observation, action = rng.uniform(-1, 1, (ROWS, 1)), rng.uniform(-1, 1, (ROWS, 1))
    reward = -np.square(action - 0.7 * observation)[:, 0]
    agent = small_agent(1, 1)
    learn(agent, made(observation, action, reward, np.zeros(ROWS), observation), 600)
    for seen in (-0.8, 0.0, 0.8):
        assert act(agent, [seen]) == pytest.approx([0.7 * seen], abs=0.12)


@pytest.mark.parametrize("n", [1, 3])
@pytest.mark.parametrize(("truncated", "worth"), [(True, 10.0), (False, 1.0)])
def test_a_time_limit_is_bootstrapped_and_an_end_is_not(n, truncated, worth):
    envs, rng = 64, np.random.default_rng(6)
    steps = NStep([n], 0.9, envs, 1, 1)
    zeros, every, none = np.zeros((envs, 1)), np.ones(envs, dtype=np.bool_), np.zeros(envs, dtype=np.bool_)
    rows = []
    for _ in range(8):
        ends = (none, every) if truncated else (every, none)
        rows += steps.add(zeros, rng.uniform(-1, 1, (envs, 1)), np.ones(envs), zeros, *ends)
    agent = small_agent(1, 1, tau=0.3)
    joined = Transitions(*[np.concatenate(part) for part in zip(*[row[0] for row in rows], strict=True)])
    learn(agent, joined, 300)
    assert value(agent, [0.0], [0.0]) == pytest.approx(worth, rel=0.1)


def test_the_actor_of_a_linear_quadratic_problem_costs_what_riccati_says():
    """A double integrator: place and velocity, force as the action; discounted cost x'x + 0.1 u^2."""
    step, gamma = 0.2, 0.8
    a, b = np.array([[1.0, step], [0.0, 1.0]]), np.array([[0.5 * step**2], [step]])
    q, r = np.eye(2), 0.1 * np.eye(1)
    p = q
    for _ in range(500):
        gain = np.linalg.solve(r + gamma * b.T @ p @ b, gamma * b.T @ p @ a)
        p = q + gamma * a.T @ p @ (a - b @ gain)
    rng = np.random.default_rng(7)
    rows = 4096
    state, action = rng.uniform(-0.5, 0.5, (rows, 2)), rng.uniform(-1, 1, (rows, 1))
    next_observation = state @ a.T + action @ b.T
    reward = -np.square(state).sum(1) - 0.1 * np.square(action)[:, 0]
    agent = small_agent(2, 1, actor_learning_rate=3e-3, critic_learning_rate=3e-3)
    learn(
        agent,
        made(state, action, reward, np.full(rows, gamma), next_observation),
        1000,
        batch=128,
        decay=True,
    )
    x = rng.uniform(-0.35, 0.35, (200, 2))
    best = np.einsum("ni,ij,nj->n", x, p, x).mean()
    cost, discount = np.zeros(200), 1.0
    for _ in range(100):
        with torch.no_grad():
            u = agent.actor(torch.from_numpy(x.astype(np.float32))).numpy().astype(np.float64)
        cost += discount * (np.square(x).sum(1) + 0.1 * np.square(u)[:, 0])
        x = x @ a.T + u @ b.T
        discount *= gamma
    assert best <= cost.mean() * 1.001
    assert cost.mean() <= 1.05 * best
