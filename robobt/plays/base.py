"""Plays by name: functions with keyword parameters that return a tree."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, overload

from robobt.tree import Behaviour, Registry, Selector, Sequence

Play = Callable[..., Behaviour]
"""A function of keyword parameters, all with defaults, that returns a new tree."""

PLAYS: Registry[Play] = Registry("play", group="robobt.plays", fits=callable)
"""Every play by name."""

PlayT = TypeVar("PlayT", bound=Play)


@overload
def play(name: PlayT, /) -> PlayT: ...
@overload
def play(name: str = "", /) -> Callable[[PlayT], PlayT]: ...
def play(name: PlayT | str = "", /) -> PlayT | Callable[[PlayT], PlayT]:
    """Enter a function that returns a tree as a play, and return it; a decorator.

    Args:
        name: of the play; the function's own where there is none, as in ``@play``.

    Raises:
        ValueError: another play has that name.
    """
    if not isinstance(name, str):
        return play()(name)

    def enter(function: PlayT) -> PlayT:
        PLAYS.register(name or function.__name__)(function)
        return function

    return enter


def when(name: str, *steps: Behaviour) -> Behaviour:
    """Return a reactive sequence of this ``name``: conditions, and what to do while they hold.

    In every tick all ``steps`` are ticked, in order, up to the first that does not succeed.
    """
    return Sequence(name, memory=False, children=list(steps))


def first_of(name: str, *options: Behaviour) -> Behaviour:
    """Return a reactive selector of this ``name``: the first of ``options`` that does not fail is played."""
    return Selector(name, memory=False, children=list(options))
