"""The files of the viewer's page: modules that a browser loads one by one, or all of them as one script."""

from __future__ import annotations

import re
from importlib.resources import files

_IMPORT = re.compile(r'^import .* from "\./([a-z_]+\.js)";\n', re.MULTILINE)
_EXPORT = re.compile(r"^export ", re.MULTILINE)


def page_text(name: str) -> str:
    """Return the text of a file of the page."""
    return files("robobt.live").joinpath("page", name).read_text(encoding="utf-8")


def bundle(entry: str) -> str:
    """Return a module and all that it imports as one script.

    The modules share one scope there, so no two of them declare the same name; each imports
    names as they are, one ``import { ... } from "./module.js";`` a line.
    """
    taken: dict[str, str] = {}

    def take(name: str) -> None:
        if name in taken:
            return
        text = page_text(name)
        # Its place is that after the modules it imports.
        for needed in _IMPORT.findall(text):
            take(needed)
        taken[name] = _EXPORT.sub("", _IMPORT.sub("", text))

    take(entry)
    return '"use strict";\n(() => {\n' + "\n".join(taken.values()) + "})();\n"
