from __future__ import annotations

import gc

import pytest


@pytest.fixture(autouse=True)
def _no_clean_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """Do not look for garbage before each case: nobody looks at times here, and it would take longer."""
    monkeypatch.setattr(gc, "collect", lambda *_: 0)
