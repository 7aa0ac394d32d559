"""What is received from a field: vision or tracked frames, and the game controller's messages."""

from __future__ import annotations

import select
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import ExitStack

from robobt.config.wording import counted
from robobt.league.connection import Connection, LeagueError
from robobt.league.estimate.clocks import CameraClocks
from robobt.league.estimate.filter import VisionFilter
from robobt.league.known_field import KnownField
from robobt.league.picture import PictureWatch
from robobt.league.sources import VisionReader
from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.geometry import CameraPlace
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.referee_message import LONGEST
from robobt.league.wire.sockets import MOST_DATAGRAMS, Packet, Receiver
from robobt.league.wire.vision import CameraFrame, VisionPacket
from robobt.match.referee.events import RefereeEvent
from robobt.sim.settings import SimSettings
from robobt.world.field import DIVISION_B, FieldGeometry
from robobt.world.game import OPEN_PLAY, GameState
from robobt.world.geometry import Point
from robobt.world.limits import RobotLimits
from robobt.world.state import Frame, RobotId

_MOST_SEEN = 64
"""Number of camera frames that are kept for records."""

ALL_CAMERAS = 0.002
"""How long a frame waits for those of the other cameras [s]."""

_LONGEST_PREDICTION = 0.25
"""Longest prediction beyond the last capture [s]."""

_SIZES = ("length", "width", "goal_width", "defense_width", "defense_depth")
"""Dimensions that have to match the scenario's."""

_EQUAL = 0.02
"""Sizes closer than this are equal [m]."""

_UNEQUAL = 0.05
"""Relative error of the initial rate from which the cameras' offsets are wrong."""

_FLOOD_READING_TIME = 0.004
"""Longest time for reading useless packets at once, so that a flood does not delay the commands [s]."""


