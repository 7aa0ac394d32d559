"""Model files that fit their use, as far as can be told without running them."""

from __future__ import annotations

from pathlib import Path

from robobt.models.card import Kind
from robobt.models.file import ModelError, ModelFile, read_model_file
from robobt.models.find import find_model
from robobt.world.features import ObservationSpec


def read_fitting_model(
    name_or_path: str | Path,
    *,
    kind: Kind | None = None,
    skill: str | None = None,
    observation: ObservationSpec | None = None,
) -> ModelFile:
    """Read a model's file and check that its card fits the use; neither torch nor onnxruntime is imported.

    Args:
        name_or_path: name of a shipped model, or a file.
        kind: what it has to be; None for any.
        skill: skill that will use it; None for any.
        observation: observation that it will be given; None for any.

    Raises:
        ModelError: it cannot be read, or its card does not fit; the message names the file and says why.
    """
    file = read_model_file(find_model(name_or_path))
    card = file.card
    problem = card.observation.problem()
    if kind is not None and card.kind != kind:
        problem = f"is a {card.kind.replace('_', ' ')}, not a {kind.replace('_', ' ')}"
    elif skill is not None and card.skill != skill:
        problem = f"is a model for {card.skill}, not for {skill}"
    elif observation is not None and card.observation.name != observation.name:
        problem = f"takes the observation {card.observation.name!r}, not {observation.name!r}"
    if problem is not None:
        raise ModelError(f"{file.path}: {problem}")
    return file
