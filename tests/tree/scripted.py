"""Leaves that follow a script, and a tree that is watched tick by tick."""

from __future__ import annotations

from collections.abc import Sequence

from robobt.tree import Behaviour, Leaf, Status, TreeRunner, preorder

S, F, R, INVALID = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.INVALID
_BY_LETTER = {"S": S, "F": F, "R": R, "-": INVALID}


class Notes:
    """A store that has the time and a diary.

    Attributes:
        time: [s].
        diary: what the leaves have lived through.
    """

    def __init__(self) -> None:
        self.time = 0.0
        self.diary: list[str] = []


class Scripted(Leaf[Notes]):
    """Returns the statuses of its script in turn, the last one for ever: "RRS" runs twice, then succeeds."""

    def __init__(self, name: str, script: str) -> None:
        super().__init__(name)
        self.script = script
        self.ticks = 0

    def on_start(self) -> None:
        self.store.diary.append(f"{self.name} starts")

    def on_running(self) -> Status:
        self.store.diary.append(f"{self.name} ticked")
        letter = self.script[min(self.ticks, len(self.script) - 1)]
        self.ticks += 1
        if letter == "!":
            raise ZeroDivisionError("no")
        return _BY_LETTER[letter]

    def on_done(self, status: Status) -> None:
        self.store.diary.append(f"{self.name} ends {status.value[0]}")

    def on_interrupt(self) -> None:
        self.store.diary.append(f"{self.name} interrupted")


def scripted(**scripts: str) -> list[Behaviour]:
    """Leaves by name and script."""
    return [Scripted(name, script) for name, script in scripts.items()]


class Watched:
    """A tree ticked by a runner.

    Attributes:
        diary: what its leaves lived through at the last tick.
    """

    def __init__(self, root: Behaviour) -> None:
        self.root = root
        self.store = Notes()
        self.runner = TreeRunner(root, self.store, on_error="raise")
        self.diary: list[str] = []

    def tick(self, time: float | None = None) -> str:
        """The first letter of the root's status after a tick, at a time where one is given [s]."""
        if time is not None:
            self.store.time = time
        self.store.diary.clear()
        try:
            return self.runner.tick().value[0]
        finally:
            self.diary = list(self.store.diary)

    def ticks(self, count: int) -> str:
        """So many ticks, a letter each."""
        return "".join(self.tick() for _ in range(count))

    def at(self, times: Sequence[float]) -> str:
        """A tick at each time [s], a letter each."""
        return "".join(self.tick(time) for time in times)

    @property
    def ticked(self) -> str:
        """Names of the leaves that were ticked at the last tick, in their order."""
        return " ".join(entry.split()[0] for entry in self.diary if entry.endswith(" ticked"))

    @property
    def statuses(self) -> str:
        """One letter a node, parents first; - is INVALID."""
        return "".join(
            "-" if node.status is INVALID else node.status.value[0] for node in preorder(self.root)
        )

    def stop(self) -> None:
        """Interrupted from outside."""
        self.store.diary.clear()
        self.runner.stop()
        self.diary = list(self.store.diary)
