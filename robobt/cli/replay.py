"""``robobt replay``: turn recordings into pages for the browser."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import PAGE, RECORDING, say
from robobt.cli.live import Host, Open, Port, page_server


def replay(
    recording: Annotated[
        Path, typer.Argument(help=f"A recording (*{RECORDING}), or a league log (*.log, *.log.gz).")
    ],
    html: Annotated[
        Path | None,
        typer.Option("--html", help="The page to write; by default beside the recording, named .html."),
    ] = None,
    live: Annotated[
        bool,
        typer.Option("--live", help="Show it in the live page instead, for what is too long for a page."),
    ] = False,
    start: Annotated[
        float, typer.Option("--from", min=0.0, help="With --live: from where on, in seconds.")
    ] = 0.0,
    host: Host = "127.0.0.1",
    port: Port = 0,
    open_page: Open = None,
) -> None:
    """Make a recorded match a page that opens in any browser and needs no network."""
    if live:
        _show(recording, start, host, port, open_page)
        return
    from robobt.live.replay_html import write_html
    from robobt.match.recording import load_recording

    if recording.name.lower().endswith((".log", ".log.gz")):
        say(f"Replay: {_replay_log(recording, html)}")
        return
    loaded = load_recording(recording)
    stem = recording.name.removesuffix(RECORDING)
    page = recording.with_name(f"{stem}{PAGE}") if html is None else html
    if page.exists() and page.samefile(recording):
        raise typer.BadParameter("is the recording itself; give another name", param_hint="--html")
    say(f"Replay: {write_html(loaded, page)}")


def _show(recording: Path, start: float, host: str, port: int, open_page: bool | None) -> None:
    """Show a recording or a league log in the live page, until Ctrl-C."""
    with tempfile.TemporaryDirectory() as folder:
        if recording.name.lower().endswith((".log", ".log.gz")):
            from robobt.league.log.world import record_log

            recording = record_log(recording, Path(folder) / f"{recording.name}{RECORDING}")
        with page_server(host, port, open_page) as server:
            from robobt.live.replayed import Replay

            Replay(server, recording, start).show()


def _replay_log(log: Path, html: Path | None) -> Path:
    """Make the page of a league log."""
    from robobt.league.log.world import record_log
    from robobt.live.replay_html import write_html

    stem = log.name.removesuffix(".gz").removesuffix(".log")
    page = log.with_name(f"{stem}{PAGE}") if html is None else html
    if page.exists() and page.samefile(log):
        raise typer.BadParameter("is the log itself; give another name", param_hint="--html")
    with tempfile.TemporaryDirectory() as folder:
        return write_html(record_log(log, Path(folder) / f"{stem}{RECORDING}"), page)
