"""Placement succeeds, and opponents in its way."""

from __future__ import annotations

import pytest

from robobt.match.referee.events import EventKind
from robobt.world import GameState, Team
from robobt.world.game import RefereeCommand, Restart
from tests.match.referee.watching import Watching

DONE, INTERFERED = EventKind.PLACEMENT_SUCCEEDED, EventKind.BOT_INTERFERED_PLACEMENT
SPOT = (1.0, 1.0)


def placing(us: Team, kicks: Team | None) -> Watching:
    """We place the ball to the spot for a free kick, or for both."""
    following = RefereeCommand.FORCE_START
    if kicks is not None:
        following = RefereeCommand[f"DIRECT_FREE_{kicks.name}"]
    command = RefereeCommand[f"BALL_PLACEMENT_{us.name}"]
    # The views of the two sides are told apart when the frame is turned.
    game = GameState(
        command,
        restart=Restart.BALL_PLACEMENT,
        restart_team=us,
        may_touch=True,
        placement=SPOT,
        upcoming=following,
    )
    return Watching(us, game=game)


@pytest.mark.parametrize(("off", "placed"), [(0.149, True), (0.151, False)])
def test_a_ball_near_enough_to_the_spot_is_placed(us: Team, off: float, placed: bool) -> None:
    game = placing(us, us).roll(0.0, 0.0).roll(1.0 + off, 1.0).wait(3.0)
    assert game.kinds == [DONE] * placed
    if placed:
        assert game.last.team is us
        assert game.last.details["precision"] == pytest.approx(off)
        assert game.last.details["distance"] == pytest.approx(2**0.5)


def test_no_placement_succeeds_before_two_seconds(us: Team) -> None:
    game = placing(us, us).roll(*SPOT)
    assert game.wait(1.9).events == []
    assert game.wait(0.2).kinds == [DONE]


def test_the_ball_has_to_lie_still(us: Team) -> None:
    game = placing(us, us).wait(2.0)
    for step in range(50):
        game.roll(1.0 + 0.002 * (step - 25), 1.0)
    assert game.events == []
    assert game.wait(1.0).kinds == [DONE]


@pytest.mark.parametrize(
    ("kicks", "gap", "free"),
    [("us", 0.139, False), ("us", 0.141, True), ("them", 0.589, False), ("them", 0.591, True)],
)
def test_robots_have_let_go_of_it(us: Team, kicks: str, gap: float, free: bool) -> None:
    game = placing(us, us if kicks == "us" else us.other).roll(*SPOT).ours(1, SPOT[0] - gap, SPOT[1])
    assert game.wait(3.0).kinds == [DONE] * free


def test_for_both_teams_robots_are_half_a_metre_away(us: Team) -> None:
    game = placing(us, None).roll(*SPOT).ours(1, SPOT[0] - 0.3, SPOT[1]).wait(3.0)
    assert game.events == []
    assert game.ours(1, SPOT[0] - 0.6, SPOT[1]).wait(0.1).kinds == [DONE]


@pytest.mark.parametrize(("gap", "near"), [(0.589, True), (0.591, False)])
@pytest.mark.parametrize("x", [0.0, 0.5, 1.0], ids=["the ball", "the way", "the spot"])
def test_opponents_keep_off_ball_way_and_spot(us: Team, x: float, gap: float, near: bool) -> None:
    game = placing(us, us).roll(0.0, 1.0).theirs(2, x, 1.0 - gap)
    assert game.wait(1.9).events == []
    assert game.wait(0.2).kinds == [INTERFERED] * near
    assert game.wait(5.0).kinds == [INTERFERED] * near


def test_a_robot_that_comes_back_interferes_anew(us: Team) -> None:
    game = placing(us, us).roll(0.0, 1.0).theirs(2, 0.0, 1.2).wait(2.2)
    game.theirs(2, 0.0, 2.2).tick().theirs(2, 0.0, 1.2).wait(2.2)
    assert game.kinds == [INTERFERED] * 2


def test_the_placing_team_may_be_there(us: Team) -> None:
    assert placing(us, us).roll(0.0, 1.0).ours(2, 0.0, 1.2).wait(3.0).events == []
