"""The option that says what of the skills' drawings is recorded."""

from __future__ import annotations

from typing import Annotated

from robobt.cli.options import option

Layers = Annotated[
    str, option("--record-layers", ": names separated by commas, as in 'paths, targets, observation'")
]


def layer_names(text: str) -> frozenset[str]:
    """Return the names in an option's text."""
    return frozenset({name.strip() for name in text.split(",")} - {""})
