"""The recording of a branch, in which the logged match is drawn beside it."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Mapping
from math import isfinite
from pathlib import Path
from types import TracebackType
from typing import Self

from robobt.live.replay_html import write_html
from robobt.match.players import Player
from robobt.match.recording import RecordedRobot, Recorder, RecordingHeader
from robobt.what_if.logged import LoggedMatch
from robobt.world.command import RobotCommand
from robobt.world.protocol import ReportedEvent
from robobt.world.sketch import Sketch
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotId

ORIGINAL = "original"
"""The drawing layer that holds the logged match."""


class BranchRecording:
    """Records a branch, and draws where ball and robots were in the log at the same times. A context manager.

    Args:
        path: the file, which ends in ``.robobt.arrows`` or ``.html``.
        title: name of the recording.
        logged: the logged match.
        players: the robots with their trees.
    """

    def __init__(self, path: str | Path, title: str, logged: LoggedMatch, players: Iterable[Player]) -> None:
        self.path, self._logged = Path(path), logged
        players = list(players)
        given = logged.recording.header
        plays = {player.robot: player.runner.root.name for player in players}
        robots = [
            RecordedRobot.model_validate({**_known(robot), "play": plays[robot.id]}) for robot in given.robots
        ]
        header = RecordingHeader(
            scenario=title[:80],
            seed=given.seed,
            period=given.period,
            field=given.field,
            ball_model=given.ball_model,
            robots=tuple(robots),
        )
        self._page = self.path.name.lower().endswith(".html")
        self._folder = tempfile.TemporaryDirectory() if self._page else None
        self._file = self.path if self._folder is None else Path(self._folder.name) / "branch.robobt.arrows"
        self._recorder = Recorder(
            self._file,
            header,
            {player.robot: player.runner for player in players},
            {player.robot: player.store for player in players},
            layers=(ORIGINAL,),
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if kind is None:
                self._recorder.close({"outcome": "branch"})
                if self._page:
                    write_html(self._file, self.path)
            else:
                self._recorder.__exit__(kind, error, trace)
        finally:
            if self._folder is not None:
                self._folder.cleanup()

    def take(
        self,
        truth: Frame,
        observed: Frame,
        commands: Mapping[RobotId, RobotCommand],
        events: Iterable[ReportedEvent],
        tick: int,
    ) -> None:
        """Record one tick of the branch; ``tick`` is the log's at that time."""
        for event in events:
            self._recorder.event(event.kind, event.time, team=event.team, robot=event.robot, text=event.text)
        draw_original(self._recorder.capture.field, self._logged, tick)
        self._recorder.tick(truth, commands, observed)


def draw_original(sketch: Sketch, logged: LoggedMatch, tick: int) -> None:
    """Draw where ball and robots were at a tick of the log."""
    recording = logged.recording
    if tick >= len(recording):
        return
    for robot, row in zip(recording.header.robots, recording.truth.robots[tick].tolist(), strict=True):
        if isfinite(row[0]):
            sketch.circle(ORIGINAL, (row[0], row[1]), ROBOT_RADIUS)
            sketch.text(ORIGINAL, (row[0], row[1]), f"{robot.team.value[0]}{robot.number}")
    x, y = recording.truth.ball[tick, :2].tolist()
    if isfinite(x):
        sketch.circle(ORIGINAL, (x, y), 2.0 * BALL_RADIUS)


def _known(robot: RecordedRobot) -> dict[str, object]:
    return {name: getattr(robot, name) for name in ("team", "number", "radius", "mouth", "limits")}
