"""Every rule is told from one team's side and holds for both."""

from __future__ import annotations

import pytest

from robobt.world import Team


@pytest.fixture(params=list(Team), ids=[team.value for team in Team])
def us(request: pytest.FixtureRequest) -> Team:
    return request.param
