"""PPO computes what its equations say, and learns."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from torch.distributions import Bernoulli, Normal

from robobt.learning.agents.networks import policy_of
from robobt.learning.agents.ppo import PPO
from robobt.learning.agents.rollout import Rollout, advantages
from robobt.learning.agents.settings import PPOSettings

GAMMA, LAMBDA = 0.9, 0.8


def agent(seed: int = 0, **settings) -> PPO:
    return PPO(PPOSettings(hidden_sizes=(16,), **settings), (1.0, 2.0), (True, False), seed)


def random_rollout(ticks: int, n: int, seed: int = 0) -> Rollout:
    rng = np.random.default_rng(seed)
    rollout = Rollout.empty(ticks, n, 2, 2)
    for name in ("observation", "action", "value", "next_value", "reward"):
        getattr(rollout, name)[:] = rng.normal(size=getattr(rollout, name).shape)
    rollout.terminated[:] = rng.random((ticks, n)) < 0.15
    rollout.ended[:] = rollout.terminated | (rng.random((ticks, n)) < 0.15)
    return rollout


def test_advantages_are_the_sum_of_discounted_errors_to_the_episodes_end():
    rollout = random_rollout(12, 5)
    found = advantages(rollout, GAMMA, LAMBDA)
    for arena in range(5):
        for first in range(12):
            total, weight = 0.0, 1.0
            for t in range(first, 12):
                bootstrap = 0.0 if rollout.terminated[t, arena] else GAMMA * rollout.next_value[t, arena]
                total += weight * (rollout.reward[t, arena] + bootstrap - rollout.value[t, arena])
                weight *= GAMMA * LAMBDA
                if rollout.ended[t, arena]:
                    break
            assert found[first, arena] == pytest.approx(total)


def test_with_a_lambda_of_one_they_are_the_return_less_the_value():
    rollout = random_rollout(8, 3)
    rollout.ended[:] = rollout.terminated[:] = False
    rollout.next_value[:-1] = rollout.value[1:]
    powers = GAMMA ** np.arange(8)
    returns = powers @ rollout.reward + GAMMA**8 * rollout.next_value[-1]
    np.testing.assert_allclose(advantages(rollout, GAMMA, 1.0)[0], returns - rollout.value[0])


def test_actions_are_weighed_as_a_normal_and_a_coin_are():
    it = agent(init_std=0.7)
    with torch.no_grad():
        it.actor.body[-1].weight.mul_(100.0)
    seen = np.random.default_rng(1).normal(size=(50, 2))
    action = it.act(seen, np.random.default_rng(2))
    assert set(action[:, 1]) == {-1.0, 1.0}
    with torch.no_grad():
        output = it.actor.body(torch.from_numpy(seen.astype(np.float32)) * it.actor.inverse_scale)
        taken = torch.from_numpy(action.astype(np.float32))
        normal, coin = Normal(torch.tanh(output[:, 0]), 0.7), Bernoulli(logits=output[:, 1])
        expected = normal.log_prob(taken[:, 0]) + coin.log_prob((taken[:, 1] > 0).float())
    np.testing.assert_allclose(it.log_probabilities(seen, action), expected.numpy(), atol=1e-5)


def test_the_drawn_actions_have_the_spread_and_the_odds_that_were_asked_for():
    it = agent(init_std=0.5, threshold_bias=-1.5)
    action = it.act(np.zeros((4000, 2)), np.random.default_rng(3))
    assert action[:, 0].std() == pytest.approx(0.5, rel=0.05)
    assert (action[:, 1] > 0).mean() == pytest.approx(1 / (1 + np.exp(1.5)), abs=0.02)


def weighed(it: PPO, seen: torch.Tensor, action: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Log-probability and entropy by torch's distributions, with gradients."""
    output = it._policy_output(seen)
    normal, coin = Normal(output[:, 0], it._log_std.exp()), Bernoulli(logits=output[:, 1])
    log_probability = normal.log_prob(action[:, 0]) + coin.log_prob((action[:, 1] > 0).float())
    return log_probability, normal.entropy() + coin.entropy()


