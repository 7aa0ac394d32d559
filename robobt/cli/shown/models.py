"""Models in tables, and a model's card."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from rich.markup import escape

from robobt.cli.common import console, print_json, say, table, warn

if TYPE_CHECKING:
    from robobt.models.file import ModelFile


def list_models(further: Iterable[Path], *, as_json: bool) -> None:
    """List the models that ship, those in the working folder and in ROBOBT_MODELS, and ``further`` ones.

    Files are checked as far as that goes without running them: checksums, archive, card.

    Raises:
        typer.Exit: a file is no intact model.
    """
    from robobt.models.find import list_models as in_folder
    from robobt.models.find import model_folders

    # Other files of the working folder need not be models, and it need not have a folder of them.
    own = (Path(), *([] if Path("models").is_dir() else [Path("models")]))
    paths: list[Path] = []
    for extra in (*[folder for folder in model_folders() if folder not in own], *further):
        paths += in_folder(extra) if extra.is_dir() else [extra]
    found, problems = _read({path.resolve(): path for path in paths}.values())
    if as_json:
        print_json({"models": [model_data(file) for file in found], "problems": problems})
    elif found:
        _print_table(found)
    elif not problems:
        say("No model is installed; 'robobt export' writes one.")
    _tell(problems)


def show_model(name: str, out: Path | None, *, as_json: bool) -> None:
    """Print the card of a model, by its name or file, or write it to ``out`` as model hubs read it.

    Raises:
        typer.Exit: the file is no intact model.
    """
    from robobt.models.find import find_model

    found, problems = _read([find_model(name)])
    if found and out is not None:
        _write_hub_page(found[0], out)
    elif as_json:
        print_json({"models": [model_data(file) for file in found], "problems": problems})
    elif found:
        _print_whole(found[0])
    _tell(problems)


def _write_hub_page(file: ModelFile, out: Path) -> None:
    from robobt.config.atomic import write_atomically
    from robobt.config.resources import models_folder
    from robobt.models.hub_card import hub_page

    # Those that ship have robobt's licence; of others nobody has said it.
    shipped = file.path.resolve().parent == models_folder().resolve()
    write_atomically(out, hub_page(file, "mit" if shipped else ""))
    say(f"Card: {out}" + ("" if shipped else "; add the model's license to its metadata"))


def _read(paths: Iterable[Path]) -> tuple[list[ModelFile], list[str]]:
    from robobt.models.file import ModelError, read_model_file

    found: list[ModelFile] = []
    problems: list[str] = []
    for each in paths:
        try:
            found.append(read_model_file(each))
        except ModelError as error:
            problems.append(str(error))
    return found, problems


def _tell(problems: list[str]) -> None:
    for problem in problems:
        warn(problem)
    if problems:
        raise typer.Exit(1)


def model_data(file: ModelFile) -> dict[str, object]:
    """Return what is known of a model's file, as plain data."""
    from robobt.models.file import read_manifest

    return {
        "file": str(file.path),
        "format": file.format,
        "size": file.size,
        "sha256": file.sha256,
        "listed": file.path.name in read_manifest(file.path.parent),
        "card": file.card.model_dump(mode="json"),
    }


def _print_table(files: list[ModelFile]) -> None:
    listed = table("model", "skill", "algorithm", "observation", "held-out results")
    listed.columns[0].no_wrap = True
    for file in files:
        card = file.card
        figures = [
            f"{name.replace('_', ' ')} {_figure(one.value, one.unit)}" for name, one in card.held_out.items()
        ][:2]
        listed.add_row(
            escape(card.name),
            escape(card.skill),
            escape(card.algorithm),
            escape(f"{card.observation.name} v{card.observation.version}"),
            escape(", ".join(figures)),
        )
    console.print(listed)


def _print_whole(file: ModelFile) -> None:
    card = file.card
    limits = {} if card.limits is None else card.limits.model_dump(exclude_none=True)
    say(f"{card.name}: {card.description or card.skill}")
    lines = {
        "file": f"{file.path} ({file.format}, {file.size} bytes)",
        "SHA-256": file.sha256,
        "skill": f"{card.skill} ({card.kind.replace('_', ' ')})",
        "algorithm": card.algorithm,
        "observation": f"{card.observation.name} version {card.observation.version}: "
        + in_short(card.observation.features),
        "outputs": ", ".join([f"{one.name} ({_figure(one.scale, one.unit)})" for one in card.outputs]),
        "period": "" if card.period is None else f"{card.period:g} s",
        "limits": ", ".join([f"{name} {value}" for name, value in limits.items()]),
        "seed": "" if card.seed is None else str(card.seed),
        "code": f"robobt {card.code_version or 'unknown'}, commit {card.code_commit or 'unknown'}",
        "written by": card.created_by,
        "settings": "--json has those of its environment and training",
    }
    for title, text in lines.items():
        if text:
            say(f"  {title:12} {text}")
    print_held_out(file)


def in_short(features: Iterable[str]) -> str:
    """Return the entries of an observation as text, with those that every numbered robot has told once."""
    texts: list[str] = []
    for kind, group in groupby(features, _kind):
        names = list(group)
        found = [match for name in names if (match := _NUMBERED.fullmatch(name))]
        numbers = list(dict.fromkeys([match[2] for match in found]))
        entries = list(dict.fromkeys([match[3] for match in found]))
        whole = [f"{kind}_{number}_{entry}" for number in numbers for entry in entries]
        if len(numbers) > 1 and names == whole:
            texts.append(f"{kind}_{numbers[0]} to {kind}_{numbers[-1]} ({', '.join(entries)} of each)")
        else:
            texts += names
    return ", ".join(texts)


_NUMBERED = re.compile(r"(.+?)_(\d+)_(.+)")
"""An entry of a numbered robot, such as ``mate_0_vx [m/s]``."""


def _kind(name: str) -> str:
    match = _NUMBERED.fullmatch(name)
    return "" if match is None else match[1]


def print_held_out(file: ModelFile) -> None:
    """Print what a model did on starts that training never saw."""
    if not file.card.held_out:
        return
    listed = table("held-out result", "value", "interval", "n")
    for name, one in file.card.held_out.items():
        within = "" if one.low is None or one.high is None else f"{one.low:.4g} to {one.high:.4g}"
        about = f" ({one.interval})" if within and one.interval else ""
        listed.add_row(
            escape(name.replace("_", " ")), _figure(one.value, one.unit), escape(within + about), str(one.n)
        )
    console.print(listed)


def _figure(value: float, unit: str) -> str:
    return f"{value:.4g}" if unit == "1" else f"{value:.4g} {unit}"
