"""Branches start from a moment of the log, repeat by their seed, and follow the log as long as they can."""

from __future__ import annotations

from dataclasses import replace
from math import hypot
from pathlib import Path

import numpy as np
import pytest

from robobt.match.recording import load_recording
from robobt.what_if import BallDecision, Branches, LoggedMatch, WhatIfError
from robobt.what_if.errors import NO_ERRORS
from robobt.what_if.moments import moments_of
from robobt.what_if.pictured import ORIGINAL
from robobt.world import RobotId, Team
from robobt.world.game import OPEN_PLAY, GameState, RefereeCommand

pytestmark = pytest.mark.integration

YELLOW = [Team.YELLOW]


def moment(logged: LoggedMatch) -> tuple[int, RobotId]:
    """The first moment at which blue has the ball for a while."""
    return moments_of(logged, Team.BLUE, 0.2)[1]


def test_a_branch_repeats_by_its_seed_and_number(logged: LoggedMatch, branches: Branches) -> None:
    branches.begin(moment(logged)[0])
    first = branches.play(3, 0, follow=YELLOW)
    assert branches.play(3, 1, follow=YELLOW) != first
    assert branches.play(4, 0, follow=YELLOW) != first
    assert branches.play(3, 0, follow=YELLOW) == first


def test_a_branch_does_not_depend_on_moments_before(logged: LoggedMatch, branches: Branches) -> None:
    tick = moment(logged)[0]
    branches.begin(tick)
    first = branches.play(3, 0)
    branches.begin(tick + 60)
    branches.play(3, 0)
    branches.begin(tick)
    assert branches.play(3, 0) == first


def test_all_robots_follow_the_log_where_nothing_disturbs_them(logged: LoggedMatch, tmp_path: Path) -> None:
    tick = moment(logged)[0]
    branches = Branches(logged, seconds=0.5, errors=NO_ERRORS, leave=5.0)
    branches.begin(tick)
    path = tmp_path / "branch.robobt.arrows"
    branches.play(0, 0, follow=list(Team), record=branches.recording(str(path), "branch"))
    branches.close()
    branch = load_recording(path)
    assert len(branch) == 31
    assert branch.times[0] == pytest.approx(logged.recording.times[tick])
    for step in (0, 15, 30):
        really = logged.recording.truth.robots[tick + step]
        off = np.hypot(*(branch.truth.robots[step, :, :2] - really[:, :2]).T)
        assert off.max() < 0.05
    drawn = branch.drawn["field"][0][1]
    assert {shape[0] for shape in drawn} == {ORIGINAL}
    assert len(drawn) == 2 * 6 + 1


def test_nothing_changed_goes_on_as_in_the_log_for_a_while(logged: LoggedMatch) -> None:
    tick = moment(logged)[0]
    branches = Branches(logged, seconds=0.4, errors=NO_ERRORS)
    branches.begin(tick)
    branch, really = branches.play(0, 0, follow=YELLOW), branches.really()
    branches.close()
    assert really.ball == tuple(logged.recording.truth.ball[tick + 24, :2].tolist())
    assert hypot(branch.ball[0] - really.ball[0], branch.ball[1] - really.ball[1]) < 0.15
    assert branch.followed == pytest.approx(0.4)


def test_robots_no_longer_follow_the_log_once_the_ball_is_elsewhere(logged: LoggedMatch) -> None:
    tick = moment(logged)[0]
    branches = Branches(logged, seconds=0.5, leave=0.0)
    branches.begin(tick)
    assert branches.play(0, 0, follow=YELLOW).followed < 0.1
    branches.close()


def test_a_decision_is_carried_out_and_the_own_play_goes_on(logged: LoggedMatch) -> None:
    tick, robot = moment(logged)
    mate = 2 if robot.number == 1 else 1
    branches = Branches(logged, seconds=1.5, errors=NO_ERRORS)
    branches.begin(tick)
    without = branches.play(0, 0)
    cleared = branches.play(0, 0, decision=BallDecision(robot, "clear"))
    passed = branches.play(0, 0, decision=BallDecision(robot, f"pass to {mate}", mate))
    assert len({without.ball, cleared.ball, passed.ball}) == 3
    assert branches.play(0, 0) == without
    branches.close()


def test_a_stopped_game_is_refused_and_when_it_goes_on_is_told(logged: LoggedMatch) -> None:
    stop = GameState(RefereeCommand.STOP)
    recording = replace(logged.recording, games=[(0, stop), (100, logged.game(0))])
    stopped = LoggedMatch(recording, logged.scenario, logged.known)
    with pytest.raises(
        WhatIfError, match=r"at 0\.50 s the game is stopped \(STOP\); play goes on at 1\.67 s"
    ):
        stopped.check_moment(stopped.tick(0.5))
    with pytest.raises(WhatIfError, match=r"holds from 0 to .* s, not 99 s"):
        stopped.tick(99.0)


def test_goals_before_the_moment_do_not_count(logged: LoggedMatch) -> None:
    scored = replace(logged.game(0), blue_score=3, yellow_score=1)
    recording = replace(logged.recording, games=[(0, scored)])
    branches = Branches(LoggedMatch(recording, logged.scenario, logged.known), seconds=0.1)
    for tick in (0, 30):
        branches.begin(tick)
        for branch in (branches.play(0, 0), branches.really()):
            assert branch.goals == {Team.BLUE: 0, Team.YELLOW: 0}
            assert max(branch.expected.values()) < 1.0
    branches.close()


def test_a_goal_in_a_log_without_a_referee_counts(logged: LoggedMatch) -> None:
    ball = np.array(logged.recording.truth.ball)
    ball[30:] = [5.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    ball[29, :2] = 4.45, 0.0
    truth = replace(logged.recording.truth, ball=ball)
    recording = replace(logged.recording, truth=truth, games=[(0, OPEN_PLAY)])
    branches = Branches(LoggedMatch(recording, logged.scenario, logged.known), seconds=1.0)
    branches.begin(20)
    really = branches.really()
    branches.close()
    assert really.goals == {Team.BLUE: 1, Team.YELLOW: 0}
    assert really.expected[Team.BLUE] >= 1.0
    assert really.stands == 0.0
    assert really.lasted == pytest.approx(10 / 60)


def test_a_goal_that_the_referee_gives_after_the_stop_counts(logged: LoggedMatch) -> None:
    running = logged.game(0)
    stop = GameState(RefereeCommand.STOP)
    given = replace(stop, yellow_score=1)
    games = [(0, running), (60, stop), (90, given), (120, replace(running, yellow_score=1))]
    match = LoggedMatch(replace(logged.recording, games=games), logged.scenario, logged.known)
    branches = Branches(match, seconds=2.0)
    branches.begin(20)
    really = branches.really()
    branches.close()
    assert really.goals == {Team.BLUE: 0, Team.YELLOW: 1}
    assert really.lasted == pytest.approx(40 / 60)


def test_other_plays_play_from_the_moment_on(logged: LoggedMatch, branches: Branches) -> None:
    tick = moment(logged)[0]
    still = logged.scenario
    for number in (1, 2):
        still = still.with_robot(f"blue {number}", play="stand_still")
    other = Branches(logged, still, seconds=1.0)
    other.begin(tick)
    branches.begin(tick)
    changed, unchanged = other.play(1, 0, follow=YELLOW), branches.play(1, 0, follow=YELLOW)
    other.close()
    assert changed.ball != unchanged.ball
