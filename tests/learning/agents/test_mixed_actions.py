"""Normal and threshold entries are weighed as torch's distributions are."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from torch.distributions import Bernoulli, Normal

from robobt.learning.agents.mixed_actions import MixedActions

ROWS = 300


@pytest.mark.parametrize("continuous", [(True, False, True, False), (True, True), (False,)])
def test_probabilities_entropy_and_slopes_are_torchs(continuous: tuple[bool, ...]) -> None:
    rng = np.random.default_rng(0)
    actions, normal = MixedActions(continuous), np.array(continuous)
    output = rng.normal(0.0, 4.0, (len(continuous), ROWS)).astype(np.float32)
    output[:, 0] = 200.0
    log_std = rng.normal(size=(normal.sum(), 1)).astype(np.float32)
    action, weight = actions.draw(output, log_std, rng), rng.normal(size=ROWS).astype(np.float32) / ROWS
    assert set(np.unique(action[~normal])) <= {-1.0, 1.0}

    policy, spread = (torch.from_numpy(array.copy()).requires_grad_() for array in (output, log_std))
    gauss, coin = Normal(policy[normal], spread.exp().expand(-1, ROWS)), Bernoulli(logits=policy[~normal])
    taken = torch.from_numpy(action)
    expected = gauss.log_prob(taken[normal]).sum(0) + coin.log_prob((taken[~normal] > 0.0).float()).sum(0)
    entropy = gauss.entropy().sum(0) + coin.entropy().sum(0)
    found = actions.log_probability(output, action, log_std), actions.entropy(output, log_std)
    np.testing.assert_allclose(found[0], expected.detach(), rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(found[1], entropy.detach(), rtol=1e-5, atol=1e-5)
    aim = (torch.from_numpy(weight) * expected).sum() + 0.1 * entropy.mean()
    slopes = torch.autograd.grad(aim, [policy, spread], allow_unused=True)
    for mine, torchs in zip(actions.slopes(output, action, log_std, weight, 0.1), slopes, strict=True):
        np.testing.assert_allclose(mine.ravel(), torchs.numpy().ravel(), rtol=1e-5, atol=1e-6)