@pytest.mark.parametrize("imitation", [0.0, 0.3])
@pytest.mark.parametrize("rows", [64, 700])
def test_a_step_follows_the_gradient_of_the_clipped_objective(rows: int, imitation: float):
    it = agent(max_grad_norm=100.0, ent_coef=0.05, init_std=0.7)
    with torch.no_grad():
        it.actor.body[-1].weight.mul_(100.0)
    rng = np.random.default_rng(4)
    seen = rng.normal(size=(rows, 2))
    action = it.act(seen, rng)
    old = it.log_probabilities(seen, action) + rng.normal(0.0, 0.3, rows)
    advantage, shown = rng.normal(size=rows), rng.uniform(-1.0, 1.0, (rows, 2))
    tensors = [torch.from_numpy(x.astype(np.float32)) for x in (seen, action, old, advantage, shown)]
    now, entropy = weighed(it, tensors[0], tensors[1])
    standard = (tensors[3] - tensors[3].mean()) / (tensors[3].std() + 1e-8)
    ratio = (now - tensors[2]).exp()
    assert ((ratio > 1.2) & (standard > 0.0)).any()
    assert ((ratio < 0.8) & (standard < 0.0)).any()
    gain = torch.minimum(ratio * standard, ratio.clamp(0.8, 1.2) * standard).mean()
    output, wanted = it._policy_output(tensors[0]), tensors[4]
    missed = (output - wanted)[:, 0].square() - Bernoulli(logits=output[:, 1]).log_prob(
        (wanted[:, 1] > 0).float()
    )
    loss = -gain - 0.05 * entropy.mean() + imitation * missed.mean()
    expected = torch.autograd.grad(loss, it._actor_adam.weights)
    done, weighed_old, gains, taught = (x.numpy().T.copy() for x in tensors[1:])
    it._update_policy(tensors[0], done, weighed_old, gains, False, (taught, imitation) if imitation else None)
    # After one step the first moment is a tenth of the gradient.
    for found, wanted in zip(it._actor_adam.moments["exp_avg"], expected, strict=True):
        torch.testing.assert_close(10.0 * found, wanted, atol=1e-6, rtol=1e-4)


def test_the_values_step_follows_the_gradient_of_the_squared_error():
    it, rng = agent(max_grad_norm=100.0), np.random.default_rng(4)
    seen, target = (torch.from_numpy(rng.normal(size=size).astype(np.float32)) for size in ((64, 2), 64))
    loss = 0.5 * (it._values(seen) - target).square().mean()
    expected = torch.autograd.grad(loss, it._critic_adam.weights)
    it._update_value(seen, target.numpy())
    for found, wanted in zip(it._critic_adam.moments["exp_avg"], expected, strict=True):
        torch.testing.assert_close(10.0 * found, wanted, atol=1e-6, rtol=1e-4)


def test_what_has_moved_far_enough_is_not_moved_on():
    it = agent(ent_coef=0.0)
    seen, action = np.zeros((4, 2)), np.array([[0.3, -1.0], [-0.3, -1.0]] * 2)
    # All that is good has become likelier by more than the clip allows, all that is bad unlikelier.
    advantage = np.array([1.0, -1.0] * 2, dtype=np.float32)
    old = it.log_probabilities(seen, action).astype(np.float32) - 0.5 * advantage
    it._update_policy(torch.zeros(4, 2), action.T.astype(np.float32), old, advantage)
    assert all((moment == 0.0).all() for moment in it._actor_adam.moments["exp_avg"])


