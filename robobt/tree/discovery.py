"""Importing all modules of a folder, so that they register their content."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pkgutil import walk_packages


def import_all(package: str, path: Iterable[str]) -> None:
    """Import every module below a package in order of name, so that each registers its content.

    A package's own ``__init__`` calls it with its ``__name__`` and, as ``path``, its ``__path__``.
    """
    for module in sorted(found.name for found in walk_packages(path, f"{package}.")):
        import_module(module)
