"""A field of the league as a World: seen by SSL-Vision, commanded over a simulator's ports."""

from __future__ import annotations

import atexit
import select
import time
from collections import deque
from collections.abc import Callable, Mapping
from math import hypot, isfinite, pi
from typing import Literal, Self

from pydantic import BaseModel, ConfigDict, Field

from robobt.config.errors import RobobtError
from robobt.league.estimate.clocks import CameraClocks
from robobt.league.estimate.filter import VisionFilter
from robobt.league.pacing import Pace
from robobt.league.wire.commands import BallTeleport, Teleport, bounded
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.links import GrSimLink, Link, NoLink, ProtocolLink
from robobt.league.wire.sockets import LOOPBACK, PacketCounts, Receiver
from robobt.league.wire.tracker import read_tracked
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection, VisionPacket, read_vision
from robobt.sim.settings import SimSettings
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.field import DIVISION_B, FieldGeometry
from robobt.world.game import OPEN_PLAY, GameState, Team
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement, World
from robobt.world.state import Frame, RobotId

_RATE = 60.0
"""Commands a second, at the least."""

_STALE = 0.2
"""Without any frame for so long, robots are told to stand still [s]."""

_FURTHEST = 0.25
"""Predictions go no further than this beyond the last capture [s]."""

_ALL_CAMERAS = 0.002
"""How long a frame waits for those of the other cameras [s]."""

_PATIENCE = 4.0
"""How long a reset may take until everything is seen where it was put [s]."""

_AGAIN = 0.3
"""Teleports are sent again after so long, because packets get lost [s]."""

_PUT_TOLERANCE, _PUT_HEADING = 0.05, 0.2
"""How close to its place everything has to be seen after a reset [m, rad]."""

_HIDDEN, _SHADOW = 0.8, 0.5
"""A ball not seen for so long after it was put this close to a robot lies in its shadow [s, m]."""

_BALL = "the ball"

_PARKED = 0.6
"""From the field's lines to robots that do not play, which the simulator takes off the field [m]."""

_MOST_READING = 0.004
"""For how long packets that are of no use are read at a time: a flood must not delay the commands [s]."""

_CLOCK_MEMORY = 2.0
"""For how long the fastest packet tells the offset between the clocks [s]."""


class LeagueError(RobobtError, RuntimeError):
    """The other side does not play along; the message is one line."""


