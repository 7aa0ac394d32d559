"""What a tree did from one tick to the next: statuses, the path that was ticked, what nodes said.

A recorder that asks every node at every tick costs a tenth of a match. A
:class:`TreeWatch` asks only nodes that can have a status, in code made for the
tree, and works out what changed only where something did.
"""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence as SequenceOf
from dataclasses import dataclass
from functools import lru_cache
from itertools import compress, count
from operator import is_not
from types import CodeType, FunctionType
from typing import Any, TypeAlias

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Parallel, Selector, Sequence

from robobt.tree.engine import stops_children, ticked_children
from robobt.tree.runner import TreeRunner, text_of

_LETTERS = {"SUCCESS": "S", "FAILURE": "F", "RUNNING": "R", "INVALID": "-"}
_SILENT = (Selector, Sequence, Parallel)
_Seen: TypeAlias = tuple[Any, ...] | None


@dataclass(slots=True, frozen=True)
class Look:
    """What a tree looked like after a tick or a stop, as :meth:`TreeWatch.tell` understands it."""

    seen: _Seen
    error: str | None
    failed: int | None
    ticked: bool
    marked: tuple[int, ...]
    words: tuple[tuple[int, object], ...] = ()
    """What nodes said, by their place, when nothing else is new; the rest does not count then."""


@dataclass(slots=True, frozen=True)
class Change:
    """What is new at one tick.

    Attributes:
        letters: one a node in the order of ``runner.nodes``: S, F, R of a node ticked by the
            last tick, s, f, r where it kept the status of an earlier one, - without a status;
            None when they are as they were.
        said: what nodes said anew, by their place.
        error: what the runner's tree raised, when that is new.
    """

    letters: str | None
    said: dict[int, str]
    error: str | None


