"""Field geometry. Origin at the centre, x towards the goal a team attacks, metres."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from pydantic import Field, model_validator

from robobt.config.validation import Settings

_PENALTY_SHARE = 2.0 / 3.0
"""Penalty mark to attacked goal as a share of the field's length: 6 of 9 m, 8 of 12 m. Source: SSL rules."""


class FieldGeometry(Settings):
    """Dimensions of a field in metres, lines included in the areas they bound.

    Tournament fields may differ by 10 % from the rules' sizes, so nothing in
    robobt hard-codes a dimension: skills read it from ``frame.field``.

    Source of the presets: RoboCup SSL rules, chapter "Playing Environment".
    """

    length: float = Field(gt=0.5, le=50, description="goal line to goal line [m]")
    width: float = Field(gt=0.5, le=50, description="touch line to touch line [m]")
    goal_width: float = Field(gt=0.1, le=20, description="between the inner sides of the posts [m]")
    goal_depth: float = Field(0.18, gt=0.05, le=2, description="goal line to back wall [m]")
    defense_width: float = Field(gt=0, le=50, description="defence area along the goal line [m]")
    defense_depth: float = Field(gt=0, le=25, description="defence area into the field [m]")
    center_radius: float = Field(0.5, gt=0, le=10, description="centre-circle radius [m]")
    margin: float = Field(0.3, ge=0.2, le=5, description="touch line to the wall beside it [m]")
    goal_line_margin: float = Field(
        0.3, ge=0.2, le=5, description="goal line to the wall behind it, by default like margin [m]"
    )

    @model_validator(mode="before")
    @classmethod
    def _margin_all_around(cls, data: Any) -> Any:
        if isinstance(data, dict) and "margin" in data and "goal_line_margin" not in data:
            return {**data, "goal_line_margin": data["margin"]}
        return data

    @model_validator(mode="after")
    def _parts_fit(self) -> FieldGeometry:
        if self.goal_width >= self.width:
            raise ValueError(f"goal_width {self.goal_width} must be smaller than width {self.width}")
        if self.defense_width > self.width:
            raise ValueError(f"defense_width {self.defense_width} must not exceed width {self.width}")
        if self.defense_depth > self.length / 2:
            raise ValueError(f"defense_depth {self.defense_depth} must not exceed half the length")
        if self.goal_depth > self.goal_line_margin:
            raise ValueError(
                f"goal_depth {self.goal_depth} must not exceed goal_line_margin {self.goal_line_margin}"
            )
        return self

    @cached_property
    def half_length(self) -> float:
        """The opponent's goal line, its x [m]."""
        return self.length / 2

    @cached_property
    def half_width(self) -> float:
        """The left touch line, its y [m]."""
        return self.width / 2

    @cached_property
    def their_goal(self) -> tuple[float, float]:
        """Centre of the attacked goal on its line [m]."""
        return (self.length / 2, 0.0)

    @cached_property
    def our_goal(self) -> tuple[float, float]:
        """Centre of the defended goal on its line [m]."""
        return (-self.length / 2, 0.0)

    @cached_property
    def outer(self) -> tuple[float, float]:
        """The walls behind their goal and beside the left touch line, their x and y [m]."""
        return (self.half_length + self.goal_line_margin, self.half_width + self.margin)

    @cached_property
    def penalty_distance(self) -> float:
        """Penalty mark to the centre of the attacked goal [m]."""
        return _PENALTY_SHARE * self.length

    def contains(self, x: float, y: float, tolerance: float = 0.0) -> bool:
        """Return whether (x, y) lies inside the lines, grown outwards by ``tolerance`` [m]."""
        return abs(x) <= self.half_length + tolerance and abs(y) <= self.half_width + tolerance


DIVISION_A = FieldGeometry(
    length=12.0, width=9.0, goal_width=1.8, defense_width=3.6, defense_depth=1.8, goal_line_margin=0.6
)
"""Division A of the rules of 2026: 12 m x 9 m, up to 11 robots a team."""

DIVISION_B = FieldGeometry(length=9.0, width=6.0, goal_width=1.0, defense_width=2.0, defense_depth=1.0)
"""Division B of the rules: 9 m x 6 m, up to 6 robots a team."""

FIELDS: dict[str, FieldGeometry] = {"division_a": DIVISION_A, "division_b": DIVISION_B}
