"""Progress bars."""

from __future__ import annotations

from io import StringIO

import pytest
from rich.console import Console

from robobt.cli import progress
from robobt.cli.progress import Progress


def test_a_bar_follows_a_total_that_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = StringIO()
    monkeypatch.setattr(progress, "errors", Console(file=screen, force_terminal=True, width=80))
    with Progress("branches", 1) as bar:
        bar.reach(30, 120)
        bar.reach(61, 122)
    assert "61/122" in screen.getvalue()
