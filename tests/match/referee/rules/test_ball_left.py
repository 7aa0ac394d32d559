"""Goals, balls over the lines, aimless kicks."""

from __future__ import annotations

import pytest

from robobt.match.referee.events import EventKind
from robobt.world import BALL_RADIUS, DIVISION_A, DIVISION_B, FieldGeometry, Team
from robobt.world.game import Restart
from tests.match.referee.watching import STOP, Watching

GOAL_LINE, TOUCH_LINE = DIVISION_B.half_length, DIVISION_B.half_width


def approx(x: float, y: float) -> object:
    return pytest.approx((x, y), abs=1e-9)


def test_a_ball_fully_over_the_line_between_the_posts_is_a_possible_goal(us: Team) -> None:
    game = Watching(us).touch(1).ours(1, 0.0, 1.0).ours(2, 0.0, 2.0).roll(GOAL_LINE - 0.05, 0.2)
    game.roll(GOAL_LINE + BALL_RADIUS + 0.001, 0.2).wait(1.0)
    (goal,) = game.events
    assert (goal.kind, goal.team, goal.robot) == (EventKind.POSSIBLE_GOAL, us, (us, 1))
    assert goal.details["kicking_bot"] == 1
    assert goal.details["num_robots_by_team"] == 2
    assert goal.details["last_touch_by_team"] == 0.0


def test_a_ball_a_millimetre_short_of_that_is_in(us: Team) -> None:
    game = Watching(us).touch(1).roll(GOAL_LINE - 0.05, 0.2).roll(GOAL_LINE + BALL_RADIUS - 0.001, 0.2)
    assert game.events == []


@pytest.mark.parametrize(("y", "goal"), [(0.499, True), (-0.499, True), (0.501, False), (-0.501, False)])
def test_a_ball_at_the_post_is_in_the_goal_on_its_inner_side(us: Team, y: float, goal: bool) -> None:
    game = Watching(us).touch(1).roll(GOAL_LINE - 0.05, y).roll(GOAL_LINE + 0.04, y)
    assert game.kinds == [EventKind.POSSIBLE_GOAL if goal else EventKind.BALL_LEFT_FIELD_GOAL_LINE]


@pytest.mark.parametrize(("z", "goal"), [(0.11, True), (0.12, False), (1.0, False)])
def test_a_ball_above_the_bar_leaves_over_the_goal_line(us: Team, z: float, goal: bool) -> None:
    game = Watching(us).touch(1).roll(GOAL_LINE - 0.05, 0.0, z=z).roll(GOAL_LINE + 0.05, 0.0, z=z)
    assert game.kinds == [EventKind.POSSIBLE_GOAL if goal else EventKind.BALL_LEFT_FIELD_GOAL_LINE]


def test_a_goal_tells_how_high_the_ball_was_since_the_scorers_touched_it(us: Team) -> None:
    game = Watching(us).touch(2).roll(0.0, 0.0, z=0.9).touch(1).roll(1.0, 0.0)
    game.roll(2.0, 0.0, z=0.6).touch(4, us.other).roll(4.0, 0.0, z=0.02)
    game.roll(GOAL_LINE + 0.05, 0.0)
    assert game.last.details["max_ball_height"] == 0.6


def test_a_height_before_the_ball_was_put_down_does_not_count(us: Team) -> None:
    game = Watching(us).touch(1).roll(0.0, 0.0, z=0.9).now(STOP).roll(0.0, 0.0)
    assert (
        game.kick_of(us).in_play().roll(4.0, 0.0).roll(GOAL_LINE + 0.05, 0.0).last.details["max_ball_height"]
        == 0.0
    )


def test_a_penalty_kick_may_be_chipped(us: Team) -> None:
    game = Watching(us).kick_of(us, Restart.PENALTY).touch(1).roll(3.0, 0.0, z=0.9).roll(4.4, 0.0)
    game.roll(GOAL_LINE + 0.05, 0.0)
    assert game.last.kind is EventKind.POSSIBLE_GOAL
    assert game.last.details["max_ball_height"] is None


