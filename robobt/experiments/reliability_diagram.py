"""A reliability diagram: what was predicted beside what came true."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from robobt.config.atomic import replacing


def draw_reliability(models: Mapping[str, Sequence[Mapping[str, Any]]], title: str, path: Path) -> None:
    """Draw the bins of several models and write a picture, whole or not at all.

    Args:
        models: bins by model, each with ``predicted``, ``observed`` and ``trials``
            (:class:`~robobt.statistics.ReliabilityBin`); a dot's area is its trials.
        path: the ending says the form (.png, .svg, .pdf).

    Raises:
        ValueError: an ending that matplotlib does not know.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 6.0), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.plot([0, 1], [0, 1], color="0.6", linewidth=1, linestyle="--", label="calibrated")
    for i, (name, bins) in enumerate(models.items()):
        x, y = [row["predicted"] for row in bins], [row["observed"] for row in bins]
        color = f"C{i % 10}"
        axes.plot(x, y, color=color, linewidth=1.2, alpha=0.8, label=name)
        most = max(row["trials"] for row in bins)
        axes.scatter(x, y, s=[6 + 90 * row["trials"] / most for row in bins], color=color, alpha=0.6)
    axes.set(xlabel="predicted probability of a goal", ylabel="share of goals", title=title)
    axes.set(xlim=(-0.02, 1.02), ylim=(-0.02, 1.02), aspect="equal")
    axes.legend(loc="upper left", fontsize=8)
    path.parent.mkdir(parents=True, exist_ok=True)
    with replacing(path) as draft:
        figure.savefig(draft, dpi=120)
