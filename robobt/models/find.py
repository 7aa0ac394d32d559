"""Finding models by name, and checking that they fit their use without running them."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from hashlib import sha256
from pathlib import Path

from robobt.config.errors import close_names
from robobt.config.resources import models_folder
from robobt.models.card import Kind, ModelCard
from robobt.models.file import (
    SUFFIXES,
    ModelError,
    ModelFile,
    UnknownModelError,
    read_manifest,
    read_model_file,
)
from robobt.world.features import ObservationSpec

_ENDINGS = tuple(SUFFIXES.values())


def find_model(name_or_path: str | Path) -> Path:
    """Return the file of a model.

    A name without a suffix is looked for among the shipped models, in the working folder, in its
    folder ``models`` and in those that the environment variable ``ROBOBT_MODELS`` lists.

    Raises:
        UnknownModelError: there is no model with that name.
        ModelError: this installation leaves it out; there are several, and they are not the same; or it names
            a file of another kind.
    """
    text = str(name_or_path)
    if isinstance(name_or_path, Path) or is_path(text):
        return Path(name_or_path)
    folders = model_folders()
    found: dict[Path, Path] = {}
    for folder in folders:
        for suffix in SUFFIXES.values():
            path = folder / f"{text}{suffix}"
            if path.is_file():
                found.setdefault(folder.resolve(), path)
    if len(found) > 1 and len({sha256(path.read_bytes()).digest() for path in found.values()}) > 1:
        several = ", ".join(map(str, found.values()))
        raise ModelError(f"several models are called {text!r}: {several}; give the path of one")
    for path in found.values():
        return path
    if Path(text).is_file():
        raise ModelError(f"{text!r} is not a model file: model files end in {' or '.join(_ENDINGS)}")
    shipped, *_ = folders
    if any(f"{text}{suffix}" in read_manifest(shipped) for suffix in SUFFIXES.values()):
        raise ModelError(
            f"the model {text!r} is not installed: it is in the folder models of robobt's repository; "
            "copy its file into a folder models here, or give its path"
        )
    there = sorted({path.stem for folder in folders for path in list_models(folder)})
    meant = close_names(text, there)
    guess = f"did you mean {' or '.join(meant)}? " if meant else ""
    known = f"installed: {', '.join(there) or 'none'}; {guess}or give the path of a file"
    raise UnknownModelError(f"no model is called {text!r}; {known}")


def read_fitting_model(
    name_or_path: str | Path,
    *,
    kind: Kind | None = None,
    skill: str | Sequence[str] | None = None,
    observation: ObservationSpec | None = None,
) -> ModelFile:
    """Read a model's file and check that its card fits the use; neither torch nor onnxruntime is imported.

    Args:
        name_or_path: name of a shipped model, or a file.
        kind: required kind; None for any.
        skill: skill that will use it, or several of which one will; None for any.
        observation: observation that it will be given; None for any.

    Raises:
        ModelError: it cannot be read, or its card does not fit; the message names the file and says why.
    """
    file = read_model_file(find_model(name_or_path))
    card = file.card
    skills = [skill] if isinstance(skill, str) else skill
    problem = card.observation.problem()
    if kind is not None and card.kind != kind:
        problem = f"is a {card.kind.replace('_', ' ')}, not a {kind.replace('_', ' ')}"
    elif skills is not None and card.skill not in skills:
        problem = f"is a model for {card.skill}, not for {_one_of(skills)}{_trained_in(card)}"
    elif observation is not None and card.observation.name != observation.name:
        problem = f"takes the observation {card.observation.name!r}, not {observation.name!r}"
    if problem is not None:
        raise ModelError(f"{file.path}: {problem}")
    return file


def _one_of(names: Sequence[str]) -> str:
    *others, last = names
    return f"{', '.join(others)} or {last}" if others else last


def _trained_in(card: ModelCard) -> str:
    """Return the words that name the task of a model's training, none where its card doesn't."""
    settings = card.training.get("settings")
    task = settings.get("task") if isinstance(settings, dict) else None
    return f"; it was trained in the task {task}" if isinstance(task, str) else ""


def is_path(text: str) -> bool:
    """Return whether a text names a model by the path of its file, not by its name."""
    return "/" in text or "\\" in text or text.endswith(_ENDINGS)


def paths_in(value: object) -> set[str]:
    """Return the texts in plain data that name a model by the path of its file."""
    if isinstance(value, str):
        return {value} if is_path(value) else set()
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list | tuple) else ()
    return {path for part in parts for path in paths_in(part)}


def rename_models(value: object, rename: Callable[[str], str]) -> object:
    """Return plain data with the model files that it names renamed: every text that ends like one."""
    if isinstance(value, str):
        return rename(value) if value.endswith(_ENDINGS) else value
    if isinstance(value, dict):
        return {name: rename_models(part, rename) for name, part in value.items()}
    return [rename_models(part, rename) for part in value] if isinstance(value, list) else value


def model_folders() -> list[Path]:
    """Return the folders in which models are found by their names, the shipped ones first."""
    named = os.environ.get("ROBOBT_MODELS", "")
    extra = [Path(part) for part in named.split(os.pathsep) if part]
    return [models_folder(), Path(), Path("models"), *extra]


def list_models(folder: Path) -> list[Path]:
    """Return the model files of a folder, in the order of their names."""
    return sorted([path for path in folder.glob("*") if path.suffix in _ENDINGS and path.is_file()])
