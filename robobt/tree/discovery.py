"""Finding what registers itself by the folder it lies in."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pkgutil import walk_packages


def import_all(package: str, path: Iterable[str]) -> None:
    """Import every module below a package in order of their names, so that each registers what it holds.

    Args:
        package: dotted name, ``__name__`` in the package's own ``__init__``.
        path: its folders, ``__path__`` there.
    """
    for module in sorted(found.name for found in walk_packages(path, f"{package}.")):
        import_module(module)
