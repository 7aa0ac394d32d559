"""Run the examples and keep what they show, in docs/tutorials: `python -m tests.notebooks [NAME...]`."""

from __future__ import annotations

import ast
import json
import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from robobt.tree import Behaviour
from robobt.tree.svg import last_tick_svg

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"
NOTEBOOKS = ROOT / "docs" / "tutorials"
KINDS = {"image/svg+xml": "_repr_svg_", "text/html": "_repr_html_"}
"""What an object shows itself as, and by which method."""


def cells(script: str) -> Iterator[tuple[str, str]]:
    """Yield the cells of a script in percent format, each with its kind: markdown or code."""
    for cell in re.split(r"(?m)^# %%", script)[1:]:
        kind, _, text = cell.partition("\n")
        if "[markdown]" in kind:
            yield "markdown", re.sub(r"(?m)^# ?", "", text).strip()
        else:
            yield "code", text.strip()


def run(code: str, scope: dict[str, Any], name: str = "cell") -> list[dict[str, Any]]:
    """Run a cell and return its outputs in a notebook's format: what it prints, and shows at its end."""
    body = ast.parse(code).body
    last = body.pop() if isinstance(body[-1], ast.Expr) else None
    printed, shown = StringIO(), None
    with redirect_stdout(printed):
        exec(compile(ast.Module(body, []), name, "exec"), scope)
        if isinstance(last, ast.Expr):
            shown = eval(compile(ast.Expression(last.value), name, "eval"), scope)
    outputs: list[dict[str, Any]] = []
    if text := printed.getvalue():
        outputs.append({"output_type": "stream", "name": "stdout", "text": text})
    if shown is not None:
        data = {kind: getattr(shown, method)() for kind, method in KINDS.items() if hasattr(shown, method)}
        if isinstance(shown, Behaviour):
            data["image/svg+xml"] = last_tick_svg(shown)
        outputs.append(
            {"output_type": "display_data", "metadata": {}, "data": data or {"text/plain": repr(shown)}}
        )
    return outputs


def notebook(script: str, scope: dict[str, Any]) -> Mapping[str, Any]:
    """Run a script and return it as a notebook."""
    found: list[dict[str, Any]] = []
    for kind, text in cells(script):
        cell = {"id": f"cell-{len(found)}", "cell_type": kind, "metadata": {}, "source": text}
        if kind == "code":
            cell |= {"execution_count": None, "outputs": run(text, scope)}
        found.append(cell)
    return {
        "nbformat": 4,
        "nbformat_minor": 5,
        "metadata": {"language_info": {"name": "python"}},
        "cells": found,
    }


def main() -> None:
    for script in sorted(EXAMPLES.glob("*.py")):
        if len(sys.argv) == 1 or script.stem in sys.argv[1:]:
            with TemporaryDirectory() as folder, chdir(folder):
                made = notebook(script.read_text(), {"__name__": "__main__"})
            text = json.dumps(made, indent=1, ensure_ascii=False)
            (NOTEBOOKS / f"{script.stem}.ipynb").write_text(f"{text}\n")


if __name__ == "__main__":
    main()
