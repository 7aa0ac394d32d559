"""Every tutorial runs, with smaller numbers, prints what a reader expects, and is a notebook and a page."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import pytest

from mkdocs_hooks import tutorial
from robobt.plays import PLAYS
from robobt.skills import SKILLS
from tests.notebooks import EXAMPLES, NOTEBOOKS, cells, notebook
from tests.registries import temporarily

if TYPE_CHECKING:
    from pathlib import Path

EXPECTED: dict[str, tuple[dict[str, float], list[str]]] = {
    "01_compose_a_play.py": ({}, ["win the ball", "goal_blue after"]),
    "02_attack_against_a_goalkeeper.py": (
        {"TRIALS": 3},
        ["segment_clearance", "moving_horizon", "scored"],
    ),
    "03_write_your_own_skill.py": ({}, ["in a match: goal_blue"]),
    "04_six_against_six.py": ({"SECONDS": 4.0}, ["PREPARE_KICKOFF", "ball in play", "blue 0"]),
    "05_train_a_skill.py": (
        {"STEPS": 2000},
        ["held out", "written: out/models/example.pt", "goals of 5"],
    ),
    "06_judge_shots.py": ({"SHOTS": 60, "TRIALS": 3}, ["unseen shots", "attack_expected"]),
    "07_play_over_the_network.py": ({"TRIALS": 1}, ["of 1 scored over the network"]),
    "08_tournament.py": ({"ROUNDS": 1, "SECONDS": 2.0}, ["team_player    Elo", "in 2 matches"]),
    "09_play_live.py": ({"SECONDS": 2.0, "SPEED": 20.0}, ["Live: http://", "0:0 after"]),
}

FIGURES = r"[0-9a-f]{32}|\d+"


def test_every_example_is_tested() -> None:
    assert sorted(EXPECTED) == sorted(path.name for path in EXAMPLES.glob("*.py"))


def kept(name: str) -> dict[str, Any]:
    """The notebook of an example, as `make notebooks` wrote it."""
    found: dict[str, Any] = json.loads((NOTEBOOKS / name).with_suffix(".ipynb").read_text())
    return found


def outputs(notebook: Mapping[str, Any]) -> list[list[dict[str, str]]]:
    """What each cell printed and showed, as text by its kind."""
    return [
        [output.get("data", {"stdout": output.get("text", "")}) for output in cell.get("outputs", ())]
        for cell in notebook["cells"]
    ]


def printed(notebook: Mapping[str, Any]) -> str:
    return "".join([shown.get("stdout", "") for cell in outputs(notebook) for shown in cell])


@pytest.mark.integration
@pytest.mark.parametrize("name", EXPECTED)
def test_an_example_runs_and_its_notebook_shows_what_it_does(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    numbers, words = EXPECTED[name]
    script = (EXAMPLES / name).read_text()
    for constant, value in numbers.items():
        script, found = re.subn(rf"(?m)^{constant} = [\d_.]+$", f"{constant} = {value}", script)
        assert found == 1
    monkeypatch.chdir(tmp_path)
    with temporarily(PLAYS), temporarily(SKILLS):
        made = notebook(script, {"__name__": "__main__"})
    for word in words:
        assert word in printed(made)
        assert re.sub(FIGURES, "#", word) in re.sub(FIGURES, "#", printed(kept(name)))
    shown, before = outputs(made), outputs(kept(name))
    assert [[list(one) for one in cell] for cell in shown] == [[list(one) for one in cell] for cell in before]
    if not numbers:  # the same but for figures, in whose last bits machines differ
        assert re.sub(FIGURES, "#", str(shown)) == re.sub(FIGURES, "#", str(before))


@pytest.mark.parametrize("name", EXPECTED)
def test_an_examples_notebook_and_page_hold_all_of_its_code_and_prose(name: str) -> None:
    script = list(cells((EXAMPLES / name).read_text()))
    assert [(cell["cell_type"], cell["source"]) for cell in kept(name)["cells"]] == script
    page = tutorial((NOTEBOOKS / name).with_suffix(".ipynb"))
    assert page.startswith("# ")
    for kind, text in script:
        assert (f"```python\n{text}\n```" if kind == "code" else text) in page
    assert all(line in page for line in printed(kept(name)).splitlines())
