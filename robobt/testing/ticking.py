"""A tree ticked on frames made by hand, without a simulator."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.skills.store import Store
from robobt.testing.frames import frame, robot
from robobt.tree import TreeRunner, node_path
from robobt.world import Frame, RobotCommand, RobotState


def make_store(seen: Frame | None = None, number: int | None = None, **entries: Any) -> Store:
    """Return a robot's store.

    Args:
        seen: the frame in it; by default a robot is in the middle of the field and the ball 1 m before it.
        number: of the robot of the own team; by default the lowest on the field.
        entries: other entries of :class:`~robobt.skills.Store` by their names, such as ``target=(1.0, 0.0)``.

    Raises:
        ValueError: the robot is not on the field.
    """
    seen = frame(robot(), (1.0, 0.0)) if seen is None else seen
    if number is None and seen.own:
        number = seen.own[0].id
    return Store(seen, _robot(seen, number), **entries)


class Statuses(list[Status]):
    """The statuses of some ticks: a list, which pytest shows with the reasons.

    Attributes:
        said: for each tick the path of the node that decided, and its feedback.
    """

    def __init__(self) -> None:
        super().__init__()
        self.said: list[str] = []

    def differences(self, expected: Sequence[object]) -> list[str]:
        """Return what pytest shows where these are not the statuses that a test expects."""
        lines = [f"{_names(self)} == {_names(expected)}"]
        for tick, (status, said) in enumerate(zip(self, self.said, strict=True)):
            wanted = expected[tick] if tick < len(expected) else None
            if status is not wanted:
                instead = f", not {_name(wanted)}" if wanted is not None else ", a tick too many"
                lines.append(f"tick {tick}: {status.name} ({said}){instead}")
        return lines


def _names(statuses: Iterable[object]) -> str:
    return f"[{', '.join(map(_name, statuses))}]"


def _name(status: object) -> str:
    return status.name if isinstance(status, Status) else repr(status)


class Ticker:
    """Ticks trees on frames, one tick a frame; pytest's fixture ``tick_on`` is one."""

    def __init__(self) -> None:
        self._runners: dict[Behaviour, tuple[TreeRunner, Store]] = {}

    def __call__(self, tree: Behaviour, frames: Iterable[Frame], store: Store | None = None) -> Statuses:
        """Tick a skill or a tree once on each frame and return its statuses.

        A second call with the same tree goes on where the first one ended, unless it is given another store.

        Args:
            tree: the skill or tree.
            frames: one for each tick.
            store: what it works on, with the robot it moves; by default that of the call before, or a new
                one of the first robot of the own team. What was commanded last is in ``store.command``.

        Returns:
            the status of each tick; where a test compares them, pytest shows the nodes' reasons.

        Raises:
            TreeError: a node raised.
            ValueError: the robot is not on the field.
        """
        statuses = Statuses()
        for seen in frames:
            runner, own = self._runner(tree, seen, store)
            own.frame, own.me, own.command = seen, _robot(seen, own.me.id), RobotCommand()
            statuses.append(runner.tick())
            tip = runner.tip()
            statuses.said.append(": ".join(filter(None, (node_path(tip), tip.feedback_message))))
        return statuses

    def close(self) -> None:
        """Shut the trees down."""
        for runner, _ in self._runners.values():
            _end(runner)
        self._runners.clear()

    def _runner(self, tree: Behaviour, seen: Frame, store: Store | None) -> tuple[TreeRunner, Store]:
        kept = self._runners.get(tree)
        if kept is not None:
            if store is None or store is kept[1]:
                return kept
            _end(kept[0])
        own = make_store(seen) if store is None else store
        self._runners[tree] = made = TreeRunner(tree, own, on_error="raise"), own
        return made


def _end(runner: TreeRunner) -> None:
    runner.stop()
    runner.shutdown()


def _robot(seen: Frame, number: int | None) -> RobotState:
    found = None if number is None else seen.robot(number)
    if found is None:
        raise ValueError("there is no robot" if number is None else f"robot {number} is not on the field")
    return found
