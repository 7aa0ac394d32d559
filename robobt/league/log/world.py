"""A league log as a World that only observes, and as a recording that can be replayed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from robobt.league.estimate.clocks import CameraClocks
from robobt.league.estimate.filter import VisionFilter
from robobt.league.log.files import LogError, LogKind, LogRecord, read_log
from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.tracker import read_tracked
from robobt.league.wire.vision import CameraFrame, read_vision
from robobt.match.recording import RecordedRobot, Recorder, RecordingHeader
from robobt.match.referee.events import RefereeEvent
from robobt.match.scenario.scenario import Scenario
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B, FieldGeometry
from robobt.world.game import OPEN_PLAY
from robobt.world.protocol import Placement, World
from robobt.world.state import BallState, Frame, RobotId

_LONGEST_PAUSE = 2.0
"""Pauses in a log are shortened to this [s]."""


class LogWorld(World):
    """Plays a log back as a :class:`robobt.world.World` whose robots ignore commands.

    Frames come from the log's vision through the filter, or from its tracked
    frames where it holds no vision; the game state comes from its referee messages.
    Truth and observation are the same. Pauses are shortened to 2 s.

    ``field`` holds until the log reports another; from one frame to the next it takes ``period`` [s].

    Raises:
        LogError: the file is not a log.
        OSError: it cannot be read.
    """

    def __init__(self, path: str | Path, field: FieldGeometry = DIVISION_B, period: float = 1 / 60) -> None:
        self.path = Path(path)
        self.field = field
        self.period = period
        self.counts = PacketCounts()
        self._clock = 0
        self._kicks: list[tuple[RobotId, float]] = []
        self._rewind()

    def reset(self, placement: Placement, seed: int) -> None:  # noqa: ARG002
        """Rewind to the log's first robots; nothing can be placed and nothing is random.

        Raises:
            LogError: the log holds no robot.
        """
        self._rewind()
        while not (self._filter.robots() or (self._tracked and self._tracked[1].robots())):
            if self._waiting is None:
                raise LogError(f"{self.path}: holds no robot")
            self._use(self._waiting)

    def observe(self) -> Frame:
        """Return the present frame, seen from blue's side."""
        frame = self._frame()
        frame.time, frame.period = self._ticks * self.period, self.period
        return frame

    def truth(self) -> Frame:
        """See :meth:`observe`."""
        return self.observe()

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:  # noqa: ARG002
        """Let one period of the log pass; commands have no effect."""
        self._ticks += 1
        self._clock += round(self.period * 1e9)
        while self._waiting is not None and self._waiting.time <= self._clock:
            self._use(self._waiting)
        if self._waiting is not None:
            self._clock = max(self._clock, self._waiting.time - round(_LONGEST_PAUSE * 1e9))
        # A log's clocks may differ from the frames' time, so that only the tick is known.
        self._kicks = [(kick.robot, self._ticks * self.period) for kick in self._filter.kicks]
        self._filter.kicks.clear()

    def seen_kicks(self) -> list[tuple[RobotId, float]]:
        """Return who was seen to kick during the last act, and when; see the protocol."""
        return self._kicks

    def place_ball(self, x: float, y: float) -> None:
        """Do nothing: the ball is where it was."""

    def reported(self) -> list[RefereeEvent]:
        """See :meth:`robobt.world.World.reported`."""
        # A log's clocks may differ from the frames' time, so that only the tick is known.
        return self._referee.reported(self._ticks * self.period)

    @property
    def ended(self) -> bool:
        """Whether the log is over; from then on only the time changes."""
        return self._waiting is None

    def _rewind(self) -> None:
        self._records: Iterator[LogRecord] = read_log(self.path)
        self._filter = VisionFilter(self.field)
        self._camera_clocks, self._restarts = CameraClocks(), 0
        self._referee = RefereeFollower()
        self._refereed = False
        self._tracked: tuple[str, Frame] | None = None
        self._ticks = 0
        self._kicks = []
        self._waiting = next(self._records, None)
        self._clock = self._began = 0 if self._waiting is None else self._waiting.time

    def _use(self, record: LogRecord) -> None:
        self._clock = max(self._clock, record.time)
        if record.kind in (LogKind.VISION, LogKind.VISION_2010):
            seen = read_vision(record.data, self.counts)
            if seen is not None and seen.field is not None:
                self.field = self._filter.field = seen.field
            if seen is not None:
                self._filter.cameras.update(seen.cameras)
            if seen is not None and seen.frame is not None:
                self._see(seen.frame, record.time)
        elif record.kind == LogKind.REFEREE:
            self._refereed = self._referee.read(record.data) or self._refereed
        elif record.kind == LogKind.TRACKER:
            tracked = read_tracked(record.data, self.field, self.counts)
            # A log may hold several trackers; the first is followed.
            if tracked is not None and (self._tracked is None or self._tracked[0] == tracked[0]):
                self._tracked = tracked
        self._waiting = next(self._records, None)

    def _see(self, frame: CameraFrame, received: int) -> None:
        """Use a camera's frame that was received at a time of the log's clock [ns]."""
        self._camera_clocks.align(frame, (received - self._began) * 1e-9)
        self._filter.add(frame)
        if self._filter.restarts != self._restarts:
            self._restarts = self._filter.restarts
            self._camera_clocks.clear()

    def _frame(self) -> Frame:
        captured = self._filter.captured
        if captured is not None and (self._tracked is None or self._filter.robots()):
            frame = self._filter.frame_at(captured)
        elif self._tracked is not None:
            frame = self._tracked[1]
            frame.field = self.field
        else:
            frame = Frame(0.0, self.field, BallState(0.0, 0.0))
        frame.game = self._referee.watch(frame) if self._refereed else OPEN_PLAY
        return frame


def log_factory(path: str | Path) -> Callable[[Scenario], LogWorld]:
    """Return a factory of worlds in which a scenario's robots watch a log."""
    return lambda scenario: LogWorld(path, scenario.field, scenario.period)


def record_log(log: str | Path, out: str | Path, period: float = 1 / 30) -> Path:
    """Convert a log to a recording, which ``robobt show`` turns into a page, and return where it is.

    ``period`` is the time from one frame of the recording to the next [s].

    Raises:
        LogError: the file is not a log, or holds no robot.
        OSError: a file cannot be read or written.
    """
    world = LogWorld(log, period=period)
    world.reset(Placement(), 0)
    robots: set[RobotId] = set()
    while not world.ended:
        robots.update(world.truth().robots())
        world.act({})
    header = RecordingHeader(
        scenario=Path(log).name[:80],
        period=period,
        field=world.field,
        robots=tuple(RecordedRobot(team=robot.team, number=robot.number) for robot in sorted(robots)),
    )
    world.reset(Placement(), 0)
    with Recorder(out, header) as recorder:
        while True:
            for event in world.reported():
                recorder.event(event.kind, event.time, team=event.team, robot=event.robot, text=event.text)
            recorder.tick(world.truth())
            if world.ended:
                break
            world.act({})
    return Path(out)
