"""A recorded match as a page for the browser, a picture or an animation, or in the live page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from robobt.cli.common import say
from robobt.cli.option_groups.page import Page
from robobt.cli.options import option
from robobt.cli.outputs import PAGE, RECORDING
from robobt.cli.recordings import recording_file

RECORDING_FORMATS = (PAGE, ".gif", ".png")
"""How the names of files end that a recording is written to."""


@dataclass(frozen=True)
class Shown:
    """Which part of a recording is shown, and where."""

    live: Annotated[bool, option("--live", " instead of writing a page, for a long recording")] = False
    start: Annotated[
        float | None,
        option("--from", "; by default the start, for a picture the end", min=0.0),
    ] = None
    end: Annotated[float | None, option("--to", ", of an animation; by default the end", min=0.0)] = None
    robot: Annotated[str | None, option("--robot", " to show beside a picture or animation")] = None

    def given(self) -> str | None:
        """Return one of the options that was given, None if none was."""
        named = {"--live": self.live, "--from": self.start, "--to": self.end, "--robot": self.robot}
        return next((name for name, value in named.items() if value not in (None, False)), None)

    def check(self, ending: str) -> None:
        """Refuse options that would do nothing; ``ending`` is that of the file to write, empty for none."""
        picture = ending in (".gif", ".png")
        for given, needed, name in (
            (self.start is not None, self.live or picture, "--from"),
            (self.end is not None, ending == ".gif", "--to"),
            (self.robot is not None, picture, "--robot"),
            (self.live, not ending, "--live"),
        ):
            if given and not needed:
                raise typer.BadParameter("does nothing here; see --help", param_hint=name)


def show_recording(recording: Path, out: Path | None, shown: Shown, page: Page) -> None:
    """Write a recording or league log as a page, a picture or an animation, or show it in the live page."""
    shown.check("" if out is None else out.suffix.lower())
    if shown.live:
        _show(recording, shown.start or 0.0, page)
        return
    from robobt.match.recording import load_recording

    with recording_file(recording) as file:
        loaded = load_recording(file)
    stem = recording.name.removesuffix(".gz").removesuffix(".log").removesuffix(RECORDING)
    target = recording.with_name(f"{stem}{PAGE}") if out is None else out
    if target.exists() and target.samefile(recording):
        raise typer.BadParameter("is the recording itself; give another name", param_hint="--out")
    if out is None:
        _check_replaced(target)
    if target.suffix.lower() in (".gif", ".png"):
        from robobt.cli.recordings import recorded_robot
        from robobt.live.replay_picture import write_gif, write_png

        who = None if shown.robot is None else recorded_robot(loaded, shown.robot)
        if target.suffix.lower() == ".gif":
            say(f"Animation: {write_gif(loaded, target, shown.start, shown.end, who)}")
        else:
            say(f"Picture: {write_png(loaded, target, shown.start, who)}")
        return
    from robobt.live.replay_html import write_html

    say(f"Page: {write_html(loaded, target)}")


def _check_replaced(page: Path) -> None:
    """Refuse to replace a page that this command has not written, where nobody has named it."""
    from robobt.live.replay_html import is_replay

    if page.is_file() and not is_replay(page):
        there = f"{page} is there already and no replay; name another page"
        raise typer.BadParameter(there, param_hint="--out")


def _show(recording: Path, start: float, page: Page) -> None:
    """Show a recording or a league log in the live page, until Ctrl-C."""
    with recording_file(recording) as file, page.server() as server:
        from robobt.live.replayed import RecordingPlayback

        RecordingPlayback(server, file, start).show()
