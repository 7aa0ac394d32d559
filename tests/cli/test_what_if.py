"""``robobt what-if``."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from robobt.cli import app
from robobt.live.replay_html import is_replay
from robobt.what_if import BallDecision, Branch, Branches, DecisionFigures, Found, load_logged
from robobt.what_if.compare import MeanEstimate
from robobt.what_if.moments import moments_of
from robobt.world import RobotId, Team
from robobt.world.rules import owner
from tests.what_if.made import recorded

pytestmark = pytest.mark.integration


FAILING = """
from robobt.plays.base import PLAYS
from robobt.skills.base import Skill, skill


@skill
class FailsInABranch(Skill):
    def on_running(self):
        raise RuntimeError("no way on")


@PLAYS.register("fails_in_a_branch")
def fails_in_a_branch():
    return FailsInABranch()
"""


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return recorded(tmp_path_factory.mktemp("what_if"), 4.0)


@pytest.fixture(scope="module")
def time(small: Path) -> float:
    """When a blue robot has the ball."""
    logged = load_logged(small)
    return float(logged.recording.times[moments_of(logged, Team.BLUE, 0.2)[1][0]])


def invoke(*options: object) -> Result:
    return CliRunner().invoke(app, ["what-if", *map(str, options)])


def test_decisions_at_a_moment_are_compared_and_a_branch_is_recorded(small: Path, time: float) -> None:
    page = small.with_name("branch.html")
    done = invoke(small, "--at", time, "--trials", 3, "--seconds", 0.5, "--record", page, "--json")
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert (said["team"], said["seconds"], said["record"]) == ("blue", 0.5, str(page))
    names = [one["name"] for one in said["decisions"]]
    assert names[:2] == ["nothing changed", "shoot"]
    assert said["decisions"][0]["gain"] is None
    assert set(said["really"]) == {"expected", "goals"}
    for one in said["decisions"][1:]:
        assert one["trials"] == 3
        assert one["gain"]["low"] <= one["gain"]["mean"] <= one["gain"]["high"]
    assert is_replay(page)
    assert "original" in page.read_text()


def test_another_play_is_compared_with_what_played(small: Path, time: float) -> None:
    options = (small, "--at", time, "--blue", "stand_still", "--trials", 3, "--seconds", 0.5)
    said = json.loads(invoke(*options, "--json").stdout)
    assert [one["name"] for one in said["decisions"]] == ["nothing changed", "stand_still"]
    shown = invoke(*options)
    assert "blue's goals in the next 0.5 s" in shown.output
    assert "stand_still" in shown.output


def test_a_tree_that_fails_in_a_branch_is_told(small: Path, time: float, tmp_path: Path) -> None:
    own = tmp_path / "own.py"
    own.write_text(FAILING)
    shown = invoke(small, "--at", time, "--blue", "fails_in_a_branch", "--import", own, "--trials", 2)
    assert shown.exit_code == 3
    assert "FailsInABranch: RuntimeError: no way on (own.py:9)" in " ".join(shown.output.split())
    assert "nothing changed" in shown.output


def test_who_decides_is_told_and_whose_branch_is_recorded(small: Path, time: float) -> None:
    options = (small, "--at", time, "--trials", 2, "--seconds", 0.3)
    page = small.with_name("one.html")
    shown = " ".join(invoke(*options, "--record", page).output.split())
    assert re.search(r"blue \d has the ball and decides otherwise", shown)
    assert re.search(r"Replay of '(shoot|pass to \d|carry|clear)', with the log", shown)


def test_a_moment_at_which_nobody_decides_is_refused_and_the_next_is_named(small: Path, time: float) -> None:
    logged = load_logged(small)
    ticks = range(len(logged.recording))
    loose = next(tick for tick in ticks if owner(logged.recording.frame(tick)) is None)
    at = float(logged.recording.times[loose])
    nobody, yellow = invoke(small, "--at", at), invoke(small, "--at", time, "--team", "yellow")
    assert (nobody.exit_code, yellow.exit_code) == (1, 1)
    assert f"nobody has the ball at {at:g} s, so no other decision can be tried; " in nobody.output
    assert f"no robot of yellow has the ball at {time:g} s" in yellow.output
    assert "--scan looks for moments" in nobody.output
    found = re.search(r"((blue|yellow) \d) has it at (\d+\.\d\d) s", nobody.output)
    assert found is not None
    assert owner(logged.recording.frame(logged.tick(float(found[3])))) == RobotId(
        Team(found[2]), int(found[1][-1])
    )


def test_a_match_is_searched_and_each_moment_has_a_replay(small: Path) -> None:
    folder = small.with_name("moments")
    options = ("--scan", "--trials", 2, "--moments", 2, "--every", 1.0, "--seconds", 0.5, "--to", 3)
    done = invoke(small, *options, "--out", folder, "--json")
    assert done.exit_code == 0, done.output
    moments = json.loads(done.stdout)["moments"]
    assert 1 <= len(moments) <= 2
    for one in moments:
        assert is_replay(Path(one["replay"]))
        assert one["changed"]["trials"] == 2
        assert one["robot"].startswith("blue ")


def test_moments_that_are_worth_nothing_are_left_out_and_counted(
    small: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def figures(name: str, gain: float | None) -> DecisionFigures:
        worth = MeanEstimate(gain or 0.0, (gain or 0.0) - 0.1, (gain or 0.0) + 0.1)
        return DecisionFigures(name, 9, worth, worth, None if gain is None else worth, worth, 1.0)

    def found(*gains: float) -> list[Found]:
        decision = BallDecision(RobotId(Team.BLUE, 2), "carry")
        unchanged = figures("nothing changed", None)
        return [
            Found(1.0 + i, 60, decision, unchanged, figures("carry", it), 0) for i, it in enumerate(gains)
        ]

    monkeypatch.setattr("robobt.what_if.scan", lambda *_args, **_given: found(0.2, 0.004, -0.1))
    shown = invoke(small, "--scan").output
    searched = len(moments_of(load_logged(small), Team.BLUE, 0.5))
    assert f"{searched - 1} of {searched} moments left out: worth less than 0.005 expected goals" in shown
    assert "+0.20" in shown
    assert shown.count("carry") == 1
    said = json.loads(invoke(small, "--scan", "--json").stdout)
    assert ([one["time"] for one in said["moments"]], said["searched"]) == ([1.0], searched)
    monkeypatch.setattr("robobt.what_if.scan", lambda *_args, **_given: found(0.004))
    none = invoke(small, "--scan").output
    assert f"{searched} moments searched; no other decision was worth 0.005 expected goals" in none


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ((), "give either --at or --scan"),
        (("--scan", "--at", 1.0), "give either --at or --scan"),
        (("--scan", "--blue", "stand_still"), "--blue: goes with --at"),
        (("--at", 1.0, "--out", "moments"), "goes with --scan"),
        (("--at", 1.0, "--to", 2.0), "--to: goes with --scan"),
        (("--at", 1.0, "--from", 0.5, "--to", 2.0), "--from, --to: go with --scan"),
        (("--at", 1.0, "--team", "red"), "must be one of 'blue', 'yellow', not 'red'"),
        (("--at", 99.0), "holds from 0 to"),
        (("--scan", "--from", 99.0), "holds from 0 to"),
        (("--scan", "--from", 3.0, "--to", 2.0), "--to has to be later than --from"),
        (("--at", 1.0, "--blue", "nobody"), "no play is called 'nobody'"),
    ],
)
def test_what_cannot_be_played_is_told_in_one_line(
    small: Path, options: tuple[object, ...], problem: str
) -> None:
    done = invoke(small, *options)
    assert done.exit_code in (1, 2)
    assert problem in " ".join(done.output.replace("│", " ").split())


def test_the_log_is_not_replaced_by_a_branch(small: Path, time: float) -> None:
    before = small.read_bytes()
    done = invoke(small, "--at", time, "--trials", 2, "--seconds", 0.1, "--record", small)
    assert (done.exit_code, small.read_bytes() == before) == (2, True)
    assert "would replace the log" in done.output


def test_a_branch_of_a_log_without_plays_is_recorded_as_it_was_measured(
    small: Path, time: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    logged = load_logged(small)
    logged.known = False
    played: list[tuple[bool, list[Team]]] = []
    play = Branches.play

    def watched(self: Branches, *args: Any, **given: Any) -> Branch:
        played.append((given.get("record") is not None, list(given["follow"])))
        return play(self, *args, **given)

    monkeypatch.setattr("robobt.what_if.load_logged", lambda *_: logged)
    monkeypatch.setattr(Branches, "play", watched)
    page = small.with_name("unknown.html")
    done = invoke(small, "--at", time, "--trials", 2, "--seconds", 0.1, "--record", page)
    assert done.exit_code == 0, done.output
    assert {kept for kept, _ in played} == {False, True}
    assert {tuple(follow) for _, follow in played} == {tuple(Team)}
