"""A mistake in the code of a play is told with its file and line."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.match import ScenarioError, load_scenario
from robobt.plays import PLAYS
from tests.registries import temporarily

FILE = """\
import robobt
from robobt.skills import GoToBall, HasBall
from robobt.tree import Sequence


@robobt.PLAYS.register("broken_{number}")
def broken(gain: float = 1.0):
    {line}
"""

MISTAKES = [
    ("return Sequence('s', children=[HasBall()])", "missing 1 required positional argument: 'memory'"),
    (
        "return Sequence('s', memory=False, children=[HasBall])",
        "HasBall is a class; HasBall() makes a node of it",
    ),
    ("return GoToBal()", "NameError: name 'GoToBal' is not defined"),
    ("return GoToBall(policy='nothing')", "no go-to-ball policy is called 'nothing'"),
    ("return 1 + 'a'", "unsupported operand"),
]


@pytest.mark.parametrize(("line", "said"), MISTAKES)
def test_the_line_is_named(line: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.py"
    number = MISTAKES.index((line, said))
    path.write_text(FILE.format(number=number, line=line))
    with temporarily(PLAYS):
        shown = CliRunner().invoke(app, ["tree", f"broken_{number}", "--import", str(path)])
        with pytest.raises(ScenarioError) as caught:
            load_scenario("striker_vs_goalie").with_robot("blue 0", play=f"broken_{number}", params={})
    for told in (" ".join(shown.output.split()), str(caught.value)):
        assert "mine.py:8: " in told
        assert said in told
    assert caught.value.field == "robots.blue.0.play"


def test_a_misspelt_play_is_guessed_and_the_way_to_ones_own_files_named() -> None:
    with pytest.raises(ScenarioError, match=r"did you mean attack_main.*\n?.*come with --import"):
        load_scenario("striker_vs_goalie").with_robot("blue 0", play="atack_main", params={})


def test_a_misspelt_scenario_is_guessed() -> None:
    with pytest.raises(ScenarioError, match="did you mean striker_vs_goalie"):
        load_scenario("striker_vs_golie")
