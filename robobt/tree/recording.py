"""Records a tree from tick to tick: statuses, ticked nodes and feedback.

Checking every node in every tick would cost a tenth of a match. A :class:`TreeWatch` checks only when the
engine's :class:`~robobt.tree.engine.Marks` report a possible change; :class:`TreeChanges` computes the
changes later, for many ticks at once.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import compress, count
from operator import eq, is_not
from types import CodeType, FunctionType

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.config.errors import text_of
from robobt.tree.engine import Marks, ticked_children
from robobt.tree.runner import TreeRunner, status_letter
from robobt.tree.walk import name_of

_NODES_WITHOUT_FEEDBACK = (composites.Selector, composites.Sequence, composites.Parallel)
"""Classes whose own nodes give no feedback."""


@dataclass(slots=True)
class TreeState:
    """The state of a changed tree.

    Attributes:
        statuses: of every node, in the order of ``runner.nodes``; None when only feedback is new,
            in which case ``ticked``, ``reached`` and ``error`` do not count.
        speakers: places of nodes that may have given new feedback.
        feedback: theirs.
        ticked: whether the tree was ticked since it was looked at before.
        reached: nodes that the last tick reached, every one among them of which the statuses
            do not tell.
        error: what the last tick raised.
        watch: who found it.
    """

    statuses: tuple[Status, ...] | None
    speakers: Sequence[int]
    feedback: Sequence[object]
    ticked: bool = True
    reached: Sequence[Behaviour] = ()
    error: str | None = None
    watch: TreeWatch | None = None


@dataclass(slots=True)
class TreeChange:
    """The changes in a state of a tree.

    Attributes:
        statuses: one letter a node in the order of ``runner.nodes``: S, F, R of a node that was
            ticked, s, f, r where it kept the status of an earlier tick, - without a status;
            None when they are as they were.
        feedback: new feedback of nodes that have a status, by their place.
        error: the exception of the tree, if it is new.
    """

    statuses: str | None
    feedback: dict[int, str]
    error: str | None


class TreeWatches:
    """Looks at the trees of some runners for what may have changed, quickly enough to be done at every tick.

    Even to ask every tree would take long, for what it answers from is in no cache any more: those
    of which there is something new say so.

    Attributes:
        each: what looks at each tree. A runner has one at a time.
    """

    def __init__(self, runners: Sequence[TreeRunner]) -> None:
        self._news: list[Marks] = []
        self.each = [TreeWatch(runner, self._news) for runner in runners]
        self._begin()

    def replace(self, place: int, runner: TreeRunner) -> None:
        """Watch another tree with equal nodes in place of one."""
        self.each[place] = TreeWatch(runner, self._news)
        self._begin()

    def _begin(self) -> None:
        self._places = {watch.marks: place for place, watch in enumerate(self.each)}
        runners = [watch.runner for watch in self.each]
        self._read = make_reader(
            "(" + "".join([f"'{place}'.ticks," for place in range(len(runners))]) + ")", runners
        )
        # As of the last look: how often each was ticked, and whether all of them were since the look before.
        self._ticks: tuple[int, ...] = self._read()
        self._usual = False

    def look(self) -> list[tuple[int, TreeState]]:
        """Return the trees' states that may have changed since the last check, by place."""
        before, self._ticks = self._ticks, self._read()
        usual, self._usual = self._usual, not any(map(eq, before, self._ticks))
        places: Iterable[int]
        if not (usual and self._usual):
            places = range(len(self.each))
        elif self._news:
            places = sorted({self._places[marks] for marks in self._news if marks in self._places})
        else:
            return []
        self._news.clear()
        states = [(place, self.each[place].look(before[place] != self._ticks[place])) for place in places]
        return [(place, state) for place, state in states if state is not None]

    def look_again(self) -> None:
        """Check every node next time, because a node may have changed another unnoticed."""
        for watch in self.each:
            watch.marks.change()


class TreeWatch:
    """Looks at one runner's tree for what may have changed.

    Attributes:
        runner: ticks it.
        marks: what is noted of its ticks.
        places: of each node, by its id().
        parents: of each node the place of its parent.
        reach: of each node which children its tick reaches.
    """

    def __init__(self, runner: TreeRunner, news: list[Marks]) -> None:
        nodes = runner.nodes
        places = {id(node): place for place, node in enumerate(nodes)}
        self.runner = runner
        self.places = places
        self.parents = [-1 if node is runner.root else places[id(node.parent)] for node in nodes]
        self.reach = [ticked_children(node) for node in nodes]
        doubtful = [node for i, node in enumerate(nodes[1:], 1) if self.reach[self.parents[i]] == "some"]
        self.marks = runner.mark(doubtful, news)
        self._speakers = [
            place for place, node in enumerate(nodes) if type(node) not in _NODES_WITHOUT_FEEDBACK
        ]
        self._statuses = _reader(range(len(nodes)), "status", nodes)
        self._feedback = _reader(self._speakers, "feedback_message", nodes)
        # As of the last look.
        self._ticked = False

    def look(self, ticked: bool) -> TreeState | None:
        """Return the tree's state if it may be another one than at the last look.

        ``ticked`` is whether it was ticked since then. Where that is as it was, and there is nothing new
        in the marks, it need not be asked.
        """
        runner, marks = self.runner, self.marks
        usual, self._ticked = self._ticked, ticked
        if ticked and usual and not marks.changed:
            if not marks.feedback:
                return None
            known = [node for node in marks.feedback if id(node) in self.places]
            marks.feedback.clear()
            places = [self.places[id(node)] for node in known]
            return TreeState(None, places, [node.feedback_message for node in known], watch=self)
        if not (ticked or usual or marks.changed):
            return None
        marks.changed = False
        if runner.error is not None or runner.root.status is Status.INVALID:
            # What becomes of a tree that was brought to rest is not what its leaves did before.
            marks.change()
        marks.feedback.clear()
        reached = marks.seen if ticked else ()
        speakers, feedback = self._speakers, self._feedback()
        return TreeState(self._statuses(), speakers, feedback, ticked, reached, runner.error, self)


