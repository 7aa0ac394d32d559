from __future__ import annotations

import inspect

from robobt.skills import KickLoose
from robobt.tree import Sequence
from robobt.tree.signatures import signature_of


def test_a_class_takes_what_its_own_constructor_takes() -> None:
    """Some releases of Python 3.11 say that a leaf takes anything, because its base has a ``__new__``."""
    assert list(signature_of(KickLoose).parameters) == ["name", "patience"]
    assert "children" in signature_of(Sequence).parameters


def test_a_function_takes_what_it_says() -> None:
    def play(*, shoot_at: float = 0.5) -> None: ...

    assert signature_of(play) == inspect.signature(play)
