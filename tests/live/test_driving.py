"""A robot that a person drives, under a clock of the test's."""

from dataclasses import replace
from math import pi

import pytest

from robobt import testing
from robobt.live.driving import HELD_UP, STOPS_IN, HandDriver
from robobt.world import Team
from robobt.world.command import RobotCommand

ME = testing.robot(0.0, 0.0, pi / 2)
VIEW = testing.frame(ME, testing.held(ME))
PERIOD = 0.025
TOP, TURN = ME.limits.max_speed, ME.limits.max_turn


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


def told(driver: HandDriver, clock: Clock, late: float = 0.0, **changes: object) -> bool:
    wanted = {"velocity": (1.0, 0.0), "omega": 0.5, "frame": "robot", "dribbler": True, "kick": 0.0} | changes
    return driver.command(clock.now - 7.0 - late, clock.now, **wanted)  # type: ignore[arg-type]


def test_shares_become_speeds_of_this_robot(clock: Clock) -> None:
    driver = HandDriver(clock, PERIOD)
    assert told(driver, clock, kick=4.0)
    command = driver(VIEW, ME)
    assert (command.vx, command.vy, command.omega) == pytest.approx((TOP, 0.0, 0.5 * TURN))
    assert (command.dribbler, command.kick_speed) == (True, 4.0)


def test_in_the_fields_frame_it_drives_as_the_page_shows_it_for_either_team(clock: Clock) -> None:
    driver = HandDriver(clock, PERIOD)
    told(driver, clock, frame="field")
    command = driver(VIEW, ME)
    assert (command.vx, command.vy) == pytest.approx((0.0, -TOP), abs=1e-9)
    theirs = replace(VIEW, team=Team.YELLOW)
    command = driver(theirs, ME)
    assert (command.vx, command.vy) == pytest.approx((0.0, TOP), abs=1e-9)


def test_both_axes_together_are_no_faster_than_one(clock: Clock) -> None:
    driver = HandDriver(clock, PERIOD)
    told(driver, clock, velocity=(1.0, 1.0))
    assert driver(VIEW, ME).vx == pytest.approx(TOP / 2**0.5)


@pytest.mark.parametrize("period", [0.005, 0.025, 0.1])
def test_a_page_that_falls_silent_stops_its_robot_within_a_fifth_of_a_second(
    clock: Clock, period: float
) -> None:
    driver = HandDriver(clock, period)
    told(driver, clock)
    silent = clock.now
    clock.now += 0.05
    assert driver(VIEW, ME).vx > 0.0
    while driver(VIEW, ME).vx > 0.0:
        clock.now += period
    assert clock.now - silent <= STOPS_IN == 0.2


def test_commands_that_were_held_up_on_their_way_are_not_followed(clock: Clock) -> None:
    driver = HandDriver(clock, PERIOD)
    told(driver, clock)
    clock.now += 1.0
    assert not told(driver, clock, late=HELD_UP + 0.01)
    assert driver(VIEW, ME) == RobotCommand()
    assert told(driver, clock, late=HELD_UP - 0.01)
    assert driver(VIEW, ME) != RobotCommand()


def test_clocks_that_drift_apart_hold_nothing_up(clock: Clock) -> None:
    driver = HandDriver(clock, PERIOD)
    for minute in range(60):
        assert told(driver, clock, late=0.02 * minute)
        clock.now += 60.0


def test_a_page_that_says_stop_stops_at_once(clock: Clock) -> None:
    driver = HandDriver(clock, PERIOD)
    told(driver, clock)
    driver.stop()
    assert driver(VIEW, ME) == RobotCommand()


def test_pass_assist_turns_to_the_mate_who_is_meant_and_kicks_as_fast_as_it_takes(clock: Clock) -> None:
    mate = testing.robot(1.0, 3.0, number=4)
    behind = testing.robot(0.0, -1.0, number=5)
    view = testing.frame(ME, testing.held(ME), mates=(mate, behind))
    driver = HandDriver(clock, PERIOD)
    told(driver, clock, kick=6.0)
    assert driver(view, ME).kick_speed == 6.0
    told(driver, clock, kick=6.0, assist=True)
    turning = driver(view, ME)
    assert turning.kick_speed == 0.0
    assert turning.omega < 0.0
    aimed = replace(ME, heading=1.25)
    passed = driver(testing.frame(aimed, testing.held(aimed), mates=(mate, behind)), aimed)
    assert 2.5 < passed.kick_speed < 6.0
    told(driver, clock, kick=1.0, assist=True)
    assert driver(testing.frame(aimed, testing.held(aimed), mates=(mate,)), aimed).kick_speed == 1.0


def test_without_a_mate_ahead_an_assisted_kick_is_a_kick(clock: Clock) -> None:
    driver = HandDriver(clock, PERIOD)
    told(driver, clock, kick=6.0, assist=True)
    away = testing.frame(ME, testing.held(ME), mates=(testing.robot(0.0, -1.0, number=5),))
    assert driver(away, ME).kick_speed == driver(VIEW, ME).kick_speed == 6.0
