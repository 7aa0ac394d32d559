from __future__ import annotations

from robobt.skills.aim.select_clearance import SelectClearance
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.geometry import distance
from tests.skills.fixed_world import Alone, pass_to, shot_at

ME = robot(-4.3, 0.0)
BALL = (-4.0, 0.3)


def test_without_team_mates_there_is_none() -> None:
    alone = Alone(SelectClearance())
    alone.store.pass_ = pass_to(1, 0.0, 0.0)
    assert alone.tick(frame(ME, BALL)) is Status.FAILURE
    assert alone.store.pass_ is None


def test_the_foremost_free_team_mate_gets_it() -> None:
    near, far = robot(-1.0, 1.0, number=1), robot(1.0, -2.0, number=2)
    alone = Alone(SelectClearance())
    assert alone.tick(frame(ME, BALL, mates=(near, far))) is Status.SUCCESS
    assert alone.store.pass_ is not None
    assert alone.store.pass_.receiver == 2
    assert alone.store.pass_.target == far.position


def test_the_ball_is_kicked_fast_enough_to_get_there() -> None:
    near, far = robot(-1.0, 1.0, number=1), robot(1.0, -2.0, number=2)
    speeds = []
    for mate in (near, far):
        alone = Alone(SelectClearance())
        alone.tick(frame(ME, BALL, mates=(mate,)))
        assert alone.store.pass_ is not None
        assert alone.store.pass_.speed > DEFAULT_BALL.kick_speed(distance(BALL, mate.position), 0.9)
        speeds.append(alone.store.pass_.speed)
    assert speeds[0] < speeds[1] <= 6.0


def test_a_shot_chosen_before_is_forgotten() -> None:
    alone = Alone(SelectClearance())
    alone.store.shot = shot_at(4.5, 0.0)
    alone.tick(frame(ME, BALL, mates=(robot(-1.0, 1.0, number=1),)))
    assert alone.store.shot is None


def test_a_team_mate_behind_an_opponent_does_not_get_it() -> None:
    near, far = robot(-1.0, 1.0, number=1), robot(1.0, -2.0, number=2)
    between = robot((1.0 - 4.0) / 2, (-2.0 + 0.3) / 2)
    alone = Alone(SelectClearance())
    alone.tick(frame(ME, BALL, mates=(near, far), opponents=(between,)))
    assert alone.store.pass_ is not None
    assert alone.store.pass_.receiver == 1


def test_a_team_mate_near_the_own_goal_does_not_get_it() -> None:
    alone = Alone(SelectClearance())
    assert alone.tick(frame(ME, BALL, mates=(robot(-2.0, 1.0, number=1),))) is Status.FAILURE
