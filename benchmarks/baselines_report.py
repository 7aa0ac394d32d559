"""The finished cells of ``baselines.py``: their file, tables in Markdown and learning curves."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any

import matplotlib
import numpy as np
from numpy.typing import NDArray

from robobt.config import new_figure, save_figure

Cells = Sequence[Mapping[str, Any]]


def read_cells(file: Path) -> list[dict[str, Any]]:
    """Return the cells that have ended, without a last line that was cut off; none where there is no file."""
    whole = file.read_bytes().rpartition(b"\n")[0] if file.exists() else b""
    return [json.loads(line) for line in whole.splitlines()]


def add_cell(file: Path, cell: Mapping[str, Any]) -> None:
    """Add a cell's line, in the place of a last line that was cut off."""
    with file.open("ab+") as lines:
        lines.seek(0)
        lines.truncate(lines.read().rfind(b"\n") + 1)
        lines.write(json.dumps(cell, allow_nan=False).encode() + b"\n")


def table(cells: Cells, tasks: Sequence[str], algorithms: Mapping[str, str]) -> str:
    """Return two tables: successes of the held-out starts, and steps within the budget.

    Args:
        cells: finished ones.
        tasks: in the order of the rows; those without a cell are left out.
        algorithms: in the order of the columns, with their headings.
    """

    def success(found: Cells) -> str:
        shares = [100.0 * cell["held_out"]["success"]["value"] for cell in found]
        span = f"{min(shares):.1f} to {max(shares):.1f}; " if len(shares) > 1 else ""
        return f"{median(shares):.1f} % ({span}{len(shares)})"

    def steps(found: Cells) -> str:
        return f"{median(cell['steps'] for cell in found) / 1000:,.0f}"

    def rows(show: Callable[[Cells], str]) -> str:
        lines = [f"| task | {' | '.join(algorithms.values())} |", "| --- " * (1 + len(algorithms)) + "|"]
        for task in tasks:
            shown = [show(found) if (found := _of(cells, task, each)) else "" for each in algorithms]
            if any(shown):
                lines.append(f"| {task} | {' | '.join(shown)} |")
        return "\n".join(lines)

    return "\n\n".join(
        [
            "Successes of the held-out starts, median over the seeds (range; number of seeds):",
            rows(success),
            "Thousands of steps within the budget, median:",
            rows(steps),
        ]
    )


def draw(cells: Cells, tasks: Sequence[str], algorithms: Mapping[str, str], path: Path) -> None:
    """Draw each task's successes of the validation starts over steps and over CPU seconds.

    Lines are medians over the seeds, bands reach from the worst to the best. Arguments as for :func:`table`;
    the ending of ``path`` decides the format.
    """
    shown = [task for task in tasks if any(cell["task"] == task for cell in cells)]
    lines = max(1, -(-len(shown) // 2))
    figure = new_figure(11.0, 1.75 * lines + 0.8)
    axes = figure.subplots(lines, 4, sharey=True, squeeze=False)
    for pair in axes.reshape(-1, 2)[len(shown) :]:
        for axis in pair:
            axis.set_axis_off()
    for task, pair in zip(shown, axes.reshape(-1, 2), strict=False):
        for index, algorithm in enumerate(algorithms):
            curves = [np.array(cell["curve"], dtype=float)[:, :3] for cell in _of(cells, task, algorithm)]
            for column, axis in enumerate(pair if curves else ()):
                x, success = _together(curves, column)
                if column == 0:
                    x, success = x[1:], success[:, 1:]  # a logarithmic axis has no 0
                axis.plot(x, np.median(success, axis=0), f"C{index}", label=algorithms[algorithm])
                axis.fill_between(x, success.min(axis=0), success.max(axis=0), color=f"C{index}", alpha=0.2)
        pair[0].set_xscale("log")
        pair[0].minorticks_off()
        pair[0].set_ylim(-2.0, 102.0)
        pair[0].set_title(task, loc="left", fontsize="small")
        for axis, label in zip(pair, ("steps", "CPU seconds"), strict=True):
            axis.set_xlabel(label, fontsize="x-small")
            axis.tick_params(labelsize="x-small")
            axis.grid(alpha=0.3)
    figure.supylabel("successes [%]", fontsize="small")
    named: dict[str, Any] = {}
    for axis in axes.flat:
        named |= {line.get_label(): line for line in axis.get_lines()}
    if named:
        names = [name for name in algorithms.values() if name in named]
        figure.legend([named[name] for name in names], names, loc="outside upper center", ncols=len(names))
    # Text as text: a tenth of the size.
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "baselines"}):
        save_figure(figure, path)


def _of(cells: Cells, task: str, algorithm: str) -> Cells:
    return [cell for cell in cells if (cell["task"], cell["algorithm"]) == (task, algorithm)]


def _together(curves: Sequence[NDArray[np.float64]], column: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return places of a column where all seeds have been, (x,), and their percentages there, (seeds, x)."""
    x = np.unique(np.minimum(curves[0][:, column], min(curve[-1, column] for curve in curves)))
    return x, 100.0 * np.array([np.interp(x, curve[:, column], curve[:, 2]) for curve in curves])
