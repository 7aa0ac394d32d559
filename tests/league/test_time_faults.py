"""Clocks that jump, stall, disagree or lie do not cost the robots that are seen."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import inf, nan

import pytest

from robobt.league.estimate.filter import VisionFilter
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection, read_vision, write_vision
from robobt.league.world import LeagueWorld
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.league.served import free_endpoints

PERIOD = 1 / 60
LEFT, RIGHT = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 1)


def frame(time: float, camera: int = 0, x: float = 0.0, robot: RobotId = LEFT) -> CameraFrame:
    return CameraFrame(camera, 0, time, time, [BallDetection(1.0, 1.0)], [RobotDetection(robot, x, 0.5, 0.3)])


@pytest.fixture
def driven() -> VisionFilter:
    """A filter that has followed a robot at 1 m/s for a second, and is at 10 s."""
    seen = VisionFilter(DIVISION_B)
    for i in range(61):
        seen.add(frame(9.0 + i * PERIOD, x=i * PERIOD))
    return seen


@pytest.mark.parametrize("time", [1e9, 1e5, -1e9, 0.0, 14.0, 10.6])
def test_a_single_frame_of_another_time_changes_nothing(driven: VisionFilter, time: float) -> None:
    assert not driven.add(frame(time, x=-3.0))
    assert driven.captured == pytest.approx(10.0)
    driven.add(frame(10.0 + PERIOD, x=1.0 + PERIOD))
    (me,) = driven.frame_at(10.0 + PERIOD).own
    assert me.vx == pytest.approx(1.0, abs=0.05)
    assert driven.restarts == 0


@pytest.mark.parametrize("time", [0.0, 1e6])
def test_a_source_that_was_started_anew_is_followed(driven: VisionFilter, time: float) -> None:
    for i in range(10):
        driven.add(frame(time + i * PERIOD, x=2.0))
    assert driven.restarts == 1
    (me,) = driven.frame_at(time + 10 * PERIOD).own
    assert me.position == pytest.approx((2.0, 0.5), abs=0.01)


def test_a_stall_of_a_second_costs_no_robot(driven: VisionFilter) -> None:
    for i in range(10):
        driven.add(frame(11.0 + i * PERIOD, x=2.0 + i * PERIOD))
        assert driven.robots() == [LEFT]
    (me,) = driven.frame_at(11.0 + 9 * PERIOD).own
    assert me.vx == pytest.approx(1.0, abs=0.05)
    assert driven.restarts == 0


def test_frames_out_of_order_and_twice_are_left_out(driven: VisionFilter) -> None:
    used = [i for i in (2, 1, 2, 2, 4, 3, 5) if driven.add(frame(10.0 + i * PERIOD, x=1.0 + i * PERIOD))]
    (me,) = driven.frame_at(10.0 + 5 * PERIOD).own
    assert (me.x, me.vx) == pytest.approx((1.0 + 5 * PERIOD, 1.0), abs=0.02)
    assert used == [2, 4, 5]


@pytest.mark.parametrize("time", [nan, inf, -inf, 1e16, -1e300])
def test_a_time_that_no_clock_shows_is_no_frame(time: float) -> None:
    counts = PacketCounts()
    assert read_vision(write_vision(frame(time)), counts) is None
    assert counts.implausible == 1


@pytest.mark.parametrize("sent", [1e9, 5.0, -1e9])
def test_a_time_of_sending_that_cannot_be_is_not_believed(sent: float) -> None:
    message = write_vision(CameraFrame(0, 0, 10.0, sent))
    seen = read_vision(message, PacketCounts())
    assert seen is not None
    assert seen.frame is not None
    assert seen.frame.sent == 10.0


@pytest.fixture
def ticking() -> Iterator[tuple[LeagueWorld, Callable[[float], None]]]:
    """A world that gets frames handed, and the function that sets its clock."""
    now = [50.0]
    with LeagueWorld(endpoints=free_endpoints(), clock=lambda: now[0]) as world:
        yield world, lambda time: now.__setitem__(0, time)


@pytest.mark.parametrize("apart", [0.0, -1000.0, 0.3, 60.0])
def test_halves_of_the_field_under_clocks_that_differ_are_both_seen(
    ticking: tuple[LeagueWorld, Callable[[float], None]], apart: float
) -> None:
    world, set_clock = ticking
    for i in range(90):
        now = 50.0 + i * PERIOD
        set_clock(now)
        world._feed.add(frame(now, 0, x=-2.0 + i * PERIOD), now)
        world._feed.add(frame(now + apart, 1, x=2.0 - i * PERIOD, robot=RIGHT), now)
    frame_now = world._feed.frame_at(world._feed.vision_now())
    assert list(frame_now.robots()) == [LEFT, RIGHT]
    x = 89 * PERIOD
    assert frame_now.own[0].x == pytest.approx(-2.0 + x, abs=0.02)
    assert frame_now.opponents[0].x == pytest.approx(2.0 - x, abs=0.02)


@pytest.mark.parametrize(("gone_on", "restarts"), [(30.0, 0), (0.0, 1)])
def test_a_field_that_went_on_while_nobody_listened_was_not_restarted(
    ticking: tuple[LeagueWorld, Callable[[float], None]], gone_on: float, restarts: int
) -> None:
    world, set_clock = ticking
    for i in range(120):
        now = 50.0 + i * PERIOD
        away = 0.0 if i < 90 else 1.0
        set_clock(now + away * gone_on)
        world._feed.add(frame(now + away * 30.0, x=-2.0), now + away * gone_on)
    assert world._feed.filter.restarts == restarts
    assert list(world._feed.frame_at(world._feed.vision_now()).robots()) == [LEFT]


@pytest.mark.parametrize("ahead", [1.8e9, -40.0])
def test_a_machine_that_begins_too_slow_for_all_packets_does_not_jump_in_time(
    ticking: tuple[LeagueWorld, Callable[[float], None]], ahead: float
) -> None:
    world, set_clock = ticking
    times = []
    for i in range(120):
        now = 50.0 + i * PERIOD
        set_clock(now)
        world._feed.add(frame(now + ahead), now, waited=i < 60)
        if i == 30:
            world._restart_time()
        world._look()
        times.append(world._time)
    assert times[-1] == pytest.approx(89 * PERIOD, abs=0.05)
    assert max(after - before for before, after in pairwise(times[31:])) < 0.05
