"""The page on several robots tells the suite's starts and rewards as they are."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.config.validation import Settings
from robobt.learning.envs.soccer.rewards import SoccerReward
from robobt.learning.envs.soccer.suite import SUITE

PAGE = (Path(__file__).parents[3] / "docs" / "several_robots.md").read_text(encoding="utf-8")


def span(ends: tuple[float, float]) -> str:
    return f"{ends[0]:g} to {ends[1]:g}"


def weights(reward: Settings, *, changed: bool) -> str:
    given = reward.model_dump(exclude_defaults=changed)
    return ", ".join(f"`{name}` {value:g}" for name, value in given.items())


@pytest.mark.parametrize("name", SUITE)
def test_every_tasks_starts_and_rewards_are_in_the_docs(name: str) -> None:
    settings = SUITE[name]()
    starts = settings.starts
    field_players = set(settings.yellow) - {"goalkeeper"}
    free = starts.held < 1.0
    cells = [
        name,
        span(starts.blue_x),
        span(starts.yellow_x) if field_players else "",
        span(starts.y),
        span(starts.ball_x) if free else "",
        span(starts.ball_speed) + " at blue" * (starts.coming > 0.0) if free else "",
        f"{100 * starts.held:g} %, {starts.holder}'s" if starts.held else "",
        f"{starts.apart:g}",
        weights(settings.reward, changed=True),
    ]
    assert "|".join([f" {cell} " if cell else " " for cell in cells]) in PAGE


def test_the_weights_of_all_others_are_there_too() -> None:
    assert weights(SoccerReward(), changed=False) in " ".join(PAGE.split())