class Connection(BaseModel):
    """How a field of the league is reached. Nothing leaves this machine unless a host is named."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    simulator: Literal["grsim", "protocol", "observer"] = Field(
        "grsim", description="grSim's packets, the simulation protocol, or no commands at all"
    )
    host: str = Field(LOOPBACK, description="where the robots are commanded (IPv4 address)")
    interface: str | None = Field(
        None, description="own address of the interface to listen on; none: this machine's packets only"
    )
    endpoints: Endpoints = Endpoints()
    source: Literal["vision", "tracker"] = Field(
        "vision", description="what is listened to: the cameras, or somebody's tracked frames"
    )
    teams: tuple[Team, ...] = Field(
        (Team.BLUE, Team.YELLOW), description="whose robots are commanded, whatever the trees say"
    )
    blue_on_positive_half: bool | None = Field(
        None, description="whether blue defends +x there; none: as the referee says, else no"
    )
    follow_referee: bool = Field(False, description="whether a game controller is listened to")
    latency: float = Field(
        0.0, ge=0, le=0.5, description="what the vision is late beyond what its packets say [s]"
    )
    speed: float = Field(1.0, ge=0.05, le=20, description="simulated time in shares of real time")


class LeagueWorld(World):
    """Implements :class:`robobt.world.World` over SSL-Vision and a simulator's ports.

    The field's size comes from the vision as soon as it says it. Frames are
    predicted from the last capture to now with the commands that were sent
    since. Commands go out once a control period, and at least 60 times a second,
    whether or not the vision sends; without frames for 0.2 s they tell the robots
    to stand still, as they do when this world is closed or its process ends.

    Args:
        field: dimensions until the vision says them.
        robots: limits of the robots that play; None takes the settings' own, and without
            the mapping whatever robots are seen play.
        settings: the physics to be expected there.
        period: control period [s].
        connection: how it is reached; by default, as ``simulator`` and the others say.
        clock: seconds that only grow; the one clock of this world.
        connect: fields of :class:`Connection` by name.

    Attributes:
        frames: how many frames of cameras were used.
        sent: how many times commands were sent.
        latencies: from a frame's arrival to the commands that answer it, newest last [s].
        referee: what the game controller has said, None where nobody listens.

    Raises:
        OSError: a port is taken, or there is no such interface.
        pydantic.ValidationError: a field of the connection is wrong.
    """

    def __init__(
        self,
        field: FieldGeometry = DIVISION_B,
        robots: Mapping[RobotId, RobotLimits | None] | None = None,
        settings: SimSettings | None = None,
        period: float = 1 / _RATE,
        connection: Connection | None = None,
        clock: Callable[[], float] = time.monotonic,
        **connect: object,
    ) -> None:
        self.connection = connection or Connection.model_validate(connect)
        self.field = field
        self.settings = settings or SimSettings()
        self.period = period
        self._robots = None if robots is None else dict(robots)
        limits = {robot: own for robot, own in (robots or {}).items() if own is not None}
        self._limits = limits
        self._clock, self._speed = clock, self.connection.speed
        self._filter = VisionFilter(field, self.settings, limits)
        self.frames = self.sent = 0
        self.latencies: deque[float] = deque(maxlen=100_000)
        self.referee = RefereeFollower() if self.connection.follow_referee else None
        self._commands: dict[RobotId, RobotCommand] = {}
        self._cameras: dict[int, float] = {}
        self._offsets: deque[tuple[float, float]] = deque()
        self._camera_clocks = CameraClocks()
        self._arrived = self._heard = -1e9
        self._restarts = 0
        self._fresh = False
        self._tracker: str | None = None
        now = self._now()
        self._pace = Pace(period, now)
        self._sent_at = now
        self._began = self._looked = now
        self._looked_at = now
        self._closed = False
        endpoints, interface = self.connection.endpoints, self.connection.interface
        self._open: list[Receiver] = []
        try:
            self._source = endpoints.vision if self.connection.source == "vision" else endpoints.tracker
            self._vision = self._listen(*self._source, interface)
            self._controller = self._listen(*endpoints.referee, interface) if self.referee else None
            self._link = self._make_link(endpoints, interface)
        except OSError:
            for receiver in self._open:
                receiver.close()
            raise
        atexit.register(self.close)

    # The World protocol.

    def reset(self, placement: Placement, seed: int) -> None:  # noqa: ARG002
        """See :meth:`robobt.world.World.reset`; the randomness over there is not ours to fix.

        Robots that do not play are taken off the field. Where nothing can be put
        anywhere, what is there is played with.

        Raises:
            LeagueError: nothing is heard from the vision, or what was put somewhere is not seen there.
            ValueError: as the protocol says.
        """
        self._check_placement(placement)
        self._commands = {}
        self._filter.clear()
        self._filter.touched(None)
        self._await_vision()
        if self._link.places:
            self._put(placement)
        self._filter_settles()
        self._began = self._looked = self._now()
        self._looked_at = self._target()
        self._pace.restart(self._began)
        self._fresh = False

    def observe(self) -> Frame:
        """The field as it should be by now, seen from blue's side."""
        return self._frame(self._looked_at)

    def truth(self) -> Frame:
        """The field at the last capture, seen from blue's side: nothing in it is extrapolated."""
        captured = self._filter.captured
        return self._frame(self._looked_at if captured is None else min(captured, self._looked_at))

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Send the commands, within the robots' limits, and let one control period pass.

        Raises:
            KeyError: a command for a robot that does not play here.
            ValueError: a command that is not finite. Nothing is sent then.
        """
        checked = {}
        for robot, command in commands.items():
            if self._robots is not None and robot not in self._robots:
                raise KeyError(robot)
            if not command.finite():
                raise ValueError(f"the command for {robot} is not finite: {command}")
            limits = self._limits.get(robot, self.settings.limits)
            checked[robot] = bounded(command, limits, self.settings.kicker.max_speed)
        self._commands = self._for_all(checked)
        self._transmit()
        if self._fresh:
            self.latencies.append((self._now() - self._arrived) / self._speed)
        # What was to be kicked at once, was; the repeats of the command are for driving.
        for robot, command in self._commands.items():
            if command.kick_trigger is KickTrigger.NOW and command.kick_speed > 0.0:
                self._commands[robot] = RobotCommand(
                    command.vx, command.vy, command.omega, dribbler=command.dribbler
                )
        self._wait()
        for robot, contact in self._link.feedback():
            self._filter.feedback(robot, contact)
        # All looks until the next act are at this instant.
        self._looked = max(self._now(), self._looked + 1e-6)
        self._looked_at = self._target()

    def place_ball(self, x: float, y: float) -> None:
        """See :meth:`robobt.world.World.place_ball`; on a real field somebody has to."""
        self._check_inside(_BALL, x, y)
        side = self._side()
        self._link.place([], BallTeleport(side * x, side * y, 0.0, 0.0))

    # Beyond the protocol.

    def robots(self) -> list[RobotId]:
        """The robots that are seen."""
        return self._filter.robots()

    def counts(self) -> dict[str, PacketCounts]:
        """What became of the packets, by port."""
        counts = {self.connection.source: self._vision.counts, **self._link.counts()}
        if self._controller is not None and self.referee is not None:
            counts["referee_port"] = self._controller.counts
            counts["referee"] = self.referee.counts
        return counts

    def wait_for_vision(self, seconds: float = _PATIENCE) -> None:
        """Listen until robots and ball are seen.

        Raises:
            LeagueError: they are not, in so many seconds.
        """
        self._await_vision(seconds)

    def close(self) -> None:
        """Tell the robots to stand still, and free all ports."""
        if self._closed:
            return
        self._closed = True
        atexit.unregister(self.close)
        stop = {robot: RobotCommand() for robot in self._commanded()}
        # More than once, because packets get lost.
        for _ in range(3):
            self._link.send(stop, self._now())
        self._link.close()
        for receiver in self._open:
            receiver.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # Time.

    def _now(self) -> float:
        """This machine's clock at the pace of the other side's [s]."""
        return self._clock() * self._speed

    def _target(self) -> float:
        """What the vision's clock shows now [s]."""
        captured = self._filter.captured
        if captured is None or not self._offsets:
            return self._now()
        there = self._now() - self._offsets[0][1] + self.connection.latency
        return min(max(there, captured), captured + _FURTHEST)

    def _hear_clock(self, arrived: float, frame: CameraFrame) -> None:
        """Learn the offset between the clocks: what a packet without any delay would show."""
        offset = arrived - frame.sent
        # Only those that may still become the least are kept, so a flood does not pile up here.
        while self._offsets and self._offsets[-1][1] >= offset:
            self._offsets.pop()
        self._offsets.append((arrived, offset))
        while self._offsets and self._offsets[0][0] < arrived - _CLOCK_MEMORY:
            self._offsets.popleft()

    # Packets.

    def _listen(self, address: str, port: int, interface: str | None) -> Receiver:
        receiver = Receiver(address, port, interface)
        self._open.append(receiver)
        return receiver

    def _make_link(self, endpoints: Endpoints, interface: str | None) -> Link:
        if self.connection.simulator == "grsim":
            return GrSimLink(self.connection.host, endpoints, interface)
        if self.connection.simulator == "protocol":
            return ProtocolLink(self.connection.host, endpoints)
        return NoLink()

    def _receive(self, wait: float) -> None:
        """Take in what comes within ``wait`` seconds of this machine's clock; returns at the first."""
        sources = [self._vision] if self._controller is None else [self._vision, self._controller]
        if not select.select(sources, [], [], max(0.0, wait))[0]:
            return
        arrived = self._now()
        end = self._clock() + _MOST_READING
        for packet in self._vision.receive():
            seen = self._read(packet.data)
            if seen is None:
                if self._clock() > end:
                    break
                continue
            if seen.field is not None and seen.field != self.field:
                self.field = self._filter.field = seen.field
            if seen.frame is not None:
                self._see(seen.frame, arrived)
        if self._controller is not None and self.referee is not None:
            for packet in self._controller.receive():
                self.referee.read(packet.data)

    def _read(self, data: bytes) -> VisionPacket | None:
        if self.connection.source == "vision":
            return read_vision(data, self._vision.counts)
        tracked = read_tracked(data, self.field, self._vision.counts)
        # Several trackers may speak; the first that is heard is followed.
        if tracked is None or tracked[0] != (self._tracker or tracked[0]):
            return None
        self._tracker = tracked[0]
        return VisionPacket(_as_detections(tracked[1]), None)

    def _see(self, frame: CameraFrame, arrived: float) -> None:
        captured = self._filter.captured
        apart = self._camera_clocks.shift(frame.camera, arrived, frame.sent)
        frame.captured += apart
        frame.sent += apart
        if not self._filter.add(self._turned(frame)):
            return
        self.frames += 1
        self._heard = arrived
        if self._filter.restarts != self._restarts:
            self._restarts = self._filter.restarts
            self._offsets.clear()
            self._camera_clocks.clear()
            self._cameras.clear()
        self._hear_clock(arrived, frame)
        if captured is None or frame.captured > captured or not self._fresh:
            self._arrived = arrived
        self._fresh = True
        self._cameras[frame.camera] = frame.captured

    def _complete(self) -> bool:
        """Whether every camera's frame of this instant is there, or has had its time."""
        captured = self._filter.captured
        if not self._fresh or captured is None:
            return False
        recent = [time for time in self._cameras.values() if time > captured - 0.5]
        if all(time > captured - self.period / 2 for time in recent):
            return True
        return self._now() - self._arrived >= _ALL_CAMERAS * self._speed

    def _transmit(self) -> None:
        """Send the commands in force; without sight of the field, to stand still."""
        now = self._now()
        commands = self._commands
        if now - self._heard > _STALE:
            commands = {robot: RobotCommand() for robot in commands}
        self._link.send(commands, now)
        self._filter.sent(self._target() + self.settings.realism.command_delay, commands)
        self.sent += 1
        self._sent_at = now

    def _wait(self) -> None:
        """Until the next control period: the next frame if it comes at about that time."""
        self._fresh = False
        repeat = 1.25 / _RATE
        # Also when it is late already: trees that take too long still get to see what comes.
        self._receive(0.0)
        while True:
            now = self._now()
            if now >= self._pace.opens() and self._complete():
                self._pace.acted(now, self._arrived)
                return
            closes = self._pace.closes()
            if now >= closes:
                self._pace.acted(now, self._arrived if self._fresh else None)
                return
            until = min(closes, self._sent_at + repeat)
            if self._fresh:
                until = min(until, max(self._pace.opens(), self._arrived + _ALL_CAMERAS * self._speed))
            if now >= self._sent_at + repeat:
                self._transmit()
            self._receive((until - now) / self._speed)

    # Robots.

    def _commanded(self) -> list[RobotId]:
        """The robots that this world may command."""
        if isinstance(self._link, NoLink):
            return []
        playing = self._filter.robots() if self._robots is None else sorted(self._robots)
        return [robot for robot in playing if robot.team in self.connection.teams]

    def _for_all(self, commands: Mapping[RobotId, RobotCommand]) -> dict[RobotId, RobotCommand]:
        """Commands for every robot that is commanded: who has none stands still."""
        return {robot: commands.get(robot) or RobotCommand() for robot in self._commanded()}

    # Where things are.

    def _side(self) -> float:
        """-1 where blue defends +x there, which is turned into our coordinates; else 1."""
        positive = self.connection.blue_on_positive_half
        if positive is None and self.referee is not None:
            positive = self.referee.blue_on_positive_half
        return -1.0 if positive else 1.0

    def _turned(self, frame: CameraFrame) -> CameraFrame:
        """A camera's frame in our coordinates."""
        if self._side() > 0.0:
            return frame
        balls = [BallDetection(-ball.x, -ball.y, ball.confidence) for ball in frame.balls]
        robots = [
            RobotDetection(
                robot.robot,
                -robot.x,
                -robot.y,
                None if robot.heading is None else wrap_angle(robot.heading + pi),
                robot.confidence,
            )
            for robot in frame.robots
        ]
        return CameraFrame(frame.camera, frame.number, frame.captured, frame.sent, balls, robots)

    def _frame(self, at: float) -> Frame:
        captured = self._filter.captured
        frame = self._filter.frame_at(at if captured is None else min(at, captured + _FURTHEST))
        frame.time = self._looked - self._began
        frame.period = self.period
        frame.game = self._game(frame)
        return frame

    def _game(self, frame: Frame) -> GameState:
        if self.referee is None:
            return OPEN_PLAY
        if self._side() > 0.0:
            return self.referee.watch(frame)
        return self.referee.watch(frame.mirrored()).mirrored()

    # Starts.

    def _check_placement(self, placement: Placement) -> None:
        if self._robots is not None:
            missing = [robot for robot in self._robots if robot not in placement.robots]
            if missing:
                raise ValueError(f"the placement has no pose for {', '.join(map(str, missing))}")
        for robot, pose in placement.robots.items():
            if self._robots is not None and robot not in self._robots:
                raise ValueError(f"{robot} is not part of this world")
            if not all(map(isfinite, pose)):
                raise ValueError(f"{robot} is placed at {pose}: not finite")
            self._check_inside(str(robot), *pose[:2])
        if not all(map(isfinite, placement.ball)):
            raise ValueError(f"the ball is placed at {placement.ball}: not finite")
        self._check_inside(_BALL, *placement.ball[:2])

    def _check_inside(self, what: str, x: float, y: float) -> None:
        outer_x = self.field.half_length + self.field.margin
        outer_y = self.field.half_width + self.field.margin
        if not (abs(x) <= outer_x and abs(y) <= outer_y):
            raise ValueError(
                f"{what} is placed at ({x:g}, {y:g}), outside the walls at ({outer_x:g}, {outer_y:g})"
            )

    def _await_vision(self, seconds: float = _PATIENCE) -> None:
        end = self._clock() + seconds
        while not self._filter.robots() and not self._filter.sees_ball():
            if self._clock() > end:
                counts = self._vision.counts
                heard = f" ({counts.dropped} packets were dropped)" if counts.dropped else ""
                what, where = self.connection.source, self._source
                raise LeagueError(f"no {what} at {where} for {seconds:g} s{heard}: is the simulator running?")
            self._receive(0.05)

    def _put(self, placement: Placement) -> None:
        """Put robots, then the ball, where they belong, and see them there."""
        side = self._side()
        turn = 0.0 if side > 0.0 else pi
        robots = [
            Teleport(robot, side * x, side * y, wrap_angle(heading + turn), present=True)
            for robot, (x, y, heading) in placement.robots.items()
        ]
        x, y, vx, vy = placement.ball
        ball = BallTeleport(side * x, side * y, side * vx, side * vy, rolls=True)
        at_rest = BallTeleport(ball.x, ball.y, 0.0, 0.0)
        self._until_seen(placement, robots, at_rest)
        if vx or vy:
            self._link.place([], ball)

    def _until_seen(self, placement: Placement, robots: list[Teleport], ball: BallTeleport) -> None:
        began = self._clock()
        end = began + _PATIENCE
        again = -1e9
        while True:
            now = self._clock()
            strangers = [robot for robot in self._filter.robots() if robot not in placement.robots]
            wrong = self._out_of_place(placement)
            if not wrong and not strangers:
                return
            waited = now > began + _HIDDEN / self._speed
            if wrong == [_BALL] and not strangers and waited and self._ball_is_hidden(placement):
                self._filter.ball_put(*placement.ball[:2])
                return
            if now > end:
                what = ", ".join(wrong or [str(robot) for robot in strangers])
                raise LeagueError(f"not seen where put in {_PATIENCE:g} s: {what}; is that robot there?")
            if now > again + _AGAIN / self._speed:
                again = now
                self._link.place([*robots, *self._off_field(strangers)], ball)
            self._link.send({robot: RobotCommand() for robot in self._commanded()}, self._now())
            self._receive(0.01)
            self._receive(0.0)

    def _off_field(self, robots: list[RobotId]) -> list[Teleport]:
        y = self.field.half_width + self.field.margin + _PARKED
        return [
            Teleport(robot, -self.field.half_length + 0.3 * i, y, 0.0, present=False)
            for i, robot in enumerate(robots)
        ]

    def _out_of_place(self, placement: Placement) -> list[str]:
        captured = self._filter.captured
        if captured is None:
            return ["anything"]
        frame = self._filter.frame_at(captured)
        seen = {RobotId(Team.BLUE, robot.id): robot for robot in frame.own}
        seen.update({RobotId(Team.YELLOW, robot.id): robot for robot in frame.opponents})
        wrong = []
        for robot, (x, y, heading) in placement.robots.items():
            state = seen.get(robot)
            if state is None or (
                max(abs(state.x - x), abs(state.y - y)) > _PUT_TOLERANCE
                or abs(wrap_angle(state.heading - heading)) > _PUT_HEADING
            ):
                wrong.append(str(robot))
        ball = frame.ball
        off = max(abs(ball.x - placement.ball[0]), abs(ball.y - placement.ball[1]))
        if not self._filter.sees_ball() or off > _PUT_TOLERANCE:
            wrong.append(_BALL)
        return wrong

    def _ball_is_hidden(self, placement: Placement) -> bool:
        """Whether a robot may stand between a camera and a ball that nobody has seen since it was put."""
        if self._filter.sees_ball() and self._filter.ball_unseen() < _HIDDEN / 2:
            return False
        x, y = placement.ball[:2]
        return any(hypot(pose[0] - x, pose[1] - y) < _SHADOW for pose in placement.robots.values())

    def _filter_settles(self) -> None:
        """A few frames more, so that velocities are known at the start."""
        end = self._clock() + 0.1 / self._speed
        while self._clock() < end:
            self._receive(end - self._clock())


def _as_detections(frame: Frame) -> CameraFrame:
    """A tracked frame as what one camera that sees everything would report."""
    robots = [
        RobotDetection(RobotId(team, robot.id), robot.x, robot.y, robot.heading)
        for team, states in ((Team.BLUE, frame.own), (Team.YELLOW, frame.opponents))
        for robot in states
    ]
    balls = [BallDetection(frame.ball.x, frame.ball.y)]
    return CameraFrame(0, 0, frame.time, frame.time, balls, robots)
