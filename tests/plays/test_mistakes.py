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
from robobt.tree import Inverter, Leaf, Sequence

class Mine(Leaf):
    def __init__(self):
        pass


@robobt.PLAYS.register("broken_{number}")
def broken(gain: float = 1.0):
    {line}
"""

LINE = FILE.partition("{line}")[0].count("\n") + 1
"""Of the play's body in the file."""

RAISED = [
    ("return Sequence('s', children=[HasBall()])", "missing 1 required positional argument: 'memory'"),
    ("return GoToBal()", "NameError: name 'GoToBal' is not defined"),
    ("return GoToBall(policy='nothing')", "no go-to-ball policy is called 'nothing'"),
    ("return 1 + 'a'", "unsupported operand"),
    ("assert False", "AssertionError"),
    ("exit()", "SystemExit"),
    ("import json; json.loads('{')", "Expecting property name"),
    ("return broken()", "RecursionError"),
    *[
        (f"return {node}", said)
        for child, said in [
            ("HasBall", "HasBall is a class; HasBall() makes a node of it"),
            ("None", "None is not a node"),
            ("'HasBall'", "'HasBall' is not a node"),
            ("[HasBall()]", "a list is not a node; put its nodes into a Sequence"),
            ("broken", "broken is a function; call it, as broken()"),
        ]
        for node in (f"Sequence('s', memory=False, children=[{child}])", f"Inverter('i', {child})")
    ],
    *[
        (f"return Sequence('s', memory=False, children={children})", f"children=[...], not {said}")
        for children, said in [("HasBall()", "HasBall"), ("3", "3"), ("'HasBall'", "'HasBall'")]
    ],
    ("return Sequence('s', memory=False, children=[Mine()])", "let Mine.__init__ call super().__init__(...)"),
    ("node = HasBall(); return Sequence('s', memory=False, children=[node, node])", "already has parent"),
]

RETURNED = [
    ("pass", "returns nothing; return the root of its tree"),
    ("HasBall()", "returns nothing"),
    ("return HasBall", "HasBall is a class; HasBall() makes a node of it"),
    ("return [HasBall()]", "a list is not a node; put its nodes into a Sequence"),
    ("return 'HasBall'", "'HasBall' is not a node"),
    ("return robobt.PLAYS['attack_main']", "attack_main is a function; call it, as attack_main()"),
    ("yield HasBall()", "is a generator; write 'def' and 'return'"),
    ("return Inverter('i', Mine())", "let Mine.__init__ call super().__init__(...)"),
    ("return Mine()", "let Mine.__init__ call super().__init__(...)"),
    (
        "a = HasBall(); return Sequence('s', memory=False, children=[Inverter('i', a), Inverter('j', a)])",
        "HasBall: is a child of 's/i' and of 's/j'; make a node for each place",
    ),
    ("s = Sequence('s', memory=False); s.add_child(s); return s", "s: is its own descendant"),
    ("s = Sequence('s', memory=False); s.children.append(None); return s", "below 's', None is not a node"),
    ("s = Sequence('s', memory=False); s.children = HasBall(); return s", "children of 's' are not a list"),
]


def messages(body: str, number: int, path: Path) -> tuple[str, str]:
    """Return what `robobt show` and a scenario say about a play with this body."""
    path.write_text(FILE.format(number=number, line=body))
    with temporarily(PLAYS):
        shown = CliRunner().invoke(app, ["show", f"broken_{number}", "--import", str(path)])
        with pytest.raises(ScenarioError) as caught:
            load_scenario("striker_vs_goalkeeper").with_robot("blue 0", play=f"broken_{number}", params={})
    assert shown.exit_code == 1
    assert caught.value.field == "robots.blue.0.play"
    return " ".join(shown.output.split()), str(caught.value)


@pytest.mark.parametrize(("line", "said"), RAISED)
def test_the_line_that_raises_is_named(line: str, said: str, tmp_path: Path) -> None:
    for told in messages(line, RAISED.index((line, said)), tmp_path / "mine.py"):
        assert f"mine.py:{LINE}: " in told
        assert said in told


@pytest.mark.parametrize(("line", "said"), RETURNED)
def test_a_play_that_returns_no_tree_is_named_with_its_line(line: str, said: str, tmp_path: Path) -> None:
    number = 100 + RETURNED.index((line, said))
    for told in messages(line, number, tmp_path / "mine.py"):
        assert f"mine.py:{LINE - 2}: the play 'broken_{number}' " in told
        assert said in told


def test_a_misspelt_play_is_guessed_and_the_way_to_ones_own_files_named() -> None:
    with pytest.raises(ScenarioError, match=r"did you mean attack_main.*\n?.*come with --import"):
        load_scenario("striker_vs_goalkeeper").with_robot("blue 0", play="atack_main", params={})


def test_a_misspelt_scenario_is_guessed() -> None:
    with pytest.raises(ScenarioError, match="did you mean striker_vs_goalkeeper"):
        load_scenario("striker_vs_golie")
