"""Random trees of all stock and own nodes, built twice from one description, and their life as a log."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from itertools import combinations
from typing import Any

import py_trees
from py_trees import behaviours, composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import OneShotPolicy, ParallelPolicy, Status

from robobt.tree import Leaf
from robobt.tree.nodes import (
    CommitFor,
    CommittingSelector,
    Cooldown,
    Delay,
    HoldSuccess,
    ParallelCount,
    SequenceWithMemory,
    Switch,
    TickDivider,
    Timeout,
    Wait,
)

STATUSES = [Status.SUCCESS, Status.FAILURE, Status.RUNNING]
Log = list[Any]


class Told(Behaviour):
    """A leaf that follows a script and tells its life."""

    def __init__(self, name: str, script: list[Any], log: Log) -> None:
        super().__init__(name)
        self.script, self.log, self.count = script, log, 0

    def initialise(self) -> None:
        self.log.append((self.name, "initialise", self.status))

    def update(self) -> Status:
        status = self.script[self.count % len(self.script)]
        self.count += 1
        self.feedback_message = f"{self.count}"
        self.log.append((self.name, "update"))
        return status

    def terminate(self, new_status: Status) -> None:
        self.log.append((self.name, "terminate", self.status, new_status))


class Plain(Behaviour):
    """A leaf without a life to tell."""

    def __init__(self, name: str, script: list[Any]) -> None:
        super().__init__(name)
        self.script, self.count = script, 0

    def update(self) -> Status:
        self.count += 1
        return self.script[self.count % len(self.script)]


def _telling_leaf(*methods: str) -> type[Leaf[Any]]:
    """A leaf of the package that defines some of its lifecycle, and tells it."""

    class Scripted(Leaf[Any]):
        def __init__(self, name: str, script: list[Any], log: Log) -> None:
            super().__init__(name)
            self.script, self.log, self.count = script, log, 0

        def on_running(self) -> Status:
            self.count += 1
            self.log.append((self.name, "update"))
            return self.script[self.count % len(self.script)]

    for method in methods:

        def told(self: Any, *args: Any, method: str = method) -> None:
            self.log.append((self.name, method, self.status, *args))

        setattr(Scripted, method, told)
    return Scripted


LEAVES = [
    _telling_leaf(*methods)
    for count in range(4)
    for methods in combinations(("on_start", "on_done", "on_interrupt", "initialise", "terminate"), count)
]


def _telling(base: type) -> type:
    """A user's subclass of a composite or decorator that tells its life."""

    def initialise(self: Any) -> None:
        self.log.append((self.name, "initialise", self.status))
        base.initialise(self)

    def terminate(self: Any, new_status: Status) -> None:
        self.log.append((self.name, "terminate", self.status, new_status))
        base.terminate(self, new_status)

    return type(
        f"Telling{base.__name__}", (base,), {"initialise": initialise, "terminate": terminate, "log": None}
    )


class OwnTick(composites.Sequence):
    """A user's subclass with a tick and a stop of its own."""

    log: Log

    def tick(self) -> Iterator[Behaviour]:
        self.log.append((self.name, "own tick"))
        yield from super().tick()
        self.log.append((self.name, "after its own tick"))

    def stop(self, new_status: Status = Status.INVALID) -> None:
        self.log.append((self.name, "own stop", new_status))
        super().stop(new_status)


class OwnStopLeaf(Told):
    """A leaf with a stop of its own."""

    def stop(self, new_status: Status) -> None:
        self.log.append((self.name, "own stop", new_status))
        super().stop(new_status)


class OwnTickLeaf(Told):
    """A leaf whose tick goes on after it has shown itself."""

    def tick(self) -> Iterator[Behaviour]:
        yield from super().tick()
        self.log.append((self.name, "after its tick", self.status))


class SecondThoughts(Told):
    """A leaf that changes its mind after its tick."""

    def tick(self) -> Iterator[Behaviour]:
        yield from super().tick()
        self.status = Status.SUCCESS


class Unseen(Told):
    """A leaf whose tick never shows it."""

    def tick(self) -> Iterator[Behaviour]:
        self.status = self.update()
        yield from ()


class SeenTwice(Told):
    """A leaf that shows itself before its tick as well."""

    def tick(self) -> Iterator[Behaviour]:
        self.status = Status.RUNNING
        yield self
        yield from super().tick()


class Scheduled(Switch):
    """A switch whose case follows a script."""

    def __init__(self, name: str, script: list[str], cases: dict[str, Behaviour], otherwise: Any) -> None:
        super().__init__(name, cases, otherwise=otherwise)
        self.script, self.count = script, 0

    def case(self) -> str:
        self.count += 1
        return self.script[self.count % len(self.script)]


