"""The search for moments: what it looks at, and figures that its own luck does not spoil."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import pairwise
from statistics import fmean
from typing import Any

import numpy as np
import pytest

from robobt.what_if import Branch, Branches, LoggedMatch, Moment, decisions_of, promising_moments, scan
from robobt.what_if.compare import MeanEstimate
from robobt.what_if.moments import _short_time, moments_of
from robobt.world import Team
from robobt.world.rules import owner

pytestmark = pytest.mark.integration


class Luck:
    """Branches in which no decision changes anything but luck, except one."""

    def __init__(self, logged: LoggedMatch, good: int = -1) -> None:
        self.logged, self.good, self.tick = logged, good, 0
        self.played: set[int] = set()

    def begin(self, tick: int) -> None:
        self.tick = tick

    def play(self, seed: int, trial: int, *, follow: Any, decision: Any = None, record: Any = None) -> Branch:
        del follow, record
        name = "" if decision is None else decision.name
        drawn = np.random.default_rng([seed, trial, self.tick, *name.encode()])
        worth = 2.0 if self.tick == self.good and name == "carry" else 0.0
        return Branch(
            dict.fromkeys(Team, 0),
            dict.fromkeys(Team, 0.0),
            worth + float(drawn.normal(0.0, 0.5)),
            (0.0, 0.0),
            0.0,
            3.0,
        )


def searched(branches: Any, seed: int, **options: Any) -> list[Any]:
    given = {"count": 3, "trials": 20, "first": 2, "apart": 0.2, **options}
    there = moments_of(branches.logged, Team.BLUE, given.pop("every", 0.2), end=given.pop("end", None))
    moments = [Moment(tick, robot, {}) for tick, robot in there]
    return scan(branches.logged, Team.BLUE, branches, moments, seed=seed, **given)


def test_moments_are_where_a_field_player_gets_and_keeps_the_ball(logged: LoggedMatch) -> None:
    often, seldom = moments_of(logged, Team.BLUE, 0.1), moments_of(logged, Team.BLUE, 5.0)
    for moments, every in ((often, 0.1), (seldom, 5.0)):
        for robot in {robot for _, robot in moments}:
            times = [logged.recording.times[tick] for tick, one in moments if one == robot]
            assert all(later - earlier > every - 0.001 for earlier, later in pairwise(times))
    assert len(often) > len(seldom) >= 1
    assert all(robot.team is Team.BLUE and robot.number != 0 for _, robot in often)
    late = moments_of(logged, Team.BLUE, 0.1, begin=2.0, end=3.0)
    assert all(2.0 <= logged.recording.times[tick] <= 3.0 for tick, _ in late)


def test_a_robot_that_gets_the_ball_again_soon_has_one_moment(logged: LoggedMatch) -> None:
    holders = [owner(logged.recording.frame(tick)) for tick in range(len(logged.recording))]
    changes = [now for before, now in pairwise(one for one in holders if one is not None) if before != now]
    blue = [one for one in changes if one.team is Team.BLUE and one.number != 0]
    moments = moments_of(logged, Team.BLUE, 60.0)
    assert len(blue) > len(moments)
    assert len({robot for _, robot in moments}) == len(moments)


def test_a_decision_that_changes_nothing_is_tried_once(logged: LoggedMatch) -> None:
    tries: Counter[str] = Counter()

    class NoWay(Luck):
        def play(self, seed: int, trial: int, **given: Any) -> Branch:
            decision = given.pop("decision", None)
            if decision is not None:
                tries[decision.name] += 1
                decision = None if decision.name == "shoot" else decision
            return super().play(seed, trial, decision=decision, **given)

    found = searched(NoWay(logged), 1)
    assert tries["shoot"] == len(moments_of(logged, Team.BLUE, 0.2))
    assert tries["carry"] >= 2 * tries["shoot"]
    assert "shoot" not in {one.decision.name for one in found}


def test_the_decisions_are_a_shot_passes_to_mates_carrying_and_a_clearance(logged: LoggedMatch) -> None:
    tick, robot = moments_of(logged, Team.BLUE, 0.2)[0]
    mate = 2 if robot.number == 1 else 1
    names = [one.name for one in decisions_of(logged.recording.frame(tick), robot)]
    assert names == ["shoot", f"pass to {mate}", "carry", "clear", "team_player"]


def test_moments_that_promise_most_are_looked_at(logged: LoggedMatch) -> None:
    there, often = promising_moments(logged, Team.BLUE, 1.0), promising_moments(logged, Team.BLUE, 0.1)
    stretches = moments_of(logged, Team.BLUE, 1.0)
    assert [one.robot for one in there] == [robot for _, robot in stretches]
    assert any(one.tick > first for one, (first, _) in zip(there, stretches, strict=True))
    for one, (first, _) in zip(there, stretches, strict=True):
        frame = logged.recording.frame(one.tick)
        assert owner(frame) == one.robot
        assert one.chances.keys() <= {decision.name for decision in decisions_of(frame, one.robot)}
        assert all(0.0 <= chance <= 1.0 for chance in one.chances.values())
        same = [it for it in often if it.robot == one.robot and 0 <= it.tick - first < 60]
        assert one.best >= 0.7 * max(it.best for it in same)
    assert len(often) > len(there)


def test_the_search_begins_with_what_raters_promise(logged: LoggedMatch) -> None:
    tried: set[str] = set()

    class Watched(Luck):
        def play(self, seed: int, trial: int, **given: Any) -> Branch:
            if given.get("decision") is not None:
                tried.add(given["decision"].name)
            return super().play(seed, trial, **given)

    tick, robot = moments_of(logged, Team.BLUE, 0.2)[0]
    promised = {"carry": 0.4, "clear": 0.3, "team_player": 0.2, "shoot": 0.1}
    branches: Any = Watched(logged)
    scan(logged, Team.BLUE, branches, [Moment(tick, robot, promised)])
    assert tried == {"carry", "clear", "team_player"}


def test_a_good_decision_is_found_first(logged: LoggedMatch) -> None:
    there = moments_of(logged, Team.BLUE, 0.2)
    good = there[len(there) // 2][0]
    found = searched(Luck(logged, good), 1)
    assert (found[0].tick, found[0].decision.name) == (good, "carry")
    gain = found[0].changed.gain
    assert gain.low < 2.0 < gain.high
    times = [one.time for one in found]
    assert all(abs(a - b) >= 0.2 for i, a in enumerate(times) for b in times[:i])


def test_the_figures_of_the_best_of_many_are_not_their_luck(logged: LoggedMatch) -> None:
    gains = [one.gain for seed in range(12) for one in searched(Luck(logged), seed)]
    assert abs(fmean(gains)) < 0.1


def test_the_first_of_the_list_is_not_lucky_either(logged: LoggedMatch) -> None:
    assert abs(fmean(searched(Luck(logged), seed)[0].gain for seed in range(40))) < 0.08


def test_equal_values_leave_room_for_what_was_not_seen() -> None:
    none = MeanEstimate.of([0.0] * 100)
    assert none.mean == 0.0
    assert none.high == -none.low == pytest.approx(0.037, abs=1e-3)


def test_a_real_search_repeats(logged: LoggedMatch) -> None:
    branches = Branches(logged, seconds=0.3)
    options = {"every": 2.0, "count": 1, "trials": 2, "first": 1, "end": 2.5}
    first = searched(branches, 1, **options)
    assert first == searched(branches, 1, **options)
    assert first[0].changed.trials == 2
    branches.close()


@pytest.mark.parametrize("period", [0.01, 0.005, 1 / 60, 0.0001])
def test_the_moment_that_is_named_is_one_at_which_the_robot_has_the_ball(
    logged: LoggedMatch, period: float
) -> None:
    times = np.array([period * tick for tick in range(len(logged.recording))])
    closer = replace(logged.recording, times=times)
    other = replace(logged, recording=closer)
    for tick in range(0, len(closer), 7):
        assert other.tick(float(_short_time(other, tick))) == tick
