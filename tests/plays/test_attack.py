from __future__ import annotations

from math import pi

from robobt.plays import attack_main, attack_support
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
    robot,
    yellow,
)
from robobt.world import Frame, Team
from tests.skills.fixed_world import Alone


def wall(x: float, half_width: float) -> tuple[tuple[float, float], ...]:
    count = int(2 * half_width / 0.18) + 1
    return tuple((x, -half_width + 0.18 * i) for i in range(count))


def doing(now: Frame, **parameters: object) -> str:
    """The branch of attack_main that is at work on a frame."""
    tree = attack_main(**parameters)  # type: ignore[arg-type]
    Alone(tree).tick(now)
    tip = tree.tip()
    assert tip is not None
    assert tip.parent is not None
    return str(tip.parent.name)


def test_with_a_free_way_to_the_goal_it_shoots() -> None:
    me = robot(2.0, 0.0)
    assert doing(frame(me, held(me))) == "score"


def test_with_the_goal_closed_it_passes_to_a_free_mate() -> None:
    me, mate = robot(1.0, 0.0), robot(2.0, 2.0, number=1)
    closed = tuple(robot(x, y, number=i) for i, (x, y) in enumerate(wall(1.6, 0.6)))
    assert doing(frame(me, held(me), mates=(mate,), opponents=closed)) == "pass"


def test_alone_with_the_goal_closed_it_dribbles() -> None:
    me = robot(1.0, 0.0)
    closed = tuple(robot(x, y, number=i) for i, (x, y) in enumerate(wall(1.6, 0.6)))
    assert doing(frame(me, held(me), opponents=closed)) == "dribble"


def test_without_the_ball_and_a_shot_it_gets_the_ball() -> None:
    me = robot(-1.0, 0.0)
    closed = tuple(robot(x, y, number=i) for i, (x, y) in enumerate(wall(1.6, 0.6)))
    assert doing(frame(me, (1.0, 0.0), opponents=closed)) == "get the ball"


def test_from_too_far_away_it_does_not_shoot() -> None:
    me = robot(0.0, 0.0)
    assert doing(frame(me, held(me)), max_distance=3.0) == "dribble"


def test_it_scores_in_an_empty_goal() -> None:
    alone(attack_main(), (-1.0, 1.0, 0.0), ball=(0.5, 0.0), settings="robobulls").run(
        10.0,
        eventually("the ball is in the goal", goal_for(Team.BLUE)),
        always("inside the field", inside_the_field),
    )


def test_it_finds_its_way_round_a_defender() -> None:
    poses = {blue(0): (0.0, 0.0, 0.0), yellow(0): (1.0, 0.0, pi)}
    Trial({blue(0): attack_main(max_distance=3.0)}, poses, ball=(0.1, 0.0)).run(
        12.0,
        eventually("the ball is in the goal", goal_for(Team.BLUE)),
        always("inside the field", inside_the_field),
    )


def test_a_pass_reaches_the_supporter() -> None:
    closed = {yellow(i): (1.6, y, pi) for i, (_, y) in enumerate(wall(1.6, 0.6))}
    poses = {blue(0): (1.0, 0.0, 0.0), blue(1): (2.0, 2.0, -pi / 2), **closed}
    trees = {blue(0): attack_main(), blue(1): attack_support()}
    Trial(trees, poses, ball=(1.1, 0.0)).run(8.0, eventually("the supporter has the ball", has_ball(blue(1))))


def test_the_supporter_waits_in_the_opponents_half_facing_the_ball() -> None:
    poses = {blue(0): (0.0, 0.0, 0.0), blue(1): (-2.0, 1.0, 0.0)}
    trial = Trial({blue(1): attack_support()}, poses, ball=(0.1, 0.0))
    mate = trial.run(5.0).own[1]
    assert mate.x > 0.0
    assert mate.speed < 0.1


def test_the_supporter_stands_still_for_a_mate_that_aims_at_it() -> None:
    passer, me = robot(0.0, 0.0, number=1), robot(2.0, 0.0, number=0)
    alone = Alone(attack_support())
    for tick in range(30):
        alone.tick(frame(me, held(passer), mates=(passer,), time=tick / 60))
    assert alone.command.vx == alone.command.vy == 0.0
    assert alone.command.dribbler
