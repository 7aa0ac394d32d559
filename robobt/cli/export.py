"""``robobt export``: a trained policy as a model file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.markup import escape

from robobt.cli.common import Json, errors, print_json, say
from robobt.cli.options import option
from robobt.cli.outputs import make_folders
from robobt.cli.shown.models import model_data, print_held_out

if TYPE_CHECKING:
    from robobt.models.file import Format


def export(
    run: Annotated[Path, typer.Argument(help="What 'robobt train' wrote: its folder, or that of one seed.")],
    name: Annotated[str, option("--name", "; by default task and algorithm, as in duel_ppo")] = "",
    onnx: Annotated[bool, option("--onnx", ", beside the TorchScript file")] = False,
    out: Annotated[Path | None, option("--out", "; by default in the run's folder", metavar="FOLDER")] = None,
    force: Annotated[bool, option("--force")] = False,
    as_json: Json = False,
) -> None:
    """Write the best policy of a training run as a model file that skills load.

    The file holds the network, which takes the raw observation in SI units and
    answers an action in [-1, 1], and its model card. It is loaded again and
    compared with the network before it takes its place, and its checksum is
    entered in the folder's manifest. By its name alone it is found in the working folder, in its
    folder 'models' and in those that ROBOBT_MODELS lists.

    Keys of --json: files, a list as 'robobt list models --json' prints it.
    """
    from robobt.learning.training.export_run import export_run
    from robobt.models.file import read_model_file

    make_folders({"--out": out}, folders=True)
    with errors.status(f"exporting {escape(str(run))}"):
        formats: tuple[Format, ...] = ("torchscript", "onnx") if onnx else ("torchscript",)
        files = export_run(run, name, run if out is None else out, formats, force=force)
    read = [read_model_file(path) for path in files]
    if as_json:
        print_json({"files": [model_data(file) for file in read]})
        return
    for file in read:
        say(f"{file.path}: {file.size} bytes, SHA-256 {file.sha256}")
    print_held_out(read[0])
