"""Leaves for trees like those of BehaviorTree.CPP's tutorials, and what files may name of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

from robobt.tree import Leaf, Registry, Status
from robobt.tree.interop import Entry, Vocabulary

LEAVES: Registry[type[Leaf[Any]]] = Registry("leaf")


@dataclass
class House:
    """The store of the tutorials' robot."""

    time: float = 0.0
    said: list[str] = field(default_factory=list)
    door_open: bool = False
    locked: int = 0
    battery: bool = True
    move_goal: tuple[float, float, float] | None = None
    move_result: str | None = None
    the_answer: str | None = None
    target: tuple[float, float] | None = None
    moving: int = 0


class Tutor(Leaf[House]):
    """A leaf whose parameters may be entries of the store."""

    def value(self, given: Any) -> Any:
        return getattr(self.store, given.entry) if isinstance(given, Entry) else given

    def say(self, text: str) -> Status:
        self.store.said.append(text)
        return self.succeed()


def leaf(cls: type[Tutor]) -> type[Tutor]:
    return LEAVES.register(cls.__name__)(cls)  # type: ignore[return-value]


@leaf
class CheckBattery(Tutor):
    def on_running(self) -> Status:
        self.store.said.append("battery")
        return self.succeed() if self.store.battery else self.fail("empty")


@leaf
class OpenGripper(Tutor):
    def on_running(self) -> Status:
        return self.say("open")


@leaf
class ApproachObject(Tutor):
    def on_running(self) -> Status:
        return self.say("approach")


@leaf
class CloseGripper(Tutor):
    def on_running(self) -> Status:
        return self.say("close")


@leaf
class SaySomething(Tutor):
    def __init__(self, *, message: str | Entry, name: str = "") -> None:
        super().__init__(name)
        self.message = message

    def on_running(self) -> Status:
        return self.say(f"{self.value(self.message)}")


@leaf
class ThinkWhatToSay(Tutor):
    def __init__(self, *, text: Entry, name: str = "") -> None:
        super().__init__(name)
        self.text = text

    def on_running(self) -> Status:
        setattr(self.store, self.text.entry, "forty-two")
        return self.succeed()


@leaf
class Remember(Tutor):
    """Writes a value into an entry."""

    def __init__(
        self, *, entry: Entry, value: str | tuple[float, float, float] | Entry, name: str = ""
    ) -> None:
        super().__init__(name)
        self.entry, self.value_ = entry, value

    def on_running(self) -> Status:
        setattr(self.store, self.entry.entry, self.value(self.value_))
        return self.succeed()


@leaf
class MoveBase(Tutor):
    """Moves for two ticks."""

    def __init__(self, *, goal: tuple[float, float, float] | Entry, name: str = "") -> None:
        super().__init__(name)
        self.goal = goal

    def on_start(self) -> None:
        self.store.moving = 2
        self.store.said.append(f"move to {self.value(self.goal)}")

    def on_running(self) -> Status:
        self.store.moving -= 1
        if self.store.moving > 0:
            return self.run("moving")
        return self.say("arrived")


@leaf
class IsDoorClosed(Tutor):
    def on_running(self) -> Status:
        return self.succeed() if not self.store.door_open else self.fail("open")


@leaf
class OpenDoor(Tutor):
    def on_running(self) -> Status:
        if self.store.locked:
            return self.fail("locked")
        self.store.door_open = True
        return self.say("door opened")


@leaf
class PickLock(Tutor):
    def on_running(self) -> Status:
        self.store.said.append("picking")
        self.store.locked -= 1
        if self.store.locked:
            return self.fail("still locked")
        self.store.door_open = True
        return self.succeed()


@leaf
class SmashDoor(Tutor):
    def on_running(self) -> Status:
        self.store.door_open = True
        return self.say("smashed")


@leaf
class PassThroughDoor(Tutor):
    def on_running(self) -> Status:
        return self.say("through") if self.store.door_open else self.fail("closed")


@leaf
class Aim(Tutor):
    """Reads an entry of a name of its own, as robobt's skills do."""

    reads: ClassVar[tuple[str, ...]] = ("target",)
    writes: ClassVar[tuple[str, ...]] = ("battery",)

    def __init__(
        self, *, target: tuple[float, float] | None = None, speed: float = 1.0, name: str = ""
    ) -> None:
        super().__init__(name)
        self.target, self.speed = target, speed

    def on_running(self) -> Status:
        return self.run("aiming")


def patrol(*, length: float = 2.0, word: str = "hello") -> Leaf[Any]:
    """A play, for sub-trees."""
    return SaySomething(message=f"{word} {length}")


VOCABULARY = Vocabulary(LEAVES, {"patrol": patrol}, store=House)
