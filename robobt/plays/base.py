"""Plays by name: functions with keyword parameters that return a tree."""

from __future__ import annotations

from collections.abc import Callable

from robobt.tree import Behaviour, Registry

Play = Callable[..., Behaviour]
"""A function of keyword parameters, all with defaults, that returns a new tree."""

PLAYS: Registry[Play] = Registry("play", group="robobt.plays", fits=callable)
"""Every play by name."""
