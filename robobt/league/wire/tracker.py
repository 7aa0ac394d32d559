"""Tracked frames: positions and velocities that somebody's filter has found, in SI units."""

from __future__ import annotations

from collections.abc import Iterable

from robobt.league.wire.messages import TrackerWrapperPacket
from robobt.league.wire.sockets import PacketCounts, decode
from robobt.league.wire.vision import LATEST, MOST_NUMBER
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.state import BallState, Frame, RobotState

_FAR = 30.0
"""No object of a field lies further from its centre [m]."""

_FASTEST = 30.0
"""Nothing on a field is faster [m/s, rad/s / 10]."""

_MOST_OBJECTS = 64
_YELLOW, _BLUE = 1, 2


def write_tracked(frame: Frame, number: int, time: float, uuid: str, source: str = "robobt") -> bytes:
    """A tracker's packet.

    Args:
        frame: what is known, seen from blue's side.
        number: counts the frames.
        time: of the frame, Unix time or the simulation's [s].
        uuid: tells this source from others while it runs.
        source: its name.
    """
    packet = TrackerWrapperPacket(uuid=uuid, source_name=source)
    tracked = packet.tracked_frame
    tracked.frame_number, tracked.timestamp = number % 2**32, time
    ball = frame.ball
    tracked.balls.add(
        pos={"x": ball.x, "y": ball.y, "z": 0.0}, vel={"x": ball.vx, "y": ball.vy, "z": 0.0}, visibility=1.0
    )
    for team, robots in ((_BLUE, frame.own), (_YELLOW, frame.opponents)):
        for robot in robots:
            tracked.robots.add(
                robot_id={"id": robot.id, "team": team},
                pos={"x": robot.x, "y": robot.y},
                orientation=robot.heading,
                vel={"x": robot.vx, "y": robot.vy},
                vel_angular=robot.omega,
                visibility=1.0,
            )
    return bytes(packet.SerializeToString())


def read_tracked(data: bytes, field: FieldGeometry, counts: PacketCounts) -> tuple[str, Frame] | None:
    """Source and frame of a tracker's packet; None, counted, when it is none or cannot be true.

    The frame's time is that of the packet. Of several balls it holds the first,
    without any one at rest in the centre.

    Args:
        field: dimensions, which a tracker's packet does not say.
    """
    message = decode(TrackerWrapperPacket, data, counts)
    if message is None:
        return None
    tracked = message.tracked_frame
    crowded = max(len(tracked.balls), len(tracked.robots)) > _MOST_OBJECTS
    if not message.HasField("tracked_frame") or not abs(tracked.timestamp) <= LATEST or crowded:
        counts.implausible += 1
        return None
    ball = BallState(0.0, 0.0)
    for seen in tracked.balls:
        values = (seen.pos.x, seen.pos.y, seen.vel.x, seen.vel.y)
        if _plausible(values):
            ball = BallState(*values)
            break
    teams: dict[int, list[RobotState]] = {_BLUE: [], _YELLOW: []}
    for robot in tracked.robots:
        team = int(robot.robot_id.team)
        values = (robot.pos.x, robot.pos.y, robot.vel.x, robot.vel.y)
        turning = (robot.orientation, robot.vel_angular)
        if team not in teams or robot.robot_id.id > MOST_NUMBER or not _plausible(values):
            continue
        if not all(abs(value) <= 10.0 * _FASTEST for value in turning):
            continue
        x, y, vx, vy = values
        teams[team].append(
            RobotState(robot.robot_id.id, x, y, wrap_angle(robot.orientation), vx, vy, robot.vel_angular)
        )
    counts.accepted += 1
    frame = Frame(
        tracked.timestamp, field, ball, _in_order(teams[_BLUE]), _in_order(teams[_YELLOW]), Team.BLUE
    )
    return message.source_name or message.uuid, frame


def _plausible(values: tuple[float, float, float, float]) -> bool:
    # Not finite compares as false.
    return all(
        abs(value) <= most for value, most in zip(values, (_FAR, _FAR, _FASTEST, _FASTEST), strict=True)
    )


def _in_order(robots: Iterable[RobotState]) -> tuple[RobotState, ...]:
    numbers = {robot.id: robot for robot in robots}
    return tuple(numbers[number] for number in sorted(numbers))