def test_the_diagnostics_of_an_update_are_what_their_names_say():
    it = agent(minibatch_size=64, num_epochs=1, ent_coef=0.0, max_grad_norm=1e-3)
    rng = np.random.default_rng(4)
    rollout = random_rollout(8, 8)
    rollout.action[..., 1] = np.sign(rollout.action[..., 1])
    seen, action = (
        torch.from_numpy(x.reshape(64, 2).astype(np.float32)) for x in (rollout.observation, rollout.action)
    )
    with torch.no_grad():
        now, entropy = weighed(it, seen, action)
        value = it._values(seen)
    shift = torch.linspace(-0.5, 0.5, 64)
    rollout.log_probability[:] = (now - shift).reshape(8, 8).numpy()
    advantage = advantages(rollout, it.settings.gamma, it.settings.gae_lambda)
    target = advantage + rollout.value
    it.update(rollout, rng)
    found = it.diagnostics.means()
    ratio = shift.exp()
    standard = torch.from_numpy((advantage - advantage.mean()) / advantage.std(ddof=1)).reshape(-1)
    gain = torch.minimum(ratio * standard, ratio.clamp(0.8, 1.2) * standard)
    assert found["policy_loss"] == pytest.approx(-float(gain.mean()), abs=1e-5)
    assert found["approx_kl"] == pytest.approx(float((ratio - 1.0 - shift).mean()), abs=1e-5)
    assert found["clip_fraction"] == pytest.approx(float(((ratio - 1.0).abs() > 0.2).float().mean()))
    assert found["entropy"] == pytest.approx(float(entropy.mean()), abs=1e-5)
    assert found["value_loss"] == pytest.approx(((value.numpy() - target.reshape(-1)) ** 2).mean(), rel=1e-4)
    assert found["explained_variance"] == pytest.approx(1.0 - advantage.var() / target.var())
    # They are the norms before clipping.
    assert found["policy_grad_norm"] > 1e-2
    assert found["value_grad_norm"] > 1e-2


def test_it_learns_what_pays_from_rollouts():
    # One decision: drive where the first entry points, kick where the second is above 0.
    it, rng = agent(learning_rate=5e-3, minibatch_size=128, num_epochs=4), np.random.default_rng(5)
    for _ in range(60):
        rollout = Rollout.empty(1, 256, 2, 2)
        rollout.observation[0] = rng.uniform(-1.0, 1.0, (256, 2))
        rollout.action[0] = it.act(rollout.observation[0], rng)
        rollout.log_probability[0] = it.log_probabilities(rollout.observation[0], rollout.action[0])
        rollout.value[0] = it.values(rollout.observation[0])
        seen, done = rollout.observation[0], rollout.action[0]
        rollout.reward[0] = -np.square(done[:, 0] - 0.8 * seen[:, 0]) + np.sign(done[:, 1] * seen[:, 1])
        rollout.terminated[:] = rollout.ended[:] = True
        it.update(rollout, rng)
    seen = rng.uniform(-1.0, 1.0, (500, 2))
    decided = policy_of(it.actor)(seen)
    assert np.abs(decided[:, 0] - 0.8 * seen[:, 0]).mean() < 0.12
    assert ((decided[:, 1] > 0) == (seen[:, 1] > 0)).mean() > 0.93


def test_a_central_value_knows_what_the_policy_does_not():
    # What pays is told to the value alone.
    it, rng = (
        PPO(
            PPOSettings(hidden_sizes=(16,), learning_rate=1e-2, minibatch_size=64), (1.0,), (True,), 0, (1.0,)
        ),
        np.random.default_rng(8),
    )
    for _ in range(40):
        rollout = Rollout.empty(1, 128, 2, 1)
        rollout.observation[0] = rng.uniform(-1.0, 1.0, (128, 2))
        rollout.action[0] = it.act(rollout.observation[0], rng)
        rollout.log_probability[0] = it.log_probabilities(rollout.observation[0], rollout.action[0])
        rollout.value[0] = it.values(rollout.observation[0])
        rollout.reward[0] = rollout.observation[0, :, 1]
        rollout.terminated[:] = rollout.ended[:] = True
        it.update(rollout, rng)
    both = np.array([[0.3, -0.8], [0.3, 0.8]])
    np.testing.assert_allclose(it.values(both), [-0.8, 0.8], atol=0.15)
    assert it.actor.build["scale"] == [1.0]
    first, second = (it.act(both[[k]], np.random.default_rng(9)) for k in range(2))
    np.testing.assert_array_equal(first, second)


