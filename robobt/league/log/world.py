"""A league log as a World that only observes, and as a recording that can be replayed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from robobt.league.estimate.filter import VisionFilter
from robobt.league.log.files import LogError, LogKind, LogRecord, read_log
from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.sockets import PacketCounts
from robobt.league.wire.tracker import read_tracked
from robobt.league.wire.vision import read_vision
from robobt.match.recording import RecordedRobot, Recorder, RecordingHeader
from robobt.match.scenario.scenario import Scenario
from robobt.sim.settings import SimSettings
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B, FieldGeometry
from robobt.world.game import OPEN_PLAY, GameState, Team
from robobt.world.protocol import Placement, World
from robobt.world.state import BallState, Frame, RobotId

_GAP = 2.0
"""A pause in a log is shortened to this [s]."""

_VISION = (LogKind.VISION, LogKind.VISION_2010)


class LogWorld(World):
    """Plays a log back: :class:`robobt.world.World` whose robots obey nobody.

    Frames come from the log's vision through the filter, or from its tracked
    frames where it holds no vision; the game state from its referee messages.
    Everything is as it was seen, so truth and observation are the same. Pauses
    are shortened to 2 s.

    Args:
        path: the log.
        field: dimensions until the log says them.
        settings: the physics to be expected.
        period: from one frame to the next [s].

    Attributes:
        ended: whether the log is over; from then on nothing changes but the time.
        counts: what became of the packets.

    Raises:
        LogError: the file is no log.
        OSError: it cannot be read.
    """

    def __init__(
        self,
        path: str | Path,
        field: FieldGeometry = DIVISION_B,
        settings: SimSettings | None = None,
        period: float = 1 / 60,
    ) -> None:
        self.path = Path(path)
        self.field = field
        self.period = period
        self.counts = PacketCounts()
        self._settings = settings or SimSettings()
        self._clock = self._ticks = 0
        self._rewind()

    def reset(self, placement: Placement, seed: int) -> None:  # noqa: ARG002
        """Begin at the log's first robots; nothing can be put anywhere and nothing is random.

        Raises:
            LogError: the log holds no robot.
        """
        self._rewind()
        while not self._known():
            if not self._next():
                raise LogError(f"{self.path}: holds no robot")
        self._ticks = 0

    def observe(self) -> Frame:
        """The frame of now, seen from blue's side."""
        frame = self._frame()
        frame.time, frame.period = self._ticks * self.period, self.period
        return frame

    def truth(self) -> Frame:
        """See :meth:`observe`."""
        return self.observe()

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:  # noqa: ARG002
        """Let a period of the log pass; nobody hears the commands."""
        self._ticks += 1
        self._clock += round(self.period * 1e9)
        while not self.ended:
            waiting = self._waiting
            if waiting is not None and waiting.time > self._clock:
                if waiting.time - self._clock > _GAP * 1e9:
                    self._clock = waiting.time - round(_GAP * 1e9)
                return
            self._next()

    def place_ball(self, x: float, y: float) -> None:
        """Nothing: the ball is where it was."""

    def robots(self) -> list[RobotId]:
        """The robots that are seen now."""
        frame = self._frame()
        own = [RobotId(Team.BLUE, robot.id) for robot in frame.own]
        return own + [RobotId(Team.YELLOW, robot.id) for robot in frame.opponents]

    def _rewind(self) -> None:
        self._records: Iterator[LogRecord] = read_log(self.path)
        self._filter = VisionFilter(self.field, self._settings)
        self._referee = RefereeFollower()
        self._refereed = False
        self._tracked: tuple[str, Frame] | None = None
        self.ended = False
        self._waiting: LogRecord | None = None
        self._ticks = 0
        self._advance()
        self._clock = 0 if self._waiting is None else self._waiting.time

    def _advance(self) -> None:
        self._waiting = next(self._records, None)
        self.ended = self._waiting is None

    def _next(self) -> bool:
        """Take in the next record; False when there is none."""
        record = self._waiting
        if record is None:
            return False
        self._clock = max(self._clock, record.time)
        if record.kind in _VISION:
            seen = read_vision(record.data, self.counts)
            if seen is not None and seen.field is not None:
                self.field = self._filter.field = seen.field
            if seen is not None and seen.frame is not None:
                self._filter.add(seen.frame)
        elif record.kind == LogKind.REFEREE:
            self._refereed = self._referee.read(record.data) or self._refereed
        elif record.kind == LogKind.TRACKER:
            tracked = read_tracked(record.data, self.field, self.counts)
            # Several trackers may speak in one log; the first is followed.
            if tracked is not None and (self._tracked is None or self._tracked[0] == tracked[0]):
                self._tracked = tracked
        self._advance()
        return True

    def _known(self) -> bool:
        return bool(self._filter.robots() or (self._tracked and _robots_of(self._tracked[1])))

    def _frame(self) -> Frame:
        captured = self._filter.captured
        if captured is not None and (self._tracked is None or self._filter.robots()):
            frame = self._filter.frame_at(captured)
        elif self._tracked is not None:
            frame = self._tracked[1]
            frame.field = self.field
        else:
            frame = Frame(0.0, self.field, BallState(0.0, 0.0))
        frame.game = self._game(frame)
        return frame

    def _game(self, frame: Frame) -> GameState:
        return self._referee.watch(frame) if self._refereed else OPEN_PLAY


class LogFactory:
    """Makes the world of a match from a log; the scenario's robots watch it.

    Args:
        path: the log.
    """

    def __init__(self, path: str | Path) -> None:
        self._path = Path(path)

    def __call__(self, scenario: Scenario) -> LogWorld:
        """The log from its start, in the scenario's period."""
        return LogWorld(self._path, scenario.field, period=scenario.period)


def record_log(log: str | Path, out: str | Path, period: float = 1 / 30) -> Path:
    """Make a log a recording, which ``robobt replay`` makes a page.

    Args:
        out: file to write, named as recordings are.
        period: from one frame of it to the next [s].

    Raises:
        LogError: the log is none, or holds no robot.
        OSError: a file cannot be read or written.
    """
    world = LogWorld(log, period=period)
    world.reset(Placement(), 0)
    robots: set[RobotId] = set()
    while not world.ended:
        robots.update(world.robots())
        world.act({})
    header = RecordingHeader(
        scenario=Path(log).name[:80],
        period=period,
        field=world.field,
        robots=tuple(RecordedRobot(team=robot.team, number=robot.number) for robot in sorted(robots)),
    )
    world.reset(Placement(), 0)
    with Recorder(out, header) as recorder:
        while not world.ended:
            recorder.tick(world.truth())
            world.act({})
        recorder.tick(world.truth())
    return Path(out)


def _robots_of(frame: Frame) -> int:
    return len(frame.own) + len(frame.opponents)
