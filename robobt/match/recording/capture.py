"""Takes hold of what a match is at each tick, for whoever records or shows it.

That is done while the match waits, so it only takes what will not change later; a
:class:`~robobt.match.recording.encoder.TickEncoder` makes sense of it, for many ticks at once
and in any thread.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from robobt.match.recording.header import Event, RecordedNode, RecordedRobot, RecordingHeader
from robobt.match.recording.stores import Written, stores_of
from robobt.skills.store import Store
from robobt.tree import TreeRunner
from robobt.tree.drawing import describe
from robobt.tree.recording import TreeState, TreeWatches, node_ids
from robobt.world.command import RobotCommand
from robobt.world.game import GameState, Team
from robobt.world.sketch import Shape, Sketch
from robobt.world.state import Frame, RobotId

FIELD = "field"
"""What the world itself draws is under this name, among those of the robots."""

_LOOK_AGAIN = 2.0
"""How often every node of the trees is looked at, for what one may have done to another unseen [s]."""


@dataclass(slots=True)
class CapturedTick:
    """One tick.

    Attributes:
        time: [s].
        truth: what really was, packed from blue's side.
        observed: what the trees were shown, likewise; the same object where that was the truth.
        commands: what the robots were sent.
        states: by their places the trees that may have changed.
        written: the stores that may have changed.
        changes: what else is new, by the names of :class:`~robobt.match.recording.stream.TickChanges`.
    """

    time: float
    truth: bytes
    observed: bytes
    commands: Mapping[RobotId, RobotCommand]
    states: list[tuple[int, TreeState]]
    written: list[Written]
    changes: dict[str, Any]


class Capture:
    """Takes hold of a match tick by tick and gives each to ``takers``.

    Args:
        header: what stays the same. The trees of its robots are taken from ``runners``.
        runners: the runner of each robot whose tree is captured.
        stores: the store of each robot of which it is captured what its skills write.

    Attributes:
        header: the same with the trees.
        robots: those whose trees are captured.
        trees: what looks at their trees.
        stores: what looks at the stores.
        takers: are called with each tick.
        field: what the world itself draws.
        layers: the names of all layers that were drawn to so far, wanted or not.
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
        self._sketches[FIELD] = self.field
        self._drawn: dict[str, list[Shape]] = {}
        self._lookers: dict[object, Container[str]] = {}
        self._looked_at = False
        self.look(None, ())
        self._game: GameState | None = None
        self._touch: RobotId | None = None
        self._events: list[Event] = []
        self._ticks, self._round = 0, max(1, round(_LOOK_AGAIN / header.period))

    def change_tree(self, before: TreeRunner, after: TreeRunner) -> bool:
        """Look at another tree in place of one; False where it has other nodes, which nobody expects."""
        for place, watch in enumerate(self.trees.each):
            if watch.runner is before:
                if _shape(before) != _shape(after):
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
    ) -> None:
        """Take one frame, the commands decided on it and what the trees look like now.

        Robots that the header does not list are left out.

        Args:
            frame: what really was.
            commands: what the robots were sent.
            observed: what the trees were shown where that was something else.
            packed: the frame from blue's side, where it has been packed already.
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
            # They are made anew every tick, so it is enough to keep them.
            commands or {},
            self.trees.look(),
            self.stores.look(),
            changes,
        )
        for take in self.takers:
            take(tick)

    def look(self, who: object, layers: Container[str]) -> None:
        """Let skills draw the layers that one of those who look at this wants, from now on."""
        self._lookers[who] = layers
        wanted = _Layers([each for each in self._lookers.values() if each])
        self._looked_at = bool(wanted.of)
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
        """Take that something happened at ``time`` [s], with the next tick; the words are those of `Event`.

        The referee's commands, the score and a tree that raised need no event of their own:
        :meth:`tick` sees them in the frame and in the runners.
        """
        if team is None and robot is not None:
            team = robot.team
        self._events.append(Event(round(time, 6), kind, team, robot, text))

    def _take_drawn(self) -> dict[str, list[Shape]]:
        """Return what is drawn otherwise than at the tick before, by who drew it."""
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
        """Return the events that no tick has taken yet, which none will then."""
        events, self._events = self._events, []
        return events


@dataclass(slots=True, frozen=True)
class _Layers:
    """The layers that anybody wants."""

    of: list[Container[str]]

    def __contains__(self, layer: object) -> bool:
        return any(layer in wanted for wanted in self.of)


def _shape(runner: TreeRunner) -> list[tuple[str, type]]:
    paths = [path for _, path in node_ids(runner.nodes)]
    return [(path, type(node)) for path, node in zip(paths, runner.nodes, strict=True)]


def _with_tree(robot: RecordedRobot, runner: TreeRunner | None) -> RecordedRobot:
    if runner is None:
        return robot
    nodes = []
    for node, (depth, path) in zip(runner.nodes, node_ids(runner.nodes), strict=True):
        condition = bool(getattr(node, "condition", False))
        nodes.append(RecordedNode(path=path, depth=depth, condition=condition, **asdict(describe(node))))
    return robot.model_copy(update={"tree": tuple(nodes)})
