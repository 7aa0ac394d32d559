"""What a tree does from tick to tick: statuses, the nodes that were ticked, their feedback.

Calling a method of every node at every tick would cost a tenth of a match, so a
:class:`TreeWatch` compiles one expression for the tree that reads only nodes that can
have a status, and works out what changed later, for many ticks at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import compress, count
from operator import is_not, ne, or_
from types import CodeType, FunctionType

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.engine import stops_children, ticked_children
from robobt.tree.runner import TreeRunner, text_of

_LETTERS = {"SUCCESS": "S", "FAILURE": "F", "RUNNING": "R", "INVALID": "-"}
_SILENT = (composites.Selector, composites.Sequence, composites.Parallel)
"""Classes whose own nodes give no feedback."""


@dataclass(slots=True, frozen=True)
class TreeState:
    """A tree as it was found changed.

    Attributes:
        statuses, feedback: of every node, in the order of ``runner.nodes``.
        ticked: whether the tree was ticked since it was looked at before.
        reached: nodes that the last tick reached, every one among them of which the statuses
            do not tell.
        error: what the last tick raised.
    """

    statuses: tuple[Status, ...]
    feedback: tuple[object, ...]
    ticked: bool
    reached: frozenset[int]
    error: str | None


@dataclass(slots=True, frozen=True)
class TreeChange:
    """What is new in a state of a tree.

    Attributes:
        statuses: one letter a node in the order of ``runner.nodes``: S, F, R of a node that was
            ticked, s, f, r where it kept the status of an earlier tick, - without a status;
            None when they are as they were.
        feedback: new feedback of nodes that have a status, by their place.
        error: what the tree raised, when that is new.
    """

    statuses: str | None
    feedback: dict[int, str]
    error: str | None


class TreeWatch:
    """Finds out what has changed in a runner's tree since it was looked at last.

    Looking is quick and can be done at every tick; :meth:`change` makes sense of what was
    found, at any later time but in the same order.

    Args:
        runner: whose tree.
    """

    def __init__(self, runner: TreeRunner) -> None:
        nodes = runner.nodes
        places = {id(node): place for place, node in enumerate(nodes)}
        self._runner = runner
        self._places = places
        self._parents = [-1 if node is runner.root else places[id(node.parent)] for node in nodes]
        self._reach = [ticked_children(node) for node in nodes]
        doubtful = [node for i, node in enumerate(nodes[1:], 1) if self._reach[self._parents[i]] == "some"]
        self._reached: list[Behaviour] = runner.note_ticked(doubtful) if doubtful else []
        statuses = "".join([f"'{place}'.status," for place in range(len(nodes))])
        self._signature = make_reader(f"({_Signature(nodes, places).of(0)})", nodes)
        self._statuses = make_reader(f"({statuses})", nodes)
        self._feedback = make_reader(f"({statuses.replace('status', 'feedback_message')})", nodes)
        self._ticks = runner.ticks
        self._found: tuple[object, ...] = ()
        # As of the last change that was told.
        self._before = TreeState((Status.INVALID,) * len(nodes), ("",) * len(nodes), False, frozenset(), None)
        self._letters = "-" * len(nodes)
        self._texts = [""] * len(nodes)

    def look(self) -> TreeState | None:
        """Return the tree's state if it is another one than at the last look."""
        runner = self._runner
        ticked = runner.ticks != self._ticks
        self._ticks = runner.ticks
        found = (ticked, runner.error, self._reached, self._signature())
        if found == self._found:
            return None
        self._found = (ticked, runner.error, self._reached.copy(), found[3])
        reached = frozenset([self._places.get(id(node), -1) for node in self._reached])
        return TreeState(self._statuses(), self._feedback(), ticked, reached, runner.error)

    def change(self, state: TreeState) -> TreeChange | None:
        """Return what is new in ``state`` since the state before, None if that is nothing."""
        before, self._before = self._before, state
        letters = self._letters
        feedback = map(is_not, state.feedback, before.feedback)
        if (state.statuses, state.ticked, state.reached) != (before.statuses, before.ticked, before.reached):
            letters = self._letters_of(state)
            # The feedback of a node without a status did not count before.
            feedback = map(or_, feedback, map(ne, letters, self._letters))
        texts = {}
        for place in compress(count(), feedback):
            message = state.feedback[place]
            text = message if isinstance(message, str) else text_of(message)
            if letters[place] != "-" and text != self._texts[place]:
                self._texts[place] = texts[place] = text
        changed = None if letters == self._letters else letters
        error = None if state.error == before.error else state.error
        self._letters = letters
        return TreeChange(changed, texts, error) if changed or texts or error else None

    def _letters_of(self, state: TreeState) -> str:
        letters = [_LETTERS[status._value_] for status in state.statuses]
        if not state.ticked:
            return "".join(letters).lower()
        # Nodes that were not ticked, and selectors of which a child before the last one decided.
        idle: set[int] = set()
        decided: set[int] = set()
        for place, letter in enumerate(letters):
            if letter == "-" or not place:
                continue
            parent = self._parents[place]
            reach = self._reach[parent]
            if reach == "some":
                ticked = place in state.reached
            else:
                ticked = parent not in idle and parent not in decided
                if letter != "F" and reach == "first":
                    decided.add(parent)
            if not ticked:
                idle.add(place)
                letters[place] = letter.lower()
        return "".join(letters)