class TreeWatch:
    """What has changed in a runner's tree since it was looked at last.

    It looks at the tree after every tick and stop, while that is still at hand, and hands
    over what it saw only when that is new. What that means, :meth:`tell` can say later, in
    the same order. What a node says counts while it has a status.

    Args:
        runner: whose tree.
        notice: called with every look that is new.

    Attributes:
        runner: whose tree.
        ticks: how often it had been ticked when a record was complete the last time.
        usual: whether it was ticked when it was looked at last.
    """

    def __init__(self, runner: TreeRunner, notice: Callable[[Look], None]) -> None:
        nodes = runner.nodes
        self.runner = runner
        self._size = len(nodes)
        self._places = places = {id(node): place for place, node in enumerate(nodes)}
        self._parents = [-1 if node is runner.root else places[id(node.parent)] for node in nodes]
        self._reach = [ticked_children(node) for node in nodes]
        unsure = [node for i, node in enumerate(nodes[1:], 1) if self._reach[self._parents[i]] == "some"]
        self._layout, ask = _Question(nodes, runner).make()
        self._ask = ask
        self._notice = notice
        self.ticks = runner.ticks
        # As it was looked at last.
        self._seen: tuple[Any, ...] = ()
        self.usual = False
        self._marked: list[Behaviour] = []
        self._marks = runner.mark(unsure, self._look)
        # As it was told last.
        self._told: _Seen = None
        self._error: str | None = None
        self._failed: int | None = None
        self._statuses = ["-"] * len(nodes)
        self._said = [""] * len(nodes)
        self._letters = "-" * len(nodes)
        self._path: tuple[bool, tuple[int, ...]] = (False, ())
        self._look()

    def tell(self, look: Look) -> Change | None:
        """What is new in this look since the one told before."""
        said: dict[int, str] = {}
        if look.words:
            for place, message in look.words:
                if self._statuses[place] != "-":
                    self._hear(place, message, said)
            self._told = None
            return Change(None, said, None) if said else None
        turned = False
        if self._failed is not None:
            self._statuses[self._failed] = "-"
            self._told, turned = None, True
        turned = self._compare(look.seen, self._told, self._layout, said) or turned
        self._told, self._failed = look.seen, look.failed
        if look.failed is not None and look.error is not None:
            # The one node that has a status although those above it have none.
            self._statuses[look.failed], turned = "F", True
            self._hear(look.failed, look.error.partition(": ")[2], said)
        path = (look.ticked, look.marked)
        letters = None
        if turned or path != self._path:
            self._path = path
            letters = self._tell_ticked(look)
            if letters == self._letters:
                letters = None
            else:
                self._letters = letters
        error = look.error if look.error != self._error else None
        self._error = look.error
        return None if letters is error is None and not said else Change(letters, said, error)

    def settle(self) -> None:
        """A record is complete: notice whether the tree was ticked for it.

        Nodes that have a status have kept it where the tree was not.
        """
        if (self.runner.ticks != self.ticks) is not self.usual:
            self._look()
        self.ticks = self.runner.ticks

    def check(self) -> None:
        """Look again at the next tick, for what a node may have done to another one unseen."""
        self._marks.changed = True

    def _place_of_failed(self) -> int | None:
        failed = self.runner.failed
        return None if failed is None or failed.status is Status.INVALID else self._places.get(id(failed))

    def _look(self) -> None:
        ticks = self.runner.ticks - self.ticks
        ticked, marks = ticks > 0, self._marks
        # Of several ticks for one record only the first can do with what is new since the last record.
        if not marks.changed and ticks == 1 and self.usual:
            self._seen = ()
            known = self._places
            words = [(known[id(node)], node.feedback_message) for node in marks.words if id(node) in known]
            if words:
                self._notice(Look(None, None, None, True, (), tuple(words)))
            return
        now, marked = self._ask(), marks.seen
        if now == self._seen and ticked is self.usual and marked == self._marked:
            return
        self._seen, self.usual, self._marked = now, ticked, marked.copy()
        places = tuple([self._places.get(id(node), -1) for node in marked]) if ticked else ()
        self._notice(Look(now[:-1], now[-1], self._place_of_failed(), ticked, places))

    def _compare(self, seen: _Seen, before: _Seen, layout: _Layout, said: dict[int, str]) -> bool:
        """Bring statuses and what was said up to date; whether a status changed."""
        statuses, items = self._statuses, layout.items
        if seen is None:
            none = ["-"] * (layout.end - layout.start)
            turned = statuses[layout.start : layout.end] != none
            statuses[layout.start : layout.end] = none
            return turned
        turned = False
        # Most are as they were, which is found out here without a step of the interpreter for each.
        for index in range(len(seen)) if before is None else compress(count(), map(is_not, seen, before)):
            item, old = seen[index], None if before is None else before[index]
            inside = items[index]
            if inside.__class__ is _Layout:
                if item != old or before is None:
                    known = old if old.__class__ is tuple else None
                    turned = self._compare(item, known, inside, said) or turned
            elif inside < 0:
                if statuses[~inside] != "-":
                    self._hear(~inside, item, said)
            elif _LETTERS[item._value_] != statuses[inside]:
                turned = True
                statuses[inside] = letter = _LETTERS[item._value_]
                if letter != "-" and index + 1 < len(items) and items[index + 1] == ~inside:
                    # The same words as before may not have counted then.
                    self._hear(inside, seen[index + 1], said)
        return turned

    def _hear(self, place: int, message: object, said: dict[int, str]) -> None:
        text = message if isinstance(message, str) else text_of(message)
        if text != self._said[place]:
            self._said[place] = said[place] = text

    def _tell_ticked(self, look: Look) -> str:
        """The statuses' letters, small where a node was not ticked."""
        statuses = self._statuses
        if not look.ticked:
            return "".join(statuses).lower()
        marked = set(look.marked)
        parents, reach = self._parents, self._reach
        letters = statuses.copy()
        # Nodes that were not ticked, and reactive selectors whose later children were not.
        idle: set[int] = set()
        decided: set[int] = set()
        for place, letter in enumerate(statuses):
            if letter == "-" or not place:
                continue
            parent = parents[place]
            how = reach[parent]
            if how == "some":
                ticked = place in marked
            else:
                ticked = parent not in idle and parent not in decided
                if letter != "F" and how == "first":
                    decided.add(parent)
            if not ticked:
                idle.add(place)
                letters[place] = letter.lower()
        return "".join(letters)


class _Layout:
    """Where the items of what was seen belong.

    Attributes:
        items: for each the place of the node whose status it is, ~place where it is what
            the node said, a layout where it is a tuple.
        start, end: the places that the whole covers.
    """

    __slots__ = ("end", "items", "start")

    def __init__(self, start: int, end: int) -> None:
        self.start, self.end = start, end
        self.items: list[Any] = []


