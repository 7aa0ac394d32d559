"""Writes a match to a file, tick by tick.

The file is a text of JSON objects, one a line, or the same compressed; docs/recording.md
has the keys. It is only ever appended to, a second at a time, so a match that was
killed leaves a file that can be read up to its last whole line. What a tick costs is
kept down by doing the work of many ticks at once, where they are written.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Mapping, Sequence
from functools import partial
from math import nan
from pathlib import Path
from struct import Struct
from types import TracebackType
from typing import Any, BinaryIO, Self

import numpy as np

from robobt.config.errors import naming
from robobt.match.recording.header import (
    FORMAT,
    VERSION,
    RecordedNode,
    RecordedRobot,
    RecordingHeader,
)
from robobt.match.recording.numbers import BALL, POSE, SENT, Columns, Snapshot
from robobt.match.recording.outputs import OutputWatch, Written, quote, team_entries, written_entries
from robobt.skills.store import Store
from robobt.tree import TreeRunner
from robobt.tree.drawing import describe
from robobt.tree.recording import Look, TreeWatch, node_paths
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.game import GameState, Team
from robobt.world.geometry import FloatArray
from robobt.world.protocol import World
from robobt.world.state import Frame, RobotId

_FLUSH_PERIOD = 1.0
# Three times as fast as zlib's default, for a file 5 % longer.
_EFFORT = 4
_encode = json.JSONEncoder(separators=(",", ":")).encode


class Recorder:
    """Writes one match to a file, tick by tick. A context manager.

    The referee's commands, the score and a tree that raised need no event of
    their own: :meth:`tick` sees them in the frame and in the runners.

    Args:
        path: file to write, replaced when it exists; a name ending in ``.gz`` is compressed.
        header: what stays the same. The trees of its robots are taken from ``runners``.
        runners: the runner of each robot whose tree is recorded.
        stores: the store of each robot whose skills' outputs are recorded.
        world: where it is played; from one that offers :class:`~robobt.world.protocol.Snapshots`
            the numbers of frames that the recorder is told to :meth:`see` are taken as they are.

    Raises:
        OSError: the file cannot be written.
    """

    def __init__(
        self,
        path: str | Path,
        header: RecordingHeader,
        runners: Mapping[RobotId, TreeRunner] | None = None,
        stores: Mapping[RobotId, Store] | None = None,
        world: World | None = None,
    ) -> None:
        self.path = Path(path)
        runners = {} if runners is None else runners
        robots = tuple([_with_tree(robot, runners.get(robot.id)) for robot in header.robots])
        self.header = header.model_copy(update={"robots": robots})
        self._outputs = OutputWatch(_outputs_of(robots, runners, {} if stores is None else stores))
        # Where each team's robots stand in a tick's numbers, by their own number.
        self._places = [
            {robot.number: BALL + POSE * slot for slot, robot in enumerate(robots) if robot.team is team}
            for team in (Team.BLUE, Team.YELLOW)
        ]
        self._slot_of = {robot.id: slot for slot, robot in enumerate(robots)}
        self._nowhere = [nan] * (BALL + POSE * len(robots))
        self._nothing = [0.0] * (SENT * len(robots))
        self._pack_poses = Struct(f"={len(self._nowhere)}d").pack
        self._pack_sent = Struct(f"={len(self._nothing)}d").pack
        self._world = None if world is None else world.snapshots
        order = () if self._world is None else self._world.robots
        self._snapshot = Snapshot(order, [robot.id for robot in robots])
        self._crowd = len(order)
        # The frame that was seen for the coming tick, and the last tick's commands if the world knows them.
        self._begun: tuple[Frame | None, bytes] = (None, b"")
        self._pending: Mapping[RobotId, RobotCommand] | None = None
        self._columns = Columns(len(robots))
        self._keys: list[RobotId] = []
        self._order: list[int] = []
        self._game: GameState | None = None
        self._touch: RobotId | None = None
        # What is still to be written: events, and of each tick time, numbers and what changed.
        self._events: list[str] = []
        self._times: list[float] = []
        # By tick: numbers as the world has them, or else in the order of the columns.
        self._taken: dict[int, bytes] = {}
        self._poses: dict[int, bytes] = {}
        self._acted: dict[int, bytes] = {}
        self._commands: dict[int, bytes] = {}
        self._shown: dict[int, bytes] = {}
        self._looks: dict[tuple[int, int], Look] = {}
        self._written: list[tuple[int, list[Written]]] = []
        self._words: list[tuple[int, str, Any]] = []
        self._trees = [
            (slot, robot.id, TreeWatch(runners[robot.id], partial(self._notice, slot)))
            for slot, robot in enumerate(robots)
            if robot.id in runners
        ]
        self._watches = [watch for _, _, watch in self._trees]
        self._tree_of = {slot: (robot, watch) for slot, robot, watch in self._trees}
        # Few enough writes, and a kill loses no more than that.
        self._most_ticks = max(1, round(_FLUSH_PERIOD / header.period))
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._file: BinaryIO | None = self.path.open("wb")
        self._deflate = zlib.compressobj(_EFFORT, wbits=31) if self.path.suffix == ".gz" else None
        start = {"format": FORMAT, "version": VERSION, **self.header.model_dump(mode="json")}
        try:
            self._write([_encode(start)])
        except OSError:
            self._release()
            raise

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
    ) -> None:
        """Record one frame, the commands decided on it and what the trees look like now.

        Robots that the header does not list are left out.

        Args:
            frame: what really was.
            commands: what the robots were sent.
            observed: what the trees were shown where that was something else.
        """
        tick = len(self._times)
        begun, numbers = self._begun
        if begun is not frame:
            self._poses[tick] = self._numbers_of(frame)
        elif self._world is None:
            self._poses[tick] = numbers
        else:
            self._taken[tick] = numbers
        if self._pending is not None:
            self._commands[tick - 1] = self._sent(self._pending)
            self._pending = None
        if commands and begun is frame and len(commands) == self._crowd:
            self._pending = commands
        else:
            self._commands[tick] = self._sent(commands or {})
        if observed is not None:
            self._shown[tick] = self._numbers_of(observed)
        for watch in self._watches:
            ticks = watch.runner.ticks
            if watch.usual and ticks != watch.ticks:
                watch.ticks = ticks
            else:
                watch.settle()
        written = self._outputs.look()
        if written is not None:
            self._written.append((tick, written))
        game = frame.game if frame.team is Team.BLUE else frame.game.mirrored()
        if game is not self._game:
            if game != self._game:
                self._words.append((tick, "g", _game_to_json(game)))
            self._game = game
        if frame.last_touch != self._touch:
            self._touch = frame.last_touch
            self._words.append((tick, "l", self._touch))
        self._times.append(frame.time)
        if tick + 1 >= self._most_ticks:
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
        self._events.append(_encode(entry))

    def close(self, outcome: Mapping[str, Any]) -> None:
        """Write the outcome, any mapping that JSON can hold, and close the file."""
        end = _encode({"end": dict(outcome)})
        self._flush()
        self._write([end])
        self._release()

    def _notice(self, slot: int, look: Look) -> None:
        # Of several ticks between two records the last one counts.
        self._looks[len(self._times), slot] = look

    def see(self, frame: Frame) -> None:
        """Take down the frame of the coming :meth:`tick`, which the world has just shown.

        It pays while its numbers are still at hand. A world that was told to act on the commands
        of the last tick has them at hand as well.
        """
        world = self._world
        if world is None:
            self._begun = (frame, self._numbers_of(frame))
            return
        if self._pending is not None:
            sent = world.sent()
            if sent is not None:
                self._acted[len(self._times) - 1] = sent
                self._pending = None
        self._begun = (frame, world.snapshot())

    def _numbers_of(self, frame: Frame) -> bytes:
        blue = frame if frame.team is Team.BLUE else frame.mirrored()
        numbers = self._nowhere.copy()
        ball = blue.ball
        numbers[:BALL] = ball.x, ball.y, ball.vx, ball.vy
        for places, robots in zip(self._places, (blue.own, blue.opponents), strict=True):
            for robot in robots:
                if robot.id in places:
                    at = places[robot.id]
                    numbers[at : at + POSE] = (
                        robot.x,
                        robot.y,
                        robot.heading,
                        robot.vx,
                        robot.vy,
                        robot.omega,
                        robot.ball_contact,
                    )
        return self._pack_poses(*numbers)

    def _sent(self, commands: Mapping[RobotId, RobotCommand]) -> bytes:
        keys = list(commands)
        if keys != self._keys:
            # A team's hash is a call of Python, too slow to look up every robot at every tick.
            self._keys = keys
            self._order = [SENT * self._slot_of[key] if key in self._slot_of else -1 for key in keys]
        numbers = self._nothing.copy()
        for at, command in zip(self._order, commands.values(), strict=True):
            if at < 0:
                continue
            flags = 18 if command.dribbler else 16
            if command.kick_speed:
                flags += 12 if command.kick_trigger is KickTrigger.NOW else 4
            numbers[at : at + SENT] = command.vx, command.vy, command.omega, command.kick_speed, flags
        return self._pack_sent(*numbers)

    def _flush(self) -> None:
        """Write the events and ticks that wait for it."""
        block, ticks = "", len(self._times)
        if ticks:
            times = ",".join([repr(round(time, 6)) for time in self._times])
            if self._pending is not None:
                self._commands[ticks - 1] = self._sent(self._pending)
                self._pending = None
            table = self._table()
            text = self._columns.pack(table)
            block = f'{{"n":{ticks},"t":[{times}],"x":"{text}"'
            if self._shown:
                shown = self._columns.pack(self._with_shown(table))
                block += f',"o":"{shown}"' if shown != text else ""
            changes = self._changes()
            block += f',"c":{changes}}}' if changes else "}"
            for waiting in (
                self._times,
                self._taken,
                self._poses,
                self._acted,
                self._commands,
                self._shown,
                self._looks,
                self._written,
                self._words,
            ):
                waiting.clear()
        for watch in self._watches:
            watch.check()
        lines, self._events = self._events, []
        self._write([*lines, block] if block else lines)

    def _table(self) -> FloatArray:
        """The numbers of all waiting ticks (ticks, columns)."""
        columns = self._columns
        table = np.empty((len(self._times), columns.count))
        poses, sent = table[:, : columns.poses], table[:, columns.poses :]
        if self._taken:
            poses[list(self._taken)] = self._snapshot.poses(self._taken.values())
        if self._poses:
            poses[list(self._poses)] = _rows(self._poses)
        if self._acted:
            sent[list(self._acted)] = self._snapshot.sent(self._acted.values())
        if self._commands:
            sent[list(self._commands)] = _rows(self._commands)
        return table

    def _with_shown(self, table: FloatArray) -> FloatArray:
        table[list(self._shown), : self._columns.poses] = _rows(self._shown)
        return table

    def _changes(self) -> str:
        """What changed in this block, a JSON object by tick; "" if nothing did."""
        letters: dict[int, list[str]] = {}
        said: dict[int, list[str]] = {}
        others: dict[int, list[str]] = {}
        for (tick, slot), look in self._looks.items():
            if tick == len(self._times):
                # A tree that was ticked or stopped after the last frame.
                continue
            robot, watch = self._tree_of[slot]
            change = watch.tell(look)
            if change is None:
                continue
            if change.error is not None:
                self.event("error", self._times[tick], robot=robot, text=change.error)
            if change.letters is not None:
                letters.setdefault(tick, []).append(f'"{slot}":"{change.letters}"')
            if change.said:
                words = ",".join([f'"{place}":{quote(text)}' for place, text in change.said.items()])
                said.setdefault(tick, []).append(f'"{slot}":{{{words}}}')
        for tick, written in self._written:
            text = self._outputs.tell(written)
            if text:
                others.setdefault(tick, []).append(f'"w":{text}')
        for tick, key, value in self._words:
            others.setdefault(tick, []).append(f'"{key}":{_encode(value)}')
        ticks = []
        for tick in sorted({*letters, *said, *others}):
            parts = others.get(tick, [])
            if tick in said:
                parts.insert(0, f'"f":{{{",".join(said[tick])}}}')
            if tick in letters:
                parts.insert(0, f'"s":{{{",".join(letters[tick])}}}')
            ticks.append(f'"{tick}":{{{",".join(parts)}}}')
        return f"{{{','.join(ticks)}}}" if ticks else ""

    def _write(self, lines: list[str]) -> None:
        if self._file is None or not lines:
            return
        data = ("\n".join(lines) + "\n").encode()
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


def _rows(packed: Mapping[int, bytes]) -> FloatArray:
    return np.frombuffer(b"".join(packed.values())).reshape(len(packed), -1)


def _outputs_of(
    robots: tuple[RecordedRobot, ...],
    runners: Mapping[RobotId, TreeRunner],
    stores: Mapping[RobotId, Store],
) -> dict[str, tuple[object, Sequence[str]]]:
    """Every robot's store by its slot and every team's by its name, with what skills write into them."""
    outputs: dict[str, tuple[object, Sequence[str]]] = {}
    for slot, robot in enumerate(robots):
        if robot.id in runners and robot.id in stores:
            outputs[str(slot)] = (stores[robot.id], written_entries(runners[robot.id].nodes))
    for team in Team:
        of_team = [store.team for robot, store in stores.items() if robot.team is team]
        if of_team:
            outputs[team.value] = (of_team[0], team_entries(type(of_team[0])))
    return outputs


def _with_tree(robot: RecordedRobot, runner: TreeRunner | None) -> RecordedRobot:
    if runner is None:
        return robot
    depths = {id(runner.root): 0}
    for node in runner.nodes:
        depths.update({id(child): depths[id(node)] + 1 for child in node.children})
    told = [describe(node) for node in runner.nodes]
    levels = [depths[id(node)] for node in runner.nodes]
    paths = node_paths([each.name for each in told], levels)
    nodes = [
        RecordedNode(
            name=each.name,
            path=path,
            type=each.type,
            kind=each.kind,
            depth=depth,
            glyph=each.glyph,
            detail=each.detail,
        )
        for each, path, depth in zip(told, paths, levels, strict=True)
    ]
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
