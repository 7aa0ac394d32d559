"""A field of the league as a World: seen by SSL-Vision, commanded over a simulator's ports."""

from __future__ import annotations

import atexit
import time
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import replace

from robobt.config.closing import Closing
from robobt.league.claims import RobotClaims
from robobt.league.connection import Connection
from robobt.league.feed import ALL_CAMERAS, Feed
from robobt.league.known_field import KnownField
from robobt.league.pacing import FrameBeat
from robobt.league.placing import FieldPlacer
from robobt.league.step_feed import StepFeed
from robobt.league.watch import MatchWatch
from robobt.league.wire.commands import clamp_command
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.steps import StepLink
from robobt.match.referee.events import RefereeEvent
from robobt.signals import uninterrupted
from robobt.sim.settings import SimSettings
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.delay import MeasuredDelay
from robobt.world.detections import Detections
from robobt.world.field import FieldGeometry
from robobt.world.limits import RobotLimits
from robobt.world.placement import check_inside, check_placement
from robobt.world.protocol import Placement, World
from robobt.world.sketch import Sketch
from robobt.world.state import Frame, RobotId

_LOWEST_COMMAND_RATE = 60.0
"""Lowest rate of the commands [Hz]."""

_SHORTEST_WAIT = 1e-5
"""Shortest wait for packets [s]."""

_STAND = RobotCommand()

_STALLED_TIME_RATE = 0.25
"""Rate of a match's time while it waits for a field's clock that stood still."""


