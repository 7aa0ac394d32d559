"""What decisions are worth, in the terminal."""

from __future__ import annotations

import pytest

from robobt.cli.shown.what_if import print_decisions
from robobt.what_if import DecisionFigures
from robobt.what_if.compare import MeanEstimate


def test_nothing_has_no_sign_of_less(capsys: pytest.CaptureFixture[str]) -> None:
    small = MeanEstimate(-0.001, -0.002, 0.004)
    print_decisions([DecisionFigures("carry", 5, small, small, small, small, 1.0)])
    shown = capsys.readouterr().out
    assert "+0.00" in shown
    assert "-0.00" not in shown
