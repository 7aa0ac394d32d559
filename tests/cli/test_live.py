"""The commands that show something in the live page."""

import threading
from _thread import interrupt_main
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.match.recording import load_recording
from tests.live.playing import Client

pytestmark = pytest.mark.integration

Look = Callable[[Client], object]


def seen_by(monkeypatch: pytest.MonkeyPatch, look: Look, *command: str, end: bool = True) -> Client:
    """Run a command whose page somebody opens, looks at, and who then ends it by Ctrl-C."""
    viewers: list[Client] = []

    def visit(url: str) -> None:
        try:
            with Client(url) as viewer:
                viewer.read(look)
                viewers.append(viewer)
        finally:
            if end:
                interrupt_main()

    visits: list[threading.Thread] = []

    def open_page(url: str) -> None:
        visits.append(threading.Thread(target=visit, args=(url,)))
        visits[0].start()

    monkeypatch.setattr("webbrowser.open", open_page)
    result = CliRunner().invoke(app, [*command, "--open"])
    visits[0].join()
    assert result.exit_code == (130 if end else 0), result.output
    return viewers[0]


def test_what_was_played_live_is_shown_again(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = str(tmp_path / "m.robobt.arrows")
    played = ("match", "striker_vs_goalkeeper", "--live", "--record", path, "--seed", "4")
    live = seen_by(monkeypatch, lambda it: len(it.chunks) > 5 and it.state, *played)
    assert live.hello["scenario"] == "striker_vs_goalkeeper"
    assert live.state["movable"]
    recorded = load_recording(path)
    assert len(recorded) > 1
    again = seen_by(monkeypatch, lambda it: it.state.get("over"), "show", path, "--live")
    assert again.hello["seed"] == live.hello["seed"]
    assert again.state["span"] == [recorded.times[0], recorded.times[-1]]
    assert not again.state["movable"]


def test_the_trials_of_a_match_are_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robobt.live.session.LOOK", 0.1)
    played = ("match", "striker_vs_goalkeeper", "--set", "ends.time_limit=2.5", "--trials", "2", "--live")
    viewer = seen_by(monkeypatch, lambda it: it.chunks and it.state, *played, end=False)
    assert viewer.state["viewers"] == 1
