"""The page of what a skill reads and writes names all of it."""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass
from functools import cached_property
from pathlib import Path

import pytest

from robobt.skills import Skill, Store
from robobt.world import BallState, FieldGeometry, Frame, GameState, RobotCommand, RobotState

PAGE = (Path(__file__).parents[2] / "docs" / "skill_data.md").read_text(encoding="utf-8")
TEXTS = PAGE.split("\n## ")


def described(section: str) -> set[str]:
    """The names in the first column of a section's table."""
    (text,) = [text for text in TEXTS if text.startswith(f"{section}\n")]
    cells = [line.split("|")[1] for line in text.splitlines() if line.startswith("| `")][1:]
    return {name for cell in cells for name in re.findall(r"`(\w+)[`(]", cell)}


@pytest.mark.parametrize(
    "record", [Frame, RobotState, BallState, FieldGeometry, GameState, Store, RobotCommand]
)
def test_every_field_of_a_record_is_on_the_page(record: type) -> None:
    there = described(record.__name__)
    assert there >= {it.name for it in fields(record)} if is_dataclass(record) else {*record.model_fields}
    for name in there:
        assert name in dir(record) or name in getattr(record, "model_fields", ()), f"there is no {name}"
    properties = {name for name, it in vars(record).items() if isinstance(it, property | cached_property)}
    assert there >= {name for name in properties if not name.startswith("_")} - {"made", "outer"}


def test_every_property_of_a_skill_is_on_the_page() -> None:
    names = set(re.findall(r"`self\.(\w+)", TEXTS[0]))
    assert names >= {name for name, it in vars(Skill).items() if isinstance(it, property)}
    assert all(hasattr(Skill, name) or name == "store" for name in names)
