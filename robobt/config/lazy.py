"""Names that a package imports when they are first used, so that importing the package stays cheap."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from importlib import import_module

from robobt.config.extras import need


def lazily(
    package: str, homes: Mapping[str, str], rooms: Collection[str] = (), needs: Sequence[str] = ()
) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """Return the functions ``__getattr__`` and ``__dir__`` of a package.

    Args:
        package: its ``__name__``.
        homes: for each name, the module below the package that it is imported from.
        rooms: modules and packages below the package that are imported when they are first used.
        needs: the extra that brings what ``homes`` import, then the import names of the extra's packages;
            none where all of them can be imported without an extra.

    A name that is used without its extra raises :class:`~robobt.config.extras.MissingExtraError`.
    """

    def get(name: str) -> object:
        if name in rooms:
            return import_module(f"{package}.{name}")
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        if needs:
            need(*needs)
        value = getattr(import_module(f"{package}.{homes[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    def names() -> list[str]:
        return sorted({*vars(sys.modules[package]), *homes, *rooms})

    return get, names
