"""Where commands write: one rule for the folders of all outputs."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

import typer

from robobt.cli.common import warn
from robobt.config.errors import ConfigError

RECORDING = ".robobt.arrows"
"""How the name of a recorded match ends."""

PAGE = ".html"
PAGES = (PAGE, ".htm")
"""How the names of pages end."""


def check_ending(option: str, output: Path, *endings: str) -> None:
    """Refuse a name that is more likely another file's: what is there is replaced.

    Raises:
        typer.BadParameter: it ends in none of ``endings``.
    """
    if not output.name.lower().endswith(endings):
        there = f"takes a name that ends in {', '.join(endings)}, not '{output}'"
        raise typer.BadParameter(there, param_hint=option)


def make_folders(outputs: Mapping[str, Path | None], *, folders: bool = False) -> None:
    """Make the folders that outputs are written to, and say so, before anything is computed.

    Args:
        outputs: files, or folders that a command fills, by the option that names them; None where it is
            not given.
        folders: whether the outputs are folders.

    Raises:
        ConfigError: an output cannot be written there; the message names the option.
    """
    for option, output in outputs.items():
        if output is None:
            continue
        if output.is_dir() != folders and output.exists():
            raise ConfigError(option, f"{output} is {'no' if folders else 'a'} folder")
        folder = output.parent
        try:
            if not folder.exists():
                folder.mkdir(parents=True)
                warn(f"{option}: made the folder {folder}")
        except OSError as error:
            raise ConfigError(option, f"cannot make the folder {folder}: {error.strerror}") from error
        if not folder.is_dir() or not os.access(output if output.exists() else folder, os.W_OK):
            raise ConfigError(option, f"cannot write to {output}")
