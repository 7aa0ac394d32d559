"""Of several vision sources the first is followed; no frame from another address takes a robot away."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import pytest

from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.sockets import Packet
from robobt.league.wire.tracker import write_tracked
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection, write_vision
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_A, DIVISION_B
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.league.faults.faulty_field import FIRST, PERIOD, SECOND, FaultyField, Sent

ME = RobotId(Team.BLUE, 0)
DRIVE = {ME: RobotCommand(0.5), RobotId(Team.YELLOW, 1): RobotCommand(0.3, 0.0, 0.5)}
CLOSE = 0.02
"""How far from its place a robot may seem to be [m]."""

Stranger = Callable[[float, CameraFrame], list[CameraFrame]]


@contextmanager
def disturbed(stranger: Stranger, sender: tuple[str, int] = SECOND, **options: Any) -> Iterator[FaultyField]:
    """A field that has been seen for a second before a second source begins."""
    with FaultyField(**options) as world:
        world.play(1.0, DRIVE)

        def fault(now: float, frames: list[CameraFrame]) -> Sent:
            own = [(frame, FIRST) for frame in frames]
            return [*[(frame, sender) for frame in stranger(now, frames[0])], *own]

        world.fault = fault
        yield world


def elsewhere(camera: int, every: float = PERIOD) -> Stranger:
    """A source of the same robots, 2 m further up, with a clock and frame numbers of its own."""

    def frames(now: float, frame: CameraFrame) -> list[CameraFrame]:
        if now % every > PERIOD:
            return []
        robots = [RobotDetection(it.robot, it.x, it.y + 2.0, it.heading) for it in frame.robots]
        return [
            CameraFrame(camera, frame.number + 7, now - 90.0, now - 90.0, [BallDetection(2.0, 2.0)], robots)
        ]

    return frames


def empty(camera: int, ahead: float, every: float = 0.3) -> Stranger:
    """A source that sees nothing, a few times a second, with timestamps that are ahead."""

    def frames(now: float, frame: CameraFrame) -> list[CameraFrame]:
        if now % every > PERIOD:
            return []
        return [CameraFrame(camera, frame.number, now + ahead, now + ahead)]

    return frames


def four_cameras(now: float, frame: CameraFrame) -> list[CameraFrame]:
    """Another simulator with four cameras, the number of one of which is ours; that one comes last."""
    robots = [RobotDetection(it.robot, -it.x, -it.y, it.heading) for it in frame.robots]
    cameras = [(camera, robots[camera::4]) for camera in (3, 2, 1, 0)]
    return [CameraFrame(camera, 1, now, now, [], seen) for camera, seen in cameras]


@pytest.mark.parametrize(
    ("stranger", "told"),
    [
        (elsewhere(0), "two vision sources send camera 0"),
        (elsewhere(0, every=0.1), "two vision sources send camera 0"),
        (elsewhere(7), "see robots in different places"),
        (four_cameras, "two vision sources send camera 0"),
        (empty(0, 0.4), "two vision sources send camera 0"),
        (empty(0, 0.03), "two vision sources send camera 0"),
        (empty(5, 0.4), None),
        (empty(5, 0.03, every=PERIOD), None),
        (empty(5, 1e6), None),
    ],
)
@pytest.mark.parametrize("sender", [SECOND, (FIRST[0], 50_000)], ids=["address", "port"])
def test_a_second_source_changes_nothing_and_is_told_once(
    caplog: pytest.LogCaptureFixture, stranger: Stranger, told: str | None, sender: tuple[str, int]
) -> None:
    with disturbed(stranger, sender) as world:
        error = world.play(2.5, DRIVE)
        print(f"a second source: at most {error * 1000:.1f} mm off")
        assert error < CLOSE
        assert world.counts()["vision"].foreign > 5
    assert len(caplog.messages) == (told is not None)
    assert told is None or told in caplog.text


@pytest.mark.parametrize("late", [0.0, 1.0])
@pytest.mark.parametrize("apart", [0.0, 2.0, -1000.0])
def test_two_vision_computers_with_cameras_of_their_own_are_both_followed(
    caplog: pytest.LogCaptureFixture, late: float, apart: float
) -> None:
    with FaultyField(cameras=2) as world:
        begins = world.machine_time + late

        def fault(now: float, frames: list[CameraFrame]) -> Sent:
            left, right = frames
            right.captured, right.sent = now + apart, now + apart
            return [(left, FIRST), (right, SECOND)] if now >= begins else [(left, FIRST)]

        world.fault = fault
        world.play(late + 0.4)
        assert world.play(3.0, DRIVE) < CLOSE
    assert caplog.messages == []


@pytest.mark.parametrize(
    ("sender", "soon", "told"),
    [((FIRST[0], 50_000), 0.5, 0), (SECOND, 2.3, 1)],
    ids=["same machine", "another"],
)
def test_a_source_that_was_started_again_is_followed_soon(
    caplog: pytest.LogCaptureFixture, sender: tuple[str, int], soon: float, told: int
) -> None:
    with FaultyField() as world:
        world.play(1.0, DRIVE)
        world.fault = lambda _, frames: [(frame, sender) for frame in frames]
        world.play(soon)
        assert world.play(1.0, DRIVE) < CLOSE
    # That the robots have to stand meanwhile.
    assert len(caplog.messages) == told


def test_who_sees_nothing_takes_over_from_nobody() -> None:
    with disturbed(empty(0, 0.4)) as world:
        both = world.fault
        world.fault = lambda now, frames: [it for it in both(now, frames) if it[1] == SECOND]
        world.play(4.0)
        world.fault = both
        world.play(0.3)
        assert world.play(2.0, DRIVE) < CLOSE


def test_the_field_is_that_of_the_source_that_is_followed() -> None:
    with disturbed(elsewhere(0)) as world:
        world.play(0.5)
        feed = world._feed
        for sender, field in ((FIRST, DIVISION_B), (SECOND, DIVISION_A)):
            feed._read(Packet(write_vision(None, write_geometry(field)), sender), world.machine_time)
        assert world.observe().field == DIVISION_B
        # A program that publishes nothing else, but it comes second.
        publisher = ("10.0.0.9", 1)
        feed._read(Packet(write_vision(None, write_geometry(DIVISION_A)), publisher), world.machine_time)
        assert world.observe().field == DIVISION_B


def test_two_computers_are_followed_where_blue_defends_the_other_side() -> None:
    with FaultyField(cameras=2, blue_on_positive_half=True) as world:
        world.fault = lambda now, frames: (
            [(frames[0], FIRST), (frames[1], SECOND)] if now > 101.0 else [(frames[0], FIRST)]
        )
        world.play(3.0)
        assert len(world.observe().robots()) == 4
        # The second one's frames were left out until it had agreed.
        assert world.counts()["vision"].foreign < 20


def test_a_vision_computer_that_comes_back_is_followed_again() -> None:
    with FaultyField(cameras=2) as world:

        def fault(now: float, frames: list[CameraFrame]) -> Sent:
            return [(frames[0], FIRST)] + ([(frames[1], SECOND)] if not 102.0 < now < 106.0 else [])

        world.fault = fault
        world.play(6.5)
        assert world.play(2.0, DRIVE) < CLOSE


def test_a_copy_of_the_picture_from_another_address_changes_nothing(caplog: pytest.LogCaptureFixture) -> None:
    def relayed(now: float, frame: CameraFrame) -> list[CameraFrame]:
        return [replace(frame, captured=now - 0.1, sent=now - 0.1)]

    with disturbed(relayed) as world:
        assert world.play(3.0, DRIVE) < CLOSE
    assert len(caplog.messages) == 1


def test_a_second_source_that_was_there_first_is_followed_and_told(caplog: pytest.LogCaptureFixture) -> None:
    with FaultyField() as world:
        begins = world.machine_time + 0.5

        def fault(now: float, frames: list[CameraFrame]) -> Sent:
            other = elsewhere(0)(now, frames[0])
            return [(it, SECOND) for it in other] + [(it, FIRST) for it in frames if now > begins]

        world.fault = fault
        world.play(3.0)
        seen = world.observe().robots()
        assert {robot: state.y for robot, state in seen.items()} == pytest.approx(
            {robot: pose[1] + 2.0 for robot, pose in world.poses.items()}, abs=CLOSE
        )
    (told,) = caplog.messages
    assert "following 10.0.0.6:40006, ignoring 10.0.0.5:10006" in told


def test_a_source_that_sends_our_camera_now_and_then_adds_nobody() -> None:
    guest = RobotDetection(RobotId(Team.BLUE, 9), 2.0, 2.0, 0.0)

    def frames(now: float, frame: CameraFrame) -> list[CameraFrame]:
        shared = [CameraFrame(0, 1, now, now)] if now % 0.6 < PERIOD else []
        return [*shared, CameraFrame(3, 1, now, now, [], [guest])]

    with disturbed(frames) as world:
        world.play(2.0, DRIVE)
        for _ in range(180):
            world.act(DRIVE)
            assert guest.robot not in world.observe().robots()


def test_a_flood_of_senders_fills_nothing_up() -> None:
    with disturbed(lambda now, frame: []) as world:
        for port in range(5000):
            frame = CameraFrame(0, 1, 0.0, 0.0)
            world._feed._read(Packet(write_vision(frame), (SECOND[0], port)), world.machine_time)
        assert len(world._feed._reader._senders._sources) <= 64
        assert len(world._feed.known._told) <= 1
        assert world.play(1.0, DRIVE) < CLOSE


def test_of_several_trackers_one_is_followed_until_it_falls_silent(caplog: pytest.LogCaptureFixture) -> None:
    with FaultyField(source="tracker") as world:
        frame, feed = world.observe(), world._feed

        def heard(seconds: float, *trackers: tuple[str, tuple[str, int]]) -> list[bool]:
            """Whether the frames of each tracker are used in the end."""
            for i in range(round(seconds * 60)):
                world.machine_time += PERIOD
                used = [
                    feed._read(Packet(write_tracked(frame, i, 0.0, name), sender), world.machine_time)
                    for name, sender in trackers
                ]
            return [it is not None for it in used]

        one, copy, other = ("one", FIRST), ("one", SECOND), ("other", ("10.0.0.7", 1))
        assert heard(1.0, one, copy, other) == [True, False, False]
        assert heard(1.9, copy) == [False]
        assert heard(0.2, copy) == [True]
        assert heard(0.5, copy, one) == [True, False]
    (told,) = caplog.messages
    assert "several trackers send: following robobt at 10.0.0.5:10006, ignoring robobt at 10.0.0.6" in told
