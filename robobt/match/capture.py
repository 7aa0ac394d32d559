"""The capture of a match for recording and display, and the file it is written to."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from robobt.match.ends import Outcome
from robobt.match.players import Player
from robobt.match.recording import RecordedRobot, RecordingHeader
from robobt.match.recording.capture import Capture
from robobt.match.scenario.scenario import Scenario
from robobt.signals import uninterrupted
from robobt.tree import TreeRunner
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.limits import DEFAULT_LIMITS, RobotLimits
from robobt.world.protocol import ReportedEvent, World
from robobt.world.state import Frame, RobotId

if TYPE_CHECKING:
    from robobt.match.recording import Recorder

_ENDING = ".robobt.arrows"


class MatchCapture:
    """Captures a match from the first request on, or from the start if the match is recorded.

    Args:
        scenario: the scenario that is played.
        trial: number of the trial.
        seed: seed of the trial.
        world: the world of the match.
        players: the robots.
        record: file to record to, or None.
        layers: drawing layers of skills to record.

    Raises:
        OSError: the recording cannot be written.
    """

    def __init__(
        self,
        scenario: Scenario,
        trial: int,
        seed: int,
        world: World,
        players: Sequence[Player],
        record: Path | None,
        layers: Container[str] = (),
    ) -> None:
        self._scenario, self._trial, self._seed = scenario, trial, seed
        self._world, self._players, self._shows_truth = world, players, world.shows_truth
        self._plays = {robot: setup.play for robot, setup in scenario.robots}
        self._record, self._layers, self._parts = record, layers, 0
        self._capture: Capture | None = None
        self._recorder: Recorder | None = None
        if record is not None:
            try:
                self.get()
            except BaseException:
                # A signal that came while the file was begun.
                self.close(None)
                raise

    def get(self) -> Capture:
        """Return the capture, which takes every tick from now on."""
        if self._capture is None:
            self._capture = self._begin()
        return self._capture

    def change_tree(self, before: TreeRunner, player: Player, play: str) -> None:
        """Capture a robot's new tree.

        A tree with other nodes or parameters starts a new capture and, if the match is recorded, a new file:
        ``match-2`` after ``match``.
        """
        self._plays[player.robot] = play
        if self._capture is not None and not self._capture.change_tree(before, player.runner, play):
            self.close(None)
            self._capture = self._begin()

    def tick(
        self,
        truth: Frame,
        commands: Mapping[RobotId, RobotCommand],
        observed: Frame,
        packed: bytes,
        kicked: Iterable[RobotId],
        outcome: Outcome | None,
    ) -> None:
        """Capture one tick with its kicks and, in a match without a referee, its outcome."""
        if self._capture is None:
            return
        with uninterrupted:
            for robot in kicked:
                self._capture.event("kick", truth.time, robot=robot)
            if outcome is not None and outcome in _END_EVENTS:
                kind, team = _END_EVENTS[outcome]
                self._capture.event(kind, truth.time, team=team)
            self._world.draw(self._capture.field)
            # Observations that may differ from the truth are compared with it when they are written.
            shown = None if self._shows_truth else observed
            world = self._world
            self._capture.tick(truth, commands, shown, packed, world.detections(), world.cameras)

    def note(self, event: ReportedEvent) -> None:
        """Capture an event."""
        if self._capture is not None:
            self._capture.event(event.kind, event.time, team=event.team, robot=event.robot, text=event.text)

    def close(self, outcome: Mapping[str, object] | None) -> None:
        """Finish the recording; without an outcome it stays incomplete."""
        if self._recorder is not None:
            with uninterrupted, self._recorder as recorder:
                if outcome is not None:
                    recorder.close(outcome)
            self._recorder = None

    def _begin(self) -> Capture:
        first = self._world.truth()
        header = RecordingHeader(
            scenario=self._scenario.name,
            trial=self._trial,
            seed=self._seed,
            period=self._scenario.period,
            field=first.field,
            ball_model=first.ball_model,
            played=self._scenario.model_dump(mode="json"),
            cameras_show_truth=self._world.cameras_show_truth,
            robots=tuple(
                RecordedRobot(
                    team=robot.team,
                    number=robot.number,
                    play=self._plays[robot],
                    limits=_limits_of(robot, first),
                )
                for robot, _ in self._scenario.robots
            ),
        )
        capture = Capture(
            header,
            {player.robot: player.runner for player in self._players},
            {player.robot: player.store for player in self._players},
        )
        if self._record is not None:
            self._parts += 1
            path = self._record
            if self._parts > 1:
                path = path.with_name(f"{path.name.removesuffix(_ENDING)}-{self._parts}{_ENDING}")
            with uninterrupted:
                from robobt.match.recording import Recorder

                self._recorder = Recorder(path, capture, layers=self._layers)
        return capture


def _limits_of(robot: RobotId, frame: Frame) -> RobotLimits:
    state = frame.seen_by(robot.team).robot(robot.number)
    return DEFAULT_LIMITS if state is None else state.limits


_END_EVENTS: Mapping[Outcome, tuple[str, Team | None]] = {
    Outcome.GOAL_BLUE: ("goal", Team.BLUE),
    Outcome.GOAL_YELLOW: ("goal", Team.YELLOW),
    Outcome.SAVED: ("save", None),
    Outcome.OUT: ("out", None),
}
