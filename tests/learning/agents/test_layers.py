"""Layers of networks."""

from __future__ import annotations

import torch

from robobt.learning.agents.layers import Tanh, linear


def test_tanh_and_its_slope_are_torchs() -> None:
    x = torch.linspace(-30.0, 30.0, 4001, requires_grad=True)
    given = torch.linspace(0.5, 2.0, 4001)
    found, wanted = Tanh()(x), torch.tanh(x)
    torch.testing.assert_close(found, wanted, atol=3e-7, rtol=0.0)
    slopes = [torch.autograd.grad((y * given).sum(), x)[0] for y in (found, wanted)]
    torch.testing.assert_close(*slopes, atol=1e-6, rtol=0.0)
    with torch.no_grad():
        assert torch.equal(Tanh()(x), found)


def test_a_layer_leaves_the_processs_generator_alone() -> None:
    torch.manual_seed(0)
    before = torch.get_rng_state()
    one, other = (linear(3, 4, torch.Generator().manual_seed(seed)) for seed in (1, 1))
    assert torch.equal(torch.get_rng_state(), before)
    assert torch.equal(one.weight, other.weight)
    assert torch.equal(one.bias, other.bias)