def turned(seen: np.ndarray, angle: float, first: tuple[int, ...]) -> np.ndarray:
    """Rows of which the vectors that begin there are turned by an angle."""
    found, (c, s) = seen.copy(), (np.cos(angle), np.sin(angle))
    for k in first:
        found[:, k], found[:, k + 1] = (
            c * seen[:, k] - s * seen[:, k + 1],
            s * seen[:, k] + c * seen[:, k + 1],
        )
    return found


def test_in_the_balls_frame_it_does_in_every_heading_what_it_does_in_one():
    it = PPO(PPOSettings(hidden_sizes=(16,)), (1.0, 1.0, 3.0, 2.0, 2.0), (True,) * 3, 0, vectors=(0, 3))
    with torch.no_grad():
        it.actor.body[-1].weight.mul_(300.0)
    seen = np.random.default_rng(1).normal(size=(200, 5))
    plain = policy_of(it.actor)(seen)
    assert np.hypot(*plain[:, :2].T).max() == pytest.approx(1.0)
    assert np.abs(np.hypot(*plain[:, :2].T) - 1.0).max() > 0.1
    for angle in (0.3, 2.0, -1.2):
        other = turned(seen, angle, (0, 3))
        np.testing.assert_allclose(policy_of(it.actor)(other), turned(plain, angle, (0,)), atol=1e-4)
        np.testing.assert_allclose(it.values(other), it.values(seen), atol=1e-5)


def test_what_it_draws_in_the_balls_frame_is_about_what_it_does_without_noise():
    it = PPO(PPOSettings(hidden_sizes=(16,), init_std=0.5), (1.0,) * 4, (True,) * 3, 0, vectors=(0, 2))
    with torch.no_grad():
        it.actor.body[-1].weight.mul_(300.0)
    seen = np.tile(np.random.default_rng(1).normal(size=(1, 4)), (8000, 1))
    action = it.act(seen, np.random.default_rng(2))
    mean = policy_of(it.actor)(seen[:1])[0]
    np.testing.assert_allclose(action.mean(axis=0), mean, atol=0.03)
    expected = Normal(torch.from_numpy(mean), 0.5).log_prob(torch.from_numpy(action)).sum(-1)
    np.testing.assert_allclose(it.log_probabilities(seen, action), expected.numpy(), atol=1e-4)


@pytest.mark.parametrize(("share", "horizon"), [(0.0, 10.0), (0.5, 30.0), (1.0, 50.0)])
def test_it_looks_farther_ahead_the_longer_it_has_learned(monkeypatch, share, horizon):
    rollout, patient, valued = random_rollout(3, 2), agent(gamma=0.9, final_gamma=0.98, gae_lambda=1.0), []
    monkeypatch.setattr(patient, "_update_value", lambda _, target, report: valued.extend(target.tolist()))
    patient.anneal_gamma(share)
    patient.update(rollout, np.random.default_rng(0), policy="keep")
    expected = advantages(rollout, 1.0 - 1.0 / horizon, 1.0) + rollout.value
    np.testing.assert_allclose(sorted(set(valued)), sorted(expected.ravel()), rtol=1e-6)


def test_its_state_is_all_there_is_to_it():
    one, other = agent(seed=1), agent(seed=2)
    rng = np.random.default_rng(6)
    rollout = random_rollout(4, 8)
    rollout.action[..., 1] = np.sign(rollout.action[..., 1])
    one.update(rollout, rng)
    other.restore(one.state())
    for it in (one, other):
        it.update(rollout, np.random.default_rng(7))
    first, second = one.state(), other.state()
    assert first.keys() == second.keys()
    assert all(np.array_equal(first[key], second[key]) for key in first)
