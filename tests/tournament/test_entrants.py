"""Who takes part, and what its robots play on either side."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.config.errors import ConfigError
from robobt.match import load_scenario
from robobt.plays import PLAYS
from robobt.tournament.entrants import Entrant, EntrantError, RobotPlay, meeting, read_entrant
from tests.tournament.made_up import drill

pytestmark = pytest.mark.integration

TEAM = """
entrant: mine
players:
  - {play: take_shot}
  - {play: attack_main, params: {speed_factor: 0.5}}
goalkeeper: {play: goalkeeper}
"""


def plays(scenario: object, team: str) -> list[str]:
    return [setup.play for robot, setup in scenario.robots if robot.team == team]  # type: ignore[attr-defined]


def test_a_play_is_what_all_field_players_play() -> None:
    scenario = load_scenario("three_v_three")
    met = meeting(scenario, read_entrant("take_shot"), read_entrant("attack_main", {"speed_factor": 0.5}))
    assert plays(met, "blue") == ["refereed_goalkeeper", "take_shot", "take_shot"]
    assert plays(met, "yellow") == ["refereed_goalkeeper", "attack_main", "attack_main"]
    assert dict(met.robots)[
        met.robots.of("yellow")[1] and next(r for r, _ in met.robots if str(r) == "yellow 1")
    ].params == {"speed_factor": 0.5}


def test_a_file_says_what_each_plays_and_the_last_is_all_that_follow(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(TEAM)
    entrant = read_entrant(str(file))
    assert entrant.name == "mine"
    scenario = load_scenario("six_v_six")
    met = meeting(scenario, entrant, entrant)
    for team in ("blue", "yellow"):
        assert plays(met, team) == ["goalkeeper", "take_shot", *["attack_main"] * 4]


def test_both_sides_have_the_same_goalkeeper_unless_an_entrant_brings_its_own() -> None:
    scenario = load_scenario("team_v_baseline")
    new, old = read_entrant("team_player"), read_entrant("team_v_baseline:yellow")
    met = meeting(scenario, old, new)
    assert plays(met, "blue")[0] == "goalkeeper_2026_11"
    assert plays(met, "yellow")[0] == "team_goalkeeper"


def test_a_side_alone_with_its_goalkeeper_plays_what_the_entrant_plays() -> None:
    met = meeting(
        load_scenario("striker_vs_goalkeeper"), read_entrant("take_shot"), read_entrant("take_shot")
    )
    assert plays(met, "yellow") == ["take_shot"]


def test_a_scenarios_side_is_an_entrant_in_any_scenario() -> None:
    old = read_entrant("team_v_baseline:yellow")
    met = meeting(load_scenario("three_v_three"), old, old)
    assert plays(met, "yellow") == ["goalkeeper_2026_11", "defender_2026_11", "defender_2026_11"]


def test_an_edited_tree_is_another_team(tmp_path: Path) -> None:
    tree = tmp_path / "tree.yaml"
    tree.write_text("play: mine\ntree: Stop\n")
    before = read_entrant(str(tree)).digest()
    assert read_entrant(str(tree)).digest() == before
    tree.write_text("play: mine\ntree: Stop \n")
    assert read_entrant(str(tree)).digest() != before


def test_python_files_come_with_the_entrant(tmp_path: Path) -> None:
    (tmp_path / "own.py").write_text(
        "from robobt import PLAYS\nfrom robobt.skills import Stop\n"
        "PLAYS.register('own_stop')(lambda: Stop())\n"
    )
    file = tmp_path / "own.yaml"
    file.write_text("entrant: own\nimports: [own.py]\nplayers: [{play: own_stop}]\n")
    entrant = read_entrant(str(file))
    assert plays(meeting(drill(), entrant, entrant), "blue") == [f"{tmp_path / 'own.py'}:own_stop"]
    assert "own_stop" not in PLAYS


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("no_such_play", "no play is called 'no_such_play'"),
        ("zzz", "'robobt list plays' and 'robobt list scenarios' list what there is"),
        ("no_such.yaml", "no_such.yaml: cannot be read"),
        ("no_such:blue", "no such file or bundled scenario"),
        ("table4_trial1_own:yellow", "yellow has no robot there"),
    ],
)
def test_what_is_no_entrant_is_one_plain_error(text: str, problem: str) -> None:
    with pytest.raises(ConfigError, match=problem):
        read_entrant(text)


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        ("entrant: a\n", "players: is missing"),
        ("entrant: a\nplayers: []\n", "players: "),
        ("entrant: a\nplayers: [{play: nope}]\n", "players.0.play: no play is called 'nope'"),
        ("entrant: a\nplayers: [{play: take_shot}]\nkeeper: {}\n", "keeper: there is no such field"),
        ("entrant: a\nplayers: [{play: take_shot}]\nimports: [gone.py]\n", "imports.0: there is no file"),
        ("entrant: ' a'\nplayers: [{play: take_shot}]\n", "entrant: a name has to be printable"),
        ("robots: {blue: []}\n", "is a scenario; name its side"),
    ],
)
def test_a_wrong_file_is_told_by_its_field(content: str, problem: str, tmp_path: Path) -> None:
    file = tmp_path / "team.yaml"
    file.write_text(content)
    with pytest.raises(EntrantError, match=problem) as raised:
        read_entrant(str(file))
    assert str(raised.value).startswith(str(file))


def test_a_parameter_that_does_not_fit_names_the_robot() -> None:
    entrant = read_entrant("take_shot", {"nope": 1})
    with pytest.raises(ConfigError, match="no such parameter"):
        meeting(drill(), entrant, entrant)


def test_parameters_are_for_plays_only() -> None:
    with pytest.raises(EntrantError, match="takes no parameters"):
        read_entrant("six_v_six:blue", {"speed": 1.0})


def test_another_model_under_the_same_name_is_another_team(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    model, tree = tmp_path / "mine.pt", tmp_path / "tree.yaml"
    tree.write_text("go_to_ball_and_shoot: {policy: mine.pt}\n")
    for given in (RobotPlay(play="attack_main", params={"rater": "mine.pt"}), RobotPlay(play=str(tree))):
        team = Entrant("a", "a", (given,))
        model.write_bytes(b"one")
        before = team.digest()
        assert team.digest() == before
        model.write_bytes(b"another")
        assert team.digest() != before