class _Signature:
    """Writes the expression whose value is another one whenever a tree has changed.

    It reads the status of every node and the feedback of most. Nodes below a node without
    a status have none either, and are passed over; so are the children of a reactive
    sequence after the first that has not succeeded.
    """

    def __init__(self, nodes: Sequence[Behaviour], places: dict[int, int]) -> None:
        self._nodes = nodes
        self._children = [[places[id(child)] for child in node.children] for node in nodes]
        self._sizes = [1] * len(nodes)
        # Whether nothing below a node has a status unless the node has one.
        self._whole = [False] * len(nodes)
        for place in range(len(nodes) - 1, -1, -1):
            below = self._children[place]
            self._sizes[place] += sum([self._sizes[child] for child in below])
            self._whole[place] = stops_children(nodes[place]) and all(self._whole[each] for each in below)

    def of(self, place: int, depth: int = 0) -> str:
        """Return the items that read a node and what is below it, each with a comma behind it."""
        node, below = self._nodes[place], self._children[place]
        skip = bool(below) and self._worth_skipping([place], depth)
        items = f"'{place}'.status,"
        if type(node) not in _SILENT:
            items += f"'{place}'.feedback_message,"
        items += self._of_children(
            below, isinstance(node, composites.Sequence) and not node.memory, depth + skip
        )
        return f"({items})if'{place}'.status is not I else None," if skip else items

    def _of_children(self, below: list[int], reactive: bool, depth: int) -> str:
        items = ""
        for i, place in enumerate(below):
            items += self.of(place, depth)
            rest = below[i + 1 :]
            if reactive and rest and self._worth_skipping(rest, depth):
                others = self._of_children(rest, True, depth + 1)
                return f"{items}({others})if'{place}'.status is S else None,"
        return items

    def _worth_skipping(self, places: list[int], depth: int) -> bool:
        # Python reads no more than 200 brackets within each other.
        enough = sum([self._sizes[place] for place in places]) >= 4 and depth < 40
        return enough and all(self._whole[place] for place in places)


def make_reader(expression: str, objects: Sequence[object]) -> FunctionType:
    """Make the function that reads attributes of objects.

    Args:
        expression: what it returns; an object is written as its place in quotes, and I and S
            are the statuses INVALID and SUCCESS.
        objects: by their places.
    """
    # With a place in the code for each object, the interpreter remembers at each where in that class
    # the attribute is found; in a loop over objects of many classes it has to search every time,
    # which takes three times as long. Trees of one shape share what is compiled.
    code = _compiled(f"lambda:{expression}")
    named: dict[object, object] = {str(place): each for place, each in enumerate(objects)}
    constants = tuple([named.get(constant, constant) for constant in code.co_consts])
    return FunctionType(code.replace(co_consts=constants), {"I": Status.INVALID, "S": Status.SUCCESS})


@lru_cache(maxsize=256)
def _compiled(source: str) -> CodeType:
    made: FunctionType = eval(source)
    return made.__code__


def node_ids(nodes: Sequence[Behaviour]) -> list[tuple[int, str]]:
    """Return depth and id of each node of a tree, parents before children; the root has depth 0.

    The id is the names from the root down to the node, joined by slashes. No two are the
    same: of two that would be, the later one ends in ``#2``, and so on.

    Args:
        nodes: all nodes of the tree.
    """
    found: dict[int, tuple[int, str]] = {}
    taken: set[str] = set()
    for node in nodes:
        depth, above = found[id(node.parent)] if found else (-1, "")
        name = path = f"{above}/{node.name}" if found else str(node.name)
        number = 1
        while path in taken:
            number += 1
            path = f"{name}#{number}"
        taken.add(path)
        found[id(node)] = (depth + 1, path)
    return list(found.values())
