from __future__ import annotations

from dataclasses import replace
from math import hypot, pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robobt.learning.envs.go_to_ball.settings import GoToBallAmongRobotsSettings
from robobt.learning.envs.go_to_ball.task import GoToBallTask
from robobt.models.file import ModelError
from robobt.models.policy import load_policy
from robobt.skills import GoToPose
from robobt.testing import (
    Trial,
    alone,
    always,
    blue,
    eventually,
    frame,
    inside_the_field,
    never,
    robot,
    succeeds,
    touches_a_robot,
    yellow,
)
from robobt.tree import Status
from robobt.world import (
    DIVISION_B,
    BallState,
    Frame,
    GameState,
    RefereeCommand,
    RobotCommand,
    RobotLimits,
    RobotState,
)
from robobt.world.avoiding import GO_TO_BALL_AMONG_ROBOTS, among_robots_of
from robobt.world.rules import in_own_defense_area, in_their_defense_area
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS
from tests.models.made_models import Faulty, Onward, among_robots_card, network, write_model
from tests.skills.fixed_world import Alone, moved


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
    half = Alone(GoToPose(target=(4.0, 0.0), speed_factor=0.5))
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

    end = trial.run(
        4.0,
        eventually("it has arrived", succeeds(go)),
        always("inside the field", inside_the_field),
        always("the ball lies still", lambda frame: frame.ball.speed == 0.0),
        never("it touches a robot", touches_a_robot(blue(0))),
    )
    assert abs(end.own[0].heading - pi / 2) < 0.04


def test_it_never_leaves_the_walls_and_never_enters_their_area() -> None:
    trial = alone(GoToPose(target=(9.0, 0.5)), (0.0, 2.0, 0.0), ball=(-2.0, 0.0))
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


def learned(folder: Path, **given: Any) -> GoToPose:
    return GoToPose(policy=str(write_model(folder, Onward(), among_robots_card())), **given)


def test_a_policy_drives_to_the_place_as_it_does_to_the_ball_in_training(tmp_path: Path) -> None:
    inside = {"robot_x": (-2, 2), "robot_y": (-2, 2), "ball_x": (-2, 2), "ball_y": (-2, 2)}
    task = GoToBallTask(GoToBallAmongRobotsSettings(starts={"distance": (2.5, 9.0), **inside}), 1, seed=2)
    model = write_model(tmp_path, network(GO_TO_BALL_AMONG_ROBOTS.size, 3), among_robots_card())
    policy, alone = load_policy(model), Alone(GoToPose(policy=str(model)))
    seen = task.reset()
    for decision in range(8):
        me, *others = (RobotState(k, *row) for k, row in enumerate(task.arenas.robots[0].tolist()))
        ball = task.arenas.balls[0].tolist()
        alone.store.target = (ball[0], ball[1])
        elsewhere = Frame(
            0.06 * decision, DIVISION_B, BallState(-3.0, 2.5), (me,), tuple(others), period=0.03
        )
        alone.tick(elsewhere)
        assert alone.tree.feedback_message == "driving as learned"
        at_place = replace(elsewhere, ball=BallState(*ball[:2]))
        np.testing.assert_array_equal(among_robots_of(at_place, me), seen[0])
        seen = task.advance(policy(seen)).observation
        told = alone.command
        assert (told.vx, told.vy, told.omega) == pytest.approx(task._commands[0, 0, :3].tolist(), abs=1e-5)


def test_where_a_policy_drives_the_robot_stands_as_it_is_to_in_the_end(tmp_path: Path) -> None:
    go = learned(tmp_path, target=(1.5, 1.0), heading=2.0)
    trial = alone(go, (-2.0, 0.0, 0.0), ball=(3.0, -2.0), period=0.03)
    trial.run(6.0, eventually("it is there", succeeds(go)))


def test_a_policy_is_led_round_the_defence_area(tmp_path: Path) -> None:
    go = learned(tmp_path, target=(-4.2, -1.8))
    trial = alone(go, (-4.2, 1.8, 0.0), ball=(3.0, -2.0), period=0.03)
    trial.run(
        9.0,
        eventually("it is there", succeeds(go)),
        never("in the area", lambda seen: in_own_defense_area(seen.field, *seen.own[0].position)),
    )


def test_a_policy_drives_only_while_the_ball_is_in_play(tmp_path: Path) -> None:
    stopped = frame(robot(), ball=(0.0, 2.0), game=GameState(RefereeCommand.STOP))
    alone, by_hand = Alone(learned(tmp_path, target=(3.0, 0.0))), Alone(GoToPose(target=(3.0, 0.0)))
    alone.tick(stopped)
    by_hand.tick(stopped)
    assert alone.command == by_hand.command
    alone.tick(frame(robot(), ball=(0.0, 2.0)))
    assert alone.tree.feedback_message == "driving as learned"


def test_a_policy_that_answers_nonsense_fails_it_and_stops_the_robot(tmp_path: Path) -> None:
    model = write_model(tmp_path, Faulty("nan", far=3.0), among_robots_card(), probed=False)
    alone = Alone(GoToPose(policy=str(model)), target=(4.0, 0.0))
    assert alone.tick(frame(robot())) is Status.FAILURE
    assert alone.command == RobotCommand()


def test_a_policy_has_to_see_robots(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="takes the observation 'go_to_ball', not 'go_to_ball_among_robots'"):
        GoToPose(policy=str(write_model(tmp_path, network())))
