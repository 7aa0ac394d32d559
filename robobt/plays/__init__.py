"""Trees composed of skills; a play is a function that returns a tree, registered by name."""

from __future__ import annotations

from collections.abc import Callable

from robobt.tree import Behaviour, Registry

PLAYS: Registry[Callable[..., Behaviour]] = Registry("play")
"""Every play by its name."""
