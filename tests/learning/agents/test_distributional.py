from __future__ import annotations

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from robobt.learning.agents.distributional import Atoms

ATOMS = Atoms(-2.0, 3.0, 11)


def project(probabilities, reward, discount, atoms=ATOMS):
    row = torch.tensor([probabilities], dtype=torch.float32)
    return atoms.project(row, torch.tensor([reward]), torch.tensor([discount]))[0]


@given(
    st.lists(st.floats(0.01, 1.0), min_size=11, max_size=11),
    st.floats(-5.0, 5.0),
    st.floats(0.0, 1.0),
)
def test_no_probability_is_lost(weights, reward, discount):
    probabilities = np.array(weights) / np.sum(weights)
    projected = project(probabilities.tolist(), reward, discount)
    assert float(projected.sum()) == pytest.approx(1.0, abs=1e-5)
    assert float(projected.min()) >= -1e-6


@given(st.lists(st.floats(0.01, 1.0), min_size=11, max_size=11), st.floats(-0.5, 0.5), st.floats(0.0, 0.5))
def test_the_mean_inside_the_support_is_kept(weights, reward, discount):
    probabilities = np.array(weights) / np.sum(weights)
    mean = float(probabilities @ ATOMS.values.numpy())
    projected = project(probabilities.tolist(), reward, discount)
    assert float(projected @ ATOMS.values) == pytest.approx(reward + discount * mean, abs=1e-4)


def test_a_value_on_an_atom_stays_whole():
    one_hot = torch.eye(11)[4].tolist()
    assert project(one_hot, 0.5, 1.0).tolist() == pytest.approx(torch.eye(11)[5].tolist(), abs=1e-5)


def test_a_value_between_atoms_is_shared_in_proportion():
    projected = project(torch.eye(11)[4].tolist(), 0.125, 1.0)
    assert projected[4:6].tolist() == pytest.approx([0.75, 0.25], abs=1e-5)


@pytest.mark.parametrize(("reward", "atom"), [(100.0, 10), (-100.0, 0)])
def test_what_lies_outside_counts_as_the_last_atom(reward, atom):
    even = [1 / 11] * 11
    assert project(even, reward, 0.9)[atom] == pytest.approx(1.0, abs=1e-5)


def test_a_terminal_reward_is_all_there_is():
    projected = project([1 / 11] * 11, 1.0, 0.0)
    assert projected[6] == pytest.approx(1.0, abs=1e-5)


def test_a_support_that_rounds_badly_loses_nothing():
    atoms = Atoms(-60.0, 35.0, 51)
    row = torch.softmax(torch.randn(64, 51, generator=torch.Generator().manual_seed(0)), -1)
    for reward in (35.0, -60.0, 34.999996, 0.1):
        projected = atoms.project(row, torch.full((64,), reward), torch.full((64,), 0.99))
        assert projected.sum(-1).tolist() == pytest.approx([1.0] * 64, abs=1e-5)


def test_fewer_than_two_atoms_are_refused():
    with pytest.raises(ValueError, match="at least 2 atoms on a rising range, not 1"):
        Atoms(0.0, 1.0, 1)