class LeagueWorld(World, Closing):
    """Implements :class:`robobt.world.World` over SSL-Vision and a simulator's ports.

    Frames are predicted from the last capture to now with the commands sent since.
    Commands go out once a control period, and at least 60 times a second, whether or not
    the vision sends. They stop all robots where none of them has been seen for 0.2 s, in a HALT, and
    when this world is closed or its process ends; and those robots that are not seen to obey
    (:class:`robobt.league.picture.PictureWatch`). Another world of this process that commands one of the
    same robots is closed.

    All times but those of the attributes pass as on the field's own clock, whose rate is
    measured: a simulator at half speed is played at half speed.

    Args:
        field: dimensions that the vision's have to equal, unless ``connection.geometry`` is "seen"; None
            takes whatever it reports.
        robots: limits of the robots that play; None as a limit takes the settings' own, and
            without the mapping all robots that are seen play.
        settings: physics to expect there.
        period: control period [s].
        connection: how the field is reached.
        clock: monotonic seconds; the only clock of this world. In lock step it is the field's own.
        known: what earlier worlds of the same field have found out about it.
        options: fields of :class:`Connection` by name, instead of ``connection``.

    Attributes:
        send_times: when commands were sent by ``clock``, newest last [s].
        latencies: from a frame's arrival to the commands that respond to it by ``clock``, newest last [s].

    Raises:
        OSError: a port is taken, or no interface has the address.
        pydantic.ValidationError: a field of the connection is wrong.
    """

    def __init__(
        self,
        field: FieldGeometry | None = None,
        robots: Mapping[RobotId, RobotLimits | None] | None = None,
        settings: SimSettings | None = None,
        period: float = 1 / _LOWEST_COMMAND_RATE,
        connection: Connection | None = None,
        clock: Callable[[], float] = time.monotonic,
        known: KnownField | None = None,
        **options: object,
    ) -> None:
        self.connection = connection or Connection.model_validate(options)
        self.settings = settings or SimSettings()
        self.period = period
        self.send_times: deque[float] = deque(maxlen=100_000)
        self.latencies: deque[float] = deque(maxlen=100_000)
        self._robots = None if robots is None else sorted(robots)
        self._limits = {robot: limits for robot, limits in (robots or {}).items() if limits is not None}
        self._commands: dict[RobotId, RobotCommand] = {}
        self._sent: Mapping[RobotId, RobotCommand] = {}
        self._clock = clock
        here = self.connection
        commanded = () if here.simulator == "observer" else robots
        with ExitStack() as opened:
            # First, as who is released thereby gives up its ports.
            claims = RobotClaims(here.where, commanded, here.teams, self.close)
            opened.callback(claims.close)
            self._link = here.link()
            opened.callback(self._link.close)
            self._clock = clock = self._link.clock or clock
            with_what = here, field, self.settings, self._limits, clock, known
            if isinstance(self._link, StepLink):
                self._feed: Feed = StepFeed(self._link, period, *with_what)
            else:
                self._feed = Feed(*with_what)
            opened.callback(self._feed.close)
            self._opened = opened.pop_all()
        if claims.taken:
            self._feed.known.tell("players", claims.message())
        self._placer = FieldPlacer(self._feed, self._link, self._commanded, clock)
        self._watch = MatchWatch(self._feed, period)
        now = self._feed.now()
        self._pace = FrameBeat(period, now)
        self._sent_at = self._looked = self._looked_at = self._began = now
        self._kicks: list[tuple[RobotId, float]] = []
        self._restart_time()
        self._closed = False
        atexit.register(self.close)

    def reset(self, placement: Placement, seed: int) -> None:  # noqa: ARG002
        """Put everything in its place; see :meth:`robobt.world.World.reset`. ``seed`` has no effect.

        Robots that do not play are taken off the field. Where nothing may be placed
        (see :class:`Connection`) the match begins as soon as the commanded robots are seen.

        Raises:
            LeagueError: no vision is received, something is not seen where it was put, or the field is not
                the expected one.
            ValueError: as in the protocol.
        """
        check_placement(placement, self._feed.filter.field, self._robots)
        self._commands = {}
        self._feed.filter.clear()
        self._feed.picture.clear()
        self._placer.place(placement)
        self._restart_time()
        self._pace.restart(self._looked)
        self._feed.fresh = False
        self._watch.begin()

    def observe(self) -> Frame:
        """Return the field predicted to when a command sent now moves the robots, seen from blue's side.

        That is after the commands' delay and each robot's dead time, as in
        :class:`~robobt.world.prediction.PredictedWorld`, or after the delay that was measured in place of the
        two.
        """
        measured = self.connection.delay == "measured"
        arrival = 0.0 if measured else self.settings.realism.command_delay
        return self._frame(self._looked_at + arrival, to_effect=True)

    def truth(self) -> Frame:
        """Return the field at the last capture, without prediction, seen from blue's side."""
        captured = self._feed.filter.captured
        return self._frame(self._looked_at if captured is None else min(captured, self._looked_at))

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Send the commands, within the robots' limits, and let one control period pass.

        Raises:
            KeyError: a command for a robot that does not play here.
            ValueError: a command that is not finite. Nothing is sent then.
            LeagueError: the field is not the expected one; the simulator of a match that was set up there
                sends no more, or was restarted.
        """
        clamped = {}
        for robot, command in commands.items():
            if self._robots is not None and robot not in self._robots:
                raise KeyError(robot)
            if not command.finite():
                raise ValueError(f"the command for {robot} is not finite: {command}")
            limits = self._limits.get(robot, self.settings.limits)
            clamped[robot] = clamp_command(command, limits, self.settings.kicker)
        self._commands = {robot: clamped.get(robot) or RobotCommand() for robot in self._commanded()}
        feed = self._feed
        # A HALT may have come while the trees decided.
        feed.hear_referee()
        self._transmit()
        if feed.fresh:
            self.latencies.append((feed.now() - feed.arrived) / feed.rate)
        # An immediate kick has been made; repeats of the command only drive.
        for robot, command in self._commands.items():
            if command.kick_trigger is KickTrigger.NOW:
                self._commands[robot] = replace(command, kick_speed=0.0)
        self._wait()
        feed.filter.possession.hear(self._link.feedback(), feed.vision_now())
        self._look()
        seen = feed.filter.kicks
        self._kicks = [(kick.robot, min(self._time, max(0.0, kick.time - self._began))) for kick in seen]
        seen.clear()
        self._watch.acted()

    def seen_kicks(self) -> list[tuple[RobotId, float]]:
        """Return who was seen to kick during the last act, and when; see the protocol."""
        return self._kicks

    def detections(self) -> list[Detections]:
        """See :meth:`robobt.world.World.detections`."""
        frames, pictures = self._feed.seen, []
        while frames:
            frame = frames.popleft()
            best = max(frame.balls, key=lambda ball: ball.confidence, default=None)
            ball = None if best is None else (best.x, best.y)
            robots = {it.robot: (it.x, it.y, it.heading) for it in frame.robots if it.heading is not None}
            pictures.append(Detections(frame.captured - self._began, frame.camera, ball, robots))
        return pictures

    @property
    def cameras(self) -> Mapping[int, tuple[float, float, float]]:
        """See :attr:`robobt.world.World.cameras`."""
        return self._feed.filter.cameras

    def reported(self) -> list[RefereeEvent]:
        """See :meth:`robobt.world.World.reported`."""
        return self._feed.reported(self._time)

    def place_ball(self, x: float, y: float) -> None:
        """Put the ball down at rest; where nothing may be placed, a person has to."""
        check_inside("the ball", (x, y), self._feed.filter.field)
        if self.connection.places:
            self._link.place([], self._placer.place_ball(x, y))

    def delays(self) -> Mapping[RobotId, MeasuredDelay | None]:
        """See :meth:`robobt.world.World.delays`; they are measured whether or not frames reckon with them."""
        return self._feed.filter.delays.measured(self._feed.age)

    def draw(self, sketch: Sketch) -> None:
        """See :meth:`robobt.world.World.draw`: what the cameras reported last, and how sure the filter is."""
        self._feed.filter.draw(sketch)

    @property
    def refereed(self) -> bool:
        """See :meth:`robobt.world.World.refereed`."""
        return self.connection.follow_referee

    @property
    def scenario_ends(self) -> bool:
        """See :meth:`robobt.world.World.scenario_ends`."""
        return self.connection.ends or not self.connection.follow_referee

    def counts(self) -> dict[str, PacketCounts]:
        """Return what happened to the packets, by port."""
        return self._feed.counts() | self._link.counts

    def close(self) -> None:
        """Stop the robots and release all ports."""
        with uninterrupted:
            if self._closed:
                return
            self._closed = True
            atexit.unregister(self.close)
            stop = {robot: RobotCommand() for robot in self._commanded()}
            # Repeated, because packets get lost.
            for _ in range(3):
                self._link.send(stop, self._feed.now())
            self._opened.close()

    def _commanded(self) -> list[RobotId]:
        """Return the robots that this world may command."""
        if not self._link.active:
            return []
        playing = self._feed.filter.robots() if self._robots is None else self._robots
        return [robot for robot in playing if robot.team in self.connection.teams]

    def _restart_time(self) -> None:
        """Begin the match's time at 0, now."""
        self._time, self._kicks = 0.0, []
        self._feed.filter.kicks.clear()
        self._feed.reported(0.0)
        self._looked, self._looked_at = self._feed.now(), self._feed.vision_now()
        self._began = self._looked_at
        self._restarts = self._feed.filter.restarts

    def _look(self) -> None:
        """Let all frames until the next act be of this instant."""
        feed = self._feed
        now, there = feed.now(), feed.vision_now()
        elapsed = max(now - self._looked, _SHORTEST_WAIT)
        if feed.filter.restarts != self._restarts:
            # Another clock, but the match's time goes on.
            self._restarts = feed.filter.restarts
            self._began = there - self._time - elapsed
        # Where the field stood still the match's time is ahead; it must not stand or go back.
        self._time = max(self._time + _STALLED_TIME_RATE * elapsed, there - self._began)
        self._looked, self._looked_at = now, there

    def _frame(self, at: float, to_effect: bool = False) -> Frame:
        frame = self._feed.frame_at(at, to_effect)
        frame.time = self._time
        frame.period = self.period
        return frame

    def _transmit(self) -> None:
        """Send the commands in force; commands to stop in a HALT, and to robots that are not seen to obey."""
        now = self._feed.now()
        commands = self._commands
        if self._feed.halted:
            commands = {robot: RobotCommand() for robot in commands}
        commands = self._feed.picture.checked(commands, now)
        self._link.send(commands, now)
        # The age of the vision is not in it, and what the robots themselves delay the filter adds.
        self._feed.filter.sent(self._feed.vision_now(), commands, self.settings.realism.command_delay)
        self.send_times.append(self._clock())
        self._sent, self._sent_at = commands, now

    @property
    def paced(self) -> bool:
        """See :attr:`robobt.world.World.paced`; in lock step the field waits."""
        return self._link.clock is None

    def _wait(self) -> None:
        """Wait for the next control period: for the next frame, if it comes at about that time."""
        feed, pace = self._feed, self._pace
        feed.fresh = False
        repeat = 1.25 / _LOWEST_COMMAND_RATE
        # Even when it is late already, so that slow trees still see what has arrived.
        feed.receive(0.0)
        while True:
            now = feed.now()
            if now >= pace.opens() and feed.complete(self.period):
                pace.acted(now, feed.arrived)
                return
            closes = pace.closes()
            if now >= closes:
                pace.acted(now, feed.arrived if feed.fresh else None)
                return
            until = min(closes, self._sent_at + repeat)
            if feed.fresh:
                until = min(until, max(pace.opens(), feed.arrived + ALL_CAMERAS * feed.rate))
            if now >= self._sent_at + repeat:
                self._transmit()
            # A time lost in rounding must not be waited for again and again.
            feed.receive(max(until - now, _SHORTEST_WAIT) / feed.rate)
            if feed.halted and any(command != _STAND for command in self._sent.values()):
                self._transmit()
