"""Registries that are as they were after a test."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from robobt.tree.registry import Registry, T


@contextmanager
def temporarily(registry: Registry[T]) -> Iterator[Registry[T]]:
    """Undo, after this context, what is registered within it."""
    undo = registry.undo_point()
    try:
        yield registry
    finally:
        undo()
