from __future__ import annotations

import pytest

from tests.waiting import LIMIT


@pytest.fixture(autouse=True)
def _a_busy_machine_has_time_to_set_up_a_field(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robobt.league.placing.TIMEOUT", LIMIT)