class TreeChanges:
    """Makes sense of what a :class:`TreeWatch` finds, at any later time but in the same order.

    Another watch, of a tree of the same nodes, may take its place on the way.
    """

    def __init__(self, watch: TreeWatch) -> None:
        count = len(watch.parents)
        # As of the last change that was reported.
        self._before = TreeState((Status.INVALID,) * count, (), (), False)
        self._raw = ["-"] * count
        self._letters = "-" * count
        self._messages: list[object] = [None] * count
        self._texts = [""] * count

    def change(self, state: TreeState) -> TreeChange | None:
        """Return what is new in ``state`` since the state before, None if that is nothing."""
        letters, error = self._letters, None
        if state.statuses is not None:
            before, self._before = self._before, state
            for place in compress(count(), map(is_not, state.statuses, before.statuses or ())):
                self._raw[place] = status_letter(state.statuses[place])
                # The feedback of a node without a status did not count before.
                self._messages[place] = None
            letters = self._with_ticked(state)
            error = None if state.error == before.error else state.error
        texts = {}
        for place, message in zip(state.speakers, state.feedback, strict=True):
            if message is self._messages[place]:
                continue
            self._messages[place] = message
            text = message if isinstance(message, str) else text_of(message)
            if letters[place] != "-" and text != self._texts[place]:
                self._texts[place] = texts[place] = text
        changed = None if letters == self._letters else letters
        self._letters = letters
        return TreeChange(changed, texts, error) if changed or texts or error else None

    def _with_ticked(self, state: TreeState) -> str:
        """Return the statuses' letters, small where a node was not ticked."""
        if not state.ticked:
            return "".join(self._raw).lower()
        letters, watch = self._raw.copy(), state.watch
        assert watch is not None
        reached = {watch.places.get(id(node), -1) for node in state.reached}
        # Nodes that were not ticked, and selectors of which a child before the last one decided.
        idle: set[int] = set()
        decided: set[int] = set()
        for place, letter in enumerate(self._raw):
            if letter == "-" or not place:
                continue
            parent = watch.parents[place]
            reach = watch.reach[parent]
            if reach == "some":
                ticked = place in reached
            else:
                ticked = parent not in idle and parent not in decided
                if letter != "F" and reach == "first":
                    decided.add(parent)
            if not ticked:
                idle.add(place)
                letters[place] = letter.lower()
        return "".join(letters)


def _reader(places: Iterable[int], attribute: str, nodes: Sequence[Behaviour]) -> FunctionType:
    return make_reader("(" + "".join([f"'{place}'.{attribute}," for place in places]) + ")", nodes)


def make_reader(expression: str, objects: Sequence[object]) -> FunctionType:
    """Make the function that reads attributes of objects.

    It returns what ``expression`` says, in which an object is written as its place in ``objects`` in quotes.
    """
    # With a place in the code for each object, the interpreter remembers at each where in that class
    # the attribute is found; in a loop over objects of many classes it has to search every time,
    # which takes three times as long. Trees of one shape share what is compiled.
    code = _compiled(f"lambda:{expression}")
    named: dict[object, object] = {str(place): each for place, each in enumerate(objects)}
    constants = tuple([named.get(constant, constant) for constant in code.co_consts])
    return FunctionType(code.replace(co_consts=constants), {})


@lru_cache(maxsize=256)
def _compiled(source: str) -> CodeType:
    made: FunctionType = eval(source)
    return made.__code__


def node_ids(nodes: Sequence[Behaviour]) -> list[tuple[int, str]]:
    """Return depth and id of each node of a tree, parents before children; the root has depth 0.

    The id is the names from the root down to the node, joined by slashes. No two are the
    same: of two that would be, the later one ends in ``#2``, and so on.
    """
    found: dict[int, tuple[int, str]] = {}
    taken: set[str] = set()
    # Where to go on counting, else many of one name would take as long as their square.
    numbers: dict[str, int] = {}
    for node in nodes:
        depth, above = found[id(node.parent)] if found else (-1, "")
        name = path = f"{above}/{name_of(node)}" if found else name_of(node)
        number = numbers.get(name, 1)
        while path in taken:
            number += 1
            path = f"{name}#{number}"
        numbers[name] = number
        taken.add(path)
        found[id(node)] = (depth + 1, path)
    return list(found.values())
