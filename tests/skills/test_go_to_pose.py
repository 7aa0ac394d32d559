from __future__ import annotations

from math import hypot, pi

import pytest

from robobt.skills import GoToPose
from robobt.tree import Status
from robobt.world import Frame, GameState, RefereeCommand, RobotLimits
from robobt.world.rules import in_their_defense_area
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS
from tests.simulation import Trial, always, blue, eventually, inside_the_field, never, yellow
from tests.skills.fixed_world import Alone, frame, moved, robot


def test_without_a_target_it_fails() -> None:
    alone = Alone(GoToPose())
    assert alone.tick(frame(robot())) is Status.FAILURE
    assert alone.tree.feedback_message == "no target"


def test_the_target_comes_from_the_parameter_or_the_store() -> None:
    stored = Alone(GoToPose(), target=(-1.0, 0.0))
    assert stored.tick(frame(robot(), ball=(3.0, 0.0))) is Status.RUNNING
    assert stored.command.vx < 0.0
    given = Alone(GoToPose(target=(1.0, 0.0)), target=(-1.0, 0.0))
    given.tick(frame(robot(), ball=(3.0, 0.0)))
    assert given.command.vx > 0.0


def test_there_means_place_heading_and_standing() -> None:
    go = GoToPose(target=(1.0, 1.0), heading=0.5)
    assert Alone(go).tick(frame(robot(1.0, 1.005, 0.5))) is Status.SUCCESS
    assert Alone(go).tick(frame(robot(1.0, 1.02, 0.5))) is Status.RUNNING
    assert Alone(go).tick(frame(robot(1.0, 1.0, 0.6))) is Status.RUNNING
    assert Alone(go).tick(frame(robot(1.0, 1.0, 0.5, velocity=(0.5, 0.0, 0.0)))) is Status.RUNNING


def test_it_keeps_its_heading_unless_told_otherwise() -> None:
    alone = Alone(GoToPose(target=(2.0, 0.0)))
    alone.tick(frame(robot(heading=1.0)))
    assert alone.command.omega == 0.0
    alone.tick(frame(robot(heading=1.2)))
    assert alone.command.omega < 0.0


def test_it_can_face_the_ball_on_its_way() -> None:
    alone = Alone(GoToPose(target=(2.0, 0.0), face_ball=True))
    alone.tick(frame(robot(), ball=(0.0, 2.0)))
    assert alone.command.omega > 0.0


def test_speed_and_limits_say_how_fast() -> None:
    me = robot(velocity=(3.0, 0.0, 0.0))
    half = Alone(GoToPose(target=(4.0, 0.0), speed=0.5))
    half.tick(frame(me, ball=(0.0, 2.0)))
    assert half.command.vx <= 1.5
    gentle = Alone(GoToPose(target=(4.0, 0.0), limits=RobotLimits(acceleration=1.0)))
    gentle.tick(frame(robot(), ball=(0.0, 2.0), period=0.02))
    assert 0.0 < gentle.command.vx <= 0.02 + 1e-9


def test_it_stands_at_the_nearest_allowed_point() -> None:
    inside_their_area = GoToPose(target=(4.0, 0.9), heading=0.0)
    assert Alone(inside_their_area).tick(frame(robot(4.0, 1.11))) is Status.SUCCESS
    behind_the_wall = GoToPose(target=(0.0, 9.0), heading=0.0)
    assert Alone(behind_the_wall).tick(frame(robot(0.0, 3.19))) is Status.SUCCESS
    keeper = GoToPose(target=(-4.3, 0.0), heading=0.0, goalkeeper=True)
    assert Alone(keeper).tick(frame(robot(-4.3, 0.0))) is Status.SUCCESS


def test_it_arrives_round_robots_and_ball_and_turned() -> None:
    go = GoToPose(target=(2.0, 0.2), heading=pi / 2, avoid_ball=True)
    trial = Trial(
        {blue(0): go},
        {blue(0): (-2.0, 0.0, 0.0), yellow(0): (-0.5, 0.0, pi), yellow(1): (1.0, 0.2, pi)},
        ball=(0.3, 0.0),
    )

    def touched(frame: Frame) -> bool:
        me = frame.own[0]
        return any(hypot(other.x - me.x, other.y - me.y) < 0.18 for other in frame.opponents)

    end = trial.run(
        4.0,
        eventually("it has arrived", lambda _: go.status is Status.SUCCESS),
        always("inside the field", inside_the_field),
        always("the ball lies still", lambda frame: frame.ball.speed == 0.0),
        never("it touches a robot", touched),
    )
    assert abs(end.own[0].heading - pi / 2) < 0.04


def test_it_never_leaves_the_walls_and_never_enters_their_area() -> None:
    trial = Trial({blue(0): GoToPose(target=(9.0, 0.5))}, {blue(0): (0.0, 2.0, 0.0)}, ball=(-2.0, 0.0))
    trial.run(
        3.0,
        always("inside the field", inside_the_field),
        never("in their area", lambda f: in_their_defense_area(f.field, f.own[0].x, f.own[0].y, 0.08)),
    )


def test_it_obeys_a_stop() -> None:
    alone = Alone(GoToPose(target=(4.0, 2.0), avoid_ball=False))
    stopped = GameState(command=RefereeCommand.STOP)
    alone.tick(frame(robot(velocity=(3.0, 0.0, 0.0)), ball=(0.0, -2.0), game=stopped))
    assert hypot(alone.command.vx, alone.command.vy) <= 1.5 + 1e-9


@pytest.mark.parametrize("kicker", [1, 2])
def test_who_took_a_restart_goes_round_its_ball(kicker: int) -> None:
    me, gaps = robot(-1.0, 0.01, number=1), []
    alone = Alone(GoToPose(target=(1.0, 0.0)))
    alone.store.team.kicker = kicker
    for _ in range(120):
        alone.tick(frame(me), 1)
        me = moved(me, alone.command, 1 / 60)
        gaps.append(hypot(me.x, me.y) - ROBOT_RADIUS - BALL_RADIUS)
    assert me.x > 0.9
    assert (min(gaps) > 0.05) is (kicker == 1)
