"""Plays by name: functions with keyword parameters that return a tree."""

from __future__ import annotations

from collections.abc import Callable

from robobt.tree import Behaviour, Registry, Selector, Sequence

Play = Callable[..., Behaviour]
"""A function of keyword parameters, all with defaults, that returns a new tree."""

PLAYS: Registry[Play] = Registry("play", group="robobt.plays", fits=callable)
"""Every play by name."""


def when(name: str, *steps: Behaviour) -> Behaviour:
    """Return a sequence of conditions and what to do while they hold, judged anew every tick."""
    return Sequence(name, memory=False, children=list(steps))


def first_of(name: str, *options: Behaviour) -> Behaviour:
    """Return a selector that plays the first option that can be played, chosen anew every tick."""
    return Selector(name, memory=False, children=list(options))
