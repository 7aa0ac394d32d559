"""The replay file: what a match looked like and what its trees thought, a line at a time.

A recording is a text file of JSON objects, one a line (``*.robobt.jsonl``), or the
same compressed (``*.robobt.jsonl.gz``). It is only ever appended to, so a match that
was killed leaves a file that can be read up to its last whole line.

| line | keys |
| --- | --- |
| first | ``format``, ``version``, and the fields of :class:`RecordingHeader` |
| a tick | ``t`` time; ``b`` ball; ``r`` one entry a robot of the header, null when it is not on the field; |
| | only when changed: ``s`` statuses and ``f`` feedback by robot, ``g`` referee's word, ``l`` last touch |
| an event | ``e`` kind; ``t`` time; ``team``, ``robot``, ``text`` where they apply |
| last | ``end``: the outcome |

Everything is in world coordinates (blue defends -x). Lengths are integers in units of
0.1 mm, velocities in mm/s, angles in mrad, turning rates in mrad/s. ``b`` is x, y, vx,
vy; an entry of ``r`` is x, y, heading, vx, vy, omega, flags (:class:`RobotFlag`).
"""

from __future__ import annotations

import json
import json.encoder
import zlib
from array import array
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping
from collections.abc import Sequence as SequenceOf
from dataclasses import dataclass
from enum import IntFlag
from itertools import accumulate, chain
from math import isfinite, nan
from pathlib import Path
from struct import Struct
from types import TracebackType
from typing import Any, BinaryIO, Self, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from robobt import __version__
from robobt.match.problems import naming
from robobt.tree import Parallel, Selector, Sequence, TreeRunner
from robobt.tree.drawing import NodeKind, describe
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.game import OPEN_PLAY, GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.geometry import FloatArray
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

T = TypeVar("T")

FORMAT = "robobt-recording"
VERSION = 1

_BALL_UNITS = (1e-4, 1e-4, 1e-3, 1e-3)
_ROBOT_UNITS = (1e-4, 1e-4, 1e-3, 1e-3, 1e-3, 1e-3)
_BALL_SCALE = (1e4, 1e4, 1e3, 1e3)
_ROBOT_SCALE = (1e4, 1e4, 1e3, 1e3, 1e3, 1e3, 1.0)
_BALL, _ROBOT = len(_BALL_SCALE), len(_ROBOT_SCALE)
_encode = json.JSONEncoder(separators=(",", ":")).encode
_quote = json.encoder.encode_basestring_ascii
# Three times as fast as zlib's default, for a file 5 % longer.
_EFFORT = 4
_SILENT = (Selector, Sequence, Parallel)
_LETTERS = {Status.SUCCESS.name: "S", Status.FAILURE.name: "F", Status.RUNNING.name: "R"}


class RecordingError(ValueError):
    """A file is not a recording that can be read.

    Attributes:
        path, line, field: where; ``line`` counts from 1, None when the file as a whole is meant.
    """

    def __init__(self, path: Path, problem: str, line: int | None = None, field: str | None = None) -> None:
        self.path, self.line, self.field = path, line, field
        place = str(path) if line is None else f"{path}, line {line}"
        super().__init__(f"{place}: {problem}" if field is None else f"{place}: {field}: {problem}")


class RobotFlag(IntFlag):
    """What else is known of a robot at one tick."""

    BALL_CONTACT = 1
    """The ball lies in its mouth."""
    DRIBBLER = 2
    """Its command turns the dribbler."""
    KICK = 4
    """Its command asks for a kick."""


