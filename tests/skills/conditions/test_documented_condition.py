"""The condition that docs/trees.md shows how to write."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from robobt.skills import SKILLS
from robobt.tree import Status
from tests.registries import temporarily
from tests.skills.fixed_world import Alone, frame, robot

PAGE = Path(__file__).parents[3] / "docs" / "trees.md"


@pytest.mark.parametrize(("away", "gap", "status"), [(0.5, 0.6, "SUCCESS"), (0.5, 0.4, "FAILURE")])
def test_it_holds_while_an_opponent_is_close(away: float, gap: float, status: str) -> None:
    blocks = re.findall(r"(?ms)^```python\n(.*?)^```", PAGE.read_text())
    (block,) = [block for block in blocks if "(Condition)" in block]
    scope: dict[str, Any] = {"__name__": "__main__"}
    with temporarily(SKILLS):
        exec(compile(block, str(PAGE), "exec"), scope)
        assert SKILLS["OpponentIsNear"].condition
        alone = Alone(scope["OpponentIsNear"](gap=gap))
        assert alone.tick(frame(robot(), opponents=(robot(away),))) is Status[status]
        assert alone.tick(frame(robot())) is Status.FAILURE
        assert alone.tree.feedback_message == "no opponent is near"
