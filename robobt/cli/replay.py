"""``robobt replay``: turn recordings into pages for the browser."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import PAGE, RECORDING, say


def replay(
    recording: Annotated[
        Path, typer.Argument(help=f"A recording (*{RECORDING}), or a league log (*.log, *.log.gz).")
    ],
    html: Annotated[
        Path | None,
        typer.Option("--html", help="The page to write; by default beside the recording, named .html."),
    ] = None,
) -> None:
    """Make a recorded match a page that opens in any browser and needs no network."""
    from robobt.match.recording import load_recording
    from robobt.match.recording.replay_html import write_html

    if recording.name.lower().endswith((".log", ".log.gz")):
        say(f"Replay: {_replay_log(recording, html)}")
        return
    loaded = load_recording(recording)
    stem = recording.name.removesuffix(RECORDING)
    page = recording.with_name(f"{stem}{PAGE}") if html is None else html
    if page.exists() and page.samefile(recording):
        raise typer.BadParameter("is the recording itself; give another name", param_hint="--html")
    say(f"Replay: {write_html(loaded, page)}")


def _replay_log(log: Path, html: Path | None) -> Path:
    """Make the page of a league log."""
    from robobt.league.log.world import record_log
    from robobt.match.recording.replay_html import write_html

    stem = log.name.removesuffix(".gz").removesuffix(".log")
    page = log.with_name(f"{stem}{PAGE}") if html is None else html
    if page.exists() and page.samefile(log):
        raise typer.BadParameter("is the log itself; give another name", param_hint="--html")
    with tempfile.TemporaryDirectory() as folder:
        return write_html(record_log(log, Path(folder) / f"{stem}{RECORDING}"), page)
