"""``robobt replay``: turn recordings into pages for the browser, pictures and animations."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import say
from robobt.cli.live import Page
from robobt.cli.outputs import PAGE, RECORDING, make_folders

_LOGS = (".log", ".log.gz")


def replay(
    recording: Annotated[
        Path, typer.Argument(help=f"A recording (*{RECORDING}), or a league log (*.log, *.log.gz).")
    ],
    html: Annotated[
        Path | None,
        typer.Option("--html", help="The page to write; by default beside the recording, named .html."),
    ] = None,
    gif: Annotated[Path | None, typer.Option("--gif", help="Write an animation, and no page.")] = None,
    png: Annotated[
        Path | None, typer.Option("--png", help="Write a picture of one moment, and no page.")
    ] = None,
    live: Annotated[
        bool,
        typer.Option("--live", help="Show it in the live page instead, for what is too long for a page."),
    ] = False,
    start: Annotated[
        float | None,
        typer.Option(
            "--from",
            min=0.0,
            help="Where --live and --gif begin, by default at the start, and the moment of --png, "
            "by default the end, in seconds.",
        ),
    ] = None,
    end: Annotated[
        float | None, typer.Option("--to", min=0.0, help="Where --gif ends, in seconds; by default the end.")
    ] = None,
    robot: Annotated[
        str | None,
        typer.Option("--robot", help="With --gif or --png: also show this robot's tree, as 'blue 0'."),
    ] = None,
    *,
    page: Page,
) -> None:
    """Make a recorded match a page that opens in any browser and needs no network, or a picture of it."""
    for given, needs, option in (
        (start is not None, live or gif or png, "--from"),
        (end is not None, gif, "--to"),
        (robot is not None, gif or png, "--robot"),
        (live, not (html or gif or png), "--live"),
    ):
        if given and not needs:
            raise typer.BadParameter("does nothing here; see --help", param_hint=option)
    if live:
        _show(recording, start or 0.0, page)
        return
    from robobt.match.recording import load_recording

    with _recording(recording) as file:
        loaded = load_recording(file)
    if html is None and gif is None and png is None:
        stem = recording.name.removesuffix(".gz").removesuffix(".log").removesuffix(RECORDING)
        html = recording.with_name(f"{stem}{PAGE}")
    for target, option in ((html, "--html"), (gif, "--gif"), (png, "--png")):
        if target is not None and target.exists() and target.samefile(recording):
            raise typer.BadParameter("is the recording itself; give another name", param_hint=option)
    make_folders({"--html": html, "--gif": gif, "--png": png})
    if html is not None:
        from robobt.live.replay_html import write_html

        say(f"Replay: {write_html(loaded, html)}")
    if gif is not None or png is not None:
        from robobt.cli.record import recorded_robot
        from robobt.live.replay_picture import write_gif, write_png

        who = None if robot is None else recorded_robot(loaded, robot)
        if gif is not None:
            say(f"Animation: {write_gif(loaded, gif, start, end, who)}")
        if png is not None:
            say(f"Picture: {write_png(loaded, png, start, who)}")


@contextmanager
def _recording(file: Path) -> Iterator[Path]:
    """Give the file itself, or a recording of what a league log holds."""
    if not file.name.lower().endswith(_LOGS):
        yield file
        return
    from robobt.league.log.world import record_log

    with tempfile.TemporaryDirectory() as folder:
        yield record_log(file, Path(folder) / f"{file.name}{RECORDING}")


def _show(recording: Path, start: float, page: Page) -> None:
    """Show a recording or a league log in the live page, until Ctrl-C."""
    with _recording(recording) as file, page.server() as server:
        from robobt.live.replayed import Replay

        Replay(server, file, start).show()
