"""What goes wrong in the code of a play, told with its place."""

from __future__ import annotations

import traceback
from pathlib import Path

from py_trees.behaviour import Behaviour

from robobt.config.errors import RobobtError, message_of


class PlayError(RobobtError):
    """A play whose code raises as its tree is built."""


_OURS = ("robobt", "py_trees")


def mistake_in_play(error: Exception) -> str:
    """Return what an exception says that building a tree raised, with the play's file and line.

    An exception that no code outside robobt and py_trees has led to comes as it is.
    """
    places = [
        (Path(frame.f_code.co_filename).name, line)
        for frame, line in traceback.walk_tb(error.__traceback__)
        if str(frame.f_globals.get("__name__")).partition(".")[0] not in _OURS
        # What the standard library and other packages raise, the play has asked them for.
        and "site-packages" not in frame.f_code.co_filename
        and frame.f_globals.get("__file__") is not None
    ]
    said = _without_brackets(error) or message_of(error)
    if not places:
        return said
    # robobt's own errors are whole sentences; of others the kind says half.
    kind = "" if isinstance(error, RobobtError | ValueError) else f"{type(error).__name__}: "
    file, line = places[-1]
    return f"{file}:{line}: {kind}{said}"


def _without_brackets(error: Exception) -> str | None:
    """Return the message for a class in the place of a node, which py_trees tells by its metaclass."""
    frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
    child = frames[-1].f_locals.get("child") if isinstance(error, TypeError) and frames else None
    if isinstance(child, type) and issubclass(child, Behaviour):
        return f"{child.__name__} is a class; {child.__name__}() makes a node of it"
    return None
