from __future__ import annotations

from math import atan2, cos, degrees, hypot, nan, pi, radians, sin

import pytest

from robobt.skills import KickToTarget
from robobt.skills.ball.kick_to_target import MAX_CHIP_SPEED, SHOT_SPEED
from robobt.skills.store import Pass, Shot
from robobt.testing import (
    Trial,
    alone,
    always,
    blue,
    eventually,
    frame,
    goal_for,
    held,
    inside_the_field,
    never,
    robot,
    succeeds,
    touches_a_robot,
    yellow,
)
from robobt.tree import Status
from robobt.world import Frame, KickTrigger, RobotLimits, Team
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.command import CHIP_ANGLE
from robobt.world.geometry import wrap_angle
from tests.skills.fixed_world import Alone, pass_to, shot_at
from tests.skills.refereed import OPEN, free_kick

GOAL = (4.5, 0.0)


def kicked_ball_passes(trial: Trial, target: tuple[float, float], seconds: float = 4.0) -> float:
    """Play until the kick; the angle by which the ball then goes past ``target`` [deg]."""
    frame = trial.run(seconds, eventually("it kicks", lambda _: bool(trial.kicks)))
    course = atan2(frame.ball.vy, frame.ball.vx)
    return degrees(abs(wrap_angle(course - atan2(target[1] - frame.ball.y, target[0] - frame.ball.x))))


def test_without_a_target_it_fails() -> None:
    alone = Alone(KickToTarget())
    assert alone.tick(frame(robot())) is Status.FAILURE
    assert alone.tree.feedback_message == "no target"


def test_aimed_and_with_the_ball_it_kicks_at_full_speed() -> None:
    alone, me = Alone(KickToTarget(target=GOAL)), robot(contact=True)
    assert alone.tick(frame(me, ball=held(me))) is Status.RUNNING
    assert alone.command.kick_speed == SHOT_SPEED
    assert alone.command.kick_trigger is KickTrigger.ON_CONTACT
    assert alone.command.dribbler


def test_the_kick_speed_is_a_parameter() -> None:
    alone, me = Alone(KickToTarget(target=GOAL, kick_speed=2.0)), robot(contact=True)
    alone.tick(frame(me, ball=held(me)))
    assert alone.command.kick_speed == 2.0


def test_off_its_aim_it_turns_with_the_ball_and_does_not_kick() -> None:
    alone, me = Alone(KickToTarget(target=GOAL)), robot(heading=0.5, contact=True)
    alone.tick(frame(me, ball=held(me)))
    assert alone.command.kick_speed == 0.0
    assert alone.command.omega < 0.0
    assert alone.command.dribbler


def test_a_ball_that_comes_is_kicked_softer_by_what_the_kicker_returns_of_its_speed() -> None:
    me = robot(contact=True, limits=RobotLimits(touch_returned=0.2))
    for vx, speed in ((-2.0, 3.1), (0.0, 3.5), (1.0, 3.5)):
        alone = Alone(KickToTarget(target=GOAL, kick_speed=3.5))
        alone.tick(frame(me, ball=(*held(me), vx, 0.0)))
        assert alone.command.kick_speed == pytest.approx(speed)


def test_a_ball_that_moves_ahead_is_kicked_softer_by_what_the_kick_adds() -> None:
    me = robot(contact=True, limits=RobotLimits(kick_carried=0.9))
    for vx, speed in ((-1.0, 3.5), (0.0, 3.5), (1.0, 2.6)):
        alone = Alone(KickToTarget(target=GOAL, kick_speed=3.5))
        alone.tick(frame(me, ball=(*held(me), vx, 0.0)))
        assert alone.command.kick_speed == pytest.approx(speed)


@pytest.mark.parametrize("ahead", [0.2, 1.0])
def test_a_shot_in_the_run_up_breaks_no_speed_limit_where_a_kick_adds_to_the_robot_s_speed(
    ahead: float,
) -> None:
    trial = alone(KickToTarget(target=GOAL), (-ahead, 0.0, 0.0), (0.0, 0.0), settings="erforce")
    trial.run(2.0)
    assert len(trial.kicks) == 1
    fastest = max(frame.ball.speed for frame in trial.frames)
    # The robot's own speed may change by a little before the kick.
    assert 6.0 < fastest <= 6.51


