from __future__ import annotations

from math import cos, degrees, hypot, pi, radians, sin

import pytest

from robobt.skills.robobulls.detour import allowed, first_waypoint
from robobt.skills.robobulls.kick import ROBOBULLS_KICK_SPEED, KickStage, RobobullsKick
from robobt.skills.robobulls.pilot import robobulls_drive
from robobt.skills.store import Store
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import DIVISION_B, KickTrigger, RobotState
from tests.skills.fixed_world import moved

GOAL = (4.5, 0.0)
PERIOD = 0.03


def tick(
    kick: RobobullsKick, me: RobotState, ball: tuple[float, ...], **others: object
) -> tuple[Status, Store]:
    store = Store(frame(me, ball, period=PERIOD, **others), me)  # type: ignore[arg-type]
    return kick.tick(store, GOAL), store


def drive_until(
    kick: RobobullsKick, me: RobotState, ball: tuple[float, float], stage: KickStage
) -> RobotState:
    for _ in range(400):
        _, store = tick(kick, me, ball)
        if kick.stage is stage:
            return me
        me = moved(me, store.command, PERIOD)
    raise AssertionError(f"never {stage}")


def lined_up() -> RobobullsKick:
    kick = RobobullsKick()
    drive_until(kick, robot(-0.3, 0.0), (0.0, 0.0), KickStage.FORWARD)
    return kick


def test_a_robot_that_points_at_target_and_ball_lines_up_at_once() -> None:
    kick = RobobullsKick()
    tick(kick, robot(-2.0, 0.0), (0.0, 0.0))
    assert kick.stage is KickStage.LINE_UP


def test_a_robot_before_the_ball_drives_behind_it_first() -> None:
    kick = RobobullsKick()
    me = drive_until(kick, robot(1.0, 0.3, heading=pi), (0.0, 0.0), KickStage.LINE_UP)
    assert hypot(me.x + 0.1265, me.y) < 0.15
    assert abs(degrees(me.heading)) < 5.0


def test_it_creeps_to_the_ball_with_the_dribbler_on() -> None:
    kick = lined_up()
    _, store = tick(kick, robot(-0.2, 0.0), (0.0, 0.0))
    assert store.command.dribbler
    assert 0.0 < store.command.vx < 0.35
    assert store.command.kick_speed == 0.0


def test_it_kicks_at_full_power_when_it_holds_the_ball_and_points_at_the_target() -> None:
    kick = lined_up()
    _, store = tick(kick, robot(-0.11, 0.0), (0.0, 0.0))
    assert kick.stage is KickStage.KICK
    assert store.command.kick_speed == ROBOBULLS_KICK_SPEED
    assert store.command.kick_trigger is KickTrigger.NOW


def test_it_does_not_kick_beside_the_target() -> None:
    kick = lined_up()
    _, store = tick(kick, robot(-0.11, 0.0, heading=radians(1.5)), (0.0, 0.0))
    assert kick.stage is KickStage.FORWARD
    assert store.command.kick_speed == 0.0


def test_it_is_done_once_the_ball_has_left() -> None:
    kick = lined_up()
    tick(kick, robot(-0.11, 0.0), (0.0, 0.0))
    status, _ = tick(kick, robot(-0.11, 0.0), (0.3, 0.0, 7.0, 0.0))
    assert status is Status.SUCCESS


def test_a_ball_that_slipped_away_unkicked_is_fetched_again() -> None:
    kick = lined_up()
    tick(kick, robot(-0.11, 0.0), (0.0, 0.0))
    status, _ = tick(kick, robot(-0.11, 0.0, heading=0.1), (0.1, 0.1, 0.1, 0.0))
    assert status is Status.RUNNING
    assert kick.stage is KickStage.BEHIND


def test_far_from_the_ball_it_no_longer_creeps() -> None:
    kick = lined_up()
    tick(kick, robot(-0.7, 0.0), (0.0, 0.0))
    assert kick.stage is KickStage.BEHIND


def test_a_robot_that_keeps_the_ball_off_its_heading_is_kick_locked() -> None:
    kick = lined_up()
    askew = robot(-0.15 * cos(0.2), -0.15 * sin(0.2))
    for _ in range(15):
        tick(kick, askew, (0.0, 0.0))
    assert kick.stage is not KickStage.BEHIND
    tick(kick, askew, (0.0, 0.0))
    assert kick.stage is KickStage.BEHIND
    tick(kick, robot(-0.11, 0.0), (0.0, 0.0))
    assert kick.stage is KickStage.BEHIND


def test_being_behind_the_ball_for_six_cycles_ends_the_lock() -> None:
    kick = lined_up()
    askew = robot(-0.15 * cos(0.2), -0.15 * sin(0.2))
    for _ in range(16):
        tick(kick, askew, (0.0, 0.0))
    stages = []
    for _ in range(6):
        tick(kick, robot(-0.1265, 0.0), (0.0, 0.0))
        stages.append(kick.stage)
    assert KickStage.LINE_UP in stages[4:]
    assert KickStage.LINE_UP not in stages[:4]


def test_a_new_start_forgets_the_last_kick() -> None:
    kick = lined_up()
    kick.start()
    assert kick.stage is KickStage.BEHIND


def test_the_way_behind_the_ball_leads_round_it() -> None:
    me = robot(1.0, 0.0)
    around = first_waypoint(frame(me, (0.0, 0.0)), me, (-0.2, 0.0))
    assert hypot(*around) > 0.13
    assert around[1] > 0.0, "to the right of a robot that drives to -x"


def test_a_free_way_leads_straight_to_the_goal() -> None:
    me = robot(1.0, 1.0)
    assert first_waypoint(frame(me, (0.0, 0.0)), me, (-1.0, 1.0)) == (-1.0, 1.0)


def test_the_way_leads_round_other_robots() -> None:
    me = robot(0.0, 0.0)
    opponent = robot(1.0, 0.0)
    x, y = first_waypoint(frame(me, (3.0, 2.0), opponents=(opponent,)), me, (2.0, 0.0))
    assert hypot(x - 1.0, y) > 0.25


@pytest.mark.parametrize(
    ("point", "expected"),
    [
        ((0.0, 0.0), (0.0, 0.0)),
        ((4.0, 0.3), (3.5, 0.3)),
        ((3.9, 0.9), (3.9, 1.0)),
        ((-4.0, -0.3), (-3.5, -0.3)),
        ((5.0, 3.5), (4.4, 2.9)),
    ],
)
def test_places_outside_the_lines_and_in_defence_areas_are_moved(
    point: tuple[float, float], expected: tuple[float, float]
) -> None:
    assert allowed(DIVISION_B, point) == pytest.approx(expected)


def test_the_goalkeeper_may_stand_in_its_area() -> None:
    assert allowed(DIVISION_B, (-4.0, 0.3), goalkeeper=True) == (-4.0, 0.3)


def test_the_pilot_changes_its_velocity_by_no_more_than_its_acceleration() -> None:
    me = robot(0.0, 0.0, velocity=(1.0, 0.0, 0.0))
    command = robobulls_drive(me, (0.0, 3.0), 0.0, PERIOD)
    assert hypot(command.vx - 1.0, command.vy) <= 2.5 * PERIOD + 1e-9


def test_the_pilot_arrives() -> None:
    me = robot(0.0, 0.0)
    for _ in range(200):
        me = moved(me, robobulls_drive(me, (1.0, 0.5), radians(30.0), PERIOD), PERIOD)
    assert hypot(me.x - 1.0, me.y - 0.5) < 0.01
    assert degrees(me.heading) == pytest.approx(30.0, abs=1.0)
