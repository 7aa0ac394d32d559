"""``robobt live``: play a scenario in real time and watch it in the browser."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import (
    Bundled,
    Seed,
    Where,
    say,
    warn,
    world_of,
)
from robobt.cli.layers import Layers, layer_names
from robobt.cli.refereeing import Refereeing
from robobt.cli.scenario_options import TeamChanges
from robobt.config.extras import need

if TYPE_CHECKING:
    from robobt.live.server import Server


@dataclass(frozen=True)
class Page:
    """Where the live page is served."""

    host: Annotated[
        str,
        typer.Option(
            help="Address to serve the page at. Any other than this machine's own lets whoever can reach it "
            "and knows the page's address watch and steer, unencrypted."
        ),
    ] = "127.0.0.1"
    port: Annotated[
        int, typer.Option(min=0, max=65535, help="Port to serve the page at; 0 takes a free one.")
    ] = 0
    open_page: Annotated[
        bool | None,
        typer.Option(
            "--open/--no-open", help="Whether to open the page; by default where there is a desktop."
        ),
    ] = None

    @contextmanager
    def server(self) -> Iterator[Server]:
        """Serve the live page, say where, and open it where that is wanted."""
        need("live", "pyarrow", "websockets")
        from robobt.live.server import Server

        own = self.host in ("127.0.0.1", "localhost", "::1")
        names = () if own else tuple(_names_of(self.host))
        with Server(self.host, self.port, names) as server:
            say(f"Live: {server.url}")
            if not own:
                warn(
                    f"the page is open to every machine that can reach {self.host}: whoever has its address "
                    "watches and steers, and nothing is encrypted"
                )
            if _desktop() if self.open_page is None else self.open_page:
                import webbrowser

                webbrowser.open(server.url)
            yield server


def live(
    scenario: Bundled = "six_v_six",
    seed: Seed = None,
    speed: Annotated[
        float, typer.Option(min=0.05, max=20.0, help="Times real time; the page can change it.")
    ] = 1.0,
    paused: Annotated[bool, typer.Option("--paused", help="Wait for the page to start it.")] = False,
    record: Annotated[
        Path | None, typer.Option("--record", help="Record the first match to this file as well.")
    ] = None,
    record_layers: Layers = "",
    *,
    changes: TeamChanges,
    world: Where = "sim",
    refereeing: Refereeing,
    page: Page,
) -> None:
    """Play a scenario in real time and show it in the browser while it happens.

    The page shows all that a replay does, and can pause, step, slow down, go back up to five minutes and
    save what was seen. Ctrl-C ends it.
    """
    from robobt.match import MatchLoop
    from robobt.match.runner import trial_seed

    with page.server() as server:
        from robobt.live.session import Live

        loaded, referees = refereeing.of(changes.scenario(scenario))
        start = loaded.seed if seed is None else seed
        records = [record]

        def make(trial: int) -> MatchLoop:
            seed = trial_seed(start, trial)
            recorded = records.pop() if records else None
            return MatchLoop(loaded, seed, factory, recorded, trial, referees, layer_names(record_layers))

        with world_of(world) as factory:
            Live(server, speed, paused).play_on(make)


def _names_of(host: str) -> Iterator[str]:
    """Give the names by which other machines may call this one."""
    import socket

    if host in ("0.0.0.0", "::"):
        yield socket.gethostname()
        yield from sorted({str(info[4][0]) for info in socket.getaddrinfo(socket.gethostname(), None)})
    else:
        yield host


def _desktop() -> bool:
    return sys.platform in ("darwin", "win32") or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )
