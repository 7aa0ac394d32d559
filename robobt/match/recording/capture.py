"""Captures the state of a match at each tick, for recorders and viewers.

The match waits meanwhile, so the capture only keeps objects that will not change later; a
:class:`~robobt.match.recording.encoder.TickEncoder` encodes them, for many ticks at once and in any thread.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from robobt.match.recording.header import Event, RecordedNode, RecordedRobot, RecordingHeader
from robobt.match.recording.stores import Written, stores_of
from robobt.skills.store import Store
from robobt.tree import TreeRunner
from robobt.tree.drawing import describe
from robobt.tree.recording import TreeState, TreeWatches, node_ids
from robobt.world.command import RobotCommand
from robobt.world.detections import Detections
from robobt.world.game import GameState, Team
from robobt.world.sketch import Shape, Sketch
from robobt.world.state import Frame, RobotId

FIELD_SKETCHES = "field"
"""Name under which the world's own drawing is kept, beside the robots' names."""

_LOOK_AGAIN = 2.0
"""How often every node of the trees is checked, because a node may change another unnoticed [s]."""


@dataclass(slots=True)
class CapturedTick:
    """One tick.

    Attributes:
        time: time of the tick [s].
        truth: the true frame, packed from blue's side.
        observed: the frame that the trees saw, packed from blue's side; the object ``truth`` itself if they
            are equal.
        commands: the commands sent to the robots.
        states: the trees that may have changed, by their places.
        written: the stores that may have changed.
        changes: all other changes, by the names of :class:`~robobt.match.recording.stream.TickChanges`.
        detections: what cameras saw since the tick before, as they did.
    """

    time: float
    truth: bytes
    observed: bytes
    commands: Mapping[RobotId, RobotCommand]
    states: list[tuple[int, TreeState]]
    written: list[Written]
    changes: dict[str, Any]
    detections: Sequence[Detections] = ()


class Capture:
    """Captures a match tick by tick and passes each tick to ``takers``.

    Args:
        header: the constant part of the recording. The trees of its robots are taken from ``runners``.
        runners: the runner of each robot whose tree is captured.
        stores: the store of each robot whose skills' writes are captured.

    Attributes:
        header: the header given, with the trees added.
        robots: the robots whose trees are captured.
        trees: the watchers of their trees.
        stores: the watcher of the stores.
        takers: functions called with each tick.
        field: the world's own drawing.
        layers: names of all layers used so far, captured or not.
    """

    def __init__(
        self,
        header: RecordingHeader,
        runners: Mapping[RobotId, TreeRunner] | None = None,
        stores: Mapping[RobotId, Store] | None = None,
    ) -> None:
        runners = runners or {}
        robots = tuple([_with_tree(robot, runners.get(robot.id)) for robot in header.robots])
        self.header = header.model_copy(update={"robots": robots})
        self.robots = [robot.id for robot in robots if robot.id in runners]
        self.trees = TreeWatches([runners[robot] for robot in self.robots])
        self.stores = stores_of(runners, stores or {})
        self.takers: list[Callable[[CapturedTick], None]] = []
        self.field = Sketch()
        self.layers: set[str] = set()
        self._sketches = {str(robot): store.draw for robot, store in (stores or {}).items()}
        self._sketches[FIELD_SKETCHES] = self.field
        self._drawn: dict[str, list[Shape]] = {}
        self._lookers: dict[object, Container[str]] = {}
        self._looked_at = False
        self.look(None, ())
        self._game: GameState | None = None
        self._touch: RobotId | None = None
        self._cameras: Mapping[int, tuple[float, float, float]] = {}
        self._events: list[Event] = []
        self._ticks, self._round = 0, max(1, round(_LOOK_AGAIN / header.period))

    def change_tree(self, before: TreeRunner, after: TreeRunner, play: str) -> bool:
        """Watch another tree in place of one.

        Args:
            before: the runner of the tree that was watched.
            after: the runner of the new tree.
            play: name of the new tree's play.

        Returns:
            False, and nothing is changed, if the header shows another play, other nodes or parameters.
        """
        for place, watch in enumerate(self.trees.each):
            if watch.runner is before:
                shown = next(robot for robot in self.header.robots if robot.id == self.robots[place])
                if _with_tree(shown.model_copy(update={"play": play}), after) != shown:
                    return False
                self.trees.replace(place, after)
                return True
        return False

    def tick(
        self,
        frame: Frame,
        commands: Mapping[RobotId, RobotCommand] | None = None,
        observed: Frame | None = None,
        packed: bytes | None = None,
        detections: Sequence[Detections] = (),
        cameras: Mapping[int, tuple[float, float, float]] | None = None,
    ) -> None:
        """Take one frame, the commands decided on it and the trees' present state.

        Robots that the header does not list are left out.

        Args:
            frame: the true frame.
            commands: the commands sent to the robots.
            observed: the frame that the trees saw, if it differs.
            packed: the frame packed from blue's side, if it has been packed already.
            detections: what cameras saw since the tick before, as they did.
            cameras: where cameras are, as far as that is known; see :attr:`robobt.world.World.cameras`.
        """
        if self._ticks == self._round:
            self._ticks = 0
            self.trees.look_again()
        self._ticks += 1
        truth = frame.seen_by(Team.BLUE).packed() if packed is None else packed
        changes: dict[str, Any] = {}
        game = frame.game if frame.team is Team.BLUE else frame.game.mirrored()
        if game is not self._game:
            if game != self._game:
                changes["game"] = game
            self._game = game
        if frame.last_touch != self._touch:
            self._touch = changes["touch"] = frame.last_touch
        if cameras and cameras != self._cameras:
            self._cameras = changes["cameras"] = dict(cameras)
        if self._events:
            changes["events"] = self.events_left()
        if self._looked_at or self._drawn:
            drawn = self._take_drawn()
            if drawn:
                changes["drawn"] = drawn
        tick = CapturedTick(
            frame.time,
            truth,
            truth if observed is None else observed.seen_by(Team.BLUE).packed(),
            # They are new objects in every tick, so keeping references is enough.
            commands or {},
            self.trees.look(),
            self.stores.look(),
            changes,
            detections,
        )
        for take in self.takers:
            take(tick)

    def look(self, who: object, layers: Container[str]) -> None:
        """Enable drawing in the layers that a viewer wants, from now on."""
        self._lookers[who] = layers
        looked_at = [each for each in self._lookers.values() if each]
        self._looked_at = bool(looked_at)
        wanted = _Layers(looked_at) if looked_at else ()
        for sketch in self._sketches.values():
            sketch.want(wanted, self.layers)

    def event(
        self,
        kind: str,
        time: float,
        *,
        team: Team | None = None,
        robot: RobotId | None = None,
        text: str = "",
    ) -> None:
        """Add an event at ``time`` [s] to the next tick; the arguments are the fields of `Event`.

        The referee's commands, the score and a tree that raised need no event of their own:
        :meth:`tick` sees them in the frame and in the runners.
        """
        if team is None and robot is not None:
            team = robot.team
        self._events.append(Event(round(time, 6), kind, team, robot, text))

    def _take_drawn(self) -> dict[str, list[Shape]]:
        """Return the drawings that changed since the last tick, by who drew them."""
        drawn = {}
        for name, sketch in self._sketches.items():
            shapes = sketch.take()
            if shapes != self._drawn.get(name, []):
                drawn[name] = shapes
                if shapes:
                    self._drawn[name] = shapes
                else:
                    del self._drawn[name]
        return drawn

    def events_left(self) -> list[Event]:
        """Return, and remove, the events that no tick has taken yet."""
        events, self._events = self._events, []
        return events


@dataclass(slots=True, frozen=True)
class _Layers:
    """The layers that any viewer wants."""

    of: list[Container[str]]

    def __contains__(self, layer: object) -> bool:
        return any(layer in wanted for wanted in self.of)


def _with_tree(robot: RecordedRobot, runner: TreeRunner | None) -> RecordedRobot:
    if runner is None:
        return robot
    nodes = []
    for node, (depth, path) in zip(runner.nodes, node_ids(runner.nodes), strict=True):
        condition = bool(getattr(node, "condition", False))
        nodes.append(RecordedNode(path=path, depth=depth, condition=condition, **asdict(describe(node))))
    return robot.model_copy(update={"tree": tuple(nodes)})
