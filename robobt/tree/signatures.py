"""How nodes and plays are made: the signatures of functions and classes."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable


def signature_of(maker: Callable[..., object]) -> inspect.Signature:
    """Return what a function, or a class's constructor, takes.

    The first releases of Python 3.11 read an inherited ``__new__`` in place of a class's own ``__init__``.

    Raises:
        ValueError: it has no signature.
    """
    if not isinstance(maker, type):
        return inspect.signature(maker)
    own = inspect.signature(maker.__init__)  # type: ignore[misc]
    return own.replace(parameters=list(own.parameters.values())[1:])


def meanings_of(maker: Callable[..., object]) -> dict[str, str]:
    """Return what the parameters mean, by name, a line each, as the docstring's section ``Args`` says."""
    doc = inspect.getdoc(maker) or ""
    section = re.search(r"^(?:Args|Attributes):\n((?:[ ]+.*\n?|\n)+)", doc, re.MULTILINE)
    if section is None:
        return {}
    entries = re.findall(r"^ {4}([\w, ]+):\s+(.+(?:\n {5,}.+)*)", section[1], re.MULTILINE)
    return {name.strip(): " ".join(text.split()) for names, text in entries for name in names.split(",")}