@pytest.mark.integration
@pytest.mark.parametrize("heading", [3.0, -2.0])
def test_a_dribbler_too_weak_to_swing_the_ball_turns_round_it(heading: float) -> None:
    ball = (0.0856 * cos(heading), 0.0856 * sin(heading))
    kick = KickToTarget(target=GOAL, round_ball=True)
    trial = alone(kick, (0.0, 0.0, heading), ball, settings="erforce")
    trial.run(1.3)
    assert len(trial.kicks) == 1
    last = trial.frames[-1].ball
    assert abs(atan2(last.vy, last.vx) - atan2(-last.y, 4.5 - last.x)) < 0.05


def test_a_wide_shot_is_taken_sooner_than_a_narrow_one() -> None:
    me = robot(heading=radians(1.5), contact=True)
    wide, narrow = Alone(KickToTarget()), Alone(KickToTarget())
    wide.store.shot, narrow.store.shot = shot_at(*GOAL, tolerance=0.1), shot_at(*GOAL, tolerance=0.02)
    wide.tick(frame(me, ball=held(me)))
    narrow.tick(frame(me, ball=held(me)))
    assert wide.command.kick_speed > 0.0
    assert narrow.command.kick_speed == 0.0


def test_it_aims_for_the_ball_s_own_sideways_velocity() -> None:
    sideways = 0.4
    lead = atan2(sideways, SHOT_SPEED)
    straight, led = robot(contact=True), robot(heading=-lead, contact=True)
    alone = Alone(KickToTarget(target=(100.0, 0.0)))
    alone.tick(frame(straight, ball=(*held(straight), 0.0, sideways)))
    assert alone.command.kick_speed == 0.0
    alone.tick(frame(led, ball=(*held(led), 0.0, sideways)))
    assert alone.command.kick_speed > 0.0


def test_the_shot_comes_before_the_pass_and_the_parameter_before_both() -> None:
    me = robot(contact=True)
    alone = Alone(KickToTarget())
    alone.store.pass_ = pass_to(2, 3.0, 0.0, speed=3.5)
    alone.tick(frame(me, ball=held(me)))
    assert alone.command.kick_speed == 3.5
    alone.store.shot = Shot(GOAL, 0.05, 1.0)
    alone.tick(frame(me, ball=held(me)))
    assert alone.command.kick_speed == SHOT_SPEED
    elsewhere = Alone(KickToTarget(target=(0.0, 3.0)))
    elsewhere.store.shot = Shot(GOAL, 0.05, 1.0)
    elsewhere.tick(frame(me, ball=held(me)))
    assert elsewhere.command.kick_speed == 0.0


def test_a_pass_is_noted_for_the_team_as_it_is_kicked() -> None:
    alone, me = Alone(KickToTarget()), robot(number=4, contact=True)
    alone.store.pass_ = Pass(2, (3.0, 0.0), 3.5, 0.9)
    alone.tick(frame(me, ball=held(me), time=1.5), number=4)
    team = alone.store.team
    assert (team.passer, team.receiver, team.pass_target, team.pass_time) == (4, 2, (3.0, 0.0), 1.5)


def test_a_shot_is_no_pass() -> None:
    alone, me = Alone(KickToTarget(target=GOAL)), robot(contact=True)
    alone.tick(frame(me, ball=held(me)))
    assert alone.store.team.passer is None


def test_it_succeeds_when_the_ball_has_left() -> None:
    alone, me = Alone(KickToTarget(target=GOAL)), robot(contact=True)
    alone.tick(frame(me, ball=held(me)))
    gone = robot()
    assert alone.tick(frame(gone, ball=(0.2, 0.0, 6.3, 0.0), time=1 / 60)) is Status.SUCCESS


def test_a_ball_that_rolls_off_unkicked_is_no_success() -> None:
    alone, me = Alone(KickToTarget(target=GOAL)), robot(heading=0.5, contact=True)
    alone.tick(frame(me, ball=held(me)))
    assert alone.tick(frame(robot(), ball=(0.3, 0.0, 1.5, 0.0), time=1 / 60)) is Status.RUNNING
    assert alone.tick(frame(robot(), ball=(0.8, 0.0, 1.5, 0.0), time=2 / 60)) is Status.FAILURE
    assert alone.tree.feedback_message == "the ball got away"


def test_before_the_ball_it_goes_round_it() -> None:
    alone, me = Alone(KickToTarget(target=GOAL)), robot(0.3, 0.0, pi)
    alone.tick(frame(me, ball=(0.0, 0.0)))
    assert abs(alone.command.vy) > 0.45 * abs(alone.command.vx), "past its edge, not into it"


