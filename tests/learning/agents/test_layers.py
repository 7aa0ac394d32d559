"""Layers of networks."""

from __future__ import annotations

import pytest
import torch

from robobt.learning.agents.layers import _MANY_ROWS, Tanh, linear, mlp


def test_tanh_is_torchs() -> None:
    x = torch.linspace(-30.0, 30.0, 4001)
    torch.testing.assert_close(Tanh()(x), torch.tanh(x), atol=3e-7, rtol=0.0)


@pytest.mark.parametrize("inputs", [5, 40])
def test_many_rows_at_once_give_the_outputs_and_gradients_of_a_few(inputs: int) -> None:
    generator = torch.Generator().manual_seed(0)
    layers = mlp([inputs, 24, 16, 3], False, generator, "tanh")
    rows = torch.randn(_MANY_ROWS, inputs, generator=generator, requires_grad=True)
    slope = torch.randn(_MANY_ROWS, 3, generator=generator) / _MANY_ROWS
    whole, parts = layers(rows), torch.cat([layers(part) for part in rows.split(100)])
    torch.testing.assert_close(whole, parts, atol=1e-6, rtol=0.0)
    with torch.no_grad():
        torch.testing.assert_close(layers(rows), whole, atol=1e-6, rtol=0.0)
    found, wanted = (
        torch.autograd.grad(output, [rows, *layers.parameters()], slope) for output in (whole, parts)
    )
    for one, other in zip(found, wanted, strict=True):
        torch.testing.assert_close(one, other, atol=1e-6, rtol=1e-5)
        assert one.is_contiguous()


def test_a_layer_leaves_the_processs_generator_alone() -> None:
    torch.manual_seed(0)
    before = torch.get_rng_state()
    one, other = (linear(3, 4, torch.Generator().manual_seed(seed)) for seed in (1, 1))
    assert torch.equal(torch.get_rng_state(), before)
    assert torch.equal(one.weight, other.weight)
    assert torch.equal(one.bias, other.bias)
