from __future__ import annotations

import pytest

from tests.learning.tiny import draw_no_curves


@pytest.fixture
def curves() -> None:
    """What a test asks for that looks at the picture of a run's curves."""


@pytest.fixture(autouse=True)
def _no_curves(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if "curves" not in request.fixturenames:
        draw_no_curves(monkeypatch)