@pytest.mark.parametrize("pose", [(-2.0, 0.5, 0.0), (2.0, 0.3, pi), (0.0, -1.5, 1.0), (0.3, 0.0, pi)])
@pytest.mark.parametrize("preset", ["default", "grsim"])
def test_it_shoots_a_resting_ball_into_the_goal(preset: str, pose: tuple[float, float, float]) -> None:
    kick = KickToTarget()
    trial = alone(kick, pose, (0.0, 0.2), settings=preset)
    trial.stores[blue(0)].shot = shot_at(4.5, 0.2)
    assert kicked_ball_passes(trial, (4.5, 0.2)) < 2.0
    trial.run(0.1, eventually("the skill succeeds", succeeds(kick)))
    trial.run(2.0, eventually("the ball is in the goal", goal_for(Team.BLUE)))
    assert len(trial.kicks) == 1


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.0, pi])
def test_with_the_ball_it_turns_and_hits(heading: float) -> None:
    ball = (1.0 + 0.098 * cos(heading), 0.098 * sin(heading))
    trial = alone(KickToTarget(target=GOAL), (1.0, 0.0, heading), ball)
    assert kicked_ball_passes(trial, GOAL, 2.0) < 1.0
    assert trial.frames[-1].time < abs(heading) / 4.0 + 0.6


@pytest.mark.parametrize("velocity", [(0.6, 0.4), (-0.8, 0.0), (0.0, -1.0)])
def test_it_shoots_a_rolling_ball(velocity: tuple[float, float]) -> None:
    trial = alone(KickToTarget(target=GOAL), (-1.5, 0.0, 0.0), (0.0, 0.2, *velocity))
    assert kicked_ball_passes(trial, GOAL) < 3.0


def test_a_ball_at_a_wall_is_taken_off_it_first() -> None:
    trial = alone(KickToTarget(target=GOAL), (-2.0, 0.0, 0.0), (-4.75, 2.0))
    assert kicked_ball_passes(trial, GOAL, 6.0) < 2.0


def test_a_pass_arrives_at_its_receiver() -> None:
    trial = Trial(
        {blue(1): KickToTarget()}, {blue(1): (-2.0, 0.0, 0.0), blue(2): (1.5, 1.5, -2.4)}, (-1.5, 0.3)
    )
    store = trial.stores[blue(1)]
    store.pass_ = Pass(2, (1.5, 1.5), 4.0, 1.0)

    def received(frame: Frame) -> bool:
        mate = frame.own[1]
        return hypot(frame.ball.x - mate.x, frame.ball.y - mate.y) < 0.2

    trial.run(5.0, eventually("the ball is at the receiver", received))
    assert (store.team.passer, store.team.receiver) == (1, 2)


def test_it_keeps_off_the_wall_and_off_robots_on_its_way() -> None:
    trial = Trial(
        {blue(0): KickToTarget(target=GOAL)},
        {blue(0): (-2.0, 0.0, 0.0), yellow(0): (-1.0, 0.0, pi)},
        (0.0, 0.0),
    )
    trial.run(
        4.0,
        eventually("the ball is in the goal", goal_for(Team.BLUE)),
        always("inside the field", inside_the_field),
        never("it touches the opponent", touches_a_robot(blue(0))),
    )


def test_a_chip_is_as_fast_as_its_first_touch_down_needs() -> None:
    alone, me = Alone(KickToTarget(target=(2.0, 0.0), chip=True)), robot(contact=True)
    ball = held(me)
    alone.tick(frame(me, ball=ball))
    assert alone.command.kick_angle == CHIP_ANGLE
    assert alone.command.kick_speed == pytest.approx(DEFAULT_BALL.chip_speed(2.0 - ball[0]))
    far = Alone(KickToTarget(target=(9.0, 0.0), chip=True))
    far.tick(frame(me, ball=ball))
    assert far.command.kick_speed == MAX_CHIP_SPEED


def test_a_kick_is_flat_unless_told_otherwise() -> None:
    alone, me = Alone(KickToTarget(target=GOAL)), robot(contact=True)
    alone.tick(frame(me, ball=held(me)))
    assert alone.command.kick_angle == 0.0


@pytest.mark.parametrize(("touch_downs", "target"), [(1, (1.5, 0.3)), (2, (2.0, -0.4))])
def test_a_chip_flies_over_a_robot_and_touches_down_at_its_target(
    touch_downs: int, target: tuple[float, float]
) -> None:
    kick = KickToTarget(target=target, chip=True, touch_downs=touch_downs)
    robots = {blue(0): (-1.5, 0.0, 0.0), yellow(0): (0.5 * target[0], 0.5 * target[1], pi)}
    trial = Trial({blue(0): kick}, robots, (-0.8, 0.0), settings="default", period=0.005)
    trial.run(4.0, eventually("the skill succeeds", succeeds(kick)))
    down: list[Frame] = []

    def touched_down(frame: Frame) -> bool:
        ball, before = frame.ball, trial.frames[-2].ball
        if ball.vz > before.vz:
            down.append(frame)
        return len(down) == touch_downs

    trial.run(2.0, eventually("it touches down", touched_down))
    ball = down[-1].ball
    assert hypot(ball.x - target[0], ball.y - target[1]) < 0.1
    assert down[-1].last_touch == blue(0)


