"""Robots are not driven on where nobody sees what they do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import cos, hypot, inf, sin

import pytest

from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.league.faults.faulty_field import FIRST, PERIOD, FaultyField, Sent

ME, MATE, IDLE = (RobotId(Team.BLUE, number) for number in range(3))
HER = RobotId(Team.YELLOW, 0)
STOPPED, BLIND = 0.5, 0.3
"""By when robots have to be stopped under a frozen picture, and where nothing is seen [s]."""

OUTDONE = 2.2
"""By when they have to be stopped where only others are seen to move [s]."""

Fault = Callable[[float, list[CameraFrame]], Sent]


def frozen(world: FaultyField, cameras: tuple[int, ...] = (0, 1), noise: float = 0.0) -> Fault:
    """Cameras that show what they showed last, with fresh numbers and timestamps."""
    last: dict[int, CameraFrame] = {}

    def fault(now: float, frames: list[CameraFrame]) -> Sent:
        sent = []
        for frame in frames:
            if frame.camera in cameras:
                shown = last.setdefault(frame.camera, frame)
                frame = replace(frame, balls=shown.balls, robots=shown.robots)
                if noise:
                    dx, dy = world._rng.normal(0.0, noise, 2)
                    robots = [replace(it, x=it.x + dx, y=it.y + dy) for it in frame.robots]
                    frame = replace(frame, robots=robots)
            sent.append((frame, FIRST))
        return sent

    return fault


def live(_: float, frames: list[CameraFrame]) -> Sent:
    return [(frame, FIRST) for frame in frames]


def nothing(_: float, frames: list[CameraFrame]) -> Sent:
    return []


def nobody(_: float, frames: list[CameraFrame]) -> Sent:
    return [(replace(frame, robots=[]), FIRST) for frame in frames]


def strangers(_: float, frames: list[CameraFrame]) -> Sent:
    robot = RobotDetection(RobotId(Team.BLUE, 9), 0.0, 0.0, 0.0)
    return [(replace(frame, robots=[robot]), FIRST) for frame in frames]


@pytest.mark.parametrize(
    ("noise", "speed", "again", "cameras"),
    [
        (0.0013, 1.0, 0.0, 1),
        (0.0, 1.0, 0.0, 2),
        (0.0013, 0.3, 0.0013, 1),
        (0.0, 0.3, 0.0, 1),
        (0.0, 1.0, 0.001, 2),
    ],
)
def test_robots_under_a_frozen_picture_are_stopped_and_told_once(
    caplog: pytest.LogCaptureFixture, noise: float, speed: float, again: float, cameras: int
) -> None:
    drive = {ME: RobotCommand(speed), HER: RobotCommand(0.0, 0.0, 2.0)}
    with FaultyField(noise=noise, cameras=cameras) as world:
        world.play(1.0, drive)
        at, before = world.machine_time, world.poses[ME][0]
        world.fault = frozen(world, noise=again)
        world.play(4.5, drive)
        for robot in drive:
            print(f"frozen picture: {robot} moved for {world.moved[robot] - at:.3f} s")
            assert world.moved[robot] - at < STOPPED
        assert abs(world.poses[ME][0] - before) < speed * 0.7
        (told,) = caplog.messages
        assert "vision shows no motion" in told
        assert "check vision and radio" in told
        # Where it goes on, so do they.
        world.fault = live
        world.play(0.1, drive)
        assert world.machine_time - world.moved[ME] < 0.05
        world.play(2.0, drive)
    assert len(caplog.messages) == 1


def test_robots_that_start_under_a_frozen_picture_are_stopped(caplog: pytest.LogCaptureFixture) -> None:
    with FaultyField() as world:
        world.play(1.0)
        world.fault = frozen(world)
        world.play(2.0)
        at = world.machine_time
        world.play(2.0, {ME: RobotCommand(1.0), MATE: RobotCommand(0.0, -1.0)})
        assert 0.0 < max(world.moved.values()) - at < STOPPED
    assert len(caplog.messages) == 1


@pytest.mark.parametrize(
    ("command", "within"),
    [
        (RobotCommand(0.15), 0.55),
        (RobotCommand(0.1), 0.75),
        (RobotCommand(0.0, 0.05), 1.4),
        (RobotCommand(0.0, 0.0, 0.2), 1.7),
    ],
    ids=["0.15 m/s", "0.1 m/s", "0.05 m/s aside", "turning at 0.2 rad/s"],
)
def test_slow_robots_under_a_frozen_picture_are_stopped(command: RobotCommand, within: float) -> None:
    with FaultyField() as world:
        world.play(0.5)
        world.fault = frozen(world, noise=0.0013)
        at = world.machine_time
        world.play(2.0, {ME: command})
        assert 0.0 < world.moved[ME] - at < within


def ball_rolls(world: FaultyField) -> Fault:
    """Robots that are shown where they were, beside a ball that rolls."""
    still = frozen(world, noise=0.0013)

    def fault(now: float, frames: list[CameraFrame]) -> Sent:
        balls = [BallDetection(1.5 * sin(3.0 * now), 1.0)]
        return [(replace(frame, balls=balls), sender) for frame, sender in still(now, frames)]

    return fault


def opponents_drive(world: FaultyField) -> Fault:
    """Opponents that move while ours are stuck, as where the radio is dead."""
    world.stuck = {ME, MATE}

    def fault(now: float, frames: list[CameraFrame]) -> Sent:
        for frame in frames:
            for robot in frame.robots:
                robot.y += 0.8 * sin(3.0 * now) if robot.robot.team is HER.team else 0.0
        return live(now, frames)

    return fault


def an_idle_mate_is_pushed(world: FaultyField) -> Fault:
    """A team-mate without a motion command that is seen to move while ours are stuck."""
    world.stuck = {ME, MATE, IDLE}

    def fault(now: float, frames: list[CameraFrame]) -> Sent:
        for frame in frames:
            for robot in frame.robots:
                robot.y += 0.5 * sin(2.0 * now) if robot.robot == IDLE else 0.0
        return live(now, frames)

    return fault


@pytest.mark.parametrize("others", [ball_rolls, opponents_drive, an_idle_mate_is_pushed])
def test_robots_that_do_not_follow_are_stopped_though_others_move(
    others: Callable[[FaultyField], Fault],
) -> None:
    drive = {ME: RobotCommand(0.5), MATE: RobotCommand(0.0, 0.5), IDLE: RobotCommand()}
    with FaultyField(robots=3) as world:
        world.play(0.5, drive)
        world.fault = others(world)
        at = world.machine_time
        world.play(4.0, drive)
        assert max(world.moved[ME], world.moved[MATE]) - at < OUTDONE


def test_a_robot_in_a_duel_for_the_ball_drives_on() -> None:
    drive = {ME: RobotCommand(1.0)}
    with FaultyField() as world:
        world.play(0.5, drive)
        world.fault = opponents_drive(world)
        world.play(1.5, drive)
        assert world.machine_time - world.moved[ME] < 0.05


def test_one_frozen_camera_of_two_stops_the_robots_that_it_shows() -> None:
    drive = {ME: RobotCommand(0.5), HER: RobotCommand(0.0, 0.0, 2.0)}
    with FaultyField(cameras=2) as world:
        world.play(1.0, drive)
        at = world.machine_time
        world.fault = frozen(world, (0,))
        world.play(2.5, drive)
        assert world.moved[ME] - at < STOPPED
        assert world.machine_time - world.moved[HER] < 0.05


@pytest.mark.parametrize("noise", [0.0013, 0.0], ids=["noise", "no noise"])
def test_a_robot_that_is_blocked_stops_nobody_while_others_move(
    caplog: pytest.LogCaptureFixture, noise: float
) -> None:
    drive = {ME: RobotCommand(1.0), HER: RobotCommand(0.3, 0.0, 1.0)}
    with FaultyField(noise=noise) as world:
        world.stuck = {ME}
        world.play(4.0, drive)
        for robot in drive:
            assert world.machine_time - world.moved[robot] < 0.05
    assert caplog.messages == []


@pytest.mark.parametrize("noise", [0.0013, 0.0], ids=["noise", "no noise"])
def test_a_robot_that_was_blocked_alone_tries_again_slowly_and_goes_on(noise: float) -> None:
    with FaultyField(noise=noise) as world:
        world.stuck = {ME}
        world.play(2.0, {ME: RobotCommand(1.0)})
        assert world.machine_time - world.moved[ME] > 1.0
        # Nobody else has to wait for it.
        world.play(0.2, {ME: RobotCommand(1.0), MATE: RobotCommand(0.5)})
        assert world.machine_time - world.moved[MATE] < 0.05
        world.play(3.0)
        world.stuck = set()
        world.play(4.0, {ME: RobotCommand(1.0)})
        assert world.machine_time - world.moved[ME] < 0.05


@pytest.mark.parametrize(
    ("pushed", "then"),
    [
        (RobotCommand(1.0), RobotCommand(-1.0)),
        (RobotCommand(1.0), RobotCommand(0.0, 1.0)),
        (RobotCommand(1.0), RobotCommand(0.6, -1.6)),
        (RobotCommand(1.0), RobotCommand(0.0, 0.0, 3.0)),
        (RobotCommand(0.0, 0.0, 3.0), RobotCommand(0.5)),
        (RobotCommand(0.0, 0.0, 2.0), RobotCommand(0.0, 0.0, -2.0)),
        (RobotCommand(0.05), RobotCommand(1.0)),
    ],
    ids=["back", "aside", "obliquely", "turn", "drive after turning", "turn back", "far faster"],
)
@pytest.mark.parametrize("hold", [0.6, 4.0])
def test_a_robot_that_stands_may_try_another_way_at_once(
    pushed: RobotCommand, then: RobotCommand, hold: float
) -> None:
    with FaultyField(robots=1) as world:
        world.play(0.5)
        world.stuck = {ME}
        world.play(hold + 1.0, {ME: pushed})
        world.stuck = set()
        at = world.machine_time
        world.play(0.1, {ME: then})
        assert world.moved[ME] > at
        world.play(0.5, {ME: then})
        assert world.machine_time - world.moved[ME] < 0.05
        assert world.sent[ME] == then


def test_under_a_frozen_picture_no_change_of_commands_drives_a_robot_far() -> None:
    with FaultyField(robots=1) as world:
        world.play(0.5)
        world.fault = frozen(world, noise=0.0013)
        world.play(1.0, {ME: RobotCommand(1.0)})
        x, y, _ = world.poses[ME]
        trials = 0
        for i in range(600):
            way = 0.9 * i
            world.play(PERIOD / 2, {ME: RobotCommand(cos(way), sin(way), 3.0 * sin(2.1 * i))})
            trials += world.machine_time - world.moved[ME] < PERIOD
        assert trials < 300
        assert hypot(world.poses[ME][0] - x, world.poses[ME][1] - y) < 0.3


def test_a_robot_that_stands_keeps_its_dribbler_and_does_not_kick() -> None:
    command = RobotCommand(1.0, kick_speed=6.0, dribbler=True)
    with FaultyField(robots=1) as world:
        world.stuck = {ME}
        world.play(1.0, {ME: command})
        assert world.sent[ME] == RobotCommand(dribbler=True)
        # The same while it tries another way.
        world.play(0.1, {ME: replace(command, vx=-1.0)})
        assert world.sent[ME] == RobotCommand(-0.2, dribbler=True)


@pytest.mark.parametrize("noise", [0.0013, 0.0], ids=["noise", "no noise"])
@pytest.mark.parametrize(
    "command",
    [RobotCommand(0.1), RobotCommand(0.0, 0.2), RobotCommand(0.0, 0.0, 0.8), RobotCommand(0.0, -3.0, 6.0)],
    ids=["slow", "slowly aside", "turning", "fast"],
)
def test_robots_that_obey_are_never_stopped(
    caplog: pytest.LogCaptureFixture, noise: float, command: RobotCommand
) -> None:
    with FaultyField(noise=noise) as world:
        for _ in range(2):
            world.play(0.5)
            at = world.machine_time
            while world.machine_time - at < 0.7:
                world.play(PERIOD / 2, {ME: command})
                assert world.machine_time - world.moved[ME] < 0.05
            world.play(0.5, {ME: RobotCommand(-command.vx, -command.vy, -command.omega)})
    assert caplog.messages == []


def test_a_robot_that_dithers_in_its_place_is_not_stopped(caplog: pytest.LogCaptureFixture) -> None:
    with FaultyField(noise=0.0) as world:
        for i in range(120):
            world.play(PERIOD / 2, {ME: RobotCommand(0.3 if i % 4 < 2 else -0.3)})
        assert world.machine_time - world.moved[ME] < 0.05
    assert caplog.messages == []


@pytest.mark.parametrize("cameras", [1, 2])
@pytest.mark.parametrize("fault", [nothing, nobody, strangers])
def test_where_nothing_is_seen_robots_are_stopped(fault: Fault, cameras: int) -> None:
    drive = {ME: RobotCommand(1.0), HER: RobotCommand(0.0, 0.0, 2.0)}
    with FaultyField(cameras=cameras) as world:
        world.play(1.0, drive)
        at = world.machine_time
        world.fault = fault
        world.play(1.0, drive)
        took = max(world.moved[robot] for robot in drive) - at
        print(f"{fault.__name__} is seen: robots moved for {took:.3f} s")
        assert took < BLIND
        world.fault = live
        world.play(0.5, drive)
        assert world.play(1.0, drive) < inf
        assert world.machine_time - world.moved[ME] < 0.05


def test_a_robot_that_is_hidden_for_a_while_drives_on() -> None:
    drive = {ME: RobotCommand(0.3), MATE: RobotCommand(0.3)}

    def hidden(_: float, frames: list[CameraFrame]) -> Sent:
        return [(replace(it, robots=[r for r in it.robots if r.robot != ME]), FIRST) for it in frames]

    with FaultyField() as world:
        world.play(1.0, drive)
        world.fault = hidden
        world.play(0.6, drive)
        assert world.machine_time - world.moved[ME] < 0.05
