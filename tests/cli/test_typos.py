"""A misspelt name is told with the option that it was given by and the name that was meant."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.config.errors import close_names, unknown_name
from robobt.plays import PLAYS
from tests.registries import temporarily

MATCH = "match striker_vs_goalkeeper "

TYPOS = [
    ("train go_to_ball --set stpes=10", "--set: stpes: there is no such field; did you mean steps or"),
    ("train go_to_ball --set agent.gama=1", "--set: agent.gama: there is no such field; did you mean gamma?"),
    ("train gotoball", "no task is called 'gotoball'; did you mean go_to_ball"),
    ("record demonstrations shot --out x.parquet", "no task is called 'shot'; did you mean shoot"),
    ("train go_to_ball --preset fsat", "did you mean fast?"),
    (MATCH + "--set sede=1", "--set: sede: there is no such field; did you mean seed?"),
    (
        MATCH + "--set ends.time_limt=1",
        "--set: ends.time_limt: there is no such field; did you mean time_limit?",
    ),
    (MATCH + "--set simulator.realism=frendly", "--set: simulator: no realism level is called 'frendly'"),
    (
        MATCH + "--blue atack_main",
        "--blue: blue 0: no play is called 'atack_main'; did you",
    ),
    (MATCH + "--yellow goalkeper", "'goalkeper'; did you mean goalkeeper or"),
    (
        MATCH + "--blue attack_main:sped=2",
        "--blue: blue 0: sped: attack_main has no such",
    ),
    (MATCH + "--substitute bleu:*=SUCCESS", "--substitute: robots: there is no robot 'bleu'"),
    ("match striker_vs_golie", "did you mean striker_vs_goalkeeper?"),
    ("show gotoball", "did you mean GoToBall"),
    ("show clearance --kind rater", "did you mean segment_clearance?"),
    ("show geometrical", "did you mean geometric?"),
    ("show Attack-Main", "did you mean attack_main"),
    ("show shot_n", "did you mean shot_nn"),
    ("show obstacles", "'obstacles' is a challenge; "),
    ("shots collect --goalkeepers robobull", "real or a file, and there is no file 'robobull'"),
    ("tournament run atack_main --against attack_nn", "Did you mean attack_main"),
    ("mtach", "Did you mean 'match'?"),
]


@pytest.mark.integration
@pytest.mark.parametrize(("command", "said"), TYPOS)
def test_what_was_meant_is_told_with_the_option(command: str, said: str) -> None:
    ended = CliRunner().invoke(app, command.split(), terminal_width=1000)
    told = " ".join(ended.output.replace("│", " ").split())
    assert ended.exit_code in (1, 2)
    assert said in told
    # Nothing else is listed, and no file is blamed that the user has not written.
    assert len(told) < 900
    assert "--set" not in command or ".yaml" not in told


def test_few_names_are_listed_and_of_many_the_nearest() -> None:
    assert unknown_name("x", ["a", "b"]) == "there are a, b"
    assert unknown_name("seed", ["seeds", "b"]) == "there are seeds, b; did you mean seeds?"
    assert unknown_name("a", []) == "there are none"
    many = [f"name_{letter}" for letter in "abcdefghij"]
    assert unknown_name("other", many) == f"there are {', '.join(many)}"
    assert unknown_name("other", many * 2, command="robobt list names") == "'robobt list names' lists all 20"
    assert unknown_name("name_c", many * 2, command="robobt list names").startswith("did you mean name_c")
    assert unknown_name("name_c", many).count("name_") == 3
    assert close_names("NAME-a", many)[0] == "name_a"


@pytest.mark.integration
@pytest.mark.parametrize("value", ["no_such.pt", "no_such_model"])
def test_a_wrong_model_is_blamed_on_its_parameter_even_beside_needed_ones(value: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.py"
    path.write_text(
        "from robobt.plays import PLAYS\n"
        "from robobt.skills import GoToBall\n"
        "@PLAYS.register('learnt_{0}')\n"
        "def play(*, model: str, speed: float):\n"
        "    return GoToBall(policy=model, speed_factor=speed)\n".replace("{0}", value.replace(".", "_"))
    )
    play = f"learnt_{value.replace('.', '_')}:speed=1,model={value}"
    with temporarily(PLAYS):
        ended = CliRunner().invoke(
            app,
            ["match", "striker_vs_goalkeeper", "--import", str(path), "--blue", play],
            terminal_width=1000,
        )
    assert "--blue: blue 0: model: " in " ".join(ended.output.split())