class _Question:
    """Makes the function that asks a tree's nodes for their statuses and words."""

    def __init__(self, nodes: SequenceOf[Behaviour], runner: TreeRunner) -> None:
        self.nodes, self.runner = nodes, runner
        places = {id(node): place for place, node in enumerate(nodes)}
        self.children = [[places[id(child)] for child in node.children] for node in nodes]
        self.ends = [0] * len(nodes)
        # Whether nothing below a node has a status unless the node has one.
        self.whole = [False] * len(nodes)
        for place in range(len(nodes) - 1, -1, -1):
            below = self.children[place]
            self.ends[place] = self.ends[below[-1]] if below else place + 1
            self.whole[place] = stops_children(nodes[place]) and all(self.whole[child] for child in below)

    def make(self) -> tuple[_Layout, Callable[[], tuple[Any, ...]]]:
        """The function, whose last answer is the runner's error, and where the other answers belong."""
        layout = _Layout(0, len(self.nodes))
        text = ",".join(self._ask(0, layout, 0))
        # Trees of the same shape share what is compiled; the names in it give way to the nodes.
        code = _code(f"lambda:({text},'runner'.error)")
        named: dict[object, object] = {"runner": self.runner}
        named |= {f"n{place}": node for place, node in enumerate(self.nodes)}
        constants = tuple([named.get(item, item) for item in code.co_consts])
        ask = FunctionType(code.replace(co_consts=constants), {"I": Status.INVALID, "S": Status.SUCCESS})
        return layout, ask

    def _ask(self, place: int, layout: _Layout, depth: int) -> list[str]:
        """The expressions for a node and what is below it; ``layout`` is told where they belong."""
        # With a place in the code for each node, the interpreter remembers at each where in
        # that class the attribute is found; in a loop over nodes of many classes it has to search
        # every time, which takes three times as long.
        node, name = self.nodes[place], f"'n{place}'"
        below = self.children[place]
        worth = self.ends[place] - place >= _WORTH_SKIPPING
        skip = worth and bool(below) and self.whole[place] and depth < _DEEPEST
        if skip:
            inside = _Layout(place, self.ends[place])
            layout.items.append(inside)
            layout, depth = inside, depth + 1
        layout.items.append(place)
        parts = [f"{name}.status"]
        if type(node) not in _SILENT:
            layout.items.append(~place)
            parts.append(f"{name}.feedback_message")
        early = isinstance(node, Sequence) and ticked_children(node) == "all"
        parts += self._ask_children(below, layout, depth, early)
        return [f"(({','.join(parts)},) if {name}.status is not I else None)"] if skip else parts

    def _ask_children(self, below: list[int], layout: _Layout, depth: int, early: bool) -> list[str]:
        parts: list[str] = []
        for index, place in enumerate(below):
            parts += self._ask(place, layout, depth)
            rest = below[index + 1 :]
            # In a reactive sequence nothing after the first child that has not succeeded has a status.
            worth = rest and self.ends[rest[-1]] - rest[0] >= _WORTH_SKIPPING
            if early and worth and depth < _DEEPEST and all(self.whole[other] for other in rest):
                inside = _Layout(rest[0], self.ends[rest[-1]])
                layout.items.append(inside)
                others = self._ask_children(rest, inside, depth + 1, early)
                return [*parts, f"(({','.join(others)},) if 'n{place}'.status is S else None)"]
        return parts


_WORTH_SKIPPING = 4
"""Nodes that are asked at once rather than upon a condition."""

_DEEPEST = 40
"""Conditions within conditions; Python reads no more than 200 brackets within each other."""


@lru_cache(maxsize=256)
def _code(source: str) -> CodeType:
    made: FunctionType = eval(source)
    return made.__code__


def node_paths(names: SequenceOf[str], depths: SequenceOf[int]) -> list[str]:
    """An id for each node of a tree: the names from the root down to it, joined by slashes.

    No two are the same: of two that would be, the later one ends in ``#2``, and so on.

    Args:
        names, depths: of all nodes, parents before children; the root has depth 0.
    """
    paths: list[str] = []
    above: list[str] = []
    taken: set[str] = set()
    for name, depth in zip(names, depths, strict=True):
        del above[depth:]
        wanted = path = "/".join([*above[-1:], name])
        count = 1
        while path in taken:
            count += 1
            path = f"{wanted}#{count}"
        taken.add(path)
        above.append(path)
        paths.append(path)
    return paths
