"""Learning curves as a picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from robobt.config.figures import new_figure, save_figure
from robobt.learning.training.results import Validation


def draw_curves(runs: Mapping[str, Sequence[Validation]], title: str, path: str | Path) -> None:
    """Write a PNG: success and time of every run over environment steps and over CPU time."""
    figure = new_figure(10.0, 6.0)
    axes = figure.subplots(2, 2, sharey="row", sharex="col")
    relative = any(validation.time_ratio is not None for run in runs.values() for validation in run)
    for name, run in runs.items():
        steps = [validation.steps for validation in run]
        cpu = [validation.cpu_s for validation in run]
        success = [100.0 * validation.success for validation in run]
        times = [validation.time_ratio if relative else validation.mean_time for validation in run]
        shown = [float("nan") if value is None else value for value in times]
        for column, x in enumerate((steps, cpu)):
            axes[0, column].plot(x, success, marker=".", label=name)
            axes[1, column].plot(x, shown, marker=".", label=name)
    axes[0, 0].set_ylabel("success [%]")
    axes[0, 0].set_ylim(-2.0, 102.0)
    axes[1, 0].set_ylabel("time over the optimum" if relative else "time [s]")
    if relative:
        axes[1, 0].set_ylim(0.98, 1.3)
    axes[1, 0].set_xlabel("environment steps")
    axes[1, 1].set_xlabel("CPU time [s]")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    if runs:
        axes[0, 1].legend(loc="lower right", fontsize="small")
    figure.suptitle(title)
    save_figure(figure, Path(path))
