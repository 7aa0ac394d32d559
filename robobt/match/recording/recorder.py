"""Writes a match to a file, tick by tick.

The file is a stream of Arrow record batches, one a second of play, and is only ever
appended to: a match that was killed leaves a file that can be read up to its last whole
batch. :mod:`robobt.match.recording.stream` has the columns. What a tick costs is kept down
by doing the work of many ticks at once, where they are written.
"""

from __future__ import annotations

import atexit
import json
from collections import defaultdict
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import pyarrow as pa

from robobt.config.errors import naming
from robobt.match.recording.header import Event, RecordedNode, RecordedRobot, RecordingHeader
from robobt.match.recording.numbers import TickNumbers
from robobt.match.recording.stores import Written, plain, stores_of
from robobt.match.recording.stream import COLUMNS, new_stream
from robobt.skills.store import Store
from robobt.tree import TreeRunner
from robobt.tree.drawing import describe
from robobt.tree.recording import TreeState, TreeWatch, node_ids
from robobt.world.command import RobotCommand
from robobt.world.game import GameState, Team
from robobt.world.state import Frame, RobotId

_FLUSH_PERIOD = 1.0
"""What a killed match loses at most [s]."""

_BUFFER = 2**20
"""Arrow writes a batch in many pieces, which go to the file as one [bytes]."""

_encode = json.JSONEncoder(ensure_ascii=False, separators=(",", ":"), default=asdict).encode


