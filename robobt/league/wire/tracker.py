"""Tracked frames: positions and velocities from a vision filter, in SI units."""

from __future__ import annotations

from robobt.league.wire.messages import TrackedRobot, TrackerWrapperPacket
from robobt.league.wire.packets import MAX_OBJECTS, MAX_ROBOT_NUMBER, MAX_TIME, PacketCounts, on_field, read
from robobt.league.wire.simulation import TEAMS
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.state import BALL_RADIUS, BallState, Frame, RobotState

_MAX_TRACKED_SPEED = 30.0
"""Nothing on a field is faster [m/s]."""

_MAX_TRACKED_HEIGHT = 10.0
"""No ball flies higher [m]."""

_MAX_TURN = 300.0
"""No robot turns faster, and no sender lets headings grow larger [rad/s, rad]."""

SOURCE = "robobt"
"""The name under which robobt publishes."""


def write_tracked(frame: Frame, number: int, time: float, uuid: str) -> bytes:
    """Return a tracker packet.

    ``frame`` is seen from blue's side, ``time`` Unix time or simulated [s]; ``uuid`` tells this source from
    others while it runs.
    """
    packet = TrackerWrapperPacket()
    fill_tracked(packet, frame, number, time, uuid)
    return bytes(packet.SerializeToString())


def fill_tracked(packet: TrackerWrapperPacket, frame: Frame, number: int, time: float, uuid: str) -> None:
    """Fill in an empty tracker packet; see :func:`write_tracked`."""
    packet.uuid, packet.source_name = uuid, SOURCE
    tracked = packet.tracked_frame
    tracked.frame_number, tracked.timestamp = number % 2**32, time
    ball = frame.ball
    tracked.balls.add(
        pos={"x": ball.x, "y": ball.y, "z": ball.z},
        vel={"x": ball.vx, "y": ball.vy, "z": ball.vz},
        visibility=1.0,
    )
    for team, robots in ((2, frame.own), (1, frame.opponents)):
        for robot in robots:
            tracked.robots.add(
                robot_id={"id": robot.id, "team": team},
                pos={"x": robot.x, "y": robot.y},
                orientation=robot.heading,
                vel={"x": robot.vx, "y": robot.vy},
                vel_angular=robot.omega,
                visibility=1.0,
            )


def read_tracked(data: bytes, field: FieldGeometry, counts: PacketCounts) -> tuple[str, Frame] | None:
    """Return source and frame of a tracker packet, None (counted) when it is malformed or implausible.

    The frame has the packet's timestamp and the first of several balls; without
    any, a ball at rest in the centre.

    ``field`` has the dimensions, which a tracker packet does not hold.
    """

    def convert(message: TrackerWrapperPacket) -> tuple[str, Frame] | None:
        tracked = message.tracked_frame
        crowded = max(len(tracked.balls), len(tracked.robots)) > MAX_OBJECTS
        if not message.HasField("tracked_frame") or not abs(tracked.timestamp) <= MAX_TIME or crowded:
            return None
        balls = [
            BallState(seen.pos.x, seen.pos.y, seen.vel.x, seen.vel.y, seen.pos.z, seen.vel.z)
            for seen in tracked.balls
        ]
        ball = next((ball for ball in balls if _plausible_ball(ball)), BallState(0.0, 0.0))
        teams: dict[Team, dict[int, RobotState]] = {team: {} for team in Team}
        for robot in tracked.robots:
            team, state = TEAMS.get(int(robot.robot_id.team)), _robot(robot)
            if team is not None and state is not None:
                teams[team][state.id] = state
        own, opponents = (
            tuple(robots[number] for number in sorted(robots))
            for robots in (teams[Team.BLUE], teams[Team.YELLOW])
        )
        return message.source_name or message.uuid, Frame(tracked.timestamp, field, ball, own, opponents)

    return read(TrackerWrapperPacket, data, counts, convert)


def detections_in(frame: Frame) -> CameraFrame:
    """Return a tracked frame as the detections of a single camera that sees everything."""
    robots = [
        RobotDetection(robot, state.x, state.y, state.heading) for robot, state in frame.robots().items()
    ]
    balls = [BallDetection(frame.ball.x, frame.ball.y, tracked=frame.ball)]
    return CameraFrame(0, 0, frame.time, frame.time, balls, robots)


def _robot(robot: TrackedRobot) -> RobotState | None:
    number = robot.robot_id.id
    x, y, vx, vy = robot.pos.x, robot.pos.y, robot.vel.x, robot.vel.y
    heading, omega = robot.orientation, robot.vel_angular
    if number > MAX_ROBOT_NUMBER or not _plausible(x, y, vx, vy):
        return None
    # NaN compares as false.
    if not (abs(heading) <= _MAX_TURN and abs(omega) <= _MAX_TURN):
        return None
    return RobotState(number, x, y, wrap_angle(heading), vx, vy, omega)


def _plausible_ball(ball: BallState) -> bool:
    # NaN compares as false.
    in_the_air = -BALL_RADIUS <= ball.z <= _MAX_TRACKED_HEIGHT and abs(ball.vz) <= _MAX_TRACKED_SPEED
    return in_the_air and _plausible(ball.x, ball.y, ball.vx, ball.vy)


def _plausible(x: float, y: float, vx: float, vy: float) -> bool:
    # NaN compares as false.
    return on_field(x, y) and abs(vx) <= _MAX_TRACKED_SPEED and abs(vy) <= _MAX_TRACKED_SPEED
