"""``robobt export`` and ``robobt models``: trained policies as files, and their cards."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import Json, console, errors, print_json, say, table, warn
from robobt.cli.outputs import make_folders

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robobt.models.file import Format, ModelFile


def export(
    run: Annotated[Path, typer.Argument(help="What 'robobt train' wrote: its folder, or that of one seed.")],
    name: Annotated[
        str,
        typer.Option("--name", help="The model's name, and its file's; by default the task's with _ddpg."),
    ] = "",
    onnx: Annotated[
        bool, typer.Option("--onnx", help="Write an ONNX file beside the TorchScript one.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option("--out", help="Folder to write to; by default that of the run.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a model that is there already.")] = False,
    as_json: Json = False,
) -> None:
    """Write the best policy of a training run as a model file that skills load.

    The file holds the network, which takes the raw observation in SI units and
    answers an action in [-1, 1], and its model card. It is loaded again and
    compared with the network before it takes its place, and its checksum is
    entered in the folder's manifest. By its name alone it is found in the working folder, in its
    folder 'models' and in those that ROBOBT_MODELS lists.

    Keys of --json: files, a list as 'robobt models --json' prints it.
    """
    from robobt.learning.training.export_run import export_run
    from robobt.models.file import read_model_file

    make_folders({"--out": out}, folders=True)
    with errors.status(f"exporting {escape(str(run))}"):
        formats: tuple[Format, ...] = ("torchscript", "onnx") if onnx else ("torchscript",)
        files = export_run(run, name, run if out is None else out, formats, force=force)
    read = [read_model_file(path) for path in files]
    if as_json:
        print_json({"files": [_data(file) for file in read]})
        return
    for file in read:
        say(f"{file.path}: {file.size} bytes, SHA-256 {file.sha256}")
    _print_held_out(read[0])


def models(
    name: Annotated[
        str | None, typer.Argument(help="One model by its name or file, with its whole card.")
    ] = None,
    path: Annotated[
        list[Path] | None,
        typer.Option("--path", help="A further folder of models, or a model file; may be given often."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", help="Write the model's card as a Markdown page with the metadata of model hubs."
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """List the models: those that ship, those in the working folder and in ROBOBT_MODELS, and further ones.

    Files are checked as far as that goes without running them: checksums, archive, card.

    Keys of --json: models, a list with file, format, size (bytes), sha256, listed (whether
    the manifest beside it lists it) and card; problems: a line for each file that is no
    intact model.
    """
    from robobt.models.file import ModelError, read_model_file
    from robobt.models.find import find_model, list_models, model_folders

    if out is not None:
        if name is None:
            raise typer.BadParameter("name the model whose card is to be written", param_hint="--out")
        _write_hub_page(read_model_file(find_model(name)), out)
        return
    if name is not None:
        paths = [find_model(name)]
    else:
        paths = []
        # What else lies in the working folder need not be a model, and it need not have a folder of them.
        own = (Path(), *([] if Path("models").is_dir() else [Path("models")]))
        for extra in (*[folder for folder in model_folders() if folder not in own], *(path or ())):
            paths += list_models(extra) if extra.is_dir() else [extra]
        paths = list({path.resolve(): path for path in paths}.values())
    found: list[ModelFile] = []
    problems: list[str] = []
    for each in paths:
        try:
            found.append(read_model_file(each))
        except ModelError as error:
            problems.append(str(error))
    if as_json:
        print_json({"models": [_data(file) for file in found], "problems": problems})
    elif name is not None and found:
        _print_whole(found[0])
    elif found:
        _print_table(found)
    elif not problems:
        say("No model is installed; 'robobt export' writes one.")
    for problem in problems:
        warn(problem)
    if problems:
        raise typer.Exit(1)


def _write_hub_page(file: ModelFile, out: Path) -> None:
    from robobt.config.atomic import write_atomically
    from robobt.config.resources import models_folder
    from robobt.models.hub_card import hub_page

    make_folders({"--out": out})
    # Those that ship have robobt's licence; of others nobody has said it.
    shipped = file.path.resolve().parent == models_folder().resolve()
    write_atomically(out, hub_page(file, "mit" if shipped else ""))
    say(f"Card: {out}" + ("" if shipped else "; add the model's license to its metadata"))


def _data(file: ModelFile) -> dict[str, object]:
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
    listed = table("model", "skill", "algorithm", "observation", "KiB", "held-out results")
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
            f"{file.size / 1024:.0f}",
            escape(", ".join(figures)),
        )
    console.print(listed)


def _print_whole(file: ModelFile) -> None:
    card = file.card
    say(f"{card.name}: {card.description or card.skill}")
    lines = {
        "file": f"{file.path} ({file.format}, {file.size} bytes)",
        "SHA-256": file.sha256,
        "skill": f"{card.skill} ({card.kind.replace('_', ' ')})",
        "algorithm": card.algorithm,
        "observation": f"{card.observation.name} version {card.observation.version}: "
        + ", ".join(card.observation.features),
        "outputs": ", ".join([f"{one.name} ({_figure(one.scale, one.unit)})" for one in card.outputs]),
        "period": "" if card.period is None else f"{card.period:g} s",
        "limits": _assignments({} if card.limits is None else card.limits.model_dump(exclude_none=True)),
        "seed": "" if card.seed is None else str(card.seed),
        "code": f"robobt {card.code_version or 'unknown'}, commit {card.code_commit or 'unknown'}",
        "written by": card.created_by,
        "settings": "--json has those of its environment and training",
    }
    for title, text in lines.items():
        if text:
            say(f"  {title:12} {text}")
    _print_held_out(file)


def _print_held_out(file: ModelFile) -> None:
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


def _assignments(settings: Mapping[str, object]) -> str:
    return ", ".join([f"{name} {value}" for name, value in settings.items()])
