"""What the teams did, as a table: after a match, of a recording, of a league log."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from robobt.cli.common import console, name_lines, table

if TYPE_CHECKING:
    from rich.table import Table

_TABLE_ROWS = {
    "goals": ("goals",),
    "expected goals": ("expected_goals",),
    "shots on goal": ("shots_on_goal",),
    "possession": ("possession",),
    "passes completed": ("passes_completed", "passes"),
    "passes intercepted": ("passes_intercepted", "passes"),
    "restarts kept": ("restarts_kept", "restarts"),
    "placements": ("placements_succeeded", "placements"),
    "fouls": ("fouls",),
    "yellow cards": ("yellow_cards",),
    "red cards": ("red_cards",),
    "distance, m": ("distance",),
}
"""Figures of :class:`~robobt.match.results.teams.TeamResult` as rows: one alone, or one of another."""


def team_figures(teams: Mapping[str, Mapping[str, float]], title: str = "") -> Table:
    """Return a row a figure and a column a team."""
    share = (console.width - 22) // max(1, len(teams))
    listed = table(title, *[name_lines(name, console.width - share) for name in teams])
    for label, names in _TABLE_ROWS.items():
        listed.add_row(label, *[_text(label, [team[name] for name in names]) for team in teams.values()])
    return listed


def _text(label: str, values: list[float]) -> str:
    if label == "possession":
        return f"{values[0]:.0%}"
    text = " of ".join(
        f"{value:.0f}" if value == round(value) or value >= 100.0 else f"{value:.2f}" for value in values
    )
    if len(values) > 1 and values[1] > 0.0:
        text += f" ({values[0] / values[1]:.0%})"
    return text