TELLING = {
    base: _telling(base)
    for base in (
        composites.Sequence,
        composites.Selector,
        composites.Parallel,
        decorators.Inverter,
        decorators.Repeat,
        decorators.OneShot,
        Timeout,
        ParallelCount,
        CommittingSelector,
        SequenceWithMemory,
        Scheduled,
    )
}


def random_tree(rng: random.Random, prefix: str) -> Callable[[Log, str], Behaviour]:
    """A recipe for a tree; every call of it builds a fresh equal one.

    The recipe takes the log to tell into and a word that keeps the blackboard
    keys of the copies apart.
    """
    counter = iter(range(10_000))
    # A bare leaf is no tree: the root has children.
    return _composite(rng, f"{prefix}root", prefix, 4, counter)


def _node(
    rng: random.Random, prefix: str, depth: int, counter: Iterator[int]
) -> Callable[[Log, str], Behaviour]:
    name = f"{prefix}{next(counter)}"
    kind = rng.random()
    if depth == 0 or kind < 0.25:
        return _leaf(rng, name)
    if kind < 0.72:
        return _composite(rng, name, prefix, depth, counter)
    return _decorator(rng, name, prefix, depth, counter)


def _leaf(rng: random.Random, name: str) -> Callable[[Log, str], Behaviour]:
    script: list[Any] = [rng.choice(STATUSES) for _ in range(rng.randint(1, 4))]
    if rng.random() < 0.03:
        script.append("nonsense")
    if rng.random() < 0.03:
        script.append(Status.INVALID)
    kind = rng.randrange(11)
    period = rng.randint(1, 3)
    if kind < 4:
        return lambda log, word: Told(name, script, log)
    if kind == 4:
        own = rng.choice([OwnStopLeaf, OwnTickLeaf, SecondThoughts, Unseen, SeenTwice])
        # What never passes through py_trees' own tick has to be sound by itself.
        own_script = [status for status in script if isinstance(status, Status)]
        return lambda log, word: own(name, own_script, log)
    if kind == 5:
        return lambda log, word: Plain(name, script)
    if kind == 6:
        return lambda log, word: behaviours.Periodic(name, period)
    if kind > 8:
        cls = rng.choice(LEAVES)
        # The package's own leaves raise where they return no status.
        sound = [status for status in script if isinstance(status, Status)]
        return lambda log, word: cls(name, sound, log)
    if kind == 7:
        return lambda log, word: Wait(name, seconds=0.1 * period)
    return lambda log, word: rng_free_stock(name, period)


def rng_free_stock(name: str, which: int) -> Behaviour:
    """A stock leaf without randomness or clock."""
    if which == 1:
        return behaviours.TickCounter(name, 2, Status.SUCCESS)
    if which == 2:
        return behaviours.SuccessEveryN(name, 3)
    return behaviours.StatusQueue(name, [Status.RUNNING, Status.SUCCESS], eventually=Status.FAILURE)


def _composite(
    rng: random.Random, name: str, prefix: str, depth: int, counter: Iterator[int]
) -> Callable[[Log, str], Behaviour]:
    children = [_node(rng, prefix, depth - 1, counter) for _ in range(rng.choice([0, 1, 2, 2, 3, 3, 4]))]
    memory = rng.random() < 0.5
    telling = rng.random() < 0.3
    kind = rng.choice(["sequence", "selector", "parallel"] * 3 + ["own", *_OWN_COMPOSITES])
    chances = [rng.random() for _ in range(10)]
    policy = rng.randrange(5)
    selected = rng.randrange(len(children)) if children else 0

    def build(log: Log, word: str) -> Behaviour:
        made = [child(log, word) for child in children]
        node: Any
        if kind == "own":
            node = OwnTick(name, memory=memory, children=made)
            node.log = log
        elif kind == "parallel":
            policies: list[Any] = [
                ParallelPolicy.SuccessOnAll(synchronise=True),
                ParallelPolicy.SuccessOnAll(synchronise=False),
                ParallelPolicy.SuccessOnOne(),
                ParallelPolicy.SuccessOnSelected(made[selected : selected + 1], synchronise=True),
                ParallelPolicy.SuccessOnSelected(made[selected : selected + 1], synchronise=False),
            ]
            chosen = policies[policy if made else policy % 3]
            node = (TELLING[composites.Parallel] if telling else composites.Parallel)(name, chosen, made)
        elif kind in _OWN_COMPOSITES:
            node = _OWN_COMPOSITES[kind](name, made, chances, telling)
        else:
            base = composites.Sequence if kind == "sequence" else composites.Selector
            node = (TELLING[base] if telling else base)(name, memory, made)
        if telling:
            node.log = log
        return node

    return build


def _told(base: Any, telling: bool) -> Any:
    return TELLING[base] if telling else base


