"""What decisions are worth, in the terminal."""

from __future__ import annotations

import pytest

from robobt.cli.common import console
from robobt.cli.shown.what_if import print_decisions
from robobt.what_if import DecisionFigures
from robobt.what_if.compare import MeanEstimate


def test_an_interval_stays_on_one_line_on_a_screen_of_80_columns(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(console, "_width", 80)
    wide = MeanEstimate(-0.011, -0.122, 0.124)
    names = ("nothing changed", "team_player:open_play=small3v3_ppo,open_play_tasks=attack")
    print_decisions([DecisionFigures(name, 5, wide, wide, wide, wide, 1.0) for name in names])
    lines = capsys.readouterr().out.splitlines()
    assert sum(line.count("-0.12 to +0.12") for line in lines) == 8
    assert max(map(len, lines)) <= 80


def test_nothing_has_no_sign_of_less(capsys: pytest.CaptureFixture[str]) -> None:
    small = MeanEstimate(-0.001, -0.002, 0.004)
    print_decisions([DecisionFigures("carry", 5, small, small, small, small, 1.0)])
    shown = capsys.readouterr().out
    assert "+0.00" in shown
    assert "-0.00" not in shown