class _HeaderPart(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class RecordedNode(_HeaderPart):
    """One node of a recorded tree; a tree is the list of its nodes, parents before children."""

    name: str
    type: str = Field(description="name of the node's class")
    kind: NodeKind
    depth: int = Field(ge=0, description="0 at the root")
    glyph: str = Field("", description="the sign of a composite or decorator")
    detail: str = Field("", description="memory or reactive, a policy, or parameters")


class RecordedRobot(_HeaderPart):
    """One robot of a recording."""

    team: Team
    number: int = Field(ge=0)
    play: str = Field("", description="what it plays, as people call it")
    radius: float = Field(ROBOT_RADIUS, gt=0, le=1, description="[m]")
    mouth: float = Field(0.075, gt=0, le=1, description="centre to flat front [m]")
    tree: tuple[RecordedNode, ...] = Field((), description="filled in by the recorder")

    @property
    def id(self) -> RobotId:
        """Team and number."""
        return RobotId(self.team, self.number)

    @model_validator(mode="after")
    def _one_root(self) -> RecordedRobot:
        for place, node in enumerate(self.tree):
            deepest = self.tree[place - 1].depth + 1 if place else 0
            if node.depth > deepest or (node.depth == 0) != (place == 0):
                raise ValueError(f"node {place} of the tree cannot have depth {node.depth}")
        return self


class RecordingHeader(_HeaderPart):
    """What stays the same during a recording."""

    scenario: str = Field("", description="name of the scenario")
    trial: int = Field(0, ge=0, description="which repetition of the scenario, from 0")
    seed: int = Field(0, description="the trial's seed")
    period: float = Field(gt=0, le=10, description="control period [s]")
    field: FieldGeometry
    teams: dict[Team, str] = Field(default_factory=dict, description="what the teams are called")
    robots: tuple[RecordedRobot, ...] = ()
    robobt: str = Field(__version__, description="version of robobt that recorded it")

    @model_validator(mode="after")
    def _robots_differ(self) -> RecordingHeader:
        ids = [robot.id for robot in self.robots]
        for robot in ids:
            if ids.count(robot) > 1:
                raise ValueError(f"robot {robot} is listed twice")
        return self


@dataclass(slots=True, frozen=True)
class Event:
    """Something worth a mark on the timeline.

    Attributes:
        time: when [s].
        kind: "goal", "kick", "save", "out", "error" or any other word.
        team: whose event it is, if anybody's.
        robot: which robot's, if one's.
        text: what happened, for people.
    """

    time: float
    kind: str
    team: Team | None = None
    robot: RobotId | None = None
    text: str = ""


class Recorder:
    """Writes one match to a file, tick by tick. A context manager.

    The referee's commands, the score and a tree that raised need no event of
    their own: :meth:`tick` sees them in the frame and in the runners.

    Args:
        path: file to write, replaced when it exists; a name ending in ``.gz`` is compressed.
        header: what stays the same. The trees of its robots are taken from ``runners``.
        runners: the runner of each robot whose tree is recorded.

    Raises:
        OSError: the file cannot be written.
    """

    def __init__(
        self,
        path: str | Path,
        header: RecordingHeader,
        runners: Mapping[RobotId, TreeRunner] | None = None,
    ) -> None:
        self.path = Path(path)
        runners = {} if runners is None else runners
        robots = tuple([_with_tree(robot, runners.get(robot.id)) for robot in header.robots])
        self.header = header.model_copy(update={"robots": robots})
        self._trees = [
            _TreeWatch(slot, robot.id, runners[robot.id])
            for slot, robot in enumerate(robots)
            if robot.id in runners
        ]
        self._slots = {
            team: {robot.number: slot for slot, robot in enumerate(robots) if robot.team is team}
            for team in Team
        }
        self._ids = [robot.id for robot in robots]
        self._nowhere = [nan] * (_BALL + _ROBOT * len(robots))
        self._pack = Struct(f"{len(self._nowhere)}d").pack
        self._game: GameState | None = None
        self._touch: RobotId | None = None
        # Lines to be written: whole ones, and ticks as what stands before and behind their numbers.
        self._lines: list[str | tuple[str, str]] = []
        self._packed: list[bytes] = []
        # A second of lines at a time: few enough writes, and a kill loses no more than that.
        self._most_lines = max(1, round(1.0 / header.period))
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._file: BinaryIO | None = self.path.open("wb")
        self._deflate = zlib.compressobj(_EFFORT, wbits=31) if self.path.suffix == ".gz" else None
        start = {"format": FORMAT, "version": VERSION, **self.header.model_dump(mode="json")}
        self._lines.append(_encode(start))
        try:
            self._flush()
        except OSError:
            self._release()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._release()

    def tick(self, frame: Frame, commands: Mapping[RobotId, RobotCommand] | None = None) -> None:
        """Record one frame, the commands decided on it and what the trees look like now.

        Robots that the header does not list are left out.
        """
        frame = frame.seen_by(Team.BLUE)
        ball, ids = frame.ball, self._ids
        numbers = self._nowhere.copy()
        numbers[:_BALL] = ball.x, ball.y, ball.vx, ball.vy
        for team, robots in ((Team.BLUE, frame.own), (Team.YELLOW, frame.opponents)):
            slots = self._slots[team]
            for robot in robots:
                slot = slots.get(robot.id)
                if slot is None:
                    continue
                flags = 1 if robot.ball_contact else 0
                if commands:
                    command = commands.get(ids[slot])
                    if command is not None:
                        flags += (2 if command.dribbler else 0) + (4 if command.kick_speed else 0)
                at = _BALL + _ROBOT * slot
                numbers[at : at + _ROBOT] = (
                    robot.x,
                    robot.y,
                    robot.heading,
                    robot.vx,
                    robot.vy,
                    robot.omega,
                    flags,
                )
        packed = self._pack(*numbers)
        changes = self._tree_changes(frame.time) if self._trees else ""
        game = frame.game
        if game is not self._game:
            if game != self._game:
                changes += f',"g":{_encode(_game_to_json(game))}'
            self._game = game
        if frame.last_touch != self._touch:
            self._touch = frame.last_touch
            changes += f',"l":{_encode(self._touch)}'
        lines = self._lines
        lines.append((f'{{"t":{round(frame.time, 6)!r},"b":', changes + "}"))
        self._packed.append(packed)
        if len(lines) >= self._most_lines:
            self._flush()

    def event(
        self,
        kind: str,
        time: float,
        *,
        team: Team | None = None,
        robot: RobotId | None = None,
        text: str = "",
    ) -> None:
        """Record that something happened at ``time`` [s]; the words are those of :class:`Event`."""
        entry: dict[str, Any] = {"e": kind, "t": round(time, 6)}
        if robot is not None:
            entry["robot"] = robot
            team = robot.team if team is None else team
        if team is not None:
            entry["team"] = team
        if text:
            entry["text"] = text
        self._lines.append(_encode(entry))

    def close(self, outcome: Mapping[str, Any]) -> None:
        """Write the outcome, any mapping that JSON can hold, and close the file."""
        self._lines.append(_encode({"end": dict(outcome)}))
        self._release()

    def _tree_changes(self, time: float) -> str:
        statuses: list[str] = []
        feedback: list[str] = []
        for tree in self._trees:
            now = tree.look_at_statuses()
            if now != tree.statuses:
                tree.statuses = now
                letters = "".join([_LETTERS.get(status._name_, "-") for some in now for status in some])
                statuses.append(f'"{tree.slot}":"{letters}"')
            said = tree.look_at_feedback()
            if said != tree.feedback:
                changes = [
                    f'"{place}":{_quote(str(message))}'
                    for place, message, before in zip(
                        tree.places, chain(*said), chain(*tree.feedback), strict=True
                    )
                    if message != before
                ]
                tree.feedback = said
                feedback.append(f'"{tree.slot}":{{{",".join(changes)}}}')
            if tree.runner.error != tree.error:
                tree.error = tree.runner.error
                if tree.error is not None:
                    self.event("error", time, robot=tree.robot, text=tree.error)
        line = f',"s":{{{",".join(statuses)}}}' if statuses else ""
        return f'{line},"f":{{{",".join(feedback)}}}' if feedback else line

    def _flush(self) -> None:
        if self._file is None or not self._lines:
            return
        places = iter(_places(b"".join(self._packed), len(self._ids)))
        lines = [
            line if isinstance(line, str) else f"{line[0]}{next(places)}{line[1]}" for line in self._lines
        ]
        data = ("\n".join(lines) + "\n").encode()
        self._lines.clear()
        self._packed.clear()
        if self._deflate is not None:
            data = self._deflate.compress(data) + self._deflate.flush(zlib.Z_SYNC_FLUSH)
        with naming(self.path):
            self._file.write(data)
            self._file.flush()

    def _release(self) -> None:
        if self._file is None:
            return
        file = self._file
        try:
            self._flush()
            if self._deflate is not None:
                file.write(self._deflate.flush())
        finally:
            self._file = None
            with naming(self.path):
                file.close()


class _TreeWatch:
    """What a tree looked like at the tick before."""

    __slots__ = (
        "error",
        "feedback",
        "look_at_feedback",
        "look_at_statuses",
        "places",
        "robot",
        "runner",
        "slot",
        "statuses",
    )

    def __init__(self, slot: int, robot: RobotId, runner: TreeRunner) -> None:
        self.slot, self.robot, self.runner = slot, robot, runner
        nodes = runner.nodes
        self.look_at_statuses = _look_at("status", nodes)
        self.statuses: _Seen = ()
        # py_trees' own composites never say anything, and a third of all nodes are such.
        self.places = [place for place, node in enumerate(nodes) if type(node) not in _SILENT]
        self.look_at_feedback = _look_at("feedback_message", [nodes[place] for place in self.places])
        self.feedback: _Seen = tuple([("",) * len(some) for some in self.look_at_feedback()])
        self.error: str | None = None


_Seen: TypeAlias = tuple[tuple[Any, ...], ...]


def _look_at(attribute: str, nodes: SequenceOf[Behaviour]) -> Callable[[], _Seen]:
    """A function that gives this attribute of every node, in tuples of up to 30."""
    # With a place in the code for each node, the interpreter remembers at each where in
    # that class the attribute is found; in a loop over nodes of many classes it has to search
    # every time, which takes three times as long. Longer tuples are built item by item.
    names = [f"n{place}" for place in range(len(nodes))]
    tuples = [
        "(" + "".join([f"{name}.{attribute}," for name in names[start : start + 30]]) + ")"
        for start in range(0, len(names), 30)
    ]
    source = f"lambda {','.join(names)}: lambda: ({''.join([part + ',' for part in tuples])})"
    look: Callable[[], _Seen] = eval(source)(*nodes)
    return look


def _places(packed: bytes, robots: int) -> list[str]:
    """What stands between the time and the changes in the lines of some ticks: ball and robots.

    Args:
        packed: the ticks' numbers in SI units, see :meth:`Recorder.tick`.
        robots: how many there are in a tick.
    """
    sizes = [_BALL, *[_ROBOT] * robots]
    with np.errstate(over="ignore"):
        table = np.rint(
            np.frombuffer(packed).reshape(-1, sum(sizes)) * [*_BALL_SCALE, *_ROBOT_SCALE * robots]
        )
    known = np.isfinite(table)
    table[~known] = 0.0
    # Whole floats are written just the same, only slower.
    fits = np.abs(table).max(initial=0.0) < 2.0**63
    rows = (table.astype(np.int64) if fits else table).tolist()
    patterns: dict[tuple[bool, ...], str] = {}
    places = []
    for row, there in zip(rows, _groups(known, sizes).tolist(), strict=True):
        key = tuple(there)
        pattern = patterns.get(key)
        if pattern is None:
            ball, *others = map(_pattern, sizes, key)
            pattern = patterns[key] = f'{ball},"r":[{",".join(others)}]'
        places.append(pattern % tuple(row))
    return places


def _groups(known: NDArray[np.bool_], sizes: SequenceOf[int]) -> NDArray[np.bool_]:
    """For each row and each group of columns whether all of it is known."""
    return np.logical_and.reduceat(known, [0, *accumulate(sizes[:-1])], axis=1)


def _pattern(size: int, known: bool) -> str:
    """How to print this many integers; null when they are not all known."""
    # A string of length 0 takes a number and prints nothing.
    return "[" + ",".join(["%d"] * size) + "]" if known else "null" + "%.0s" * size


def _with_tree(robot: RecordedRobot, runner: TreeRunner | None) -> RecordedRobot:
    if runner is None:
        return robot
    nodes = []
    depths = {runner.root.id: 0}
    for node in runner.nodes:
        depth = depths[node.id]
        depths.update({child.id: depth + 1 for child in node.children})
        told = describe(node)
        nodes.append(
            RecordedNode(
                name=told.name,
                type=told.type,
                kind=told.kind,
                depth=depth,
                glyph=told.glyph,
                detail=told.detail,
            )
        )
    return robot.model_copy(update={"tree": tuple(nodes)})


def _game_to_json(game: GameState) -> dict[str, Any]:
    return {
        "command": game.command.name,
        "stage": game.stage.name,
        "blue": game.blue_score,
        "yellow": game.yellow_score,
        "restart": game.restart,
        "team": game.restart_team,
        "may_touch": game.may_touch,
        "placement": game.placement,
    }


@dataclass(slots=True)
class Recording:
    """A match that was recorded, in world coordinates (blue defends -x).

    T is the number of ticks, K that of robots in the header.

    Attributes:
        path: the file.
        header: what stayed the same.
        times: (T,) [s], never decreasing.
        ball: (T, 4) x, y [m], vx, vy [m/s]; NaN where it was not known.
        robots: (T, K, 6) x, y [m], heading [rad], vx, vy [m/s], omega [rad/s]; NaN off the field.
        flags: (T, K) :class:`RobotFlag`.
        statuses: for each robot the ticks at which its tree changed, with one letter a node.
        feedback: for each robot the ticks at which nodes said something new, by node.
        games: the ticks at which the referee's word changed.
        touches: the ticks at which the last touch changed hands.
        events: in the order they were recorded.
        outcome: what the match ended with, None when its recorder was not closed.
    """

    path: Path
    header: RecordingHeader
    times: FloatArray
    ball: FloatArray
    robots: FloatArray
    flags: NDArray[np.uint8]
    statuses: list[list[tuple[int, str]]]
    feedback: list[list[tuple[int, dict[int, str]]]]
    games: list[tuple[int, GameState]]
    touches: list[tuple[int, RobotId | None]]
    events: list[Event]
    outcome: dict[str, Any] | None

    @property
    def complete(self) -> bool:
        """Whether the recording reached its end; a killed match's did not."""
        return self.outcome is not None

    def __len__(self) -> int:
        return len(self.times)

    def frame(self, tick: int) -> Frame:
        """What was on the field at a tick, from blue's side, as exactly as the file holds it.

        Raises:
            IndexError: no such tick.
        """
        period = self.header.period
        tick = range(len(self))[tick]
        ball = BallState(*self.ball[tick].tolist())
        teams: dict[Team, list[RobotState]] = {team: [] for team in Team}
        for robot, row, flags in zip(
            self.header.robots, self.robots[tick].tolist(), self.flags[tick].tolist(), strict=True
        ):
            if isfinite(row[0]):
                contact = bool(flags & RobotFlag.BALL_CONTACT)
                x, y, heading, vx, vy, omega = row
                state = RobotState(robot.number, x, y, heading, vx, vy, omega, contact)
                teams[robot.team].append(state)
        own, opponents = (tuple(sorted(teams[team], key=_number)) for team in (Team.BLUE, Team.YELLOW))
        game = _latest(self.games, tick, OPEN_PLAY)
        touch = _latest(self.touches, tick, None)
        time = float(self.times[tick])
        return Frame(time, self.header.field, ball, own, opponents, Team.BLUE, period, game, touch)

    def statuses_at(self, robot: RobotId, tick: int) -> str:
        """One letter a node of the robot's tree (S, F, R, - not ticked), in the order of its header.

        Raises:
            KeyError: no such robot in this recording.
        """
        slot = self._slot(robot)
        return _latest(self.statuses[slot], tick, "-" * len(self.header.robots[slot].tree))

    def feedback_at(self, robot: RobotId, tick: int) -> dict[int, str]:
        """What the nodes of the robot's tree have said last, by place in the tree.

        Raises:
            KeyError: no such robot in this recording.
        """
        said: dict[int, str] = {}
        for when, changes in self.feedback[self._slot(robot)]:
            if when > tick:
                break
            said.update(changes)
        return {place: message for place, message in said.items() if message}

    def _slot(self, robot: RobotId) -> int:
        for slot, entry in enumerate(self.header.robots):
            if entry.id == robot:
                return slot
        raise KeyError(f"robot {robot} is not in {self.path}")


def _number(robot: RobotState) -> int:
    return robot.id


def _latest(changes: SequenceOf[tuple[int, T]], tick: int, default: T) -> T:
    place = bisect_right(changes, tick, key=_when)
    return changes[place - 1][1] if place else default


def _when(change: tuple[int, Any]) -> int:
    return change[0]


def load_recording(path: str | Path) -> Recording:
    """Read a recording, plain or compressed; one that was cut off, up to its last whole line.

    Raises:
        RecordingError: the file cannot be read, is no recording, or a line of it is not what
            it should be; the message names the file, the line and the field.
    """
    path = Path(path)
    lines = _lines_of(path)
    header = _read_header(path, lines[0])
    reader = _Reader(path, header)
    for number, line in enumerate(lines[1:], start=2):
        reader.read(number, line)
    return reader.recording()


def _lines_of(path: Path) -> list[bytes]:
    """The whole lines of the file, at least one."""
    try:
        data = path.read_bytes()
        if data.startswith(b"\x1f\x8b"):
            # Unlike gzip.open, this gives what there is of a stream that was cut off.
            data = zlib.decompressobj(wbits=31).decompress(data)
    except OSError as error:
        raise RecordingError(path, error.strerror or str(error)) from None
    except zlib.error as error:
        raise RecordingError(path, f"its compressed data are damaged ({error})") from None
    if not data:
        raise RecordingError(path, "is empty")
    lines = data.split(b"\n")
    last = lines.pop()
    if not lines:
        if FORMAT.encode() in last[:100]:
            raise RecordingError(path, "is cut off inside its header", 1)
        raise RecordingError(path, "is not a robobt recording", 1)
    return lines


def _object(path: Path, number: int, line: bytes) -> dict[str, Any]:
    try:
        entry = json.loads(line)
    except (ValueError, RecursionError):
        raise RecordingError(path, "is not a JSON object", number) from None
    if not isinstance(entry, dict):
        raise RecordingError(path, "is not a JSON object", number)
    return entry


def _read_header(path: Path, line: bytes) -> RecordingHeader:
    try:
        entry = _object(path, 1, line)
    except RecordingError:
        raise RecordingError(path, "is not a robobt recording", 1) from None
    if entry.pop("format", None) != FORMAT:
        raise RecordingError(path, f"must be {FORMAT!r}: this is not a robobt recording", 1, "format")
    version = entry.pop("version", None)
    if version != VERSION:
        problem = f"{version!r} cannot be read by robobt {__version__}, which reads {VERSION}"
        raise RecordingError(path, problem, 1, "version")
    try:
        return RecordingHeader.model_validate(entry)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        raise RecordingError(path, first["msg"], 1, place or None) from None


_NOWHERE = -(2**31)
_LONGEST = 1e9


class _Reader:
    """Takes the lines after the header one by one."""

    def __init__(self, path: Path, header: RecordingHeader) -> None:
        self.path, self.header = path, header
        self.times: list[float] = []
        self.ball = array("i")
        self.robots = array("i")
        self.statuses: list[list[tuple[int, str]]] = [[] for _ in header.robots]
        self.feedback: list[list[tuple[int, dict[int, str]]]] = [[] for _ in header.robots]
        self.games: list[tuple[int, GameState]] = []
        self.touches: list[tuple[int, RobotId | None]] = []
        self.events: list[Event] = []
        self.outcome: dict[str, Any] | None = None
        self.number = 1

    def read(self, number: int, line: bytes) -> None:
        self.number = number
        if self.outcome is not None:
            raise RecordingError(self.path, "stands after the last line of the recording", number)
        entry = _object(self.path, number, line)
        if "r" in entry:
            self._tick(entry)
        elif "e" in entry:
            self._event(entry)
        elif "end" in entry:
            self._need(isinstance(entry["end"], dict), "end", "must be an object")
            self.outcome = entry["end"]
        else:
            raise RecordingError(self.path, "is neither a tick nor an event nor the end", number)

    def recording(self) -> Recording:
        ticks, count = len(self.times), len(self.header.robots)
        ball = np.array(self.ball, dtype=np.float64).reshape(ticks, len(_BALL_UNITS))
        rows = np.array(self.robots, dtype=np.float64).reshape(ticks, count, len(_ROBOT_UNITS) + 1)
        ball[ball[:, 0] == _NOWHERE] = np.nan
        flags = rows[:, :, -1].astype(np.uint8)
        robots = rows[:, :, :-1]
        robots[robots[:, :, 0] == _NOWHERE] = np.nan
        return Recording(
            self.path,
            self.header,
            np.array(self.times, dtype=np.float64),
            ball * _BALL_UNITS,
            robots * _ROBOT_UNITS,
            flags,
            self.statuses,
            self.feedback,
            self.games,
            self.touches,
            self.events,
            self.outcome,
        )

    def _tick(self, entry: dict[str, Any]) -> None:
        tick = len(self.times)
        time = self._time(entry)
        self._need(not self.times or time >= self.times[-1], "t", "runs backwards")
        self.times.append(time)
        self._integers(self.ball, entry.get("b"), 4, "b")
        rows = entry["r"]
        count = len(self.header.robots)
        if type(rows) is not list or len(rows) != count:
            raise self._error("r", f"must be a list of {count} robots")
        for slot, row in enumerate(rows):
            self._integers(self.robots, row, 7, f"r.{slot}")
            if row is None:
                self.robots[-1] = 0
            elif not 0 <= row[6] <= 7:
                raise self._error(f"r.{slot}", f"{row[6]} are no flags")
        if "s" in entry:
            for slot, letters in self._by_robot(entry["s"], "s"):
                size = len(self.header.robots[slot].tree)
                good = isinstance(letters, str) and len(letters) == size and not letters.strip("SFR-")
                self._need(good, f"s.{slot}", f"must be {size} letters out of S, F, R, -")
                self.statuses[slot].append((tick, letters))
        if "f" in entry:
            for slot, messages in self._by_robot(entry["f"], "f"):
                self.feedback[slot].append((tick, self._messages(slot, messages)))
        if "g" in entry:
            self.games.append((tick, self._game(entry["g"])))
        if "l" in entry:
            touch = entry["l"]
            self.touches.append((tick, None if touch is None else self._robot(touch, "l")))

    def _event(self, entry: dict[str, Any]) -> None:
        kind, text = entry["e"], entry.get("text", "")
        self._need(isinstance(kind, str), "e", "must be a word")
        self._need(isinstance(text, str), "text", "must be a text")
        robot = self._robot(entry["robot"], "robot") if "robot" in entry else None
        team = self._team(entry["team"], "team") if "team" in entry else None
        self.events.append(Event(self._time(entry), kind, team, robot, text))

    def _messages(self, slot: int, messages: Any) -> dict[int, str]:
        field = f"f.{slot}"
        self._need(isinstance(messages, dict), field, "must be an object")
        said = {}
        for key, message in messages.items():
            place = self._index(key, len(self.header.robots[slot].tree), field, "node")
            self._need(isinstance(message, str), f"{field}.{key}", "must be a text")
            said[place] = message
        return said

    def _game(self, entry: Any) -> GameState:
        self._need(isinstance(entry, dict), "g", "must be an object")
        try:
            placement = entry["placement"]
            if placement is not None:
                x, y = placement
                placement = (float(x), float(y))
            return GameState(
                RefereeCommand[entry["command"]],
                Stage[entry["stage"]],
                int(entry["blue"]),
                int(entry["yellow"]),
                None if entry["restart"] is None else Restart(entry["restart"]),
                None if entry["team"] is None else Team(entry["team"]),
                bool(entry["may_touch"]),
                placement,
            )
        except KeyError as error:
            raise self._error("g", f"{error.args[0]!r} is missing or unknown") from None
        except (TypeError, ValueError, OverflowError) as error:
            raise self._error("g", str(error)) from None

    def _time(self, entry: dict[str, Any]) -> float:
        time = entry.get("t")
        if isinstance(time, int | float) and not isinstance(time, bool) and abs(time) < _LONGEST:
            return float(time)
        raise self._error("t", "must be a finite number")

    def _integers(self, into: array[int], row: Any, size: int, field: str) -> None:
        if row is None:
            into.extend([_NOWHERE] * size)
            return
        try:
            if type(row) is list and len(row) == size:
                into.extend(row)
                return
        except (TypeError, OverflowError):
            pass
        raise self._error(field, f"must be null or a list of {size} integers")

    def _by_robot(self, entry: Any, field: str) -> Iterator[tuple[int, Any]]:
        self._need(isinstance(entry, dict), field, "must be an object")
        for key, value in entry.items():
            yield self._index(key, len(self.header.robots), field, "robot"), value

    def _index(self, key: str, size: int, field: str, what: str) -> int:
        index = int(key) if key.isascii() and key.isdigit() and len(key) < 6 else size
        self._need(index < size, field, f"there is no {what} {key!r}")
        return index

    def _team(self, value: Any, field: str) -> Team:
        try:
            return Team(value)
        except ValueError:
            raise self._error(field, f"{value!r} is not a team") from None

    def _robot(self, value: Any, field: str) -> RobotId:
        good = isinstance(value, list) and len(value) == 2 and type(value[1]) is int
        self._need(good, field, "must be a team and a number")
        return RobotId(self._team(value[0], field), value[1])

    def _need(self, good: bool, field: str, problem: str) -> None:
        if not good:
            raise self._error(field, problem)

    def _error(self, field: str, problem: str) -> RecordingError:
        return RecordingError(self.path, problem, self.number, field)