def _parallel_count(name: str, made: list[Behaviour], chances: list[float], telling: bool) -> Behaviour:
    counts = [n for n in range(-len(made), len(made) + 1) if n] or [1]
    succeed, fail = (counts[int(chance * len(counts))] for chance in chances[:2])
    return _told(ParallelCount, telling)(name, success_count=succeed, failure_count=fail, children=made)


def _committing(name: str, made: list[Behaviour], chances: list[float], telling: bool) -> Behaviour:
    children = [
        decorators.Inverter(f"{name}not{i}", CommitFor(f"{name}for{i}", child, seconds=0.5 * chance))
        if chance < 0.2
        else CommitFor(f"{name}for{i}", child, seconds=0.5 * chance)
        if chance < 0.6
        else child
        for i, (child, chance) in enumerate(zip(made, chances, strict=False))
    ]
    return _told(CommittingSelector, telling)(name, children=children)


def _with_place(name: str, made: list[Behaviour], chances: list[float], telling: bool) -> Behaviour:
    return _told(SequenceWithMemory, telling)(name, children=made)


def _switch(name: str, made: list[Behaviour], chances: list[float], telling: bool) -> Behaviour:
    cases = dict(zip("abcd", made, strict=False))
    otherwise = cases.pop("b", None) if chances[0] < 0.5 else None
    script = [case for case, chance in zip("abcdeabcd", chances, strict=False) if chance < 0.4]
    return _told(Scheduled, telling)(name, script or ["a"], cases, otherwise)


_OWN_COMPOSITES = {
    "count": _parallel_count,
    "committing": _committing,
    "place": _with_place,
    "switch": _switch,
}


def _decorator(
    rng: random.Random, name: str, prefix: str, depth: int, counter: Iterator[int]
) -> Callable[[Log, str], Behaviour]:
    child = _node(rng, prefix, depth - 1, counter)
    kind = rng.randrange(26)
    number = rng.randint(1, 3)
    telling = rng.random() < 0.3
    answers = [rng.choice([True, False, *STATUSES]) for _ in range(3)]

    def build(log: Log, word: str) -> Behaviour:
        decorated = child(log, word)
        key = f"/{word}{name}"
        count = iter(range(100_000))
        makers: list[Callable[[], Any]] = [
            lambda: (TELLING[decorators.Inverter] if telling else decorators.Inverter)(name, decorated),
            lambda: (TELLING[decorators.Repeat] if telling else decorators.Repeat)(name, decorated, number),
            lambda: decorators.Retry(name, decorated, number),
            lambda: (TELLING[decorators.OneShot] if telling else decorators.OneShot)(
                name,
                decorated,
                OneShotPolicy.ON_COMPLETION if number == 1 else OneShotPolicy.ON_SUCCESSFUL_COMPLETION,
            ),
            lambda: decorators.EternalGuard(name, decorated, lambda: answers[next(count) % len(answers)]),
            lambda: decorators.Timeout(name, decorated, duration=-1.0 if number == 1 else 100.0),
            lambda: decorators.Condition(name, decorated, STATUSES[number - 1]),
            lambda: decorators.Count(name, decorated),
            lambda: decorators.StatusToBlackboard(name, decorated, key),
            lambda: decorators.PassThrough(name, decorated),
            lambda: decorators.RunningIsFailure(name, decorated),
            lambda: decorators.RunningIsSuccess(name, decorated),
            lambda: decorators.FailureIsSuccess(name, decorated),
            lambda: decorators.FailureIsRunning(name, decorated),
            lambda: decorators.SuccessIsFailure(name, decorated),
            lambda: decorators.SuccessIsRunning(name, decorated),
            lambda: _for_each(name, decorated, key, number),
            lambda: decorators.Inverter(name, decorated),
            lambda: Cooldown(name, decorated, seconds=0.1 * number, after=_ENDS[number - 1]),
            lambda: HoldSuccess(name, decorated, seconds=0.15 * number),
            lambda: TickDivider(name, decorated, every=number),
            lambda: TickDivider(name, decorated, seconds=0.15 * number),
            lambda: _told(Timeout, telling)(name, decorated, seconds=0.1 * number),
            lambda: Delay(name, decorated, seconds=0.1 * number),
            lambda: Delay(name, decorated, seconds=0.0),
            lambda: Cooldown(name, decorated, seconds=0.3),
        ]
        node = makers[kind]()
        if telling and type(node) in TELLING.values():
            node.log = log
        return node

    return build


_ENDS: list[Any] = ["either", "success", "failure"]


def _for_each(name: str, decorated: Behaviour, key: str, number: int) -> Behaviour:
    writer = py_trees.blackboard.Client(name=key)
    writer.register_key(f"{key}_source", py_trees.common.Access.WRITE)
    writer.set(f"{key}_source", list(range(number)))
    return decorators.ForEach(name, decorated, f"{key}_source", f"{key}_target")
