"""Export of a finished training run as a model file with its card."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robobt import __version__
from robobt.config.commit import source_commit
from robobt.learning.agents.networks import one_thread, policy_of, resized
from robobt.learning.envs import make_task
from robobt.learning.training.fresh_starts import best_seed
from robobt.learning.training.problems import problem_of
from robobt.learning.training.results import Evaluation, TrainResult
from robobt.learning.training.run_folder import check_task, load_run
from robobt.learning.training.settings import evaluated_on
from robobt.models.card import MODEL_NAME, Measured, ModelCard, ObservationCard, action_outputs
from robobt.models.export import export_model, refuse_to_replace
from robobt.models.file import SUFFIXES, Format, ModelError
from robobt.statistics import mean_interval
from robobt.world.division import A as DIVISION_A

_Floats = NDArray[np.float64]


def export_run(
    run: str | Path,
    name: str = "",
    folder: str | Path = "models",
    formats: Sequence[Format] = ("torchscript",),
    starts: int | None = None,
    force: bool = False,
) -> tuple[Path, ...]:
    """Write the best actor of a finished run as model files, enter them in the manifest and return them.

    The actor is evaluated once more on the held-out starts; these figures, with their
    intervals, are on the card.

    Args:
        run: the folder of the run, or of several seeds of one, of which the best is taken: by
            the starts that chose its actor, not the held-out ones.
        name: of the model; the task's with the learner's when empty.
        folder: where to.
        formats: "torchscript", "onnx" or both.
        starts: number of held-out starts; None for as many as the run was set to.
        force: whether files that are there already may be replaced.

    Raises:
        RunFolderError: the folder holds no run that has ended, or the file of its task has been edited since.
        ModelError: the actor cannot be written as it is, or under that name.
    """
    if name and (not re.fullmatch(MODEL_NAME, name) or name.endswith(tuple(SUFFIXES.values()))):
        raise ModelError(
            f"{name!r} is no name for a model: up to 64 letters, digits, dots, dashes and underscores, "
            "without the file's suffix"
        )
    result = load_run(best_seed(Path(run)))
    settings = result.settings
    check_task(Path(run), settings, result.figures.get("task_digest", ""))
    called = name or f"{settings.task.rpartition(':')[2]}_{settings.learner}"
    for format_ in formats:
        refuse_to_replace(Path(folder) / f"{called}{SUFFIXES[format_]}", force)
    environment = settings.environment
    count = settings.evaluation.held_out if starts is None else starts
    with one_thread():
        figures = problem_of(environment, evaluated_on(settings, str(run))).evaluate(
            policy_of(result.actor), "held_out", count
        )
    task, actor = make_task(environment, 1), result.actor
    if actor.groups:
        # Its weights serve any team, so its file has places for the largest.
        most = {"mates": DIVISION_A.robots - 1, "opponents": DIVISION_A.robots}
        environment = environment.model_copy(update=most)
        task = make_task(environment, 1)
        actor = resized(actor, task.scale, task.observation.groups)
    skill = task.played_by
    card = ModelCard(
        kind="policy",
        name=called,
        skill=skill,
        description=(
            f"{skill} of the task {settings.task}, trained by robobt with the preset "
            f"{settings.preset or 'of its own'!r}."
        ),
        algorithm=settings.algorithm,
        observation=ObservationCard.of(task.observation),
        outputs=action_outputs(environment.action),
        action=environment.action,
        period=environment.period * environment.decide_every,
        limits=environment.robot_limits,
        environment=environment.model_dump(mode="json"),
        training=_training(result),
        seed=settings.seed,
        held_out=held_out(figures),
        code_version=str(result.figures.get("robobt", "")),
        code_commit=str(result.figures.get("commit", "")),
        created_by=f"robobt export {__version__} {source_commit()}".rstrip(),
    )
    return export_model(actor, card, Path(folder), formats, force)


def held_out(figures: Evaluation) -> dict[str, Measured]:
    """Return a card's figures: share of successes, mean time [s], its ratio to the optimum."""
    rate = figures.interval
    count = len(figures.success)
    measured = {
        "success": Measured(value=figures.rate, low=rate.low, high=rate.high, n=count, interval="95 % Wilson")
    }
    timed = figures.success & np.isfinite(figures.times)
    if timed.any():
        measured["time"] = _mean(figures.times[timed], "s")
    known = timed & (figures.optimum > 0.0)
    if known.any():
        measured["time_ratio"] = _ratio(figures.times[known], figures.optimum[known])
    return measured


def _mean(values: _Floats, unit: str) -> Measured:
    """Compute the mean of values that are never negative, as the interval then is not either."""
    low, high = mean_interval(values) if len(values) > 1 else (None, None)
    low = None if low is None else max(0.0, low)
    return Measured(
        value=float(values.mean()),
        low=low,
        high=high,
        n=len(values),
        unit=unit,
        interval="95 % Student, mean",
    )


def _ratio(times: _Floats, optima: _Floats) -> Measured:
    """Compute mean time over mean optimum; the interval is that of the mean of times less their share."""
    ratio = float(times.sum() / optima.sum())
    low: float | None = None
    high: float | None = None
    if len(times) > 1:
        off = mean_interval(times - ratio * optima)
        low, high = max(0.0, ratio + off.low / float(optima.mean())), ratio + off.high / float(optima.mean())
    return Measured(value=ratio, low=low, high=high, n=len(times), interval="95 % Student, ratio of means")


def _training(result: TrainResult) -> dict[str, Any]:
    settings = result.settings.model_dump(mode="json", exclude={"environment", "seed"})
    figures = {key: value for key, value in result.figures.items() if key not in ("held_out", "task", "seed")}
    return {"settings": settings, "figures": figures}
