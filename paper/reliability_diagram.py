"""A reliability diagram: what was predicted beside what came true."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from robobt.config import new_figure, save_figure
from robobt.statistics import ReliabilityBin


def draw_reliability(models: Mapping[str, Sequence[ReliabilityBin]], title: str, path: Path) -> None:
    """Draw the bins of several models, in the format of the path's ending; a dot's area shows its trials."""
    figure = new_figure(7.0, 6.0)
    axes = figure.add_subplot()
    axes.plot([0, 1], [0, 1], color="0.6", linewidth=1, linestyle="--", label="calibrated")
    for i, (name, bins) in enumerate(models.items()):
        x, y = [row.predicted for row in bins], [row.observed for row in bins]
        color = f"C{i % 10}"
        axes.plot(x, y, color=color, linewidth=1.2, alpha=0.8, label=name)
        most = max(row.trials for row in bins)
        axes.scatter(x, y, s=[6 + 90 * row.trials / most for row in bins], color=color, alpha=0.6)
    axes.set(xlabel="predicted probability of a goal", ylabel="share of goals", title=title)
    axes.set(xlim=(-0.02, 1.02), ylim=(-0.02, 1.02), aspect="equal")
    axes.legend(loc="upper left", fontsize=8)
    save_figure(figure, path)
