from __future__ import annotations

from math import pi

import pytest

from robobt.plays import goalkeeper
from robobt.testing import (
    Trial,
    alone,
    always,
    blue,
    eventually,
    frame,
    goal_for,
    has_ball,
    held,
    inside_the_field,
    never,
    robot,
    yellow,
)
from robobt.tree import Behaviour
from robobt.world import Frame, Team
from tests.skills.fixed_world import Alone

HOME = robot(-4.35, 0.0)


def playing(ball: tuple[float, ...]) -> Trial:
    return alone(goalkeeper(), (-4.35, 0.0, 0.0), ball)


def case(now: Frame) -> str:
    """The name of the case that is played on a frame."""
    tree: Behaviour = goalkeeper()
    Alone(tree).tick(now)
    tip = tree.tip()
    assert tip is not None
    assert tip.parent is not None
    return tip.name if tip.parent is tree else str(tip.parent.name)


def test_every_case_has_its_turn() -> None:
    shooter = robot(-2.0, 0.2, heading=pi)
    assert case(frame(HOME, held(shooter), opponents=(shooter,))) == "aim"
    assert case(frame(HOME, (-2.0, 0.0, -3.0, 0.3))) == "shot"
    assert case(frame(HOME, (-3.4, 0.0))) == "fetch"
    assert case(frame(HOME, (-4.0, 0.3))) == "clear"
    assert case(frame(HOME, (0.0, 1.0))) == "CoverAngle"
    assert case(frame(HOME, (-4.6, 1.0))) == "ReturnToGoal"


@pytest.mark.parametrize("y", [-0.3, 0.0, 0.3])
def test_it_saves_a_slow_shot(y: float) -> None:
    playing((-1.0, 0.0, -2.5, y * 2.5 / 3.5)).run(
        4.0,
        never("the ball is in our goal", goal_for(Team.YELLOW)),
        always("inside the field", inside_the_field),
    )


def test_it_clears_a_ball_that_rests_in_its_area() -> None:
    playing((-3.9, 0.4)).run(
        8.0,
        eventually("the ball is far away", lambda frame: frame.ball.x > -2.5),
        never("the ball is in our goal", goal_for(Team.YELLOW)),
    )


def test_it_clears_to_a_team_mate() -> None:
    poses = {blue(0): (-4.35, 0.0, 0.0), blue(1): (-1.0, 2.0, pi)}
    trial = Trial({blue(0): goalkeeper()}, poses, (-3.9, 0.4))
    trial.run(8.0, eventually("the mate gets the ball", has_ball(blue(1))))


def test_it_brings_a_ball_on_the_edge_of_its_area_into_play_again() -> None:
    playing((-3.45, 0.3)).run(
        15.0,
        eventually("the ball is far away", lambda frame: frame.ball.x > -2.5),
        never("the ball is in our goal", goal_for(Team.YELLOW)),
    )


def test_it_leaves_a_ball_on_the_edge_to_an_opponent_close_by() -> None:
    opponent = robot(-3.2, 0.0, heading=0.0)
    assert case(frame(HOME, (-3.4, 0.0), opponents=(opponent,))) == "CoverAngle"


def test_an_attacker_cannot_see_much_of_the_goal() -> None:
    poses = {blue(0): (-4.35, 0.0, 0.0), yellow(0): (-1.0, 1.0, 0.0)}
    trial = Trial({blue(0): goalkeeper()}, poses, (-1.5, 1.2))
    me = trial.run(2.0).own[0]
    assert -4.2 < me.x < -3.6
    assert 0.0 < me.y < 0.5
