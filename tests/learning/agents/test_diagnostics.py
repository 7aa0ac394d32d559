from __future__ import annotations

import torch

from robobt.learning.agents.diagnostics import Diagnostics


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
