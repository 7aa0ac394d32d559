"""The way among moving robots as it is judged in matches."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from itertools import islice
from math import hypot
from types import ModuleType

import pytest

from robobt.plays import PLAYS
from robobt.skills import SKILLS
from robobt.world import DIVISION_B
from robobt.world.game import Team
from robobt.world.rules import in_defense_area
from tests.registries import temporarily


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    # It enters a skill and plays, which other tests are not to see.
    with temporarily(PLAYS), temporarily(SKILLS):
        yield importlib.import_module("benchmarks.among_robots_in_matches")
        del sys.modules["benchmarks.among_robots_in_matches"]


def test_planner_and_model_play_the_same_starts(
    judged: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    judged.main(["go_to_ball_among_robots_ppo", "--starts", "2", "--only", "default"])
    planner, model, later = capsys.readouterr().out.splitlines()
    assert planner.startswith("default, geometric: of 2 reached 2 ")
    assert model.startswith("default, go_to_ball_among_robots_ppo: of 2 reached 2 ")
    assert later.endswith("later where both reach it")


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["save_ppo"], "is a model for Goalkeeper, not for GoToBall"),
        (["nobody"], "no go-to-ball policy is called 'nobody'"),
        (["go_to_ball_ddpg", "--starts", "0"], "--starts: 1 to 3523, not 0"),
        (["go_to_ball_ddpg", "--starts", "5000"], "--starts: 1 to 3523, not 5000"),
        (["go_to_ball_ddpg", "--address", "league://grsim"], "--only: with --address there is one world"),
    ],
)
def test_what_cannot_be_judged_is_one_line(
    judged: ModuleType, words: list[str], problem: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        judged.main([*words, "--only", "default"])
    assert problem in capsys.readouterr().err.splitlines()[-1]


def test_a_wrong_address_is_one_line(judged: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        judged.main(["go_to_ball_ddpg", "--address", "league://nowhere"])
    assert "league://nowhere" in capsys.readouterr().err.splitlines()[-1]


def test_where_nobody_arrives_there_is_no_gap(
    judged: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(judged, "played", lambda *_: (0.0, 1.0, 1.0))
    judged.main(["go_to_ball_ddpg", "--starts", "3", "--only", "default", "--only", "grsim"])
    lines = capsys.readouterr().out.splitlines()
    assert lines[2] == "default: - later where both reach it"
    assert lines[5] == "grsim: - later where both reach it"


def test_the_ball_lies_where_a_field_player_may_go(judged: ModuleType) -> None:
    for start in islice(judged.starts(), 100):
        assert not any(
            in_defense_area(DIVISION_B, team, start["ball_x"], start["ball_y"], 0.2) for team in Team
        )


def test_a_robot_in_the_way_drives_between_its_two_places(judged: ModuleType) -> None:
    start = next(judged.starts())
    with judged.MatchLoop(
        judged.scenario("default", "geometric", start), 0, judged.world_from("sim")
    ) as match:
        for _ in range(20):
            match.tick()
        robots = match.world.truth().opponents
    for k, robot in enumerate(robots):
        (ax, ay), (bx, by) = (
            (start[f"other_{k}_{end}_x"], start[f"other_{k}_{end}_y"]) for end in ("from", "to")
        )
        beside = abs((robot.x - ax) * (by - ay) - (robot.y - ay) * (bx - ax)) / hypot(bx - ax, by - ay)
        assert beside < 0.1
        assert robot.speed > 0.3


def test_whoever_comes_too_near_has_touched(judged: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = judged.scenario("default", "geometric", next(judged.starts()))
    reached, touched, time = judged.played(scenario, 0, judged.world_from("sim"))
    assert (reached, touched) == (1.0, 0.0)
    monkeypatch.setattr(judged, "TOUCHING", 12.0)
    assert judged.played(scenario, 0, judged.world_from("sim"))[:2] == (0.0, 1.0)
    assert time > 1.0