def test_an_own_goal_is_the_other_teams(us: Team) -> None:
    game = Watching(us).touch(1).roll(-GOAL_LINE + 0.05, 0.0).roll(-GOAL_LINE - 0.05, 0.0)
    assert (game.last.kind, game.last.team, game.last.robot) == (EventKind.POSSIBLE_GOAL, us.other, None)
    assert game.last.details["kicking_team"] is us


def test_a_ball_over_the_touch_line_is_told_once_with_who_and_where(us: Team) -> None:
    game = Watching(us).touch(3).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.1).wait(0.5)
    (out,) = game.events
    assert (out.kind, out.robot) == (EventKind.BALL_LEFT_FIELD_TOUCH_LINE, (us, 3))
    assert game.at(out) == approx(1.0, TOUCH_LINE + BALL_RADIUS)


@pytest.mark.parametrize(("pause", "told"), [(0.5, 1), (2.5, 2)])
def test_a_ball_that_comes_back_from_the_wall_is_not_out_again_at_once(
    us: Team, pause: float, told: int
) -> None:
    # The league's controller takes a second to stop play.
    game = Watching(us).touch(3)
    for _ in range(2):
        game.roll(1.0, TOUCH_LINE - 0.01).wait(pause).roll(1.0, TOUCH_LINE + 0.1)
    assert len(game.events) == told


def test_a_ball_out_before_play_began_is_told_when_it_begins(us: Team) -> None:
    game = Watching(us).kick_of(us).touch(1).roll(1.0, TOUCH_LINE - 0.2).roll(1.0, TOUCH_LINE + 0.1)
    assert game.events == []
    assert game.in_play().kinds == [EventKind.BALL_LEFT_FIELD_TOUCH_LINE]
    assert game.at(game.last) == approx(1.0, TOUCH_LINE + BALL_RADIUS)


def far_kick(us: Team, field: FieldGeometry, x: float, touched_again: bool = False) -> Watching:
    """We kick the ball from (x, 1) over their goal line, beside the goal."""
    game = Watching(us, field).touch(1).roll(x, 1.0).roll(x + 0.1, 1.0).roll(x + 0.1, 1.9)
    if touched_again:
        game.touch(2, us.other).roll(2.0, 1.9)
    return game.roll(field.half_length - 0.05, 1.9).roll(field.half_length + 0.05, 1.9)


def test_a_kick_from_the_own_half_over_their_goal_line_is_aimless(us: Team) -> None:
    game = far_kick(us, DIVISION_B, -2.0)
    assert game.kinds == [EventKind.AIMLESS_KICK]
    where = game.last.details["kick_location"]
    assert isinstance(where, tuple)
    assert where == approx(*((-2.0, 1.0) if us is Team.BLUE else (2.0, -1.0)))


@pytest.mark.parametrize(("x", "aimless"), [(-0.21, True), (-0.19, False), (0.3, False)])
def test_a_kick_from_the_half_way_line_is_not(us: Team, x: float, aimless: bool) -> None:
    kind = EventKind.AIMLESS_KICK if aimless else EventKind.BALL_LEFT_FIELD_GOAL_LINE
    assert far_kick(us, DIVISION_B, x).kinds == [kind]


def test_a_touch_on_the_way_makes_it_none(us: Team) -> None:
    game = far_kick(us, DIVISION_B, -2.0, touched_again=True)
    assert (game.last.kind, game.last.team) == (EventKind.BALL_LEFT_FIELD_GOAL_LINE, us.other)


def test_division_a_knows_no_aimless_kick(us: Team) -> None:
    assert far_kick(us, DIVISION_A, -2.0).kinds == [EventKind.BALL_LEFT_FIELD_GOAL_LINE]