def test_a_chipped_pass_is_kicked_as_fast_as_it_says() -> None:
    alone, me = Alone(KickToTarget()), robot(contact=True)
    alone.store.pass_ = Pass(2, (3.0, 0.0), 4.2, 1.0, chip=True)
    alone.tick(frame(me, held(me)))
    assert (alone.command.kick_speed, alone.command.kick_angle) == (4.2, CHIP_ANGLE)


def test_what_cannot_be_chipped_is_refused() -> None:
    with pytest.raises(ValueError, match="touch_downs"):
        KickToTarget(chip=True, touch_downs=0)


def test_a_pass_is_not_kicked_before_its_receiver_is_in_time() -> None:
    me = robot(contact=True)
    for wait, kicks in ((0.0, True), (0.4, False)):
        alone = Alone(KickToTarget())
        alone.store.pass_ = Pass(2, (3.0, 0.0), 4.0, 1.0, wait)
        alone.tick(frame(me, held(me)))
        assert (alone.command.kick_speed > 0.0) is kicks


def test_a_pass_may_have_a_tolerance_of_its_own() -> None:
    me = robot(heading=radians(3.0), contact=True)
    for tolerance, kicks in ((None, False), (radians(4.0), True)):
        alone = Alone(KickToTarget(pass_tolerance=tolerance))
        alone.store.pass_ = pass_to(2, 3.0, 0.0)
        alone.tick(frame(me, held(me)))
        assert (alone.command.kick_speed > 0.0) is kicks


def test_a_ball_close_before_it_is_taken_rather_than_gone_round() -> None:
    # The target lies behind the robot, the ball right before its mouth.
    view = frame(robot(), (0.2, 0.02))
    for take, drives_on in ((True, True), (False, False)):
        alone = Alone(KickToTarget(target=(-3.0, 0.0), take=take))
        alone.tick(view)
        straight_on = alone.command.vx > 0.3 and abs(alone.command.vy) < 0.1
        assert straight_on is drives_on


def test_at_a_restart_it_goes_round_a_ball_before_its_mouth_without_touching_it() -> None:
    # It kicks to where it stands from the side.
    me = robot(0.0, -0.125, heading=1.57, number=1)
    for game, touches in ((OPEN, True), (free_kick(Team.BLUE, (0.0, 0.0)), False)):
        alone = Alone(KickToTarget(take=True))
        alone.store.pass_ = pass_to(2, 3.0, 0.0)
        alone.tick(frame(me, (0.0, 0.0), game=game), 1)
        assert (alone.command.vx > 0.2) is touches


def test_at_a_restart_a_ball_that_it_touches_is_kicked_however_it_is_aimed() -> None:
    me = robot(0.0, 0.0, heading=0.3, number=1, contact=True)
    for game, kicks in ((OPEN, False), (free_kick(Team.BLUE, held(me)), True)):
        alone = Alone(KickToTarget())
        alone.store.pass_ = pass_to(2, 3.0, 0.0)
        alone.tick(frame(me, held(me), game=game), 1)
        assert (alone.command.kick_speed > 0.0) is kicks


def test_a_pass_with_a_tolerance_of_its_own_is_kicked_and_chipped_as_told() -> None:
    me = robot(contact=True)
    for kick, speed, angle in (
        (KickToTarget(pass_tolerance=0.06, kick_speed=2.5), 2.5, 0.0),
        (KickToTarget(pass_tolerance=0.06, chip=True, kick_speed=4.5), 4.5, CHIP_ANGLE),
    ):
        alone = Alone(kick)
        alone.store.pass_ = pass_to(2, 3.0, 0.0)
        alone.tick(frame(me, held(me)))
        assert (alone.command.kick_speed, alone.command.kick_angle) == (speed, angle)


@pytest.mark.parametrize(
    ("setting", "value"),
    [("kick_speed", 0.0), ("kick_speed", nan), ("tolerance", -0.1), ("pass_tolerance", 0.0)],
)
def test_a_speed_or_tolerance_that_is_not_positive_is_refused(setting: str, value: float) -> None:
    with pytest.raises(ValueError, match=setting):
        KickToTarget(**{setting: value})  # type: ignore[arg-type]