class Feed:
    """Receives from a field and estimates its state.

    Args:
        connection: how the field is reached.
        field: dimensions that the vision has to report; None accepts any.
        settings: physics to expect there.
        limits: of individual robots, where they differ.
        clock: monotonic seconds.
        known: what earlier worlds of this field have found out.

    Attributes:
        filter: the estimate, in world coordinates.
        frames: how many camera frames were used.
        fresh: whether a frame was used since this was last set to False.
        arrived: when the newest of them arrived, as by :meth:`now` [s].
        heard: when a frame was last used, as by :meth:`now` [s].
        known: knowledge of the field that is kept between worlds.
        picture: the check that robots move as commanded.
        referee: the game controller's state, None without one.
        seen: the newest camera frames that were used, in world coordinates.
    """

    def __init__(
        self,
        connection: Connection,
        field: FieldGeometry | None,
        settings: SimSettings,
        limits: Mapping[RobotId, RobotLimits],
        clock: Callable[[], float],
        known: KnownField | None = None,
    ) -> None:
        self.connection = connection
        self.known = known or KnownField(connection.speed)
        self.seen: deque[CameraFrame] = deque(maxlen=_MOST_SEEN)
        self._expected = field if connection.geometry == "scenario" else None
        measured = connection.delay == "measured"
        self.filter = VisionFilter(self.known.field or field or DIVISION_B, settings, limits, measured)
        if self.known.delays is None or not self.known.delays.expects_as(self.filter.delays):
            self.known.delays = self.filter.delays
        self.filter.delays = self.known.delays
        self.filter.delays.interrupt()
        self.frames = 0
        self.fresh = False
        self.arrived = self.heard = -1e9
        self.referee = RefereeFollower(self.known) if connection.follow_referee else None
        self._clock = clock
        self._cameras: dict[int, float] = {}
        self._camera_clocks = CameraClocks()
        self._delay = 0.0
        self._restarts = 0
        self._now_at = clock()
        self._now = self._now_at * connection.speed
        self.picture = PictureWatch(self.known)
        endpoints, interface = connection.endpoints, connection.interface
        self._source = endpoints.vision if connection.source == "vision" else endpoints.tracker
        with ExitStack() as opened:
            self._vision = opened.enter_context(Receiver(*self._source, interface))
            self._sources = [self._vision]
            self._reader = VisionReader(connection.source, self._vision.counts, self.known)
            if self.referee is not None:
                self._sources.append(opened.enter_context(Receiver(*endpoints.referee, interface, LONGEST)))
            self._opened = opened.pop_all()

    def close(self) -> None:
        """Release all ports."""
        self._opened.close()

    def counts(self) -> dict[str, PacketCounts]:
        """Return the packet counts, by port."""
        counts: dict[str, PacketCounts] = {self.connection.source: self._vision.counts}
        if self.referee is not None:
            counts |= {"referee_port": self._sources[1].counts, "referee": self.referee.counts}
        return counts

    @property
    def rate(self) -> float:
        """How fast the field's clock runs [s of the field per s]."""
        return self.known.clock.rate

    def now(self) -> float:
        """Return seconds that pass as fast as the field's, without its jumps; the origin is arbitrary."""
        at = self._clock()
        self._now += (at - self._now_at) * self.rate
        self._now_at = at
        return self._now

    @property
    def age(self) -> float:
        """Age of the newest picture at its arrival, as far as it is known [s]."""
        return self._delay + self.connection.latency

    def vision_now(self) -> float:
        """Return the present time on the vision's clock [s].

        It is never further beyond the last capture than the latency that was measured: the
        delay that the timestamps show, that of the slower packets against the promptest, and
        the time since the arrival. Before the first capture it is the time of :meth:`now`.
        """
        now = self.now()
        captured, there = self.filter.captured, self.known.clock.at(self._clock())
        if captured is None:
            return now
        latency = self._delay + self.connection.latency + self.known.clock.jitter
        longest = min(_LONGEST_PREDICTION, latency + now - self.arrived)
        if there is None:
            # All packets had waited, as where this machine is too slow: only the captures show that clock.
            return captured + longest
        return min(max(there + self.connection.latency, captured), captured + longest)

    def sign(self) -> float:
        """Return -1 where blue defends +x, and coordinates have to be turned by 180 degrees; else 1."""
        positive = self.connection.blue_on_positive_half
        if positive is None and self.referee is not None:
            positive = self.referee.blue_on_positive_half
        return -1.0 if positive else 1.0

    def frame_at(self, time: float, to_effect: bool = False) -> Frame:
        """Return the field at a time on the vision's clock, seen from blue's side.

        Args:
            time: of the frame [s].
            to_effect: see :meth:`robobt.league.estimate.filter.VisionFilter.frame_at`.
        """
        captured = self.filter.captured
        at = time if captured is None else min(time, captured + _LONGEST_PREDICTION)
        frame = self.filter.frame_at(at, to_effect)
        frame.game = self._game(frame)
        return frame

    def complete(self, period: float) -> bool:
        """Return whether every camera's frame of this instant has arrived, or is overdue."""
        captured = self.filter.captured
        if not self.fresh or captured is None:
            return False
        recent = [time for time in self._cameras.values() if time > captured - 0.5]
        if all(time > captured - period / 2 for time in recent):
            return True
        return self.now() - self.arrived >= ALL_CAMERAS * self.rate

    def no_frames(self, seconds: float) -> str:
        """Return the error message for a field that was silent for this time."""
        dropped = self._vision.counts.dropped
        heard = f" ({counted(dropped, 'packet')} dropped)" if dropped else ""
        return f"no {self.connection.source} at {self._source} for {seconds:g} s{heard}: start the simulator"

    def receive(self, wait: float) -> None:
        """Wait up to ``wait`` seconds of this machine's clock for packets, and process them."""
        if not select.select(self._sources, [], [], max(0.0, wait))[0]:
            return
        arrived = self._clock()
        end = arrived + _FLOOD_READING_TIME
        frames: list[CameraFrame] = []
        read = 0
        for packet in self._vision.receive():
            read += 1
            frame = self._read(packet, arrived)
            if frame is not None:
                frames.append(frame)
            elif self._clock() > end:
                break
        # Arrival times of waiting packets are unknown, so only a camera's newest frame is used for the clock.
        newest = {frame.camera: frame for frame in frames} if read < MOST_DATAGRAMS else {}
        for frame in frames:
            self.add(frame, arrived, waited=frame is not newest.get(frame.camera))
        self.hear_referee()

    def hear_referee(self) -> None:
        """Take in the game controller's packets that wait."""
        if self.referee is not None:
            arrived = self._clock()
            for packet in self._sources[1].receive():
                self.referee.read(packet.data, packet.sender, arrived)

    @property
    def halted(self) -> bool:
        """Whether the game controller wants every robot to stand still."""
        return self.referee is not None and self.referee.game.halted

    def add(self, frame: CameraFrame, arrived: float, *, waited: bool = False) -> None:
        """Use a camera's frame that arrived, or had ``waited``, at a time of this machine's clock [s]."""
        captured, known = self.filter.captured, self.known
        came = self.now() - (self._clock() - arrived) * self.rate
        self._camera_clocks.align(frame, came)
        there = known.clock.at(arrived)
        seen = frame if self.sign() > 0.0 else frame.turned()
        if not self.filter.add(seen, there):
            return
        self.seen.append(seen)
        self.frames += 1
        self.heard = came
        self.picture.see(frame, came)
        if self.filter.restarts != self._restarts:
            self._restarts = self.filter.restarts
            known.restarted()
            self._camera_clocks.clear()
            self._cameras.clear()
        if not waited:
            self._learn(arrived, frame.sent)
        if captured is None or frame.captured > captured or not self.fresh:
            self.arrived = came
            self._delay = frame.sent - frame.captured
        self.fresh = True
        self._cameras[frame.camera] = frame.captured

    def _look_around(self, seen: VisionPacket) -> None:
        """Take in a packet's geometry."""
        if seen.field is not None:
            self._see(seen.field)
        turned = self.sign()
        for number, place in seen.cameras.items():
            self.filter.cameras[number] = CameraPlace(turned * place.x, turned * place.y, place.z)

    def _see(self, field: FieldGeometry) -> None:
        """Play on the field that the vision reports."""
        if field == self.known.field:
            return
        other = [
            name for name in _SIZES if abs(_size(field, name) - _size(self._expected or field, name)) > _EQUAL
        ]
        if self._expected is not None and other:
            listed = ", ".join(
                f"{name} {_size(field, name):g} m instead of {_size(self._expected, name):g} m"
                for name in other
            )
            raise LeagueError(
                f"the vision shows another field than the scenario's: {listed}; set the scenario's field so, "
                "or the simulator's, or play on what is seen with 'geometry=seen' in the address"
            )
        self.known.field = self.filter.field = field

    def _learn(self, arrived: float, sent: float) -> None:
        """Learn from a packet how the field's clock runs."""
        clock = self.known.clock
        settled = clock.settled
        clock.update(arrived, sent)
        if clock.settled and not settled and abs(clock.rate - self.connection.speed) > _UNEQUAL * clock.rate:
            self._camera_clocks.clear()
        self.known.watch(arrived)

    def _read(self, packet: Packet, arrived: float) -> CameraFrame | None:
        """Return the frame in a packet of a followed sender, and take in the geometry."""
        seen = self._reader.read(packet, arrived, self.filter.field, self._places)
        if seen is None:
            return None
        self._look_around(seen)
        return seen.frame

    def _places(self) -> dict[RobotId, Point]:
        """Return where robots were seen last, in the coordinates of the packets."""
        captured, turned = self.filter.captured, self.sign()
        if captured is None:
            return {}
        robots = self.filter.frame_at(captured).robots()
        return {robot: (turned * state.x, turned * state.y) for robot, state in robots.items()}

    def reported(self, now: float) -> list[RefereeEvent]:
        """Return the game controller's events since this was asked last, as if they had happened now [s]."""
        events = [] if self.referee is None else self.referee.reported(now)
        return events if self.sign() > 0.0 else [event.mirrored() for event in events]

    def _game(self, frame: Frame) -> GameState:
        if self.referee is None:
            return OPEN_PLAY
        if self.sign() > 0.0:
            return self.referee.watch(frame)
        return self.referee.watch(frame.mirrored()).mirrored()


def _size(field: FieldGeometry, name: str) -> float:
    return float(getattr(field, name))
