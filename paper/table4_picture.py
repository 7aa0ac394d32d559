"""Table 4 as a picture: the times to the ball and to the shot."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from paper.table4_rows import Table4
from robobt.config import new_figure, save_figure

_PARTS: tuple[tuple[Literal["approach", "pick_up", "shoot"], str, str], ...] = (
    ("approach", "approach", "C0"),
    ("pick_up", "pick-up", "C2"),
    ("shoot", "shoot", "C1"),
)


def draw_table4(result: Table4, path: Path) -> None:
    """Draw the times of every row, a panel for each trial and set of limits.

    Bars are means, in parts; whiskers the 95 % interval of the mean total. The paper's
    rows, whose approach and pick-up are one figure, are hatched. A dashed line is the
    physical minimum to the kick. The path's ending decides the format.
    """
    panels = [
        (limits, trial, found) for limits, by in result["limits"].items() for trial, found in by.items()
    ]
    columns = len(panels) // len(result["limits"])
    figure = new_figure(6.5 * columns, 5.5 * len(result["limits"]))
    for i, (limits, trial, found) in enumerate(panels):
        axes = figure.add_subplot(len(result["limits"]), columns, i + 1)
        labels: list[str] = []
        for name, printed in result["paper"][trial].items():
            at, left = len(labels), printed["to_ball"]
            axes.barh(at, left, color="0.75", hatch="//", edgecolor="white")
            axes.barh(at, printed["shoot"], left=left, color="C1", alpha=0.5, hatch="//", edgecolor="w")
            labels.append(f"paper: {name}\n{printed['goals']:.0f} of 25 goals")
        for name, row in found["rows"].items():
            at, left = len(labels), 0.0
            for part, _, color in _PARTS:
                mean = row[part]["mean"]
                if mean is not None:
                    axes.barh(at, mean, left=left, color=color)
                    left += mean
            total = row["total"]
            mean, low, high = total["mean"], total["low"], total["high"]
            if mean is not None and low is not None and high is not None:
                axes.errorbar(mean, at, xerr=[[mean - low], [high - mean]], color="black", capsize=3)
            labels.append(f"{name}\n{row['goals'].count} of {result['runs']} goals")
        axes.set_yticks(range(len(labels)), labels, fontsize=8)
        axes.invert_yaxis()
        if found["minimum"] is not None:
            axes.axvline(found["minimum"]["to_kick"], color="black", linestyle="--", linewidth=1)
        axes.set(xlabel="time [s]", title=f"Trial {trial}, limits: {limits}, {result['preset']}")
        for _, title, color in _PARTS:
            axes.barh(0, 0, color=color, label=title)
        axes.barh(0, 0, color="0.75", hatch="//", edgecolor="white", label="to the ball (paper)")
        axes.legend(loc="lower right", fontsize=8)
    save_figure(figure, path)