class Recorder:
    """Writes one match to a file, tick by tick. A context manager.

    The referee's commands, the score and a tree that raised need no event of
    their own: :meth:`tick` sees them in the frame and in the runners.

    Args:
        path: file to write, replaced when it exists.
        header: what stays the same. The trees of its robots are taken from ``runners``.
        runners: the runner of each robot whose tree is recorded.
        stores: the store of each robot of which it is recorded what its skills write.
    """

    def __init__(
        self,
        path: str | Path,
        header: RecordingHeader,
        runners: Mapping[RobotId, TreeRunner] | None = None,
        stores: Mapping[RobotId, Store] | None = None,
    ) -> None:
        self.path = Path(path)
        runners = runners or {}
        robots = tuple([_with_tree(robot, runners.get(robot.id)) for robot in header.robots])
        self.header = header.model_copy(update={"robots": robots})
        self._trees = [
            (robot.id, str(robot.id), TreeWatch(runners[robot.id])) for robot in robots if robot.id in runners
        ]
        self._stores = stores_of(runners, stores or {})
        self._numbers = TickNumbers([robot.id for robot in robots])
        self._game: GameState | None = None
        self._touch: RobotId | None = None
        # What is still to be written.
        self._times: list[float] = []
        self._truth: list[bytes] = []
        self._observed: list[bytes] = []
        self._commands: list[Mapping[RobotId, RobotCommand]] = []
        self._states: list[tuple[int, int, TreeState]] = []
        self._written: list[tuple[int, list[Written]]] = []
        self._changes: defaultdict[int, dict[str, Any]] = defaultdict(dict)
        self._events: list[Event] = []
        # Few enough writes, and a kill loses no more than that.
        self._most_ticks = max(1, round(_FLUSH_PERIOD / header.period))
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with naming(self.path):
            self._file = self.path.open("wb", _BUFFER)
            try:
                self._writer = new_stream(self._file, self.header)
                self._file.flush()
            except BaseException:
                # What is buffered cannot be written either.
                with suppress(OSError):
                    self._file.close()
                raise
        # For a process that ends without closing it.
        atexit.register(self._release)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._release()

    def tick(
        self,
        frame: Frame,
        commands: Mapping[RobotId, RobotCommand] | None = None,
        observed: Frame | None = None,
        packed: bytes | None = None,
    ) -> None:
        """Record one frame, the commands decided on it and what the trees look like now.

        Robots that the header does not list are left out.

        Args:
            frame: what really was.
            commands: what the robots were sent.
            observed: what the trees were shown where that was something else.
            packed: the frame from blue's side, where it has been packed already.
        """
        tick = len(self._times)
        if tick == self._most_ticks:
            self._flush()
            tick = 0
        truth = frame.seen_by(Team.BLUE).packed() if packed is None else packed
        self._times.append(frame.time)
        self._truth.append(truth)
        self._observed.append(truth if observed is None else observed.seen_by(Team.BLUE).packed())
        # They are made anew every tick, so it is enough to keep them.
        self._commands.append(commands or {})
        for place, (_, _, watch) in enumerate(self._trees):
            state = watch.look()
            if state is not None:
                self._states.append((tick, place, state))
        written = self._stores.look()
        if written:
            self._written.append((tick, written))
        game = frame.game if frame.team is Team.BLUE else frame.game.mirrored()
        if game is not self._game:
            if game != self._game:
                self._changes[tick]["game"] = game
            self._game = game
        if frame.last_touch != self._touch:
            self._touch = self._changes[tick]["touch"] = frame.last_touch

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
        if team is None and robot is not None:
            team = robot.team
        self._events.append(Event(round(time, 6), kind, team, robot, text))

    def close(self, outcome: Mapping[str, object]) -> None:
        """Write the outcome, any mapping that JSON can hold, and close the file.

        It belongs to the last tick; a recording without one stays incomplete.
        """
        if self._times:
            self._changes[len(self._times) - 1]["outcome"] = plain(outcome)
        self._release()

    def _flush(self) -> None:
        """Write the ticks that wait for it."""
        ticks = len(self._times)
        if not ticks:
            return
        self._add_changes()
        if self._events:
            self._changes[ticks - 1]["events"] = self._events
        texts = [_encode(self._changes[tick]) if tick in self._changes else None for tick in range(ticks)]
        truth = self._numbers.poses(self._truth)
        shown = truth if self._observed == self._truth else self._numbers.poses(self._observed)
        columns = [
            pa.array(self._times),
            truth,
            pa.nulls(ticks, truth.type) if shown is truth else shown,
            self._numbers.commands(self._commands),
            # What is no Unicode text, as half a surrogate pair, becomes a question mark.
            pa.array([text and text.encode("utf-8", "replace") for text in texts], pa.string()),
        ]
        for waiting in (
            self._times,
            self._truth,
            self._observed,
            self._commands,
            self._states,
            self._written,
        ):
            waiting.clear()
        self._changes.clear()
        self._events = []
        for _, _, watch in self._trees:
            watch.look_again()
        with naming(self.path):
            self._writer.write_batch(pa.RecordBatch.from_arrays(columns, COLUMNS))
            self._file.flush()

    def _add_changes(self) -> None:
        for tick, place, state in self._states:
            robot, name, watch = self._trees[place]
            change = watch.change(state)
            if change is None:
                continue
            changes = self._changes[tick]
            if change.statuses is not None:
                changes.setdefault("statuses", {})[name] = change.statuses
            if change.feedback:
                changes.setdefault("feedback", {})[name] = change.feedback
            if change.error is not None:
                self.event("error", self._times[tick], robot=robot, text=change.error)
        for tick, written in self._written:
            values = self._stores.plain(written)
            if values:
                self._changes[tick]["written"] = values

    def _release(self) -> None:
        if self._file.closed:
            return
        atexit.unregister(self._release)
        with naming(self.path), self._file:
            self._flush()
            self._writer.close()


def _with_tree(robot: RecordedRobot, runner: TreeRunner | None) -> RecordedRobot:
    if runner is None:
        return robot
    nodes = []
    for node, (depth, path) in zip(runner.nodes, node_ids(runner.nodes), strict=True):
        nodes.append(RecordedNode(path=path, depth=depth, **asdict(describe(node))))
    return robot.model_copy(update={"tree": tuple(nodes)})
