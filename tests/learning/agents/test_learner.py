"""Adam over whole networks, and means of what a learner reports."""

from __future__ import annotations

import sys

import numpy as np
import pytest
import torch

from robobt.learning.agents.learner import Adam, Diagnostics, restore_state, state_of
from robobt.learning.agents.nstep import Transitions
from tests.learning.tiny import learn, small_agent


def weights() -> list[torch.nn.Parameter]:
    generator = torch.Generator().manual_seed(0)
    return [torch.nn.Parameter(torch.randn(*size, generator=generator)) for size in ((40, 30), (40,))]


@pytest.mark.parametrize("decay", [0.0, 0.01])
def test_its_steps_are_those_of_torchs_own_bit_for_bit(decay: float) -> None:
    ours, theirs = weights(), weights()
    adam = Adam(ours, 3e-3, decay, eps=1e-5)
    plain = torch.optim.Adam(theirs, lr=3e-3, weight_decay=decay, eps=1e-5, fused=True)
    generator = torch.Generator().manual_seed(1)
    for step in range(20):
        gradients = [torch.randn(weight.shape, generator=generator) for weight in ours]
        for weight, gradient in zip(theirs, gradients, strict=True):
            weight.grad = gradient.clone()
        if step % 2:
            norm = torch.nn.utils.clip_grad_norm_(theirs, 1.0)
            assert torch.equal(adam.clipped_step(gradients, 1.0), norm)
        else:
            adam.step(gradients)
        plain.step()
        if step == 9:
            adam.set_learning_rate(0.5)
            plain.param_groups[0]["lr"] = 1.5e-3
    assert all(torch.equal(one, other) for one, other in zip(ours, theirs, strict=True))
    for place, moments in plain.state_dict()["state"].items():
        assert moments.keys() == adam.moments.keys()
        assert all(torch.equal(adam.moments[name][place], moment) for name, moment in moments.items())


def test_one_that_goes_on_from_the_state_of_another_takes_its_steps() -> None:
    first, second = weights(), weights()
    one, other = Adam(first, 1e-2), Adam(second, 1e-2)
    gradients = [torch.ones_like(weight) for weight in first]
    one.step(gradients)
    other.step([2.0 * gradient for gradient in gradients])
    restore_state(state_of([], [("adam", one)]), [], [("adam", other)])
    for mine, yours in zip(first, second, strict=True):
        yours.data.copy_(mine.data)
    one.step(gradients)
    other.step(gradients)
    assert all(torch.equal(mine, yours) for mine, yours in zip(first, second, strict=True))


def test_a_state_from_before_the_first_step_may_have_no_moments() -> None:
    adam = Adam(weights(), 1e-2)
    adam.step([torch.ones_like(weight) for weight in adam.weights])
    restore_state({}, [], [("adam", adam)])
    assert all((moment == 0.0).all() for kind in adam.moments.values() for moment in kind)


def test_a_learner_does_without_torchs_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    # It cannot be imported, and torch's own optimiser has not met it before.
    monkeypatch.setitem(sys.modules, "torch._dynamo", None)
    decorated = torch.optim.Optimizer.add_param_group.__wrapped__  # type: ignore[attr-defined]
    monkeypatch.delattr(decorated, "__dynamo_disable", raising=False)
    with pytest.raises(ImportError):
        torch.optim.Adam(weights())
    row = np.zeros((8, 1))
    learn(small_agent(1, 1), Transitions(row, row, row[:, 0], row[:, 0], row), 2)


def test_each_name_has_the_mean_of_its_own_values():
    it = Diagnostics()
    it.add(loss=torch.tensor(1.0), norm=torch.tensor(4.0))
    it.add(loss=torch.tensor(3.0))
    assert it.means() == {"loss": 2.0, "norm": 4.0}
    it.clear()
    assert it.means() == {}


def test_what_is_added_is_not_changed():
    it, first = Diagnostics(), torch.tensor(1.0)
    it.add(loss=first)
    it.add(loss=torch.tensor(3.0))
    assert first == 1.0


def test_restored_it_goes_on_where_it_was():
    it, again = Diagnostics(), Diagnostics()
    it.add(loss=torch.tensor(0.1), norm=torch.tensor(0.2, dtype=torch.float64))
    again.restore(it.state())
    for each in (it, again):
        each.add(loss=torch.tensor(0.7))
    assert again.means() == it.means()
