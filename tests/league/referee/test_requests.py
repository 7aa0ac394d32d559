"""Cards, substitutions and another goalkeeper in the middle of a match under the official controller."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from robobt.league.referee.official import OfficialReferee, OfficialRefereeFactory
from robobt.league.wire.messages import Change
from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.match.referee.settings import RefereeSettings
from robobt.world.game import GameState, Team
from robobt.world.presence import without_absent
from robobt.world.rules import in_own_defense_area
from robobt.world.state import Frame
from robobt.worlds import sim_world

OFFICIAL = os.environ.get("ROBOBT_GAME_CONTROLLER", "")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not OFFICIAL, reason="ROBOBT_GAME_CONTROLLER does not name the official program"),
]

LONGEST = 10.0
"""What is asked is done within this time in which robots may move [s]."""


@pytest.fixture
def match() -> Iterator[MatchLoop]:
    scenario = load_scenario("six_v_six").lasting(600.0)
    scenario = scenario.model_copy(update={"referee": RefereeSettings(yellow_card_time=15.0)})
    with MatchLoop(scenario, 7, sim_world, referee=OfficialRefereeFactory(Path(OFFICIAL))) as match:
        while not match.game.in_play:
            assert match.tick()
        yield match


def ask(match: MatchLoop, change: Change) -> None:
    referee = match.referee
    assert isinstance(referee, OfficialReferee)
    referee.tell(change)


def team_change(**changes: object) -> Change:
    return Change(update_team_state_change=Change.UpdateTeamState(for_team="BLUE", **changes))  # type: ignore[arg-type]


def until(match: MatchLoop, done: Callable[[Frame, GameState], bool], longest: float) -> float:
    """Play until blue has done it; return for how long robots could move [s]."""
    spent = 0.0
    while spent < longest:
        assert match.tick()
        truth = match.world.truth()
        truth.game = match.game
        if done(without_absent(truth, match.game), match.game):
            return spent
        spent += 0.0 if match.game.halted else truth.period
    return longest


def test_after_a_card_a_robot_leaves_and_comes_back(match: MatchLoop) -> None:
    ask(match, Change(add_yellow_card_change={"for_team": "BLUE"}))
    until(match, lambda _, game: game.blue.max_robots == 5, 2.0)
    assert until(match, lambda frame, _: len(frame.own) <= 5, LONGEST) < LONGEST
    until(match, lambda _, game: game.blue.max_robots == 6, 120.0)
    assert until(match, lambda frame, _: len(frame.own) == 6, LONGEST) < LONGEST


def test_the_goalkeeper_that_is_named_goes_into_the_goal(match: MatchLoop) -> None:
    def there(frame: Frame, _: GameState) -> bool:
        keeper = frame.robot(4)
        return keeper is not None and in_own_defense_area(frame.field, keeper.x, keeper.y)

    ask(match, team_change(goalkeeper={"value": 4}))
    assert until(match, there, LONGEST) < LONGEST
    assert match.game.status(Team.BLUE).keeper == 4


def test_at_a_substitution_all_stand_until_play_goes_on(match: MatchLoop) -> None:
    ask(match, team_change(requests_bot_substitution={"value": True}))
    assert until(match, lambda _, game: game.blue.substituting, 180.0) < 180.0
    begun = match.world.truth().time
    while match.world.truth().time - begun < 2.0:
        assert match.tick()
    truth = match.world.truth()
    assert max(robot.speed for robot in (*truth.own, *truth.opponents)) < 0.1
    assert until(match, lambda _, game: game.in_play, 60.0) < 60.0
    assert not match.game.blue.substituting
