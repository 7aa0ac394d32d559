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
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntFlag
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

from py_trees.common import Status
from pydantic import BaseModel, ConfigDict, Field, model_validator

from robobt import __version__
from robobt.tree import TreeRunner
from robobt.tree.drawing import NodeKind, describe
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, Team
from robobt.world.state import ROBOT_RADIUS, Frame, RobotId

FORMAT = "robobt-recording"
VERSION = 1

LENGTH_UNIT = 1e-4
"""Metres a unit of the file's lengths."""

_encode = json.JSONEncoder(separators=(",", ":")).encode
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
        self._absent = ["null"] * len(robots)
        self._game: GameState | None = None
        self._touch: RobotId | None = None
        self._lines: list[str] = []
        # A second of lines at a time: few enough writes, and a kill loses no more than that.
        self._most_lines = max(1, round(1.0 / header.period))
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._file: BinaryIO | None = self.path.open("wb")
        self._deflate = zlib.compressobj(wbits=31) if self.path.suffix == ".gz" else None
        start = {"format": FORMAT, "version": VERSION, **self.header.model_dump(mode="json")}
        self._lines.append(_encode(start))
        self._flush()

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
        rows = self._absent.copy()
        for team, robots in ((Team.BLUE, frame.own), (Team.YELLOW, frame.opponents)):
            slots = self._slots[team]
            for robot in robots:
                slot = slots.get(robot.id)
                if slot is None:
                    continue
                flags = 1 if robot.ball_contact else 0
                if commands:
                    command = commands.get(RobotId(team, robot.id))
                    if command is not None:
                        flags += (2 if command.dribbler else 0) + (4 if command.kick_speed else 0)
                try:
                    rows[slot] = (
                        f"[{round(robot.x * 1e4)},{round(robot.y * 1e4)},{round(robot.heading * 1e3)},"
                        f"{round(robot.vx * 1e3)},{round(robot.vy * 1e3)},{round(robot.omega * 1e3)},{flags}]"
                    )
                except (ValueError, OverflowError):
                    # Not a number: the robot is nowhere, which is what null says.
                    continue
        ball = frame.ball
        try:
            place = (
                f"[{round(ball.x * 1e4)},{round(ball.y * 1e4)},{round(ball.vx * 1e3)},{round(ball.vy * 1e3)}]"
            )
        except (ValueError, OverflowError):
            place = "null"
        line = f'{{"t":{round(frame.time, 6)!r},"b":{place},"r":[{",".join(rows)}]'
        if self._trees:
            line += self._tree_changes(frame.time)
        game = frame.game
        if game is not self._game:
            if game != self._game:
                line += f',"g":{_encode(_game_to_json(game))}'
            self._game = game
        if frame.last_touch != self._touch:
            self._touch = frame.last_touch
            line += f',"l":{_encode(self._touch)}'
        lines = self._lines
        lines.append(line + "}")
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
            now = [node.status for node in tree.nodes]
            if now != tree.statuses:
                tree.statuses = now
                letters = "".join([_LETTERS.get(status.name, "-") for status in now])
                statuses.append(f'"{tree.slot}":"{letters}"')
            said = [node.feedback_message for node in tree.nodes]
            if said != tree.feedback:
                changes = {
                    place: str(message)
                    for place, (message, before) in enumerate(zip(said, tree.feedback, strict=True))
                    if message != before
                }
                tree.feedback = said
                feedback.append(f'"{tree.slot}":{_encode(changes)}')
            if tree.runner.error != tree.error:
                tree.error = tree.runner.error
                if tree.error is not None:
                    self.event("error", time, robot=tree.robot, text=tree.error)
        line = f',"s":{{{",".join(statuses)}}}' if statuses else ""
        return f'{line},"f":{{{",".join(feedback)}}}' if feedback else line

    def _flush(self) -> None:
        if self._file is None or not self._lines:
            return
        data = ("\n".join(self._lines) + "\n").encode()
        self._lines.clear()
        if self._deflate is not None:
            data = self._deflate.compress(data) + self._deflate.flush(zlib.Z_SYNC_FLUSH)
        self._file.write(data)
        self._file.flush()

    def _release(self) -> None:
        if self._file is None:
            return
        self._flush()
        if self._deflate is not None:
            self._file.write(self._deflate.flush())
        self._file.close()
        self._file = None


class _TreeWatch:
    """What a tree looked like at the tick before."""

    __slots__ = ("error", "feedback", "nodes", "robot", "runner", "slot", "statuses")

    def __init__(self, slot: int, robot: RobotId, runner: TreeRunner) -> None:
        self.slot, self.robot, self.runner = slot, robot, runner
        self.nodes = runner.nodes
        self.statuses: list[Status] = []
        self.feedback = [""] * len(self.nodes)
        self.error: str | None = None


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
